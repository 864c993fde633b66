/** Real media: what installed packages carry, what the project draws itself, and the shared ones outside the project. */

import { execFile, execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { promisify } from 'node:util';

const root = resolve(import.meta.dirname, '../../..');
const python = join(root, '.venv/bin/python');

/** What a few lines of Python print, in the environment of the service. */
export const inPython = (lines: string, ...given: string[]): string =>
  execFileSync(python, ['-c', lines, ...given], { cwd: root }).toString().trim();

/**
 * The same, while this process goes on. For whoever has asked the service something and will again: a process that waits
 * does not hear that the service has ended a connection that was at rest, and what it sends over that one is lost.
 */
export const inPythonBeside = async (lines: string, ...given: string[]): Promise<string> =>
  (await promisify(execFile)(python, ['-c', lines, ...given], { cwd: root })).stdout.trim();

/** A portrait that comes with matplotlib. */
export const portrait = inPython(
  'import importlib.util, pathlib; ' +
    'print(pathlib.Path(importlib.util.find_spec("matplotlib").origin).parent / "mpl-data/sample_data/grace_hopper.jpg")',
);

/** A picture without a face, from the same place. */
export const faceless = join(portrait, '../Minduka_Present_Blue_Pack.png');

/** A file as a form sends it. */
export const fileOf = (path: string): File => new File([readFileSync(path)], path.split('/').at(-1) ?? '');

/** Writes a picture of the project's own that shows somebody whole, 450 by 600 pixels. */
export const samplePerson = (path: string): string =>
  inPython(
    'import sys; from PIL import Image; from engine.character.sample import sample_picture as s; ' +
      'Image.fromarray(s()).save(sys.argv[1])',
    path,
  );

/** Writes a picture of somebody, so many pixels high, and the same once more to the right of them: further away, so smaller, on the same floor. */
export const samplePeople = (path: string, height = 600): Promise<string> =>
  inPythonBeside(
    `
import sys
from PIL import Image
from engine.character.sample import sample_picture
one = Image.fromarray(sample_picture(int(sys.argv[2])))
both = Image.new("RGB", (one.width + one.width * 4 // 5, one.height), (128, 138, 148))
both.paste(one, (0, 0))
both.paste(one.resize((one.width * 4 // 5, one.height * 4 // 5)), (one.width, one.height // 5))
both.save(sys.argv[1])
`,
    path,
    String(height),
  );

/** A driver of twelve seconds: a performance of the project's own, three times over. */
export async function lengthyPerformance(): Promise<File> {
  const path = join(mkdtempSync(join(tmpdir(), 'galatea-')), 'lengthy.mp4');
  await inPythonBeside(
    `
import sys
import av
from engine.performances.catalogue import video
with av.open(str(video("happy"))) as source, av.open(sys.argv[1], "w") as target:
    stream = target.add_stream_from_template(source.streams.video[0])
    packets = [packet for packet in source.demux(video=0) if packet.dts is not None]
    length = source.streams.video[0].duration
    for packet in packets:
        packet.stream = stream
    for _ in range(3):
        target.mux(packets)
        for packet in packets:
            packet.pts += length
            packet.dts += length
`,
    path,
  );
  return fileOf(path);
}

const mediaFolder = process.env.GALATEA_TEST_DATA ?? resolve(root, '../shared/data');

/** A file of the shared test media, which are kept outside the project; null where they are absent (never in CI). */
export function media(name: string): string | null {
  const path = join(mediaFolder, name);
  if (existsSync(path)) return path;
  if (process.env.CI === 'true') throw new Error(`test media not found: ${path} (set GALATEA_TEST_DATA)`);
  return null;
}

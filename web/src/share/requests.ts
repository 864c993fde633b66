/** How a program asks for what a job made: the request, ready to be copied. */

import type { Job } from '../api';
import type { Kind } from '../kind/kind';
import { isFileId } from '../works/inputs';
import { pictureName } from '../works/names';

/** For a shell: nothing in it is read as more than text. */
const quoted = (text: string): string => (/^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);

/** In Python, JSON but for three words is what it says. */
const pythonic = (value: unknown): string => {
  if (value === null) return 'None';
  if (typeof value === 'boolean') return value ? 'True' : 'False';
  if (Array.isArray(value)) return `[${value.map(pythonic).join(', ')}]`;
  if (typeof value !== 'object') return JSON.stringify(value);
  return `{${Object.entries(value).map(([name, one]) => `${JSON.stringify(name)}: ${pythonic(one)}`).join(', ')}}`;
};

/** Inputs that are files stand for files of the visitor's own, by names that say which is which. */
function inputsOf(job: Job, kind: Kind): { name: string; file: boolean; value: string }[] {
  const picture = pictureName(job, kind).toLowerCase().replace(/[^a-z0-9]+/g, '-').replace(/^-|-$/g, '') || 'picture';
  const { endings, pictureInput } = kind;
  return Object.entries(job.inputs).flatMap(([name, value]) => {
    const [first] = [value].flat(); // of many files an archive of them, or the first, stands for all
    if (typeof first !== 'string') return [];
    const file = isFileId(first);
    const stem = name === pictureInput ? picture : name;
    return [{ name, file, value: file ? `${stem}.${endings[name] ?? 'bin'}` : first }];
  });
}

export function curlOf(job: Job, kind: Kind, origin: string, key: boolean): string {
  const options = Object.keys(job.options).length > 0;
  return [
    `curl ${quoted(`${origin}/v1/jobs`)}`,
    ...(key ? ['-H "Authorization: Bearer $GALATEA_KEY"'] : []),
    `-H 'Prefer: wait=60'`,
    `-F kind=${quoted(job.kind)}`,
    ...inputsOf(job, kind).map(({ name, file, value }) => `-F ${quoted(`${name}=${file ? '@' : ''}${value}`)}`),
    ...(options ? [`-F ${quoted(`options=${JSON.stringify(job.options)}`)}`] : []),
  ].join(' \\\n  ');
}

export function pythonOf(job: Job, kind: Kind, origin: string, key: boolean): string {
  const inputs = inputsOf(job, kind)
    .map(({ name, file, value }) => `${JSON.stringify(name)}: ${file ? `Path(${JSON.stringify(value)})` : JSON.stringify(value)}`)
    .join(', ');
  return `${key ? 'import os\n' : ''}from pathlib import Path

from galatea_client import Client

with Client(${JSON.stringify(origin)}${key ? ', key=os.environ["GALATEA_KEY"]' : ''}) as galatea:
    job = galatea.submit(${JSON.stringify(job.kind)}, {${inputs}}, ${pythonic(job.options)})
    job.wait().download_all("out")
`;
}

/** What shows the result on a web page, once its files lie beside that page. */
export function htmlOf(job: Job): string | null {
  if (job.artifacts['profile.zip']) {
    return `<script type="module" src="reactive-portrait.js"></script>
<reactive-portrait src="profile/profile.json" width="512" height="640"></reactive-portrait>`;
  }
  const animation = Object.keys(job.artifacts).find((name) => /^animation\.(mp4|webm|webp|gif)$/.test(name));
  if (!animation) return null;
  return /\.(mp4|webm)$/.test(animation)
    ? `<video src="${animation}" autoplay loop muted playsinline></video>`
    : `<img src="${animation}" alt="">`;
}

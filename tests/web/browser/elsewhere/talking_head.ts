/** The avatar in `@met4citizen/talkinghead`, as who builds with it would have it: it says what it is given, by audio and visemes. */

import { TalkingHead } from '@met4citizen/talkinghead';
import type { TalkingHeadPage } from './pages';

const RATE = 22050; // samples a second that it expects
const QUIET = 48; // of 765: two pixels that differ by less look the same
/** Pixels from the line through the eyes, up to which a pixel may be theirs. */
const CLEAR = 2;

const head = new TalkingHead(document.getElementById('avatar')!, {
  lipsyncModules: [], // visemes come with the audio
  cameraView: 'head',
  modelFPS: 10,
});
// its mood takes a pose at random, of which some turn a foot aside
for (const pose of Object.keys(head.poseTemplates)) head.poseTemplates[pose] = head.poseTemplates.straight!;
await head.showAvatar({ url: '/avatar.glb', body: 'F', avatarMood: 'neutral' });
const face = head.morphs[0]!;
const canvas = head.renderer.domElement;

/** A hum, as speech services send their audio: 16 bits a sample. */
function hum(seconds: number): ArrayBuffer {
  const samples = new Int16Array(Math.round(seconds * RATE));
  return samples.map((_, index) => 8000 * Math.sin((2 * Math.PI * 220 * index) / RATE)).buffer;
}

function drawn(): Uint8ClampedArray {
  head.renderer.render(head.scene, head.camera);
  const pen = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d')!;
  pen.drawImage(canvas, 0, 0);
  return pen.getImageData(0, 0, canvas.width, canvas.height).data;
}

/** Where a joint is in the picture, in pixels from its left and upper edges. */
function pixel(joint: string): [number, number] {
  const { x, y } = place(joint).project(head.camera);
  return [((1 + x) / 2) * canvas.width, ((1 - y) / 2) * canvas.height];
}

/** Whether a pixel is on the forehead's side of the line through both eyes, and clear of it: heads are held at an angle, and move. */
function aboveEyes(): (x: number, y: number) => boolean {
  const [[leftX, leftY], [rightX, rightY]] = [pixel('LeftEye'), pixel('RightEye')];
  const margin = CLEAR * Math.hypot(leftX - rightX, leftY - rightY);
  return (x, y) => (leftX - rightX) * (y - rightY) < (leftY - rightY) * (x - rightX) - margin;
}

function place(joint: string) {
  const found = head.armature.getObjectByName(joint)!;
  return found.getWorldPosition(found.position.clone());
}

const page: TalkingHeadPage = {
  speak: (visemes, milliseconds) =>
    head.speakAudio({
      audio: [hum((visemes.length * milliseconds) / 1000)],
      words: ['hum'],
      wtimes: [0],
      wdurations: [visemes.length * milliseconds],
      visemes: [...visemes],
      vtimes: visemes.map((_, index) => index * milliseconds),
      vdurations: visemes.map(() => milliseconds),
    }),
  targets: () => Object.keys(face.morphTargetDictionary!),
  influence: (name) => face.morphTargetInfluences![face.morphTargetDictionary![name]!]!,
  joints: (...names) => names.map((name) => place(name).toArray()),
  shaped: async (name, least) => {
    const [index, influences] = [face.morphTargetDictionary![name]!, face.morphTargetInfluences!];
    while (influences[index]! < least) await new Promise(requestAnimationFrame);
    head.stop();
    const before = drawn();
    influences[index] = 0;
    const after = drawn();
    const isAbove = aboveEyes();
    let [pixels, above] = [0, 0];
    for (let i = 0; i < before.length; i += 4) {
      const apart = [0, 1, 2].reduce((sum, c) => sum + Math.abs(before[i + c]! - after[i + c]!), 0);
      if (apart <= QUIET) continue;
      const [x, y] = [(i / 4) % canvas.width, Math.floor(i / 4 / canvas.width)];
      pixels += 1;
      if (isAbove(x, y)) above += 1;
    }
    return { pixels, above };
  },
};
Object.assign(window, { page });

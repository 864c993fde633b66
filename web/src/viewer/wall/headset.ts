/** The stage in a headset (WebXR): one stands before the picture, in its room. */

import { Group, Vector3 } from 'three';
import type { Stage } from '../scene/stage';

const MODE = 'immersive-vr';

export const hasHeadset = async (): Promise<boolean> =>
  (await navigator.xr?.isSessionSupported(MODE).catch(() => false)) ?? false;

/** Stand at a place of the floor, looking along -z; `onSelect` when the hand or a controller says so. Call the answer to leave. */
export async function enter(stage: Stage, at: Vector3, onSelect: () => void, onEnd: () => void): Promise<() => void> {
  const { renderer, camera, scene } = stage;
  const session = await navigator.xr?.requestSession(MODE, { requiredFeatures: ['local-floor'] });
  if (!session) throw new Error('no session');
  const before = { place: camera.position.clone(), target: stage.controls.target.clone(), fov: camera.fov };
  const feet = new Group(); // the headset moves the camera within what carries it
  feet.position.copy(at);
  feet.add(camera);
  scene.add(feet);
  renderer.xr.enabled = true;
  renderer.xr.setReferenceSpaceType('local-floor');
  await renderer.xr.setSession(session);
  // after the renderer's own: when the session ends, it is the screen's again first
  session.addEventListener('select', onSelect);
  session.addEventListener('end', () => {
    renderer.setAnimationLoop(null);
    renderer.xr.enabled = false;
    feet.remove(camera);
    scene.remove(feet);
    camera.fov = before.fov;
    camera.zoom = 1;
    camera.updateProjectionMatrix();
    stage.look(before.place, before.target);
    onEnd();
  });
  renderer.setAnimationLoop((now: number) => stage.draw(now));
  return () => void session.end();
}

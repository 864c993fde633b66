/** A character under somebody's hands: half transparent, its joints dots that can be dragged. */

import { MeshBasicMaterial, type Quaternion, type SkinnedMesh } from 'three';
import { type Character, PICTURED } from '../scene/character';
import { HandleDots, moved } from './handle_dots';
import { follow, type Handle } from './handles';
import { lowest } from '../scene/lowest';
import { degreesBetween, type Pose, turnedOn } from './pose';
import { placeOf } from './inverse_kinematics';
import type { Stage } from '../scene/stage';

const OPACITY = 0.55;
/** The joint that carries all others. */
const ROOT = 'Hips';

interface Told {
  /** A joint has been taken hold of. */
  onGrasp: (handle: Handle) => void;
  /** The pose while it is dragged; `continues` after the first of a drag. */
  onPose: (pose: Pose, continues: boolean) => void;
}

export class PoseEditor {
  private readonly dots: HandleDots;
  private readonly veil: SkinnedMesh;
  private readonly pictured = new Map<string, Quaternion>();
  /** Heights in the pictured pose, in metres: of the lowest point, and of the hips. */
  private readonly ground: number;
  private readonly hips: number;
  private readonly ending = new AbortController();
  private readonly leave: () => void;
  private pose: Pose = {};
  private drag: { pointer: number; handle: Handle; x: number; y: number; pose: Pose; moved: boolean } | null = null;

  constructor(
    private readonly stage: Stage,
    private readonly character: Character,
    private readonly told: Told,
  ) {
    const { joints, mesh } = character;
    const clip = character.clip(PICTURED);
    if (clip) character.show(clip, 0);
    for (const [name, joint] of joints) this.pictured.set(name, joint.quaternion.clone());
    this.ground = lowest(mesh);
    this.hips = joints.get(ROOT)?.position.y ?? 0;
    this.dots = new HandleDots(joints);
    // drawn first, unseen: behind the nearest surface nothing of the body shines through
    this.veil = mesh.clone();
    this.veil.material = new MeshBasicMaterial({ colorWrite: false });
    this.veil.renderOrder = -1;
    mesh.parent?.add(this.veil);
    this.setOpacity(OPACITY);
    stage.scene.add(this.dots.object);
    this.leave = stage.add(this.dots);
    this.listen();
  }

  /** Stand in a pose, on the ground. */
  show(pose: Pose): void {
    this.pose = pose;
    for (const [name, joint] of this.character.joints) {
      const pictured = this.pictured.get(name);
      if (!pictured) continue;
      const degrees = pose[name];
      joint.quaternion.copy(degrees ? turnedOn(pictured, degrees) : pictured);
    }
    this.stand();
    this.stage.invalidate();
  }

  dispose(): void {
    this.ending.abort();
    this.leave();
    this.setOpacity(1);
    this.veil.removeFromParent();
    (this.veil.material as MeshBasicMaterial).dispose();
    this.stage.scene.remove(this.dots.object);
    this.dots.dispose();
    this.stage.controls.enabled = true;
    this.character.unbend();
  }

  /** The lowest point as high as in the pictured pose, as the engine does it. */
  private stand(): void {
    const { root, joints, mesh } = this.character;
    const hips = joints.get(ROOT);
    if (hips) hips.position.y = this.hips;
    root.updateMatrixWorld(true);
    if (hips) hips.position.y += this.ground - lowest(mesh);
    root.updateMatrixWorld(true);
  }

  private setOpacity(opacity: number): void {
    const material = this.character.mesh.material as MeshBasicMaterial;
    material.transparent = opacity < 1;
    material.opacity = opacity;
    material.needsUpdate = true;
  }

  private listen(): void {
    const { place, renderer, camera } = this.stage;
    const canvas = renderer.domElement;
    const options = { signal: this.ending.signal, capture: true }; // before the camera's own gestures
    const grasp = (event: PointerEvent): void => {
      if (this.drag || event.button > 0) return;
      const handle = this.dots.under(event, canvas, camera);
      if (!handle) return;
      event.stopPropagation();
      canvas.setPointerCapture(event.pointerId);
      place.focus({ preventScroll: true });
      this.dots.chosen = handle;
      this.drag = { pointer: event.pointerId, handle, x: event.clientX, y: event.clientY, pose: this.pose, moved: false };
      this.told.onGrasp(handle);
      this.stage.invalidate();
    };
    const move = (event: PointerEvent): void => {
      if (event.pointerId === this.drag?.pointer) {
        event.stopPropagation();
        this.pull(event.clientX - this.drag.x, event.clientY - this.drag.y);
      } else if (!this.drag) {
        canvas.style.cursor = event.pointerType === 'mouse' && this.dots.under(event, canvas, camera) ? 'grab' : '';
      }
    };
    const release = (event: PointerEvent): void => {
      if (event.pointerId === this.drag?.pointer) this.drag = null;
    };
    place.addEventListener('pointerdown', grasp, options);
    place.addEventListener('pointermove', move, options);
    place.addEventListener('pointerup', release, options);
    place.addEventListener('pointercancel', release, options);
  }

  /** From where the drag began, so that going back is coming back. */
  private pull(right: number, down: number): void {
    const { drag } = this;
    if (!drag) return;
    const { joints } = this.character;
    this.show(drag.pose);
    const joint = joints.get(drag.handle.joint);
    if (!joint) return;
    const { camera, renderer } = this.stage;
    follow(drag.handle, joints, moved(placeOf(joint), camera, renderer.domElement, right, down));
    const turned = drag.handle.turns.flatMap((name) => {
      const [bone, pictured] = [joints.get(name), this.pictured.get(name)];
      return bone && pictured ? [[name, degreesBetween(pictured, bone.quaternion)] as const] : [];
    });
    this.show({ ...drag.pose, ...Object.fromEntries(turned) });
    this.told.onPose(this.pose, drag.moved);
    drag.moved = true;
  }
}

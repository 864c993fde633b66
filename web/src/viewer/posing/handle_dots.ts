/** The handles as dots over the character, always seen and always as large on the screen; and which one is under a pointer. */

import {
  BufferGeometry,
  type CanvasTexture,
  Color,
  Float32BufferAttribute,
  type Object3D,
  type PerspectiveCamera,
  Points,
  ShaderMaterial,
  Vector3,
  type WebGLRenderer,
} from 'three';
import { type Handle, handles } from './handles';
import { drawnTexture } from '../scene/drawn_texture';
import { placeOf } from './inverse_kinematics';

/** Pixels of the page. */
const SIZE = 13;
const CHOSEN_SIZE = 19;
/** How near, in pixels of the page, a finger or pointer has to come. */
const REACH: Record<string, number> = { mouse: 14, pen: 18, touch: 28 };
/** On any picture: a white dot with a dark rim; the chosen one red, as on other pictures of this page. */
const CALM = new Color('#ffffff');
const CHOSEN = new Color('#e2502f');

export class HandleDots {
  readonly object: Points<BufferGeometry, ShaderMaterial>;
  chosen: Handle | null = null;
  private readonly all: { handle: Handle; joint: Object3D }[];
  private readonly disc = disc();

  constructor(joints: ReadonlyMap<string, Object3D>) {
    this.all = handles.flatMap((handle) => {
      const joint = joints.get(handle.joint);
      return joint ? [{ handle, joint }] : [];
    });
    const many = this.all.length;
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', new Float32BufferAttribute(new Float32Array(3 * many), 3));
    geometry.setAttribute('colour', new Float32BufferAttribute(new Float32Array(3 * many), 3));
    geometry.setAttribute('size', new Float32BufferAttribute(new Float32Array(many), 1));
    const material = new ShaderMaterial({
      uniforms: { disc: { value: this.disc } },
      vertexShader: `
        attribute vec3 colour;
        attribute float size;
        varying vec3 tint;
        void main() {
          tint = colour;
          gl_PointSize = size;
          gl_Position = projectionMatrix * viewMatrix * vec4(position, 1.0);
        }`,
      fragmentShader: `
        uniform sampler2D disc;
        varying vec3 tint;
        void main() {
          vec4 shade = texture2D(disc, gl_PointCoord);
          gl_FragColor = vec4(tint * shade.rgb, shade.a);
        }`,
      transparent: true,
      depthTest: false,
      depthWrite: false,
    });
    this.object = new Points(geometry, material);
    this.object.frustumCulled = false;
    this.object.renderOrder = 10;
  }

  /** To where the joints are now. */
  prepare(renderer: WebGLRenderer): void {
    const { position, colour, size } = this.object.geometry.attributes as Record<string, Float32BufferAttribute>;
    if (!position || !colour || !size) return;
    const ratio = renderer.getPixelRatio();
    this.all.forEach(({ handle, joint }, index) => {
      const { x, y, z } = placeOf(joint);
      const chosen = handle === this.chosen;
      const { r, g, b } = chosen ? CHOSEN : CALM;
      position.setXYZ(index, x, y, z);
      colour.setXYZ(index, r, g, b);
      size.setX(index, ratio * (chosen ? CHOSEN_SIZE : SIZE));
    });
    for (const attribute of [position, colour, size]) attribute.needsUpdate = true;
  }

  /** The handle under a pointer: the nearest within reach. */
  under(event: PointerEvent, canvas: HTMLElement, camera: PerspectiveCamera): Handle | null {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    let [found, shortest]: [Handle | null, number] = [null, REACH[event.pointerType] ?? 14];
    for (const { handle, joint } of this.all) {
      const { x, y, z } = placeOf(joint).project(camera);
      const across = left + ((x + 1) / 2) * width - event.clientX;
      const down = top + ((1 - y) / 2) * height - event.clientY;
      const distance = Math.hypot(across, down);
      if (z < 1 && distance < shortest) [found, shortest] = [handle, distance];
    }
    return found;
  }

  dispose(): void {
    this.disc.dispose();
    this.object.geometry.dispose();
    this.object.material.dispose();
  }
}

/** A place in the world, moved as a pointer moves on the screen: in the plane through it that faces the camera. */
export function moved(place: Vector3, camera: PerspectiveCamera, canvas: HTMLElement, right: number, down: number): Vector3 {
  const { clientWidth: width, clientHeight: height } = canvas;
  const seen = place.clone().project(camera);
  seen.x += (2 * right) / width;
  seen.y -= (2 * down) / height;
  const ray = seen.unproject(camera).sub(camera.position);
  const facing = camera.getWorldDirection(new Vector3());
  const distance = place.clone().sub(camera.position).dot(facing);
  return camera.position.clone().addScaledVector(ray, distance / ray.dot(facing));
}

const disc = (): CanvasTexture =>
  drawnTexture(64, (pen, side) => {
    pen.arc(side / 2, side / 2, 25, 0, 2 * Math.PI);
    pen.fillStyle = '#fff';
    pen.fill();
    pen.lineWidth = 9;
    pen.strokeStyle = '#24201b';
    pen.stroke();
  });

/** The ground under somebody: a soft disc, and on it the darkness of what comes near it. */

import {
  type CanvasTexture,
  Color,
  CustomBlending,
  Group,
  MaxEquation,
  Mesh,
  MeshBasicMaterial,
  OneFactor,
  OrthographicCamera,
  PlaneGeometry,
  ShaderMaterial,
  Vector2,
  Vector3,
  type WebGLRenderer,
  WebGLRenderTarget,
} from 'three';
import type { Character } from './character';
import { drawnTexture } from './drawn_texture';

/** Metres that the shadow's picture covers, and its pixels. */
const SIDE = 2.6;
const PIXELS = 256;
/** Metres above the ground from which on nothing darkens it. */
const REACH = 0.7;
const DARKEST = 0.55;
/** Standard deviation of the blur, in pixels of the shadow's picture, and how far it reaches. */
const SOFTNESS = 3.5;
const BLURRED = 9;
/** Metres; the ground is drawn as a disc that fades towards its edge. */
const GROUND = 7;

/** What is low is bright in red: the lower, the brighter; skinned as the character is. */
const nearness = () =>
  new ShaderMaterial({
    uniforms: { floor: { value: 0 } },
    vertexShader: `
      #include <common>
      #include <skinning_pars_vertex>
      varying float height;
      void main() {
        #include <skinbase_vertex>
        #include <begin_vertex>
        #include <skinning_vertex>
        vec4 place = modelMatrix * vec4(transformed, 1.0);
        height = place.y;
        gl_Position = projectionMatrix * viewMatrix * place;
      }`,
    fragmentShader: `
      uniform float floor;
      varying float height;
      void main() {
        float near = clamp(1.0 - (height - floor) / ${REACH.toFixed(2)}, 0.0, 1.0);
        gl_FragColor = vec4(near * near, 0.0, 0.0, 1.0);
      }`,
    depthTest: false,
    blending: CustomBlending,
    blendEquation: MaxEquation,
    blendSrc: OneFactor,
    blendDst: OneFactor,
  });

/**
 * A Gaussian's weights, each with its place in pixels from the middle. A texture that is read between two pixels is their mean,
 * so one reading stands for both: half as many are needed, which counts where there is no graphics card.
 */
function readings(): [place: number, weight: number][] {
  const weight = (k: number): number => Math.exp((-0.5 * k * k) / SOFTNESS ** 2);
  const aside = Array.from({ length: Math.ceil(BLURRED / 2) }, (_, pair): [number, number] => {
    const near = 2 * pair + 1;
    const [one, other] = [weight(near), near < BLURRED ? weight(near + 1) : 0];
    return [near + other / (one + other), one + other];
  });
  const all = 1 + 2 * aside.reduce((sum, [, each]) => sum + each, 0);
  return [[0, 1 / all], ...aside.flatMap(([place, each]): [number, number][] => [[-place, each / all], [place, each / all]])];
}

const blur = () =>
  new ShaderMaterial({
    uniforms: { picture: { value: null }, step: { value: new Vector2() } },
    vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
    fragmentShader: `
      uniform sampler2D picture;
      uniform vec2 step;
      varying vec2 at;
      void main() {
        float sum = 0.0;
        ${readings().map(([place, weight]) => `sum += ${weight.toFixed(8)} * texture2D(picture, at + ${place.toFixed(8)} * step).r;`).join('\n        ')}
        gl_FragColor = vec4(sum, 0.0, 0.0, 1.0);
      }`,
    depthTest: false,
  });

const shown = () =>
  new ShaderMaterial({
    uniforms: { picture: { value: null }, darkness: { value: DARKEST } },
    vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
    fragmentShader: `
      uniform sampler2D picture;
      uniform float darkness;
      varying vec2 at;
      void main() { gl_FragColor = vec4(0.0, 0.0, 0.0, darkness * texture2D(picture, at).r); }`,
    transparent: true,
    depthWrite: false,
  });

/** The shadow that a character has on the ground it stands on; it lies at `y` and moves along. */
export class ContactShadow {
  readonly object = new Group();
  private readonly camera = new OrthographicCamera(-SIDE / 2, SIDE / 2, SIDE / 2, -SIDE / 2, 0, 10);
  private readonly targets = [0, 1].map(() => new WebGLRenderTarget(PIXELS, PIXELS, { depthBuffer: false }));
  private readonly nearness = nearness();
  private readonly blur = blur();
  private readonly shown = shown();
  private readonly sheet = new Mesh(new PlaneGeometry(2, 2), this.blur);
  private readonly plane = new Mesh(new PlaneGeometry(SIDE, SIDE).rotateX(-Math.PI / 2), this.shown);

  constructor(
    private readonly character: Character,
    readonly y = 0,
  ) {
    this.camera.up.set(0, 0, -1); // the picture's up is away from the viewer, as on the plane
    this.sheet.frustumCulled = false;
    this.plane.position.y = 0.003;
    this.plane.renderOrder = 1;
    this.object.position.y = y;
    this.object.add(this.plane);
  }

  /** 1 as it is by nature, 0 for none. */
  set strength(share: number) {
    (this.shown.uniforms.darkness as { value: number }).value = DARKEST * share;
  }

  prepare(renderer: WebGLRenderer): void {
    const { mesh, joints, root } = this.character;
    const [first, second] = this.targets as [WebGLRenderTarget, WebGLRenderTarget];
    const hips = joints.get('Hips')?.getWorldPosition(new Vector3()) ?? new Vector3();
    this.object.position.set(hips.x, this.y, hips.z);
    this.camera.position.set(hips.x, this.y + 5, hips.z);
    this.camera.lookAt(hips.x, this.y, hips.z);
    this.camera.updateMatrixWorld();
    const [target, inXR, colour] = [renderer.getRenderTarget(), renderer.xr.enabled, renderer.getClearColor(new Color())];
    const alpha = renderer.getClearAlpha();
    const material = mesh.material;
    renderer.xr.enabled = false; // these pictures are not for the eyes
    renderer.setClearColor(0, 1);
    mesh.material = this.nearness;
    set(this.nearness, 'floor', this.y);
    renderer.setRenderTarget(first);
    renderer.clear();
    renderer.render(root, this.camera);
    mesh.material = material;
    for (const [from, to, x, y] of [[first, second, 1, 0], [second, first, 0, 1]] as const) {
      set(this.blur, 'picture', from.texture);
      set(this.blur, 'step', new Vector2(x / PIXELS, y / PIXELS));
      renderer.setRenderTarget(to);
      renderer.render(this.sheet, this.camera);
    }
    set(this.shown, 'picture', first.texture);
    renderer.setRenderTarget(target);
    renderer.setClearColor(colour, alpha);
    renderer.xr.enabled = inXR;
  }

  dispose(): void {
    for (const one of [...this.targets, this.nearness, this.blur, this.shown]) one.dispose();
    for (const { geometry } of [this.sheet, this.plane]) geometry.dispose();
  }
}

const set = (material: ShaderMaterial, name: string, value: unknown): void => {
  (material.uniforms[name] as { value: unknown }).value = value;
};

/** A floor without end: a disc that fades into the background. */
export class Ground {
  private readonly texture = fading();
  private readonly material = new MeshBasicMaterial({ map: this.texture, transparent: true, depthWrite: false });
  readonly object = new Mesh(new PlaneGeometry(GROUND, GROUND).rotateX(-Math.PI / 2), this.material);

  /** `x` and `z`: its middle. */
  constructor(x: number, z: number) {
    this.object.position.set(x, 0, z);
  }

  paint(colour: string): void {
    this.material.color.set(colour);
  }

  dispose(): void {
    this.texture.dispose();
    this.material.dispose();
    this.object.geometry.dispose();
  }
}

const fading = (): CanvasTexture =>
  drawnTexture(PIXELS, (pen, side) => {
    const half = side / 2;
    const fade = pen.createRadialGradient(half, half, 0, half, half, half);
    for (const [at, alpha] of [[0, 1], [0.35, 0.75], [1, 0]] as const) fade.addColorStop(at, `rgb(255 255 255 / ${alpha})`);
    pen.fillStyle = fade;
    pen.fillRect(0, 0, side, side);
  });

/** A room with a picture on its wall. */

import {
  BoxGeometry,
  DirectionalLight,
  Group,
  HemisphereLight,
  type Material,
  Mesh,
  MeshBasicMaterial,
  MeshLambertMaterial,
  PlaneGeometry,
  SRGBColorSpace,
  type Texture,
  TextureLoader,
} from 'three';
import type { Hanging } from './hanging';
import { drawnTexture } from '../scene/drawn_texture';

/** Metres. */
const MOULDING = 0.09;
const GILT = 0.018;
/** From the edge of the picture to that of its frame. */
export const FRAME_WIDTH = GILT + MOULDING;
const MOULDING_DEPTH = 0.06;
const AROUND = 3;
const HIGHEST = 0.9;
const DEPTH = 12;
const SKIRTING = 0.1;

interface Paint {
  wall: [lit: string, dim: string];
  floor: [lit: string, dim: string];
  skirting: string;
  air: string;
}
const paints: Record<'light' | 'dark', Paint> = {
  light: { wall: ['#f4efe6', '#d9d1c3'], floor: ['#b99b7a', '#8a7157'], skirting: '#fbf8f2', air: '#d9d1c3' },
  dark: { wall: ['#6a5f53', '#231f1b'], floor: ['#5b4733', '#1d1712'], skirting: '#4a4239', air: '#1a1714' },
};

export class Room {
  readonly object = new Group();
  readonly air: string;
  private readonly made: (Material | Texture | { dispose(): void })[] = [];

  constructor(
    private readonly hanging: Hanging,
    picture: string,
    dark: boolean,
    private readonly onLoad: () => void,
  ) {
    const paint = paints[dark ? 'dark' : 'light'];
    this.air = paint.air;
    this.build(paint);
    this.hangPicture(picture);
    const sun = new DirectionalLight(0xffffff, 2.2);
    sun.position.set(-1, 4, 3);
    this.object.add(new HemisphereLight(0xffffff, 0x806040, 1.4), sun);
  }

  dispose(): void {
    for (const one of this.made) one.dispose();
  }

  private build({ wall, floor, skirting }: Paint): void {
    const { left, right, top, bottom, plane } = this.hanging;
    const [middle, height] = [(left + right) / 2, top + HIGHEST];
    const width = right - left + 2 * AROUND;
    const behind = plane - 0.012;
    const pool = (colours: [string, string], x: number, y: number, reach: number) => this.basic(this.glow(colours, x, y, reach));
    const ahead = this.sheet(width, height, pool(wall, 0.5, 1 - (bottom + top) / 2 / height, 0.62));
    ahead.position.set(middle, height / 2, behind);
    const ground = this.sheet(width, DEPTH, pool(floor, 0.5, 0.12, 0.75));
    ground.rotation.x = -Math.PI / 2;
    ground.position.set(middle, 0, behind + DEPTH / 2);
    const sides = this.basic(null, wall[1]);
    for (const side of [-1, 1]) {
      const aside = this.sheet(DEPTH, height, sides);
      aside.rotation.y = (-side * Math.PI) / 2;
      aside.position.set(middle + (side * width) / 2, height / 2, behind + DEPTH / 2);
    }
    this.box(width, SKIRTING, 0.015, this.lambert(skirting)).position.set(middle, SKIRTING / 2, behind);
    const shade = this.sheet(right - left + 0.9, top - bottom + 0.9, this.shade());
    shade.position.set(middle, (top + bottom) / 2 - 0.06, behind + 0.002);
  }

  private hangPicture(url: string): void {
    const { left, right, top, bottom, plane } = this.hanging;
    const [x, y, width, height] = [(left + right) / 2, (top + bottom) / 2, right - left, top - bottom];
    const texture = new TextureLoader().load(url, this.onLoad);
    texture.colorSpace = SRGBColorSpace;
    texture.anisotropy = 8;
    this.made.push(texture);
    this.sheet(width, height, this.basic(texture)).position.set(x, y, plane);
    const wood = this.lambert('#6b4a2b');
    const gilt = this.lambert('#b98d4a');
    // the outer moulding, and a thin gilt one next to the picture
    for (const [material, off, thick, deep] of [[wood, GILT, MOULDING, MOULDING_DEPTH], [gilt, 0, GILT, 0.036]] as const) {
      for (const side of [-1, 1]) {
        const across = side * (width / 2 + off + thick / 2);
        const along = side * (height / 2 + off + thick / 2);
        this.box(thick, height + 2 * (off + thick), deep, material).position.set(x + across, y, plane + deep / 2 - 0.01);
        this.box(width + 2 * off, thick, deep, material).position.set(x, y + along, plane + deep / 2 - 0.01);
      }
    }
  }

  private sheet(width: number, height: number, material: Material): Mesh {
    return this.mesh(new Mesh(new PlaneGeometry(width, height), material));
  }

  private box(width: number, height: number, depth: number, material: Material): Mesh {
    return this.mesh(new Mesh(new BoxGeometry(width, height, depth), material));
  }

  private mesh(mesh: Mesh): Mesh {
    this.made.push(mesh.geometry);
    this.object.add(mesh);
    return mesh;
  }

  private basic(map: Texture | null, color = '#ffffff'): Material {
    const material = new MeshBasicMaterial({ map, color });
    this.made.push(material);
    return material;
  }

  private lambert(color: string): Material {
    const material = new MeshLambertMaterial({ color });
    this.made.push(material);
    return material;
  }

  /** A pool of light on something dim; its middle as shares of width and height from the top left. */
  private glow([lit, dim]: [string, string], x: number, y: number, reach: number): Texture {
    return this.draw((pen, side) => {
      const light = pen.createRadialGradient(x * side, y * side, 0, x * side, y * side, reach * side);
      light.addColorStop(0, lit);
      light.addColorStop(0.45, lit);
      light.addColorStop(1, dim);
      pen.fillStyle = light;
      pen.fillRect(0, 0, side, side);
    });
  }

  /** The soft shadow that the frame has on the wall. */
  private shade(): Material {
    const map = this.draw((pen, side) => {
      pen.shadowColor = 'rgb(0 0 0 / 38%)';
      pen.shadowBlur = side / 8;
      pen.shadowOffsetX = side; // the shadow alone
      pen.fillRect(side * 0.14 - side, side * 0.14, side * 0.72, side * 0.72);
    });
    const material = new MeshBasicMaterial({ map, transparent: true, depthWrite: false });
    this.made.push(material);
    return material;
  }

  private draw(draw: (pen: CanvasRenderingContext2D, side: number) => void): Texture {
    const texture = drawnTexture(256, draw);
    texture.colorSpace = SRGBColorSpace;
    this.made.push(texture);
    return texture;
  }
}

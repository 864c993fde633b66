/** Somebody who lies in a picture as paint does, and comes out of it as a body. */

import { type MeshBasicMaterial, type SkinnedMesh, Vector2, type Vector3 } from 'three';

/** Metres: how thick the paint is, so that an arm before the chest stays before it. */
const PAINT = 0.02;
const ABOVE_CANVAS = 0.004;
/** Metres before the nearest and behind the furthest of the people that count for the order of the paint. */
const AROUND = 1.5;

export class Emergence {
  private readonly solid: SkinnedMesh['material'];
  private readonly material: MeshBasicMaterial;
  private readonly flatness = { value: 1 };

  /**
   * All is in metres of the room.
   * @param eye From where the picture was taken.
   * @param plane The z of the picture.
   * @param away From the place on the floor where the person stands to their place in the picture's own space.
   * @param depths The z of whoever is furthest there, and nearest.
   */
  constructor(
    private readonly mesh: SkinnedMesh,
    eye: Vector3,
    plane: number,
    away: Vector3,
    depths: readonly [furthest: number, nearest: number],
  ) {
    this.solid = mesh.material;
    this.material = (mesh.material as MeshBasicMaterial).clone();
    this.material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, {
        flatness: this.flatness,
        eye: { value: eye.clone() },
        plane: { value: plane + ABOVE_CANVAS },
        away: { value: away.clone() },
        depths: { value: new Vector2(depths[0] - AROUND, depths[1] + AROUND) },
      });
      shader.vertexShader = `
        uniform float flatness, plane;
        uniform vec2 depths;
        uniform vec3 eye, away;
        ${shader.vertexShader.replace(
          '#include <project_vertex>',
          // along the ray from the eye, where nothing seems to move
          `vec3 standing = (modelMatrix * vec4(transformed, 1.0)).xyz;
          vec3 pictured = standing + away;
          vec3 ray = pictured - eye;
          float canvas = plane + ${PAINT} * smoothstep(depths.x, depths.y, pictured.z);
          vec3 painted = eye + ray * ((canvas - eye.z) / min(ray.z, -0.01));
          vec4 mvPosition = viewMatrix * vec4(mix(standing, painted, flatness), 1.0);
          gl_Position = projectionMatrix * mvPosition;`,
        )}`;
    };
    mesh.material = this.material;
  }

  /** 0: paint; 1: a body. */
  set share(share: number) {
    this.flatness.value = 1 - share;
  }

  dispose(): void {
    this.mesh.material = this.solid;
    this.material.dispose();
  }
}

/** A puppet's skin: the textures of its expressions, blended as its face moves, so that creases come and go. */

import { LinearFilter, type MeshStandardMaterial, SRGBColorSpace, type Texture, TextureLoader } from 'three';
import { sharesOf, type PuppetTextures } from './texture_shares';
import type { FaceWeights } from '../../../viewer/scene/face';

export class BlendedTextures {
  private readonly shares: { value: number[] };

  constructor(
    private readonly material: MeshStandardMaterial,
    private readonly atlas: Texture,
    private readonly told: PuppetTextures,
  ) {
    this.shares = { value: sharesOf(told.textures, {}) };
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, { expressions: { value: atlas }, shares: this.shares });
      shader.fragmentShader = blending(told.textures.length) + shader.fragmentShader.replace('#include <map_fragment>', SAMPLED);
    };
    material.customProgramCacheKey = () => `expressions ${told.textures.length}`;
    material.needsUpdate = true;
  }

  show(weights: FaceWeights): void {
    this.shares.value = sharesOf(this.told.textures, weights);
  }

  dispose(): void {
    this.material.onBeforeCompile = () => undefined;
    this.material.customProgramCacheKey = () => '';
    this.material.needsUpdate = true;
    this.atlas.dispose();
  }
}

/** The pictures stand side by side; their edges are the rim of the face, which no triangle reaches beyond. */
const blending = (count: number): string => `
uniform sampler2D expressions;
uniform float shares[${count}];
vec4 blendedExpressions(vec2 at) {
  vec4 sum = vec4(0.0);
  for (int k = 0; k < ${count}; k++) sum += shares[k] * texture2D(expressions, vec2((clamp(at.x, 0.002, 0.998) + float(k)) / ${count}.0, at.y));
  return sum;
}
`;

const SAMPLED = 'diffuseColor *= blendedExpressions(vMapUv);';

/** Rejects where the picture cannot be had. */
export async function loadAtlas(url: string): Promise<Texture> {
  const atlas = await new TextureLoader().loadAsync(url);
  atlas.colorSpace = SRGBColorSpace;
  atlas.flipY = false; // as textures of a GLB are
  atlas.generateMipmaps = false; // they would run into one another
  atlas.minFilter = LinearFilter;
  return atlas;
}

/** How much of the textures of a puppet's expressions is seen, by how far its face units are moved (puppet_textures.json). */

import type { FaceWeights } from '../../../viewer/scene/face';

export interface ExpressionTexture {
  name: string;
  /** How far each unit is moved in the expression that the texture shows; nothing in the neutral one, which is the first. */
  units: FaceWeights;
}

export interface PuppetTextures {
  /** Width and height of each, in pixels; they stand side by side. */
  size: [width: number, height: number];
  textures: readonly ExpressionTexture[];
}

/**
 * A share for each texture; together they are 1. An expression has as much of its texture as the least moved of its units
 * has come. Of several that are more than one face together each has its part. What is left is the neutral one's.
 */
export function sharesOf(textures: readonly ExpressionTexture[], weights: FaceWeights): number[] {
  const shown = textures.map(({ units }) => {
    const shares = Object.entries(units).map(([unit, full]) => Math.min(1, (weights[unit] ?? 0) / full));
    return shares.length ? Math.min(...shares) : 0;
  });
  const all = shown.reduce((sum, share) => sum + share, 0);
  const [, ...expressions] = all > 1 ? shown.map((share) => share / all) : shown;
  return [Math.max(0, 1 - all), ...expressions];
}

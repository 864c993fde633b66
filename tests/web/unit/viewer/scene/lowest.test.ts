import { lowest } from '@web/viewer/scene/lowest';
import { Bone, BufferGeometry, Float32BufferAttribute, Skeleton, SkinnedMesh, Uint16BufferAttribute, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';

/** A rod of two metres, bent half way up: its joints at heights of 0 and 1. */
function rod(places: number[], joints: number[], weights: number[]) {
  const [lower, upper] = [new Bone(), new Bone()];
  upper.position.y = 1;
  lower.add(upper);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(places, 3));
  geometry.setAttribute('skinIndex', new Uint16BufferAttribute(joints, 4));
  geometry.setAttribute('skinWeight', new Float32BufferAttribute(weights, 4));
  const mesh = new SkinnedMesh(geometry);
  mesh.add(lower);
  mesh.bind(new Skeleton([lower, upper]));
  return { mesh, lower, upper };
}

describe('the lowest point of a character', () => {
  it('is what the bones make of it', () => {
    const { mesh, lower, upper } = rod([0, 0, 0, 0, 1, 0, 0, 2, 0], [0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0], [1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0]);
    expect(lowest(mesh)).toBeCloseTo(0, 6);
    upper.rotation.x = Math.PI; // folded: its tip is beside its foot
    lower.position.y = 0.5;
    mesh.updateMatrixWorld(true);
    expect(lowest(mesh)).toBeCloseTo(0.5, 6);
    lower.rotation.z = -Math.PI / 2; // along the ground, and the tip turned up from it
    upper.rotation.set(0, 0, Math.PI / 2);
    mesh.updateMatrixWorld(true);
    expect(lowest(mesh)).toBeCloseTo(0.5, 6);
    upper.rotation.z = -Math.PI / 2; // and down
    mesh.updateMatrixWorld(true);
    expect(lowest(mesh)).toBeCloseTo(-0.5, 6);
  });

  it('is where three draws it', () => {
    const many = 50;
    const wave = (k: number): number => Math.sin(12.9898 * k) * 2;
    const { mesh, lower, upper } = rod(
      Array.from({ length: 3 * many }, (_, k) => wave(k)),
      Array.from({ length: many }, () => [0, 1, 0, 0]).flat(),
      Array.from({ length: many }, (_, k) => [k / many, 1 - k / many, 0, 0]).flat(),
    );
    mesh.position.set(3, 2, 1);
    lower.rotation.set(0.3, 0.5, -0.7);
    upper.rotation.set(-1, 0.2, 0.4);
    mesh.updateMatrixWorld(true);
    const heights = Array.from({ length: many }, (_, k) => mesh.localToWorld(mesh.getVertexPosition(k, new Vector3())).y);
    expect(lowest(mesh)).toBeCloseTo(Math.min(...heights), 5);
  });
});

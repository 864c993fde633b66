/** What a character's face does: what a clip has it do, and what is set by hand besides. */

import type { AnimationClip, Interpolant, Mesh } from 'three';

/** By the names of the mesh's morph targets, from 0 to 1. */
export type FaceWeights = Readonly<Record<string, number>>;

interface Acting {
  mesh: Mesh;
  weights: Interpolant;
}

export class Face {
  /** The names of all morph targets. */
  readonly names: readonly string[];
  private readonly meshes: readonly Mesh[];
  private readonly acted = new Map<AnimationClip, readonly Acting[]>();
  private byHand: FaceWeights = {};
  private readonly watchers = new Set<(weights: FaceWeights) => void>();
  private shown: { clip: AnimationClip; second: number } | null = null;

  /**
   * Takes the tracks of morph targets out of the clips: the mixer writes what changes alone, and what is set by hand would
   * stay when it is taken back.
   */
  constructor(meshes: readonly Mesh[], clips: readonly AnimationClip[]) {
    this.meshes = meshes.filter(({ morphTargetDictionary }) => morphTargetDictionary);
    this.names = [...new Set(this.meshes.flatMap((mesh) => Object.keys(mesh.morphTargetDictionary!)))];
    const trackOf = (mesh: Mesh): string => `${mesh.name || mesh.uuid}.morphTargetInfluences`;
    for (const clip of clips) {
      const acting = this.meshes.flatMap((mesh): Acting[] => {
        const track = clip.tracks.find(({ name }) => name === trackOf(mesh));
        return track ? [{ mesh, weights: (track as unknown as { createInterpolant(): Interpolant }).createInterpolant() }] : [];
      });
      if (acting.length) this.acted.set(clip, acting);
      clip.tracks = clip.tracks.filter(({ name }) => !name.endsWith('.morphTargetInfluences'));
    }
  }

  /** As it is at a second of a clip; null for no clip. */
  act(clip: AnimationClip | null, second = 0): void {
    this.shown = clip && { clip, second };
    this.apply();
  }

  /** What is set by hand, and added to what the clip does. */
  set(weights: FaceWeights): void {
    this.byHand = weights;
    this.apply();
    for (const watcher of this.watchers) watcher(weights);
  }

  /** Calls back with what is set by hand, now and at each change; returns what ends that. */
  watch(watcher: (weights: FaceWeights) => void): () => void {
    this.watchers.add(watcher);
    watcher(this.byHand);
    return () => this.watchers.delete(watcher);
  }

  private apply(): void {
    const acting = (this.shown && this.acted.get(this.shown.clip)) ?? [];
    for (const mesh of this.meshes) {
      const influences = mesh.morphTargetInfluences!;
      const own = acting.find((one) => one.mesh === mesh)?.weights.evaluate(this.shown!.second) as ArrayLike<number> | undefined;
      for (const [name, index] of Object.entries(mesh.morphTargetDictionary!)) {
        influences[index] = Math.min(1, (own?.[index] ?? 0) + (this.byHand[name] ?? 0));
      }
    }
  }
}

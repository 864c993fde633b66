/** The shape that was fitted to points: a mesh without a texture, in a light of its own. */

import { useEffect, useState } from 'preact/hooks';
import { type BufferGeometry, DirectionalLight, HemisphereLight, Mesh, MeshStandardMaterial } from 'three';
import { PLYLoader } from 'three/examples/jsm/loaders/PLYLoader.js';
import type { Stage } from '../scene/stage';

const CLAY = 0xb9aa97;

/** The geometry of a PLY file with faces; null until it is there. `onTrouble`: it cannot be read. */
export function useShape(url: string | undefined, onTrouble: () => void): BufferGeometry | null {
  const [geometry, setGeometry] = useState<BufferGeometry | null>(null);
  useEffect(() => {
    if (url === undefined) return;
    const stop = new AbortController();
    let made: BufferGeometry | null = null;
    const load = async (): Promise<void> => {
      try {
        const response = await fetch(url, { signal: stop.signal });
        if (!response.ok) throw new Error(`${response.status}`);
        made = new PLYLoader().parse(await response.arrayBuffer());
        made.computeVertexNormals();
        if (!stop.signal.aborted) setGeometry(made);
      } catch {
        if (!stop.signal.aborted) onTrouble();
      }
    };
    void load();
    return () => {
      stop.abort();
      setGeometry(null);
      made?.dispose();
    };
    // links are signed anew: the file is the same until its path is another
  }, [url?.split('?')[0]]);
  return geometry;
}

/** Stand a shape on a stage, as long as there are both. */
export function useStandingShape(stage: Stage | null, geometry: BufferGeometry | null): void {
  useEffect(() => {
    if (!stage || !geometry) return;
    const material = new MeshStandardMaterial({ color: CLAY, roughness: 0.85 });
    const lamp = new DirectionalLight(0xffffff, 2);
    lamp.position.set(0.6, 1.2, 1.5);
    const lights = [new HemisphereLight(0xffffff, 0x6b6258, 1.4), lamp];
    const objects = [new Mesh(geometry, material), ...lights];
    stage.scene.add(...objects);
    stage.invalidate();
    return () => {
      stage.scene.remove(...objects);
      material.dispose();
      for (const light of lights) light.dispose();
      stage.invalidate();
    };
  }, [stage, geometry]);
}

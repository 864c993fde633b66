/** What is around a character: ground and shadow, light or dark, lines of the skeleton, the whole screen. */

import type { RefObject } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { DirectionalLight, HemisphereLight, LineBasicMaterial, SkeletonHelper } from 'three';
import { ContactShadow, Ground } from './shadow';
import type { Stage } from './stage';
import type { StagedCharacter } from './staging';

/** The page's own colours for sunken places, and a floor that is seen on them. */
const backgrounds = { light: '#efeae1', dark: '#191714' };
const floors = { light: '#fffdf9', dark: '#35302a' };
const BONES = 0xe2502f;
/** From above and below, and from before: textures that were photographed have light of their own. */
const [SKY, FLOOR, SOFT, LAMP] = [0xffffff, 0xcfc6b8, 2.4, 0.9] as const;

/** Whether the page is dark, and whether the background is: as the page until it is changed by hand. */
function useDark(): [boolean, () => void] {
  const wish = matchMedia('(prefers-color-scheme: dark)');
  const [page, setPage] = useState(wish.matches);
  const [other, setOther] = useState(false);
  useEffect(() => {
    const heed = (): void => setPage(wish.matches);
    wish.addEventListener('change', heed);
    return () => wish.removeEventListener('change', heed);
  }, []);
  return [page !== other, () => setOther(!other)];
}

/** The empty surroundings; `elsewhere` where another room is built. */
export function useSurroundings(stage: Stage, cast: readonly StagedCharacter[], elsewhere: boolean) {
  const [dark, toggle] = useDark();
  useEffect(() => {
    if (elsewhere) return;
    const places = cast.map(({ character }) => character.root.position);
    const middle = (values: number[]): number => (Math.min(...values) + Math.max(...values)) / 2;
    const standing = cast.filter(({ character }) => character.stands);
    const grounds = standing.length ? [new Ground(middle(places.map(({ x }) => x)), middle(places.map(({ z }) => z)))] : [];
    const shadows = standing.map(({ character }) => new ContactShadow(character));
    const lamp = new DirectionalLight(0xffffff, LAMP);
    lamp.position.set(0.6, 1.2, 1.5);
    const lights = [new HemisphereLight(SKY, FLOOR, SOFT), lamp]; // of those who are drawn unlit nothing changes
    const objects = [...grounds.map(({ object }) => object), ...shadows.map(({ object }) => object), ...lights];
    stage.scene.add(...objects);
    for (const ground of grounds) ground.paint(dark ? floors.dark : floors.light);
    stage.paint(dark ? backgrounds.dark : backgrounds.light);
    const leave = shadows.map((shadow) => stage.add(shadow));
    return () => {
      stage.scene.remove(...objects);
      for (const one of [...grounds, ...shadows, ...lights]) one.dispose();
      for (const go of leave) go();
    };
  }, [stage, cast, elsewhere, dark]);
  return { dark, toggle };
}

/** The bones as lines over the mesh, where they are switched on. */
export function useSkeletonLines(stage: Stage, cast: readonly StagedCharacter[], allowed: boolean) {
  const [on, setOn] = useState(false);
  const shown = on && allowed;
  useEffect(() => {
    if (!shown) return;
    const all = cast.map(({ character }) => {
      const lines = new SkeletonHelper(character.root);
      const material = lines.material as LineBasicMaterial;
      material.vertexColors = false;
      material.color.set(BONES);
      return lines;
    });
    stage.scene.add(...all);
    stage.invalidate();
    return () => {
      stage.scene.remove(...all);
      for (const lines of all) lines.dispose();
      stage.invalidate();
    };
  }, [stage, cast, shown]);
  return { on, toggle: () => setOn(!on) };
}

/** Over the whole screen and back; null where the browser allows none. */
export function useWideView(element: RefObject<HTMLElement | null>) {
  const [on, setOn] = useState(false);
  useEffect(() => {
    const heed = (): void => setOn(document.fullscreenElement !== null && document.fullscreenElement === element.current);
    document.addEventListener('fullscreenchange', heed);
    return () => document.removeEventListener('fullscreenchange', heed);
  }, []);
  if (!document.fullscreenEnabled) return null;
  const toggle = (): void => void (on ? document.exitFullscreen() : element.current?.requestFullscreen());
  return { on, toggle };
}

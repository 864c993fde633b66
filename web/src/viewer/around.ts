/** What is around a character: ground and shadow, light or dark, lines of the skeleton, the whole screen. */

import type { RefObject } from 'preact';
import { useEffect, useState } from 'preact/hooks';
import { LineBasicMaterial, SkeletonHelper } from 'three';
import type { Character } from './character';
import { ContactShadow, Ground } from './shadow';
import type { Stage } from './stage';

/** The page's own colours for sunken places, and a floor that is seen on them. */
const backgrounds = { light: '#efeae1', dark: '#191714' };
const grounds = { light: '#fffdf9', dark: '#35302a' };
const BONES = 0xe2502f;

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
export function useSurroundings(stage: Stage, character: Character, elsewhere: boolean) {
  const [dark, toggle] = useDark();
  useEffect(() => {
    if (elsewhere) return;
    const ground = new Ground();
    const shadow = new ContactShadow(character);
    stage.scene.add(ground.object, shadow.object);
    ground.paint(dark ? grounds.dark : grounds.light);
    stage.paint(dark ? backgrounds.dark : backgrounds.light);
    const leave = stage.add(shadow);
    return () => {
      stage.scene.remove(ground.object, shadow.object);
      ground.dispose();
      shadow.dispose();
      leave();
    };
  }, [stage, character, elsewhere, dark]);
  return { dark, toggle };
}

/** The bones as lines over the mesh, where they are switched on. */
export function useSkeletonLines(stage: Stage, character: Character, allowed: boolean) {
  const [on, setOn] = useState(false);
  const shown = on && allowed;
  useEffect(() => {
    if (!shown) return;
    const lines = new SkeletonHelper(character.root);
    const material = lines.material as LineBasicMaterial;
    material.vertexColors = false;
    material.color.set(BONES);
    stage.scene.add(lines);
    stage.invalidate();
    return () => {
      stage.scene.remove(lines);
      lines.dispose();
      stage.invalidate();
    };
  }, [stage, character, shown]);
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

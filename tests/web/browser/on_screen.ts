/** Places of a picture that is edited, on the screen. */

import type { Page } from 'playwright-core';
import { settled } from './settled';

/** Where places of the edited picture, in its pixels, are on the screen, once the picture lies still there. */
export const onScreen = (page: Page, places: [number, number][]): Promise<[number, number][]> =>
  settled(() =>
    page.evaluate((given) => {
      const matrix = document.querySelector<SVGSVGElement>('[role=application] > svg')?.getScreenCTM();
      return given.map(([x, y]) => {
        const point = new DOMPoint(x, y).matrixTransform(matrix ?? undefined);
        return [point.x, point.y] as [number, number];
      });
    }, places),
  );

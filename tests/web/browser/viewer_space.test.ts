/** A character in one's own room, by model-viewer. */

import './nobody_works';
import { describe, expect, it } from 'vitest';
import { address } from './own_service';
import { aViewer, CLIPS } from './viewer_kit';

const { open } = aViewer();

describe('model-viewer', () => {
  it('shows the same character with the same clips, and plays them', async () => {
    const page = await open({ reducedMotion: 'no-preference' });
    const asked: string[] = [];
    page.on('request', (request) => asked.push(request.url()));
    await page.locator('.viewer-stage[aria-busy="false"]').waitFor();
    await page.getByRole('button', { name: 'View in your space' }).click();
    await page.waitForFunction(() => document.querySelector('model-viewer')?.loaded);
    const shown = await page.evaluate(() => {
      const viewer = document.querySelector('model-viewer')!;
      return {
        clips: viewer.availableAnimations,
        modes: viewer.getAttribute('ar-modes'),
        files: [viewer.src, viewer.iosSrc],
      };
    });
    expect(shown.clips).toEqual(CLIPS);
    expect(shown.modes).toBe('webxr scene-viewer quick-look');
    for (const [file, name] of [[shown.files[0], 'character.glb'], [shown.files[1], 'character.usdz']] as const) {
      expect(file, 'an address for apps outside the browser').toMatch(/^http:\/\/127\.0\.0\.1/);
      expect(new URL(file ?? '').pathname.endsWith(`/${name}`)).toBe(true);
      expect((await fetch(file ?? '')).status, 'it opens without a cookie').toBe(200);
    }
    await page.getByText('This device has no AR').waitFor();
    await page.waitForFunction(
      () => {
        const viewer = document.querySelector('model-viewer')!;
        return !viewer.paused && viewer.animationName === 'walk_in_place' && viewer.currentTime > 0.1;
      },
    );
    const ours = new RegExp(`^(${address}/|blob:|data:)`);
    expect(asked.filter((url) => !ours.test(url)), 'nobody else is asked for anything').toEqual([]);
    await page.getByRole('button', { name: 'Close' }).click();
    await page.locator('model-viewer').waitFor({ state: 'detached' });
  });
});

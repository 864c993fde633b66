import './nobody_works';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { complaints, expectComplaint } from './complaints';
import { launch } from './browser';
import { lacks } from './lacks';
import { portrait } from './media';
import { address } from './own_service';
import { open } from './page';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const start = (page: Page) => page.getByRole('button', { name: 'Bring it to life' });
const portraitInput = (page: Page) => page.getByLabel(/Drop a picture|Portrait:/);
const performance = (page: Page, name: string) => page.locator('form').getByText(name, { exact: true });

describe('choosing', () => {
  it('offers the built-in performances of the service', async () => {
    const { items } = (await (await fetch(`${address}/v1/drivers`)).json()) as { items: { name: string }[] };
    expect(items.map((driver) => driver.name)).toEqual(expect.arrayContaining(['idle', 'happy', 'surprise']));
    const page = await open(browser);
    for (const name of ['Best match', 'Idle', 'Happy', 'Normal']) {
      await page.getByRole('radio', { name, exact: true }).waitFor();
    }
  });

  it('keeps the performance when it is to be played the other way', async () => {
    const page = await open(browser);
    await performance(page, 'Anger').click();
    await page.getByRole('radio', { name: 'Strong', exact: true }).check();
    const anger = page.getByRole('radio', { name: 'Anger', exact: true });
    await expect.poll(() => anger.isChecked()).toBe(true);
    await expect.poll(() => anger.getAttribute('value')).toBe('anger-strong');
  });

  it('says what is missing until nothing is', async () => {
    const page = await open(browser);
    await expect.poll(() => start(page).isDisabled()).toBe(true);
    await page.getByText('Choose a portrait to begin.').waitFor();
    await portraitInput(page).setInputFiles(portrait);
    await page.getByText('Grace hopper · Happy').waitFor(); // a mood is chosen beforehand
    await performance(page, 'Fear').click();
    await page.getByText('Grace hopper · Fear').waitFor();
    await expect.poll(() => start(page).isEnabled()).toBe(true);
  });

  it.each([390, 1280])('lays nothing over anything else at %i pixels, wherever it is scrolled to', async (width) => {
    const page = await open(browser);
    await page.setViewportSize({ width, height: 844 });
    await page.getByRole('radio', { name: 'Idle', exact: true }).waitFor({ state: 'attached' });
    for (const share of [0, 0.3, 0.6, 1]) {
      await page.evaluate((share) => scrollTo(0, share * document.documentElement.scrollHeight), share);
      // but for the bar with the button, which is always in sight
      const bar = share === 1 ? ', .launch' : '';
      const parts = page.locator(`.studio > header, .studio .panel${bar}`);
      await expect.poll(() => parts.count()).toBe(share === 1 ? 4 : 3);
      const laid = () =>
        parts.evaluateAll((all) => {
          const places = all.map((part) => part.getBoundingClientRect());
          return places.flatMap((one, k) =>
            places.slice(k + 1).map((other) => {
              const across = Math.min(one.right, other.right) - Math.max(one.left, other.left);
              const down = Math.min(one.bottom, other.bottom) - Math.max(one.top, other.top);
              return Math.min(across, down);
            }),
          );
        });
      await expect.poll(async () => Math.max(...(await laid())), { message: 'pixels that one lies over another' }).toBeLessThanOrEqual(0);
    }
  });

  it('can be done with the keyboard alone', async () => {
    const page = await open(browser);
    // Listened for from the start: the browser has to know of it before the key that opens the chooser is pressed.
    page.on('filechooser', (chooser) => void chooser.setFiles(portrait));
    await page.getByRole('radio', { name: 'Idle', exact: true }).waitFor();
    await page.keyboard.press('Tab');
    await expect.poll(() => focused(page)).toBe('Skip to the content');
    await page.keyboard.press('Enter');
    const { kinds } = await import('@web/kinds');
    for (const place of kinds.all.map(({ label }) => label)) {
      await page.keyboard.press('Tab');
      await expect.poll(() => focused(page)).toBe(place);
    }
    for (const place of ['Pause', 'Grace Hopper', 'Eileen Collins', 'A man, painted', 'A man, rendered']) {
      await page.keyboard.press('Tab');
      await expect.poll(() => named(page)).toContain(place);
    }
    await page.keyboard.press('Tab');
    await page.keyboard.press('Space');
    await page.getByLabel('Portrait: grace_hopper.jpg. Choose another').waitFor();
    await page.keyboard.press('Tab');
    await expect.poll(() => focused(page)).toBe('Take a picture');
    await page.keyboard.press('Tab');
    await page.keyboard.press('ArrowRight');
    await expect.poll(() => page.getByRole('radio', { name: 'Strong', checked: true }).count()).toBe(1);
    await page.keyboard.press('Tab');
    await page.keyboard.press('ArrowLeft'); // from the one that is chosen beforehand
    await expect.poll(() => page.getByRole('radio', { name: 'Idle', exact: true, checked: true }).count()).toBe(1);
    await start(page).focus();
    await expect.poll(() => start(page).isEnabled()).toBe(true);
  });

  it('finds the place of a file that is dropped anywhere', async () => {
    const page = await open(browser);
    await portraitInput(page).waitFor({ state: 'attached' }); // a studio is loaded after its page
    await page.evaluate(() => {
      const data = new DataTransfer();
      // they begin as a picture and a video do, and hold nothing
      data.items.add(new File([Uint8Array.of(0x89, 0x50, 0x4e, 0x47, 13, 10, 26, 10)], 'someone.png'));
      data.items.add(new File([Uint8Array.of(0, 0, 0, 8), 'ftypisom'], 'smile.mp4'));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    });
    await page.getByLabel('Portrait: someone.png. Choose another').waitFor({ state: 'attached' });
    await page.getByLabel('Video: smile.mp4. Choose another').waitFor({ state: 'attached' });
    await page.getByText('This browser cannot show a preview').first().waitFor();
    expectComplaint(/./); // the browser says itself that these are no media
  });

  it('sends the options that were chosen', async () => {
    const page = await open(browser);
    await portraitInput(page).setInputFiles(portrait);
    await performance(page, 'Happy').click();
    await page.getByText('Options').click();
    await page.getByLabel('Strength').fill('0.5');
    await page.getByLabel('Head').uncheck();
    await lacks(page.getByLabel('Keep the sound'), page.getByLabel('Strength')); // built-in performances are silent
    const [request] = await Promise.all([
      page.waitForRequest((r) => r.url().endsWith('/v1/jobs') && r.method() === 'POST'),
      start(page).click(),
    ]);
    expect(request.postDataJSON()).toMatchObject({
      kind: 'portrait',
      inputs: { driver: 'happy' },
      options: { strength: 0.5, follow: ['eyes', 'brows', 'mouth'] },
      metadata: { portrait: 'Grace hopper', performance: 'Happy' },
    });
    await page.getByRole('heading', { name: 'Grace hopper' }).waitFor();
  });
});

const named = (page: Page): Promise<string> =>
  page.evaluate(() => {
    const one = document.activeElement;
    return one?.getAttribute('aria-label') ?? one?.querySelector('img')?.alt ?? '';
  });

const focused = (page: Page): Promise<string> =>
  page.evaluate(() => (document.activeElement as HTMLElement | null)?.innerText ?? '');

import './portraits_only';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { complaints } from './complaints';
import { launch } from './browser';
import { lacks } from './lacks';
import { portrait } from './media';
import { address } from './own_service';
import { jobOf, open, played } from './page';
import { settled } from './settled';

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
const hopper = (page: Page) => page.getByRole('button', { name: /^Grace Hopper/ });
const sizes = [
  { width: 1440, height: 900 },
  { width: 390, height: 844 },
];

describe('whoever comes for the first time', () => {
  it.each(sizes)('sees samples and the button without scrolling at $width by $height, and needs two clicks', async (viewport) => {
    const page = await open(browser, '', { viewport });
    await page.evaluate(() => {
      const counted = window as unknown as { clicks: number };
      counted.clicks = 0;
      addEventListener('click', (event) => event.detail > 0 && counted.clicks++, true);
    });
    await page.getByRole('radio', { name: 'Happy', exact: true, checked: true }).waitFor({ state: 'attached' });
    for (const one of [hopper(page), start(page)]) await expect.poll(() => inSight(one)).toBe(true);
    await hopper(page).click();
    await page.getByLabel('Portrait: Grace Hopper.jpg. Choose another').waitFor({ state: 'attached' });
    await expect.poll(() => page.evaluate(() => scrollY)).toBe(0);
    await start(page).click();
    await page.waitForURL(/#\/jobs\//);
    if (viewport.width > 1000) await played(page); // nothing more is needed for it, in whatever window
    else await fetch(`${address}/v1/jobs/${jobOf(page)}/cancel`, { method: 'POST' });
    const clicks = await page.evaluate(() => (window as unknown as { clicks: number }).clicks);
    console.info(`from the start page to the first result at ${viewport.width} by ${viewport.height}: ${clicks} clicks`);
    expect(clicks).toBe(2);
  });

  it('sees a portrait move, and can stop it', async () => {
    const page = await open(browser);
    await moving(page);
    await page.getByRole('button', { name: 'Pause' }).click();
    await page.waitForFunction(() => document.querySelector('video')?.paused);
    await page.getByRole('button', { name: 'Play' }).click();
    await page.waitForFunction(() => !document.querySelector('video')?.paused);
  });

  it('sees it stand still where motion is unwelcome, until it is asked for', async () => {
    const page = await open(browser, '', { reducedMotion: 'reduce' });
    await page.getByRole('radio', { name: 'Happy', exact: true }).waitFor({ state: 'attached' });
    await page.waitForFunction(() => (document.querySelector('video')?.readyState ?? 0) > 1);
    await expect.poll(() => page.evaluate(() => document.querySelector('video')?.paused)).toBe(true);
    await page.getByRole('button', { name: 'Play' }).click();
    await moving(page);
  });

  it('finds nothing jump when a picture is chosen', async () => {
    const page = await open(browser);
    await page.getByRole('radio', { name: 'Happy', exact: true }).waitFor({ state: 'attached' });
    /** Pixels: where each heading begins, and how high all is, of one moment. */
    const places = () =>
      page.locator('.studio').evaluate((form) => [
        ...Array.from(form.querySelectorAll('h2'), (heading) => heading.getBoundingClientRect().top),
        form.getBoundingClientRect().height,
      ]);
    const before = await settled(places);
    await hopper(page).click();
    await page.getByLabel('Portrait: Grace Hopper.jpg. Choose another').waitFor({ state: 'attached' });
    await expect.poll(places).toEqual(before);
  });
});

describe('a file that cannot be taken', () => {
  const notes = { name: 'notes.jpg', mimeType: 'image/jpeg', buffer: Buffer.from('hi') };

  it.each(sizes)('is refused in sight at $width by $height, and no picture of before is animated in its place', async (viewport) => {
    for (const place of ['', '#/character']) {
      const page = await open(browser, place, { viewport });
      const launch = page.getByRole('button', { name: place ? 'Create character' : 'Bring it to life' });
      const refusal = page.getByRole('alert').filter({ hasText: 'This is not a picture.' });
      await page.getByLabel(/Drop a picture/).setInputFiles(portrait);
      await page.getByLabel(/grace_hopper.jpg. Choose another/).setInputFiles(notes);
      await refusal.waitFor();
      await expect.poll(() => inSight(refusal)).toBe(true);
      await lacks(page.getByLabel(/grace_hopper.jpg/), refusal);
      await expect.poll(() => launch.isDisabled()).toBe(true);
      await page.locator('.samples button').first().click();
      await refusal.waitFor({ state: 'detached' });
      await page.waitForFunction(() => document.querySelector<HTMLButtonElement>('.launch [type=submit]')?.disabled === false);
      await page.evaluate(() => {
        scrollTo(0, document.documentElement.scrollHeight);
        const data = new DataTransfer();
        data.items.add(new File(['hi'], 'notes.jpg'));
        document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
      });
      await refusal.waitFor();
      await expect.poll(() => inSight(refusal)).toBe(true);
      await expect.poll(() => launch.isDisabled()).toBe(true);
      await page.close();
    }
  });

  it('leaves nothing chosen where it was to be the performance or the motion', async () => {
    const page = await open(browser);
    await page.getByLabel(/Drop a picture/).setInputFiles(portrait);
    await page.getByText('Grace hopper · Happy').waitFor();
    await page.getByLabel(/Drop a video/).setInputFiles(notes);
    await page.getByRole('alert').filter({ hasText: 'This is not a video.' }).waitFor();
    await expect.poll(() => start(page).isDisabled()).toBe(true);
    await page.locator('form').getByText('Happy', { exact: true }).click();
    await page.getByText('Grace hopper · Happy').waitFor();
    await page.getByRole('link', { name: 'Character', exact: true }).click();
    await page.getByLabel(/Drop a picture/).setInputFiles(portrait);
    await page.getByText('Grace hopper · Walk').waitFor();
    await page.getByLabel(/Drop a BVH/).setInputFiles(notes);
    await page.getByRole('alert').filter({ hasText: 'This is not a motion file.' }).waitFor();
    await expect.poll(() => page.locator('.launch [type=submit]').isDisabled()).toBe(true);
    await page.locator('form').getByText('Walk', { exact: true }).click();
    await page.getByText('Grace hopper · Walk').waitFor();
  });

  it('stays refused where another is refused as well, and after a look at another page', async () => {
    const page = await open(browser);
    const wrongVideo = page.getByRole('alert').filter({ hasText: 'This is not a video.' });
    const happy = page.getByRole('radio', { name: 'Happy', exact: true });
    await expect.poll(() => happy.isChecked()).toBe(true);
    await page.getByLabel(/Drop a video/).setInputFiles(notes);
    await wrongVideo.waitFor();
    await page.getByLabel(/Drop a picture/).setInputFiles(notes);
    await page.getByRole('alert').filter({ hasText: 'This is not a picture.' }).waitFor();
    await wrongVideo.waitFor();
    await page.getByLabel(/Drop a picture/).setInputFiles(portrait);
    await wrongVideo.waitFor();
    await expect.poll(() => happy.isChecked()).toBe(false);
    await expect.poll(() => start(page).isDisabled()).toBe(true);

    await page.getByRole('link', { name: 'Character', exact: true }).click();
    await page.getByRole('heading', { name: 'Portrait' }).waitFor({ state: 'detached' });
    await page.getByRole('link', { name: 'Portrait', exact: true }).click();
    await wrongVideo.waitFor();
    await expect.poll(() => happy.isChecked()).toBe(false);
  });
});

describe('what was chosen', () => {
  it('is still chosen after a look at the other pages', async () => {
    const page = await open(browser);
    await page.getByLabel(/Drop a picture/).setInputFiles(portrait);
    await page.locator('form').getByText('Surprise', { exact: true }).click();
    await page.getByRole('link', { name: 'Character', exact: true }).click();
    await page.getByLabel(/Drop a picture/).setInputFiles(portrait);
    await page.getByRole('link', { name: 'Keys', exact: true }).click();
    await page.getByRole('link', { name: 'Galatea' }).click();
    await page.getByLabel('Portrait: grace_hopper.jpg. Choose another').waitFor({ state: 'attached' });
    await expect.poll(() => page.getByRole('radio', { name: 'Surprise' }).isChecked()).toBe(true);
    await page.getByRole('link', { name: 'Character', exact: true }).click();
    await page.getByLabel('Picture: grace_hopper.jpg. Choose another').waitFor({ state: 'attached' });
  });
});

it('hands out the samples to programs, too', async () => {
  const answer = await fetch(`${address}/samples/grace-hopper.jpg`);
  expect(answer.headers.get('content-type')).toBe('image/jpeg');
  const body = new FormData();
  body.append('file', new File([await answer.blob()], 'grace-hopper.jpg'));
  expect((await fetch(`${address}/v1/files`, { method: 'POST', body })).status).toBe(201);
});

const inSight = (what: ReturnType<Page['locator']>): Promise<boolean> =>
  what.evaluate((element) => {
    const { top, bottom, left, right } = element.getBoundingClientRect();
    const seen = document.elementFromPoint((left + right) / 2, (top + bottom) / 2);
    return top >= 0 && left >= 0 && bottom <= innerHeight && right <= innerWidth && element.contains(seen);
  });

const moving = (page: Page) =>
  page.waitForFunction(() => {
    const video = document.querySelector('video');
    return video && !video.paused && video.currentTime > 0.2;
  });

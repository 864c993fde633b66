import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, inject, it } from 'vitest';
import { complaints, launch, media, open, portrait } from './page';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints).toEqual([]);
});

const start = (page: Page) => page.getByRole('button', { name: 'Bring it to life' });
const portraitInput = (page: Page) => page.getByLabel(/Drop a picture|Portrait:/);
const performance = (page: Page, name: string) => page.locator('form').getByText(name, { exact: true });
const videoInput = (page: Page) => page.getByLabel(/Drop a video|Video:/);

describe('choosing', () => {
  it('offers the built-in performances of the service', async () => {
    const { items } = (await (await fetch(`${inject('address')}/v1/drivers`)).json()) as { items: { name: string }[] };
    expect(items.map((driver) => driver.name)).toEqual(expect.arrayContaining(['idle', 'happy', 'surprise']));
    const page = await open(browser);
    for (const name of ['Idle', 'Happy', 'Surprise']) await page.getByRole('radio', { name }).waitFor();
  });

  it('says what is missing until nothing is', async () => {
    const page = await open(browser);
    expect(await start(page).isDisabled()).toBe(true);
    await page.getByText('First choose a portrait.').waitFor();
    await portraitInput(page).setInputFiles(portrait);
    await page.getByText('Now choose a performance.').waitFor();
    await performance(page, 'Happy').click();
    expect(await start(page).isEnabled()).toBe(true);
  });

  it('can be done with the keyboard alone', async () => {
    const page = await open(browser);
    await page.getByRole('radio', { name: 'Idle' }).waitFor();
    await page.keyboard.press('Tab');
    expect(await focused(page)).toBe('Skip to the content');
    await page.keyboard.press('Enter');
    await page.keyboard.press('Tab');
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.keyboard.press('Space')]);
    await chooser.setFiles(portrait);
    await page.getByLabel('Portrait: grace_hopper.jpg. Choose another').waitFor();
    await page.keyboard.press('Tab');
    await page.keyboard.press('Space');
    expect(await page.getByRole('radio', { checked: true }).count()).toBe(1);
    await start(page).focus();
    expect(await start(page).isEnabled()).toBe(true);
  });

  it('refuses what is no picture, in plain words, and keeps the one it has', async () => {
    const page = await open(browser);
    await portraitInput(page).setInputFiles(portrait);
    await portraitInput(page).setInputFiles({ name: 'notes.txt', mimeType: 'text/plain', buffer: Buffer.from('hi') });
    await page.getByText('That is not a picture.').waitFor();
    await page.getByLabel('Portrait: grace_hopper.jpg. Choose another').waitFor({ state: 'attached' });
  });

  it('finds the place of a file that is dropped anywhere', async () => {
    const page = await open(browser);
    await page.evaluate(() => {
      const data = new DataTransfer();
      data.items.add(new File(['x'], 'someone.png', { type: 'image/png' }));
      data.items.add(new File(['x'], 'smile.mp4', { type: 'video/mp4' }));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: data, bubbles: true, cancelable: true }));
    });
    await page.getByLabel('Portrait: someone.png. Choose another').waitFor({ state: 'attached' });
    await page.getByLabel('Video: smile.mp4. Choose another').waitFor({ state: 'attached' });
    expect(await page.getByText('No preview in this browser').count()).toBeGreaterThan(0);
    complaints.length = 0; // the browser says itself that these are no media
  });

  it('sends the options that were chosen', async () => {
    const page = await open(browser);
    await portraitInput(page).setInputFiles(portrait);
    await performance(page, 'Happy').click();
    await page.getByText('Options').click();
    await page.getByLabel('Strength').fill('0.5');
    await page.getByLabel('Head').uncheck();
    expect(await page.getByLabel('Keep the sound').count()).toBe(0); // built-in performances are silent
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

  it('shows how much of a video has been sent, and stops when told to', async ({ skip }) => {
    const video = media('driving/man_grimace_d0.mp4') ?? skip('the shared test media are not here');
    const page = await open(browser);
    const slow = await page.context().newCDPSession(page);
    await slow.send('Network.emulateNetworkConditions', {
      offline: false,
      latency: 0,
      downloadThroughput: -1,
      uploadThroughput: 300_000,
    });
    await portraitInput(page).setInputFiles(portrait);
    await videoInput(page).setInputFiles(video);
    await start(page).click();
    await page.getByText(/Sending the video: [1-9]\d?%/).waitFor();
    await page.getByRole('button', { name: 'Stop' }).click();
    await start(page).waitFor();
    expect(new URL(page.url()).hash).toBe('');
  });
});

const focused = (page: Page): Promise<string> =>
  page.evaluate(() => (document.activeElement as HTMLElement | null)?.innerText ?? '');

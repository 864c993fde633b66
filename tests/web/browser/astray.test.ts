import './nobody_works';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { answered, complaints, expectComplaint } from './complaints';
import { launch } from './browser';
import { address } from './own_service';
import { nothingToResume, open } from './page';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const found = (page: Page) => page.getByRole('heading', { name: 'Page not found' });

describe('an address that means nothing', () => {
  it.each(['#/jobs/%E0%A4%A', '#/shared/%', '#/nonsense', '#/keys/1/2'])('is told of, and left: %s', async (hash) => {
    const page = await open(browser, hash);
    await found(page).waitFor();
    await page.getByRole('link', { name: 'Go to the start page' }).click();
    await page.getByRole('heading', { name: 'Bring a portrait to life' }).waitFor();
  });

  it('is told of where the service is asked for it, too', async () => {
    expect((await fetch(`${address}/gallery`)).status).toBe(404);
    const page = await open(browser, 'gallery');
    await found(page).waitFor();
    expectComplaint(answered(404));
  });
});

it('an address that changes as soon as the page is drawn is followed', async () => {
  const page = await open(browser, '', {}, () => {
    new MutationObserver((_, observer) => {
      if (!document.querySelector('main')) return;
      observer.disconnect();
      location.hash = '#/nonsense';
    }).observe(document, { childList: true, subtree: true });
  });
  await found(page).waitFor({ timeout: 20_000 });
});

describe('help', () => {
  it.each(['', '#/character', '#/history', '#/keys', '#/webhooks', '#/nonsense'])('is at hand on the page %s', async (hash) => {
    const page = await open(browser, hash);
    const links = page.getByRole('navigation', { name: 'About Galatea' }).getByRole('link');
    await expect.poll(() => links.allInnerTexts()).toEqual(['Help', 'API reference', 'OpenAPI', 'Responsible use', 'Licences']);
  });

  it('is of no reference for programs where somebody was sent a link', async () => {
    const page = await open(browser, '#/shared/none');
    const links = page.getByRole('navigation', { name: 'About Galatea' }).getByRole('link');
    await expect.poll(() => links.allInnerTexts()).toEqual(['Responsible use', 'Licences']);
    await page.getByRole('heading', { name: 'This link does not work' }).waitFor();
    expectComplaint(answered(404));
  });

  it('begins with how the page is used, the text before the list of all of it, and leads back', async () => {
    const page = await open(browser, '', { viewport: { width: 390, height: 844 } });
    await page.getByRole('navigation', { name: 'About Galatea' }).getByRole('link', { name: 'Help' }).click();
    const heading = page.getByRole('heading', { level: 1, name: 'Using the page' });
    await heading.waitFor();
    const topics = page.getByRole('navigation', { name: 'Help' });
    await expect.poll(() => topics.getByRole('link').first().innerText()).toBe('Using the page');
    const below = async (): Promise<number> => (await topics.boundingBox())!.y - (await heading.boundingBox())!.y;
    await expect.poll(below).toBeGreaterThan(0);
    await page.getByRole('link', { name: 'Back to the page' }).click();
    await page.getByRole('heading', { name: 'Bring a portrait to life' }).waitFor();
  });

  it('comes from the service itself, whole', async () => {
    const seen = new Set<string>();
    const left = ['/help/page.html', '/help/index.html', '/help/rest.html', '/help/responsible-use.html', '/help/licences.html', '/v1/openapi.json'];
    for (let path = left.pop(); path; path = left.pop()) {
      if (seen.has(path)) continue;
      seen.add(path);
      const answer = await fetch(address + path);
      expect(answer.status, path).toBe(200);
      if (!path.endsWith('.html')) continue;
      for (const [, to = ''] of (await answer.text()).matchAll(/(?:href|src)="([^"#]+)/g)) {
        if (!/^[a-z]+:/.test(to)) left.push(new URL(to, address + path).pathname);
      }
    }
    expect(seen.size).toBeGreaterThan(15);
  });
});

describe('an upload that the service refuses', () => {
  it('is told of once, and not offered again', async () => {
    const page = await open(browser);
    await page.route('**/v1/uploads', (route) =>
      route.fulfill({ status: 415, contentType: 'application/problem+json', body: JSON.stringify({ code: 'media_type_unsupported', detail: 'Send a JPEG.' }) }),
    );
    await page.getByRole('button', { name: /^Grace Hopper/ }).click();
    await page.getByRole('button', { name: 'Bring it to life' }).click();
    await page.getByText('Send a JPEG.').waitFor();
    await page.reload();
    await nothingToResume(page);
    expectComplaint(answered(415));
  });
});

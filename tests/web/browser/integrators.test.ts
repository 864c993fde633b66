import './webhooks_only';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import type { Browser } from 'playwright-core';
import { Webhook } from 'standardwebhooks';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { answered, complaints, expectComplaint } from './complaints';
import { launch } from './browser';
import { LONG } from './jobs';
import { lacks } from './lacks';
import { address, finished } from './own_service';
import { open } from './page';

let browser: Browser;
let receiver: Server;
const received: { body: string; headers: Record<string, string> }[] = [];
const tests = (): typeof received => received.filter(({ body }) => JSON.parse(body).type === 'webhook.test');
let answer = 503;
beforeAll(async () => {
  browser = await launch();
  receiver = createServer((request, response) => {
    let body = '';
    request.on('data', (part: Buffer) => (body += part.toString()));
    request.on('end', () => {
      received.push({ body, headers: request.headers as Record<string, string> });
      response.writeHead(answer);
      response.end('come back later');
    });
  });
  await new Promise<void>((ready) => receiver.listen(0, '127.0.0.1', ready));
});
afterAll(async () => {
  receiver.close();
  await browser.close();
});
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

const service = (path: string, token?: string): Promise<Response> =>
  fetch(address + path, token ? { headers: { Authorization: `Bearer ${token}` } } : {});

describe('keys', () => {
  it('are made, shown once, used by a program, and revoked after a question', async () => {
    const page = await open(browser, '#/keys');
    await page.getByLabel('Name', { exact: true }).fill('Picture shop');
    await page.getByLabel('admin').uncheck();
    await page.getByRole('button', { name: 'Create key' }).click();
    const token = await page.getByLabel('Key', { exact: true }).inputValue();
    expect(await (await service('/v1/key', token)).json()).toMatchObject({ name: 'Picture shop', scopes: ['read', 'submit'] });
    await page.reload();
    await lacks(page.getByText(token), page.getByText('Picture shop', { exact: true }));
    await page.getByRole('button', { name: 'Revoke: Picture shop' }).click();
    await page.getByRole('button', { name: 'Cancel' }).click();
    await page.getByRole('button', { name: 'Revoke: Picture shop' }).click();
    await page.getByRole('button', { name: 'Revoke it' }).click();
    await page.getByText('Revoked').waitFor();
    expect((await service('/v1/key', token)).status).toBe(401);
  });
});

describe('webhooks', () => {
  it('are added, tested, looked into, and what did not come through is sent again', async () => {
    const url = `http://127.0.0.1:${(receiver.address() as AddressInfo).port}/galatea`;
    const page = await open(browser, '#/webhooks');
    await page.getByLabel('URL', { exact: true }).fill(url);
    await page.getByRole('button', { name: 'Add endpoint' }).click();
    const secret = await page.getByLabel(`Signing secret for ${url}`).inputValue();
    const added = page.locator('li.endpoint').filter({ hasText: url });
    await added.getByRole('button', { name: 'Send a test' }).click();
    const isTest = page.getByText('Test', { exact: true }); // jobs of other tests are told here, too
    const row = page.locator('.rows details').filter({ hasText: url }).filter({ has: isTest }).first();
    await row.locator('summary').getByText('503').waitFor({ timeout: LONG });
    await row.locator('summary').click();
    await row.getByText('come back later').first().waitFor();

    answer = 200;
    await row.getByText('Delivered').waitFor({ timeout: LONG }); // tried again by itself
    const { body, headers } = tests().at(-1)!;
    expect(new Webhook(secret).verify(body, headers)).toMatchObject({ type: 'webhook.test' });
    const before = tests().length;
    await row.getByRole('button', { name: 'Send again' }).click();
    await expect.poll(() => tests().length, { timeout: LONG }).toBeGreaterThan(before);
    expect(tests().at(-1)!.headers['webhook-id']).toBe(headers['webhook-id']);

    await added.getByRole('button', { name: 'Signing secret', exact: true }).click();
    await added.getByRole('button', { name: 'Rotate secret' }).click();
    await added.getByText('The previous secret stays valid until').waitFor();
    await expect.poll(() => added.getByRole('textbox', { name: 'Signing secret', exact: true }).inputValue()).not.toBe(secret);
  });

  it('refuse addresses of the network, in plain words', async () => {
    const page = await open(browser, '#/webhooks');
    await page.getByLabel('URL', { exact: true }).fill('http://10.1.2.3/hook');
    await page.getByRole('button', { name: 'Add endpoint' }).click();
    await page.getByRole('alert').waitFor();
    expectComplaint(answered(422)); // the refusal
  });
});

describe('a link', () => {
  it('shows the video to others until it is taken back', async () => {
    const page = await open(browser, `#/jobs/${finished.portrait}`);
    await page.getByText('Share', { exact: true }).click({ timeout: LONG });
    await page.getByLabel('Expires after').selectOption('1 day');
    await page.getByRole('button', { name: 'Create link' }).click();
    const link = await page.getByLabel('Link', { exact: true }).inputValue();
    const other = await browser.newPage();
    await other.goto(link);
    await other.getByRole('heading', { name: 'A portrait brought to life' }).waitFor();
    await other.waitForFunction(() => (document.querySelector('video')?.currentTime ?? 0) > 0.2);
    const film = other.getByLabel('The portrait, acting out');
    await expect.poll(() => film.evaluate((video: HTMLVideoElement) => video.muted)).toBe(true);
    const still = await browser.newPage({ reducedMotion: 'reduce' });
    await still.goto(link);
    await still.getByRole('region', { name: 'Result' }).getByRole('button', { name: 'Play' }).waitFor();
    await still.waitForFunction(() => (document.querySelector('video')?.readyState ?? 0) > 1);
    await expect.poll(() => still.locator('video').evaluate((video: HTMLVideoElement) => video.paused)).toBe(true);
    await lacks(other.getByRole('banner').getByRole('navigation'), other.getByRole('banner'));
    await page.getByRole('button', { name: 'Revoke' }).click();
    await page.getByRole('button', { name: 'Revoke' }).waitFor({ state: 'detached' });
    await other.reload();
    await other.getByRole('heading', { name: 'This link does not work' }).waitFor();
  });
});

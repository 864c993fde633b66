import './nobody_works';
import type { Browser, Page } from 'playwright-core';
import { afterAll, afterEach, beforeAll, describe, expect, it } from 'vitest';
import { answered, complaints, expectComplaint } from './complaints';
import { isMade, launchIn3D } from './character_kit';
import { readable } from './axe';
import { portrait } from './media';
import { finished, somebody } from './own_service';
import { open } from './page';

let browser: Browser;
const { portrait: done, noFace: failed, character, noPerson: nobody } = finished;
beforeAll(async () => {
  browser = await launchIn3D();
});
afterAll(() => browser.close());
afterEach(async () => {
  for (const context of browser.contexts()) await context.close();
  expect(complaints.splice(0)).toEqual([]);
});

/** Each page, brought to where most of it shows. */
const places: Record<string, { hash: () => string; show: (page: Page) => Promise<void> }> = {
  'the start page': {
    hash: () => '',
    show: async (page) => {
      await page.getByLabel(/Drop a picture/).setInputFiles(portrait);
      await page.getByText('Options').click();
    },
  },
  'the start page of characters': {
    hash: () => '#/character',
    show: async (page) => {
      await page.getByLabel(/Drop a picture/).setInputFiles(somebody);
      await page.getByText('Options').click();
    },
  },
  'a character with its corrections': {
    hash: () => `#/jobs/${character}`,
    show: async (page) => {
      await isMade(page);
      await page.getByText('Edit and make again').click();
      await page.getByRole('button', { name: 'Paint the mask' }).waitFor();
    },
  },
  'its joints': {
    hash: () => `#/jobs/${character}`,
    show: async (page) => {
      await page.getByText('Edit and make again').click();
      await page.getByRole('button', { name: 'Move the joints' }).click();
      await page.getByLabel('Hands, feet and face').check();
    },
  },
  'its parts, painted': {
    hash: () => `#/jobs/${character}`,
    show: async (page) => {
      await page.getByText('Edit and make again').click();
      await page.getByRole('button', { name: 'Paint the body parts' }).click();
      await page.getByRole('radio', { name: 'Torso' }).check();
      await page.getByRole('dialog').getByRole('application').click();
    },
  },
  'a picture of nobody': {
    hash: () => `#/jobs/${nobody}`,
    show: async (page) => {
      await page.getByText('Correct and try again').click();
      await page.getByRole('button', { name: 'Place the joints by hand' }).waitFor();
    },
  },
  'a result with its corrections and links': {
    hash: () => `#/jobs/${done}`,
    show: async (page) => {
      await page.getByRole('region', { name: 'Result and performance' }).waitFor();
      await page.getByText('Share', { exact: true }).click();
      await page.getByRole('button', { name: 'Create link' }).click();
      await page.getByRole('button', { name: 'Revoke' }).first().waitFor();
      await page.getByText('All files', { exact: true }).click();
      await page.getByText('Use in code', { exact: true }).click();
      await page.getByRole('heading', { name: 'curl' }).waitFor();
      await page.getByText('Edit and make again').click();
      await page.getByRole('button', { name: 'Move the landmarks' }).waitFor();
    },
  },
  'the landmarks': {
    hash: () => `#/jobs/${done}`,
    show: async (page) => {
      await page.getByText('Edit and make again').click();
      await page.getByRole('button', { name: 'Move the landmarks' }).click();
      await page.getByLabel('Single points').check();
    },
  },
  'a failure': {
    hash: () => `#/jobs/${failed}`,
    show: async (page) => {
      await page.getByText('Correct and try again').click();
      await page.getByRole('button', { name: 'Place the face by hand' }).waitFor();
    },
  },
  'the help': { hash: () => 'help/rest.html', show: (page) => page.getByRole('heading', { name: 'REST guide' }).waitFor() },
  'an address that means nothing': { hash: () => '#/nonsense', show: (page) => page.getByRole('heading', { name: 'Page not found' }).waitFor() },
  'the history': { hash: () => '#/history', show: (page) => page.locator('.entry').first().waitFor() },
  'the keys': {
    hash: () => '#/keys',
    show: async (page) => {
      await page.getByLabel('Name', { exact: true }).fill('axe');
      await page.getByRole('button', { name: 'Create key' }).click();
      await page.getByText('Copy it now').waitFor();
    },
  },
  'the webhooks': {
    hash: () => '#/webhooks',
    show: async (page) => {
      await page.getByLabel('URL', { exact: true }).fill('http://127.0.0.1:9/axe');
      await page.getByRole('button', { name: 'Add endpoint' }).click();
      await page.getByRole('button', { name: 'Send a test' }).first().click();
      await page.locator('.rows details summary').first().click();
      await page.getByRole('button', { name: 'Send again' }).waitFor();
    },
  },
  'the camera': {
    hash: () => '',
    show: async (page) => {
      await page.getByRole('button', { name: 'Record yourself' }).click();
      await page.getByRole('dialog').getByRole('alert').waitFor();
    },
  },
  'a link that opens nothing': {
    hash: () => '#/shared/nothing',
    show: async (page) => {
      await page.getByRole('heading', { name: 'This link does not work' }).waitFor();
      expectComplaint(answered(404));
    },
  },
};

describe.each(Object.entries(places))('%s', (_name, { hash, show }) => {
  it('is readable by everybody, on a wide page, light and dark, and on a phone', async () => {
    const page = await open(browser, hash(), { colorScheme: 'light', reducedMotion: 'reduce' });
    await show(page);
    await readable(page);
  });
});

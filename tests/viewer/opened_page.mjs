// A page of shape-view in Chromium, what is seen of it, and what tests do with every page.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync } from 'node:fs';
import { after, before } from 'node:test';
import { launch, settled } from './browser.mjs';

export const folder = process.env.SHAPESPACE_PAGE_DIR;
export const pictures = process.env.SHAPESPACE_SCREENSHOT_DIR;
export const url = (name) => `file://${folder}/${name}.html`;

export let browser;
before(async () => {
  browser = await launch();
  if (pictures) mkdirSync(pictures, { recursive: true });
});
after(() => browser.close());

// Opens a page, and fails at the end if it wrote anything to the console or asked for anything.
export async function open(name, options = {}, body = async () => {}) {
  const context = await browser.newContext({
    viewport: { width: 1280, height: 800 },
    reducedMotion: 'reduce',
    ...options,
  });
  const page = await context.newPage();
  const faults = [];
  page.on('console', (message) => faults.push(`${message.type()}: ${message.text()}`));
  page.on('pageerror', (error) => faults.push(`exception: ${error.stack}`));
  page.on('request', (request) => {
    if (!/^(file|data|blob):/.test(request.url())) faults.push(`request: ${request.url()}`);
  });
  try {
    await page.goto(name.startsWith('file:') ? name : url(name));
    await settled(page);
    await body(page);
    // Software rasterisers complain of reading pixels back, which tests make them do; and Ceres tells
    // of steps that it leaves out.
    assert.deepEqual(
      faults.filter((fault) => !/GPU stall|warning: \w+\.cc:\d+ Skipping/.test(fault)),
      [],
    );
  } finally {
    await context.close();
  }
}

// What is seen of the stage, or of a part of it: x and width as shares.
export async function look(page, [from, to] = [0, 1]) {
  await page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
  const box = await page.locator('#canvas').boundingBox();
  const clip = {
    x: box.x + from * box.width,
    y: box.y + 30,
    width: (to - from) * box.width,
    height: box.height - 110,
  };
  return (await page.screenshot({ clip })).toString('base64');
}

// The pixels of a picture, red, green, blue and alpha, as a handle of the browser's.
export function pixelsOf(page, picture) {
  return page.evaluateHandle(async (data) => {
    const image = new Image();
    image.src = `data:image/png;base64,${data}`;
    await image.decode();
    const canvas = document.createElement('canvas');
    canvas.width = image.width;
    canvas.height = image.height;
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    return context.getImageData(0, 0, image.width, image.height).data;
  }, picture);
}

// The share of pixels that differ visibly between two looks.
export async function difference(page, one, other) {
  return page.evaluate(
    (pixels) => {
      let count = 0;
      for (let i = 0; i < pixels[0].length; i += 4) {
        const off = [0, 1, 2].map((k) => Math.abs(pixels[0][i + k] - pixels[1][i + k]));
        if (off[0] + off[1] + off[2] > 24) ++count;
      }
      return (4 * count) / pixels[0].length;
    },
    [await pixelsOf(page, one), await pixelsOf(page, other)],
  );
}

export async function assertChanges(page, act, least = 0.005, part = [0, 1]) {
  const before = await look(page, part);
  await act();
  const after = await look(page, part);
  const share = await difference(page, before, after);
  assert.ok(share > least, `only ${(100 * share).toFixed(2)} % of the pixels changed`);
}

export const time = (page) => page.locator('#time').inputValue().then(Number);

export async function setTime(page, value) {
  await page.locator('#time').evaluate((input, to) => {
    input.value = to;
    input.dispatchEvent(new Event('input'));
  }, value);
}

export async function saved(page, button) {
  const [download] = await Promise.all([
    page.waitForEvent('download', { timeout: 60000 }),
    page.locator(button).click(),
  ]);
  return { name: download.suggestedFilename(), bytes: readFileSync(await download.path()) };
}

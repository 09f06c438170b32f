// Pictures of the pages that screenshots.sh has made, into the folder named.
import { launch, settled } from './browser.mjs';

const folder = process.argv[2];
const browser = await launch();

async function shoot(name, { width, height, colorScheme }, act) {
  const page = await browser.newPage({
    viewport: { width, height },
    colorScheme,
    reducedMotion: 'reduce',
  });
  await page.goto(`file://${process.cwd()}/${name}.html`);
  await settled(page);
  await page.keyboard.press('Shift'); // a first touch, after which the hint is gone
  await act(page);
  await page.waitForTimeout(1000);
  await page.screenshot({ path: `${folder}/view-${name === 'walk' ? 'path' : name}.png` });
  await page.close();
}

async function setTime(page, value) {
  await page.locator('#time').evaluate((input, to) => {
    input.value = to;
    input.dispatchEvent(new Event('input'));
  }, value);
}

await shoot('walk', { width: 1000, height: 760, colorScheme: 'light' }, async (page) => {
  await page.locator('#colour').selectOption('deviation');
  await setTime(page, 0.7);
});
await shoot('two', { width: 1000, height: 760, colorScheme: 'dark' }, async (page) => {
  await page.locator('#wireframe').check();
  await setTime(page, 0.5);
});
await shoot('smooth', { width: 1000, height: 760, colorScheme: 'light' }, async (page) => {
  await setTime(page, 0.3);
});
await shoot('space', { width: 1000, height: 640, colorScheme: 'light' }, async (page) => {
  await page.locator('#draw').click();
  const { x, y, width, height } = await page.locator('#plane').boundingBox();
  for (let i = 0; i <= 40; ++i) {
    const t = i / 40;
    const across = [x + width * (0.3 + 0.4 * t), y + height * (0.55 - 0.14 * Math.sin(6 * t))];
    await page.mouse.move(...across);
    if (i === 0) await page.mouse.down();
  }
  await page.mouse.up();
  await setTime(page, 0.3);
});
await shoot('modes', { width: 1000, height: 760, colorScheme: 'light' }, async (page) => {
  for (const [mode, value] of [
    [0, -1.2],
    [1, 0.8],
  ]) {
    await page
      .locator('#modes input')
      .nth(mode)
      .evaluate((input, to) => {
        input.value = to;
        input.dispatchEvent(new Event('input'));
      }, value);
  }
});
await shoot('markers', { width: 1000, height: 640, colorScheme: 'light' }, async (page) => {
  const { x, y, width, height } = await page.locator('#canvas').boundingBox();
  for (const [u, v] of [
    [0.12, 0.45],
    [0.2, 0.45],
    [0.29, 0.45],
    [0.28, 0.55],
    [0.28, 0.67],
    [0.36, 0.3],
    [0.44, 0.33],
  ]) {
    await page.mouse.click(x + u * width, y + v * height);
    await page.mouse.click(x + (u + 0.5) * width, y + v * height);
  }
});
await shoot('bones', { width: 1000, height: 760, colorScheme: 'light' }, async (page) => {
  await page.locator('#bones').check();
  await setTime(page, 0.3);
});
await browser.close();

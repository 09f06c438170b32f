// For each page named: its size, the time until its first frame, and the time that scripts take for
// a frame while it plays, in a space along a curve across it. What the browser and its rasteriser do
// besides is not in the last.
import { statSync } from 'node:fs';
import { resolve } from 'node:path';
import { drawCurve, launch, settled } from './browser.mjs';

const browser = await launch();
for (const file of process.argv.slice(2)) {
  const page = await browser.newPage({
    viewport: { width: 1280, height: 800 },
    reducedMotion: 'reduce',
  });
  await page.addInitScript(() => {
    window.frames_ = [];
    const native = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (callback) =>
      native((now) => {
        const begin = performance.now();
        callback(now);
        window.frames_.push({ begin, took: performance.now() - begin });
      });
  });
  await page.goto(`file://${resolve(file)}`);
  await settled(page);
  const first = await page.evaluate(() => window.frames_[0].begin + window.frames_[0].took);
  if (await page.locator('#draw').isVisible()) await drawCurve(page);
  // All shapes reach the GPU in a first round; the second is measured.
  await page.locator('#play').click();
  await page.waitForTimeout(10000);
  await page.evaluate(() => (window.frames_.length = 0));
  await page.waitForTimeout(8000);
  const frames = await page.evaluate(() => window.frames_);
  const times = frames.map(({ took }) => took).sort((a, b) => a - b);
  const at = (share) => times[Math.floor(share * (times.length - 1))].toFixed(2);
  const rate = (frames.length - 1) / ((frames.at(-1).begin - frames[0].begin) / 1000);
  const size = (statSync(file).size / 1e6).toFixed(2);
  console.log(
    `${file}: ${size} MB, first frame after ${(first / 1000).toFixed(2)} s; playing, scripts take ` +
      `${at(0.5)} ms a frame (at most ${at(1)}), ${rate.toFixed(1)} frames a second by ` +
      'software',
  );
  await page.close();
}
await browser.close();

// Chromium, as the tests of the page and its measurement use it.
import { chromium } from 'playwright-core';
import { execFileSync } from 'node:child_process';

const software = ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

export function launch(flags = software) {
  const executablePath = execFileSync('sh', ['-c', 'command -v chromium'], { encoding: 'utf8' });
  return chromium.launch({ executablePath: executablePath.trim(), args: flags });
}

// A curve across the plane of a space, by mouse.
export async function drawCurve(page) {
  await page.locator('#draw').click();
  const box = await page.locator('#plane').boundingBox();
  const at = (x, y) => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(0.3, 0.65));
  await page.mouse.down();
  for (let i = 1; i <= 20; ++i) {
    const t = i / 20;
    await page.mouse.move(...at(0.3 + 0.4 * t, 0.65 - 0.25 * Math.sin(Math.PI * t)));
  }
  await page.mouse.up();
}

// Waits until the page shows a scene, drawn, or says why not.
export async function settled(page) {
  await page.waitForFunction(
    () =>
      !document.getElementById('layout').hidden ||
      document.getElementById('message').textContent !== 'Loading\u2026',
  );
  await page.evaluate(
    () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))),
  );
}

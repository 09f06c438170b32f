// Chromium, as the tests of the page and its measurement use it.
import { chromium } from 'playwright-core';
import { execFileSync } from 'node:child_process';

const software = ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];

export function launch(flags = software) {
  const executablePath = execFileSync('sh', ['-c', 'command -v chromium'], { encoding: 'utf8' });
  return chromium.launch({ executablePath: executablePath.trim(), args: flags });
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

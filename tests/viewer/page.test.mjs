// What a person does with a page of shape-view, done by a program.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync, writeFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { deflateSync, inflateSync } from 'node:zlib';
import { validateBytes } from 'gltf-validator';
import { drawCurve, launch, settled } from './browser.mjs';
import { contrastFaults, layoutFaults, namelessControls } from './faults.mjs';
import {
  assertChanges,
  browser,
  difference,
  folder,
  look,
  open,
  pictures,
  pixelsOf,
  saved,
  setTime,
  time,
  url,
} from './opened_page.mjs';

// The shares of pixels that are clearly red, and clearly blue.
async function redAndBlue(page, picture) {
  return page.evaluate(
    (pixels) => {
      const counts = [0, 0];
      for (let i = 0; i < pixels.length; i += 4) {
        const [red, green, blue] = pixels.slice(i, i + 3);
        if (red > 2 * Math.max(green, blue) + 50) ++counts[0];
        if (blue > 2 * Math.max(green, red) + 50) ++counts[1];
      }
      return counts.map((count) => (4 * count) / pixels.length);
    },
    await pixelsOf(page, picture),
  );
}

describe('every page', () => {
  for (const name of ['walk-path', 'two', 'space', 'herd', 'markers', 'fit', 'mesh']) {
    for (const width of [360, 768, 1280]) {
      for (const colorScheme of ['light', 'dark']) {
        test(`${name}, ${width} px, ${colorScheme}`, async () => {
          const viewport = { width, height: width < 500 ? 740 : 800 };
          await open(name, { viewport, colorScheme }, async (page) => {
            const isPath = name === 'walk-path' || name === 'two';
            if (name === 'mesh') await page.locator('#pick-mode').selectOption('handles');
            if (isPath) await page.locator('#colour').selectOption('deviation');
            assert.deepEqual(await page.evaluate(contrastFaults), []);
            assert.deepEqual(await page.evaluate(layoutFaults), []);
            assert.deepEqual(await page.evaluate(namelessControls), []);
            if (name === 'space') await drawCurve(page);
            else if (isPath) await setTime(page, 0.6);
            await look(page);
            if (!pictures) return;
            const path = `${pictures}/${name}-${width}-${colorScheme}.png`;
            await page.screenshot({ path, fullPage: true });
          });
        });
      }
    }
  }
  test('follows the theme that is chosen', async () => {
    await open('walk-path', { colorScheme: 'light' }, async (page) => {
      await assertChanges(page, () => page.getByRole('button', { name: 'Dark colours' }).click());
      assert.deepEqual(await page.evaluate(contrastFaults), []);
      await assertChanges(page, () => page.getByRole('button', { name: 'Light colours' }).click());
    });
  });
});

describe('a path', () => {
  test('plays by itself, unless motion is unwanted', async () => {
    await open('walk-path', { reducedMotion: 'no-preference' }, async (page) => {
      await page.waitForFunction(() => Number(document.getElementById('time').value) > 0.05);
      await page.locator('#play').click();
      const stopped = await time(page);
      await page.waitForTimeout(300);
      assert.equal(await time(page), stopped);
    });
    await open('walk-path', {}, async (page) => {
      await page.waitForTimeout(300);
      assert.equal(await time(page), 0);
    });
  });

  test('plays, and the shape moves', async () => {
    await open('walk-path', {}, async (page) => {
      await assertChanges(page, async () => {
        await page.locator('#play').click();
        await page.waitForFunction(() => Number(document.getElementById('time').value) > 0.3);
        await page.locator('#play').click();
      });
    });
  });

  test('ends, begins again or goes back, as asked', async () => {
    await open('walk-path', {}, async (page) => {
      await page.locator('#speed').selectOption('4');
      await page.locator('#loop').selectOption('once');
      await page.locator('#play').click();
      await page.getByRole('button', { name: 'Play' }).waitFor();
      assert.equal(await time(page), 1);
      for (const [repeat, falls] of [
        ['loop', (a, b) => b < a - 0.3],
        ['swing', (a, b) => b < a && b > a - 0.3],
      ]) {
        await page.locator('#loop').selectOption(repeat);
        await setTime(page, 0.5);
        await page.locator('#play').click();
        const places = [];
        for (let i = 0; i < 60; ++i) {
          places.push(await time(page));
          await page.waitForTimeout(25);
        }
        assert.ok(places.some((place, i) => i > 0 && falls(places[i - 1], place)), repeat);
        await page.locator('#play').click();
      }
    });
  });

  test('goes at the speed that is chosen', async () => {
    await open('walk-path', {}, async (page) => {
      const distance = async (speed) => {
        await page.locator('#speed').selectOption(speed);
        await setTime(page, 0);
        await page.locator('#play').click();
        await page.waitForTimeout(800);
        await page.locator('#play').click();
        return time(page);
      };
      const [slow, fast] = [await distance('0.25'), await distance('2')];
      assert.ok(fast > 4 * slow, `${fast} after ${slow}`);
    });
  });

  test('is scrubbed, by mouse and by keys', async () => {
    await open('walk-path', {}, async (page) => {
      await assertChanges(page, () => setTime(page, 0.9));
      await page.locator('#time').focus();
      await page.keyboard.press('ArrowLeft');
      assert.ok(Math.abs((await time(page)) - 0.89) < 1e-6);
    });
  });

  test('is coloured by energy and by near-rigid parts', async () => {
    await open('walk-path', {}, async (page) => {
      await setTime(page, 0.7);
      const colour = page.locator('#colour');
      await colour.selectOption('deviation');
      const deviation = await look(page);
      await colour.selectOption('energy');
      assert.ok((await difference(page, deviation, await look(page))) > 0.02);
      assert.match(await page.locator('#legend-title').textContent(), /^Energy/);
      assert.doesNotMatch(await page.locator('#ramp-end').textContent(), /%/);
      await assertChanges(page, () => colour.selectOption('parts'), 0.02);
      assert.equal(await page.locator('#legend-title').isVisible(), true);
      assert.equal(await page.locator('#ramp').isVisible(), false);
      // The deviations are what they were, after energies were in their place.
      await colour.selectOption('deviation');
      assert.ok((await difference(page, deviation, await look(page))) < 0.001);
    });
  });

  test('is coloured where it passes through itself', async () => {
    await open('pierced-path', {}, async (page) => {
      const colour = page.locator('#colour');
      const figures = page.locator('#contacts');
      await colour.selectOption('deviation');
      assert.equal(await figures.isVisible(), false);
      const deviation = await look(page);
      await colour.selectOption('contacts');
      assert.match(await page.locator('#legend-title').textContent(), /passes through itself/);
      assert.match(await figures.textContent(), /: 1 in shape 1\. .*: 2 of 5\.$/);
      assert.ok((await redAndBlue(page, await look(page)))[0] > 0.01);
      assert.deepEqual(await page.evaluate(contrastFaults), []);
      assert.deepEqual(await page.evaluate(layoutFaults), []);
      await setTime(page, 0.9);
      assert.match(await figures.textContent(), /: 0 in shape 5\./);
      assert.equal((await redAndBlue(page, await look(page)))[0], 0);
      await setTime(page, 0);
      await colour.selectOption('deviation');
      assert.equal(await figures.isVisible(), false);
      assert.ok((await difference(page, deviation, await look(page))) < 0.001);
    });
    await open('walk-path', {}, async (page) => {
      await page.locator('#colour').selectOption('contacts');
      assert.match(await page.locator('#contacts').textContent(), /: 0 in shape 1\. .*: 0 of 9\.$/);
    });
    await open('two', {}, async (page) => {
      await page.locator('#colour').selectOption('contacts');
      assert.match(await page.locator('#contacts').textContent(), /^A: .* of 9\.\nB: .* of 5\.$/);
    });
    for (const name of ['graph-path', 'walk-glb']) {
      await open(name, {}, async (page) => {
        const option = page.locator('#colour option[value=contacts]');
        assert.ok(await option.evaluate(({ disabled }) => disabled), name);
      });
    }
  });

  test('shows wires, deviation and flat faces', async () => {
    await open('walk-path', {}, async (page) => {
      await setTime(page, 0.7);
      await assertChanges(page, () => page.locator('#wireframe').check());
      await assertChanges(page, () => page.locator('#wireframe').uncheck());
      await assertChanges(page, () => page.locator('#facets').check());
      assert.equal(await page.locator('#legend').isVisible(), false);
      await assertChanges(page, () => page.locator('#colour').selectOption('deviation'), 0.02);
      assert.equal(await page.locator('#legend').isVisible(), true);
      assert.match(await page.locator('#ramp-end').textContent(), /[1-9].*%/);
      // The first shape deviates nowhere: it has one colour, and red is not in it.
      await setTime(page, 0);
      const still = await look(page);
      await setTime(page, 1);
      assert.ok((await difference(page, still, await look(page))) > 0.02);
    });
  });

  test('plots follow the time, and set it', async () => {
    await open('two', {}, async (page) => {
      assert.equal(await page.locator('.plot').count(), 3);
      const cursor = page.locator('.plot .cursor').first();
      const place = async () => Number(await cursor.getAttribute('x1'));
      const start = await place();
      await setTime(page, 0.5);
      const middle = await place();
      const readout = await page.locator('.readout').last().textContent();
      assert.match(readout, /A: [1-9].*B: [1-9]/);
      const box = await page.locator('.plot').first().boundingBox();
      assert.ok(Math.abs(middle - start - (box.width - 16) / 2) < 1);
      await page.mouse.click(box.x + box.width * 0.75, box.y + 40);
      assert.ok(Math.abs((await time(page)) - 0.75) < 0.03);
    });
  });

  test('energy jumps at the poses of a chain, and not on a smooth path', async () => {
    await open('smooth', {}, async (page) => {
      const plot = page.locator('.plot').first();
      const heights = (series) =>
        plot.locator(`.series-${series}`).evaluate((line) => [...line.points].map(({ y }) => y));
      const steps = (values) => values.slice(1).map((y, i) => Math.abs(y - values[i]));
      const [chain, spline] = [await heights(1), await heights(2)];
      assert.equal(chain.length, 2 * 17 - 1);
      assert.equal(spline.length, 16 + 2);
      const sum = (values) => values.reduce((a, b) => a + b, 0);
      const share = (values) => Math.max(...values) / sum(values);
      assert.ok(share(steps(chain)) > 0.5, 'one step is most of the way');
      assert.ok(share(steps(spline)) < 0.3, 'no step is much of the way');
    });
  });

  test('two stand side by side, seen by one camera', async () => {
    await open('two', {}, async (page) => {
      await page.locator('#canvas').focus();
      for (const half of [
        [0, 0.5],
        [0.5, 1],
      ]) {
        await assertChanges(
          page,
          async () => {
            for (let i = 0; i < 5; ++i) await page.keyboard.press('ArrowRight');
          },
          0.02,
          half,
        );
      }
    });
  });

  test('is turned by mouse, and shown whole again', async () => {
    await open('walk-path', {}, async (page) => {
      const first = await look(page);
      const box = await page.locator('#canvas').boundingBox();
      await assertChanges(page, async () => {
        await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
        await page.mouse.down();
        await page.mouse.move(box.x + box.width / 2 + 150, box.y + box.height / 2 + 30);
        await page.mouse.up();
        await page.mouse.wheel(0, 300);
      });
      await page.locator('#reset').click();
      assert.ok((await difference(page, first, await look(page))) < 0.002);
    });
  });

  test('is saved as picture and as film', async () => {
    await open('walk-path', { viewport: { width: 700, height: 700 } }, async (page) => {
      const picture = await saved(page, '#picture');
      assert.equal(picture.name, 'walk.png');
      assert.equal(picture.bytes.toString('latin1', 1, 4), 'PNG');
      assert.ok(picture.bytes.length > 5000);
      await page.locator('#speed').selectOption('4');
      const film = await saved(page, '#film');
      assert.equal(film.name, 'walk.webm');
      assert.equal(film.bytes.toString('hex', 0, 4), '1a45dfa3');
      assert.ok(film.bytes.length > 10000, `${film.bytes.length} bytes`);
      assert.equal(await page.locator('#loop').inputValue(), 'swing');
    });
  });

  test('is saved as MP4 where the browser writes no WebM', async () => {
    await open('walk-path', { viewport: { width: 700, height: 700 } }, async (page) => {
      await page.evaluate(() => {
        const native = MediaRecorder.isTypeSupported.bind(MediaRecorder);
        MediaRecorder.isTypeSupported = (type) => !type.includes('webm') && native(type);
      });
      await page.locator('#speed').selectOption('4');
      const film = await saved(page, '#film');
      assert.equal(film.name, 'walk.mp4');
      assert.equal(film.bytes.toString('latin1', 4, 8), 'ftyp');
    });
  });

  test('runs no script but its own, in a frame of a notebook too', async () => {
    const page = readFileSync(`${folder}/walk-path.html`, 'utf8');
    assert.doesNotMatch(page.match(/Content-Security-Policy[^>]*/)[0], /unsafe/);
    const escaped = page.replaceAll('&', '&amp;').replaceAll('"', '&quot;');
    writeFileSync(`${folder}/notebook.html`, `<iframe srcdoc="${escaped}"></iframe>`);
    const context = await browser.newContext();
    try {
      const opened = await context.newPage();
      await opened.goto(url('notebook'));
      await opened.frameLocator('iframe').locator('#layout').waitFor();
    } finally {
      await context.close();
    }
  });

  for (const kind of ['glb', 'path']) {
    test(`of a ${kind} has its textures`, async () => {
      await open(`skin-${kind}`, {}, async (page) => {
        await setTime(page, 0.1);
        const [red, blue] = await redAndBlue(page, await look(page));
        assert.ok(red > 0.01 && blue > 0.01, `${red} of it is red, ${blue} blue`);
        await page.locator('#colour').selectOption('deviation');
        assert.equal((await redAndBlue(page, await look(page)))[1], 0);
        await page.locator('#colour').selectOption('plain');
        const again = await redAndBlue(page, await look(page));
        assert.ok(Math.abs(again[0] - red) < 0.01 && Math.abs(again[1] - blue) < 0.01);
      });
    });
  }

  // Halves of a square with parts of their own of a texture, so that the surface is cut between them.
  test('of a path is cut where its texture has seams', async () => {
    await open('seam-path', {}, async (page) => {
      await setTime(page, 0.1);
      const [red, blue] = await redAndBlue(page, await look(page));
      assert.ok(red > 0.01 && blue > 0.05, `${red} is red, ${blue} blue`); // blue: a whole half
      await assertChanges(page, () => setTime(page, 0.9));
      await assertChanges(page, () => page.locator('#colour').selectOption('deviation'));
      await page.locator('#colour').selectOption('plain');
      assert.ok((await redAndBlue(page, await look(page)))[1] > 0.01);
    });
  });

  test('says so if its image is damaged, and shows all else', async () => {
    await open('damaged-skin', {}, async (page) => {
      assert.match(await page.locator('#status').textContent(), /texture/);
      await assertChanges(page, () => setTime(page, 0.9));
    });
  });

  test('of a glb moves, and has its deviation', async () => {
    await open('walk-glb', {}, async (page) => {
      await assertChanges(page, () => setTime(page, 0.5));
      await assertChanges(page, () => page.locator('#colour').selectOption('deviation'));
      assert.equal(await page.locator('.plot').count(), 2); // no energy
    });
  });

  test('of a glb with bones moves, and shows them', async () => {
    await open('bones-glb', {}, async (page) => {
      await assertChanges(page, () => setTime(page, 0.5));
      await assertChanges(page, () => page.locator('#bones').check());
      await assertChanges(page, () => setTime(page, 0.1));
    });
    await open('walk-glb', {}, async (page) => {
      assert.equal(await page.locator('#bones').isVisible(), false);
    });
  });

  test('of a graph is drawn as lines', async () => {
    for (const name of ['graph-path', 'graph-glb']) {
      await open(name, {}, async (page) => {
        await assertChanges(page, () => setTime(page, 0.5), 0.0005);
        assert.equal(await page.locator('#wireframe').isVisible(), false);
      });
    }
  });
});

async function planeBox(page) {
  return page.locator('#plane').boundingBox();
}

describe('a space', () => {
  test('has a picture of every pose', async () => {
    await open('space', {}, async (page) => {
      const images = await page
        .locator('.pose image')
        .evaluateAll((list) => list.map((image) => image.getAttribute('href')));
      assert.equal(images.length, 3);
      assert.equal(new Set(images).size, 3);
      assert.equal(await page.locator('.edges polygon').count(), 4);
    });
  });

  test('shows the shape at the point that is dragged', async () => {
    await open('space', {}, async (page) => {
      const dot = await page.locator('.handle .dot').boundingBox();
      const [x, y] = [dot.x + dot.width / 2, dot.y + dot.height / 2];
      await assertChanges(page, async () => {
        await page.mouse.move(x, y);
        await page.mouse.down();
        await page.mouse.move(x + 40, y + 25, { steps: 4 });
        await page.mouse.up();
      });
      const moved = await page.locator('.handle .dot').boundingBox();
      assert.ok(Math.abs(moved.x + moved.width / 2 - x - 40) < 2);
    });
  });

  test('says when the point lies outside, and shows the nearest shape', async () => {
    await open('space', {}, async (page) => {
      const box = await planeBox(page);
      await page.mouse.click(box.x + box.width - 4, box.y + box.height - 4);
      const status = page.locator('#plane-status');
      assert.match(await status.textContent(), /^bent 100.*lies outside/);
      const nodes = await page.locator('.nodes circle').nth(1).boundingBox();
      const dot = await page.locator('.handle .dot').boundingBox();
      const middle = ({ x, width }) => x + width / 2;
      assert.ok(Math.abs(middle(nodes) - middle(dot)) < 1);
    });
  });

  test('plays a curve that is drawn', async () => {
    await open('space', {}, async (page) => {
      await drawCurve(page);
      const corners = await page.locator('.curve').getAttribute('points');
      assert.ok(corners.split(' ').length > 10);
      await assertChanges(page, () => setTime(page, 0.9));
      await assertChanges(page, async () => {
        await setTime(page, 0);
        await page.locator('#play').click();
        await page.waitForFunction(() => Number(document.getElementById('time').value) > 0.3);
        await page.locator('#play').click();
      });
    });
  });

  test('plays it at once where motion is welcome', async () => {
    await open('space', { reducedMotion: 'no-preference' }, async (page) => {
      await drawCurve(page);
      await page.waitForFunction(() => Number(document.getElementById('time').value) > 0.05);
    });
  });

  test('saves a curve as a glb, which is valid and moves', async () => {
    await open('space', {}, async (page) => {
      await page.locator('#glb').click();
      assert.match(await page.locator('#status').textContent(), /draw a curve first/);
      await drawCurve(page);
      const { name, bytes } = await saved(page, '#glb');
      assert.equal(name, 'tubes-curve.glb');
      const report = await validateBytes(new Uint8Array(bytes));
      assert.deepEqual(
        report.issues.messages.filter(({ severity }) => severity < 2), // errors, warnings
        [],
      );
      assert.equal(report.info.animationCount, 1);
      assert.ok(report.info.hasMorphTargets);
      assert.equal(report.info.totalVertexCount, 1002);
      // It moves as the page does.
      const page64 = bytes.toString('base64');
      const element = `<script type="model/gltf-binary" data-scene data-name="c.glb">${page64}</script>`;
      const viewer = readFileSync(`${folder}/empty.html`, 'utf8');
      writeFileSync(
        `${folder}/curve-glb.html`,
        viewer.replace('<!-- scenes -->', () => element),
      );
    });
    await open('curve-glb', {}, async (page) => {
      await assertChanges(page, () => setTime(page, 0.9));
    });
  });

  test('saves a film of the curve', async () => {
    await open('space', { viewport: { width: 700, height: 700 } }, async (page) => {
      await drawCurve(page);
      await page.locator('#speed').selectOption('4');
      const { name, bytes } = await saved(page, '#film');
      assert.equal(name, 'tubes.webm');
      assert.ok(bytes.length > 10000, `${bytes.length} bytes`);
    });
  });

  test('takes touch', async () => {
    const options = { hasTouch: true, isMobile: true, viewport: { width: 360, height: 740 } };
    await open('space', options, async (page) => {
      const box = await planeBox(page);
      await assertChanges(page, () =>
        page.touchscreen.tap(box.x + 0.6 * box.width, box.y + 0.6 * box.height),
      );
    });
  });

  test('of shape-explore is explored', async () => {
    await open('poses', {}, async (page) => {
      assert.equal(await page.locator('.pose image').count(), 4);
      await drawCurve(page);
      await assertChanges(page, () => setTime(page, 0.8));
      const { bytes } = await saved(page, '#glb');
      const report = await validateBytes(new Uint8Array(bytes));
      assert.equal(report.issues.numErrors + report.issues.numWarnings, 0);
    });
  });

  test('of two poses lies on a line', async () => {
    await open('line', {}, async (page) => {
      const box = await planeBox(page);
      await assertChanges(page, () => page.mouse.click(box.x + 0.3 * box.width, box.y + 10));
      assert.match(await page.locator('#plane-status').textContent(), /straight.*bent.*outside/);
    });
  });
});

describe('a model', () => {
  const sliders = (page, part) => page.locator(`#${part} input`);
  const values = (page) =>
    sliders(page, 'modes').evaluateAll((inputs) => inputs.map((input) => Number(input.value)));
  const setSlider = (slider, value) =>
    slider.evaluate((input, to) => {
      input.value = to;
      input.dispatchEvent(new Event('input'));
    }, value);

  test('has a slider for each mode, which moves the shape', async () => {
    await open('herd', {}, async (page) => {
      assert.equal(await sliders(page, 'modes').count(), 3);
      assert.match(await page.locator('#modes').textContent(), /Mode 1, [\d.]+\u2009% of the/);
      for (let k = 0; k < 3; ++k) {
        await assertChanges(page, () => setSlider(sliders(page, 'modes').nth(k), 1.5));
      }
      await assertChanges(page, () => page.locator('#to-mean').click());
      assert.deepEqual(await values(page), [0, 0, 0]);
    });
  });
  test('says the command line of the exact shape, and copies it', async () => {
    await open('herd', { permissions: ['clipboard-read', 'clipboard-write'] }, async (page) => {
      await setSlider(sliders(page, 'modes').nth(0), 1.5);
      await setSlider(sliders(page, 'modes').nth(2), -0.5);
      const wanted = 'shape-statistics herd.modes --at 1.5,0,-0.5 --output shape.obj';
      assert.equal(await page.locator('#command').inputValue(), wanted);
      await page.locator('#copy').click();
      await page.waitForFunction(
        async (text) => (await navigator.clipboard.readText()) === text,
        wanted,
      );
    });
  });
  test('goes to a pose that is clicked, or chosen by keys', async () => {
    await open('herd', {}, async (page) => {
      const poses = page.locator('.scatter .pose');
      assert.equal(await poses.count(), 5);
      await assertChanges(page, () => poses.nth(3).click({ force: true }));
      const first = await values(page);
      assert.match(await page.locator('#pose').textContent(), /herd3/);
      await poses.nth(1).focus();
      await page.keyboard.press('Enter');
      assert.notDeepEqual(await values(page), first);
      await page.locator('#across').selectOption('2');
      assert.match(await page.locator('.scatter').textContent(), /mode 3/);
    });
  });
  test('follows a scalar, if there are any', async () => {
    await open('herd', {}, async (page) => {
      await setSlider(sliders(page, 'scalars').first(), 1);
      const young = await values(page);
      await assertChanges(page, () => setSlider(sliders(page, 'scalars').first(), 6));
      const old = await values(page);
      assert.ok(young.some((value, k) => Math.abs(value - old[k]) > 0.1));
    });
    await open('plain', {}, async (page) => {
      assert.equal(await sliders(page, 'scalars').count(), 0);
    });
  });
  test('plays the mode that was moved last', async () => {
    await open('herd', {}, async (page) => {
      await setSlider(sliders(page, 'modes').nth(1), 0.5);
      const [first] = await values(page);
      await page.locator('#play').click();
      await page.waitForTimeout(700);
      await page.locator('#play').click();
      const after = await values(page);
      assert.equal(after[0], first);
      assert.notEqual(after[1], 0.5);
    });
  });
});

describe('picking', () => {
  const run = (tool, ...args) =>
    execFileSync(`${process.env.SHAPESPACE_PAGE_BIN}/${tool}`, args, { cwd: folder, stdio: 'pipe' });
  // Runs the command line that the page shows.
  const follow = async (page) => {
    const command = await page.locator('#pick-command').inputValue();
    const PATH = `${process.env.SHAPESPACE_PAGE_BIN}:${process.env.PATH}`;
    execFileSync('bash', ['-c', command], { cwd: folder, stdio: 'pipe', env: { ...process.env, PATH } });
  };
  const vertices = (name) =>
    readFileSync(`${folder}/${name}`, 'utf8')
      .split('\n')
      .filter((line) => line.startsWith('v '))
      .map((line) => line.split(/\s+/).slice(1, 4).map(Number));
  const distance = (a, b) => Math.hypot(...a.map((x, k) => x - b[k]));
  const rows = (page) => page.locator('#picked li');
  const keep = async (page, file) => {
    const { name, bytes } = await saved(page, '#pick-save');
    assert.equal(name, file);
    writeFileSync(`${folder}/${name}`, bytes);
    return bytes.toString();
  };
  // All vertices of a selection, counted from 1.
  const listed = ({ vertices: list }) =>
    list.flatMap((item) =>
      Array.isArray(item)
        ? Array.from({ length: item[1] - item[0] + 1 }, (_, i) => item[0] + i)
        : [item],
    );
  // Draws around a part of the canvas, given as shares of it.
  const drawAround = async (page, [left, top, right, bottom]) => {
    const { x, y, width, height } = await page.locator('#canvas').boundingBox();
    const at = (u, v) => [x + u * width, y + v * height];
    await page.mouse.move(...at(left, top));
    await page.mouse.down();
    await page.mouse.move(...at(right, top), { steps: 3 });
    await page.mouse.move(...at(right, bottom), { steps: 3 });
    await page.mouse.move(...at(left, bottom), { steps: 3 });
    await page.mouse.up();
  };

  test('markers on two bodies are those that shape-correspond meets', async () => {
    await open('markers', {}, async (page) => {
      const { x, y, width, height } = await page.locator('#canvas').boundingBox();
      await page.locator('#pick-save').click();
      assert.match(await page.locator('#status').textContent(), /marker/);
      // Both have one outline and one camera, so the same place in both halves is the same on both.
      for (const u of [0.12, 0.2, 0.28, 0.36, 0.44]) {
        for (const v of [0.3, 0.45, 0.55, 0.68]) {
          const before = await rows(page).count();
          await page.mouse.click(x + u * width, y + v * height);
          if ((await rows(page).count()) === before) continue; // beside the body
          await page.mouse.click(x + (u + 0.5) * width, y + v * height);
        }
      }
      // One that is not complete is not saved.
      const count = await rows(page).count();
      assert.ok(count >= 6, `only ${count} markers`);
      await rows(page).first().getByRole('button').click();
      assert.equal(await rows(page).count(), count - 1);
      await page.locator('#pick-undo').click();
      assert.equal(await rows(page).count(), count);
      if (pictures) await page.screenshot({ path: `${pictures}/picking-markers.png` });
      const text = await keep(page, 'markers.txt');
      const pairs = text
        .split('\n')
        .filter((line) => /^\d/.test(line))
        .map((line) => line.split(' ').map(Number));
      const [template, target] = [vertices('small cat/body0.obj'), vertices('lion/body0.obj')];
      assert.ok(pairs.length >= count - 1);
      for (const [a, b] of pairs) assert.ok(distance(template[a - 1], target[b - 1]) < 0.12);
      await follow(page);
      const fitted = vertices('fitted.obj');
      for (const [a, b] of pairs) assert.ok(distance(fitted[a - 1], target[b - 1]) < 1e-6);
    });
  });

  test('the markers of a fit are there, can be mended, and are saved', async () => {
    await open('fit', {}, async (page) => {
      const pairs = (text) => text.split('\n').filter((line) => /^\d/.test(line));
      const found = pairs(readFileSync(`${folder}/found.txt`, 'utf8'));
      assert.equal(await rows(page).count(), found.length);
      const numbers = await page.locator('#labels text').allTextContents();
      assert.deepEqual(numbers, [1, 2].flatMap(() => found.map((_, i) => String(i + 1))));
      if (pictures) await page.screenshot({ path: `${pictures}/fit.png` });
      assert.deepEqual(pairs(await keep(page, 'markers.txt')), found);
      await rows(page).first().getByRole('button').click();
      assert.deepEqual(pairs(await keep(page, 'markers.txt')), found.slice(1));
    });
  });

  test('handles move the vertices that were picked, as far as was asked', async () => {
    await open('mesh', {}, async (page) => {
      await page.locator('#pick-mode').selectOption('handles');
      await page.locator('#pick-tool').selectOption('lasso');
      await drawAround(page, [0, 0.6, 1, 1]);
      await page.locator('#pick-new').click();
      await drawAround(page, [0.02, 0.02, 0.98, 0.25]);
      const up = page.getByLabel('y', { exact: true }).nth(1);
      await up.fill('0.125');
      await up.blur();
      const { handles } = JSON.parse(await keep(page, 'handles.json'));
      assert.equal(handles[0].fixed, true);
      assert.deepEqual(handles[1].translation, [0, 0.125, 0]);
      const [low, high] = handles.map(({ select }) => listed(select));
      const before = vertices('animal0.obj');
      const heights = (list) => list.map((v) => before[v - 1][1]);
      assert.ok(low.length > 5 && high.length > 5);
      assert.ok(Math.max(...heights(low)) < Math.min(...heights(high)));
      await follow(page);
      const after = vertices('deformed.obj');
      for (const v of low) assert.ok(distance(before[v - 1], after[v - 1]) < 1e-6);
      for (const v of high) {
        const [a, b] = [before[v - 1], after[v - 1]];
        assert.ok(distance([a[0], a[1] + 0.125, a[2]], b) < 1e-6);
      }
    });
  });

  test('a selection and a standing part are held by --anchor', async () => {
    await open('walk-path', {}, async (page) => {
      await page.locator('#pick-mode').selectOption('selection');
      await page.locator('#pick-tool').selectOption('lasso');
      await drawAround(page, [0, 0.6, 1, 1]);
      const all = listed(JSON.parse(await keep(page, 'selection.json')));
      await page.locator('#pick-tool').selectOption('without');
      await drawAround(page, [0.5, 0.6, 1, 1]);
      const text = await keep(page, 'selection.json');
      const fewer = listed(JSON.parse(text));
      assert.ok(fewer.length > 0 && fewer.length < all.length);
      assert.ok(fewer.every((v) => all.includes(v)));
      run('shape-export', 'walk.path', '--anchor', text, '--output', 'held%02d.obj');
      assert.equal(vertices('held06.obj').length, vertices('animal0.obj').length);
      await page.locator('#pick-mode').selectOption('standing');
      const parts = await keep(page, 'anchor.json');
      assert.deepEqual(JSON.parse(parts)[0].poses, [1, 2]);
      run('shape-export', 'walk.path', '--anchor', parts, '--output', 'standing%02d.obj');
      const [first, last] = [vertices('standing00.obj'), vertices('standing06.obj')];
      const [middle, from] = [vertices('standing03.obj'), vertices('animal0.obj')];
      // A part that stands goes from its place in one pose straight to that in the other.
      for (const v of fewer) {
        assert.ok(distance(first[v - 1], from[v - 1]) < 1e-5);
        const [a, b, c] = [first, middle, last].map((list) => list[v - 1]);
        const detour = distance(a, b) + distance(b, c) - distance(a, c);
        assert.ok(detour < 1e-3, `${detour} at vertex ${v}`);
      }
    });
  });

  test('a click takes a vertex, a second one leaves it out, and dragging takes none', async () => {
    await open('mesh', {}, async (page) => {
      await page.locator('#pick-mode').selectOption('selection');
      const { x, y, width, height } = await page.locator('#canvas').boundingBox();
      const middle = [x + width / 2, y + height / 2];
      await page.mouse.click(...middle);
      assert.match(await rows(page).textContent(), /1 vertex/);
      await page.mouse.click(...middle);
      assert.match(await rows(page).textContent(), /0 vertices/);
      await page.locator('#pick-save').click();
      assert.match(await page.locator('#status').textContent(), /has no vertex/);
      await page.mouse.move(...middle);
      await page.mouse.down();
      await page.mouse.move(middle[0] + 60, middle[1], { steps: 3 });
      await page.mouse.up();
      assert.match(await rows(page).textContent(), /0 vertices/);
    });
  });
});

describe('keys alone', () => {
  // Elements by the order in which Tab reaches them.
  async function tabbed(page) {
    const reached = [];
    await page.evaluate(() => document.activeElement.blur());
    for (let i = 0; i < 40; ++i) {
      await page.keyboard.press('Tab');
      const at = await page.evaluate(() => {
        const { activeElement: element } = document;
        if (!element || element === document.body) return null;
        const style = getComputedStyle(element.querySelector?.('.target') ?? element);
        const visible = style.outlineStyle !== 'none' || style.strokeWidth === '3px';
        return { name: element.id || element.getAttribute('class'), visible };
      });
      if (!at || reached.some(({ name }) => name === at.name)) break;
      reached.push(at);
    }
    return reached;
  }

  test('reach every control, visibly', async () => {
    for (const name of ['walk-path', 'space', 'markers']) {
      await open(name, {}, async (page) => {
        const reached = await tabbed(page);
        const wanted = await page.evaluate(() =>
          [...document.querySelectorAll('button, input, select, textarea, canvas, [tabindex="0"]')]
            .filter((element) => element.checkVisibility())
            .map((element) => element.id || element.getAttribute('class')),
        );
        assert.deepEqual(reached.map((at) => at.name).sort(), [...wanted].sort());
        assert.deepEqual(
          reached.filter((at) => !at.visible),
          [],
        );
      });
    }
  });

  test('play a path and turn it', async () => {
    await open('walk-path', {}, async (page) => {
      await page.keyboard.press(' ');
      await page.waitForFunction(() => Number(document.getElementById('time').value) > 0.05);
      await page.keyboard.press(' ');
      await page.locator('#canvas').focus();
      for (const key of ['ArrowUp', '+', '+', '-', 'ArrowLeft']) {
        await assertChanges(page, () => page.keyboard.press(key));
      }
      await assertChanges(page, () => page.keyboard.press('Home'));
    });
  });

  test('move the point, make a curve and play it', async () => {
    await open('space', {}, async (page) => {
      await page.locator('.handle').focus();
      await page.keyboard.press('Enter');
      await assertChanges(page, async () => {
        for (let i = 0; i < 8; ++i) await page.keyboard.press('ArrowRight');
      });
      await page.keyboard.press('Enter');
      for (let i = 0; i < 5; ++i) await page.keyboard.press('ArrowDown');
      await page.keyboard.press('Enter');
      assert.match(await page.locator('#status').textContent(), /3 points/);
      await assertChanges(page, async () => {
        await page.keyboard.press(' ');
        await page.waitForFunction(() => Number(document.getElementById('time').value) > 0.2);
        await page.keyboard.press(' ');
      });
      await page.locator('#clear').focus();
      await page.keyboard.press('Enter');
      assert.equal(await page.locator('.curve').getAttribute('points'), '');
    });
  });
});

describe('a page that cannot be shown says so', () => {
  test('where scripts are switched off', async () => {
    const context = await browser.newContext({ javaScriptEnabled: false });
    try {
      const page = await context.newPage();
      await page.goto(url('walk-path'));
      assert.match(await page.locator('body').innerText(), /needs JavaScript/);
      assert.doesNotMatch(await page.locator('body').innerText(), /Loading/);
    } finally {
      await context.close();
    }
  });

  test('where showing it fails after its data were read', async () => {
    const context = await browser.newContext();
    try {
      const page = await context.newPage();
      await page.addInitScript(() => {
        window.ResizeObserver = class {
          constructor() {
            throw new Error('no observer');
          }
        };
      });
      await page.goto(url('walk-path'));
      await page.getByText(/cannot be shown: no observer/).waitFor();
      assert.equal(await page.locator('#layout').isVisible(), false);
    } finally {
      await context.close();
    }
  });

  const whole = (name) => readFileSync(`${folder}/${name}.html`, 'utf8');
  // The page with the text of its data changed.
  async function damaged(name, change) {
    const page = whole(name).replace(
      /(<script type="[a-z]+\/[^>]*>)([^<]*)(<\/script>)/,
      (_, begin, data, end) => begin + change(data) + end,
    );
    writeFileSync(`${folder}/damaged.html`, page);
    let message = '';
    await open('damaged', {}, async (opened) => {
      assert.equal(await opened.locator('#layout').isVisible(), false);
      message = await opened.getByRole('alert').textContent();
    });
    return message;
  }
  const cut = (share) => (data) => data.slice(0, 4 * Math.floor((share * data.length) / 4));
  const flip = (share) => (data) => {
    const at = Math.floor(share * data.length);
    return data.slice(0, at) + (data[at] === 'A' ? 'B' : 'A') + data.slice(at + 1);
  };

  test('where its data is cut, changed, empty or no data', async () => {
    for (const name of ['walk-path', 'space', 'walk-glb']) {
      const changes = [cut(0.5), cut(0.999), () => '', () => 'AAAA', () => 'no data: <&>'];
      if (name !== 'walk-glb') changes.push(flip(0.0001), flip(0.3), flip(0.9)); // has no checksum
      for (const change of changes) {
        const message = await damaged(name, change);
        assert.match(message, /is damaged: .*Make the page again/, name);
      }
    }
  });

  test('where its header is at odds with the rest', async () => {
    const lies = {
      'walk-path': [{ vertices: 9 }, { shapes: 10 }, { triangles: -1 }, { kind: 'space' }, { version: 2 }, { intersections: [] }],
      space: [{ parents: [] }, { planeTriangles: [[0, 1, 6]] }, { names: null }],
    };
    for (const [name, list] of Object.entries(lies)) {
      for (const lie of list) {
        const message = await damaged(name, (data) => {
          const bytes = inflateSync(Buffer.from(data, 'base64'));
          const length = bytes.readUInt32LE(0);
          const header = JSON.parse(bytes.subarray(4, 4 + length).toString());
          const text = Buffer.from(JSON.stringify({ ...header, ...lie }));
          const size = Buffer.alloc(4);
          size.writeUInt32LE(text.length);
          const all = Buffer.concat([size, text, bytes.subarray(4 + length)]);
          return deflateSync(all).toString('base64');
        });
        assert.match(message, /is damaged: .*Make the page again/, JSON.stringify(lie));
      }
    }
  });

  test('where the file ends too early', async () => {
    const page = whole('walk-path');
    writeFileSync(`${folder}/cut.html`, page.slice(0, page.length - 5000));
    await open('cut', {}, async (opened) => {
      assert.match(await opened.getByRole('alert').textContent(), /is damaged/);
    });
  });

  test('where it holds nothing', async () => {
    await open('empty', {}, async (page) => {
      assert.match(await page.getByRole('alert').textContent(), /holds nothing to show/);
    });
  });

  test('where the browser does not draw in three dimensions', async () => {
    const without = await launch(['--no-sandbox', '--disable-3d-apis']);
    try {
      const page = await without.newPage();
      const errors = [];
      page.on('pageerror', (error) => errors.push(error.stack));
      await page.goto(url('walk-path'));
      await settled(page);
      assert.match(await page.getByRole('alert').textContent(), /WebGL 2 is missing/);
      assert.deepEqual(errors, []);
    } finally {
      await without.close();
    }
  });
});

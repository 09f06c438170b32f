// That a page explains itself, shows what a person looks for, and has room for it on any screen.
import assert from 'node:assert/strict';
import { describe, test } from 'node:test';
import { contrastFaults, layoutFaults, namelessControls } from './faults.mjs';
import { assertChanges, difference, look, open, pictures, setTime } from './opened_page.mjs';

const kinds = ['walk-path', 'two', 'space', 'herd', 'markers', 'mesh'];
const lying = { isMobile: true, hasTouch: true, viewport: { width: 844, height: 390 } };
const upright = { isMobile: true, hasTouch: true, viewport: { width: 390, height: 844 } };

const boxOf = (page, selector) => page.locator(selector).boundingBox();

// How much of an element's height is in the window.
async function heightInSight(page, selector) {
  const { y, height } = await boxOf(page, selector);
  return Math.min(y + height, page.viewportSize().height) - Math.max(y, 0);
}

async function assertInSight(page, selectors) {
  for (const selector of selectors) {
    const { height } = await boxOf(page, selector);
    const seen = await heightInSight(page, selector);
    assert.ok(seen > height - 1, `${selector}: ${seen} of ${height} pixels are seen`);
  }
}

// The shares of pixels that are darker, and brighter, in another look than in one.
function darkerAndBrighter(page, one, other) {
  return page.evaluate(
    async (pictures) => {
      const [a, b] = await Promise.all(
        pictures.map(async (picture) => {
          const image = new Image();
          image.src = `data:image/png;base64,${picture}`;
          await image.decode();
          const canvas = new OffscreenCanvas(image.width, image.height);
          const context = canvas.getContext('2d');
          context.drawImage(image, 0, 0);
          return context.getImageData(0, 0, image.width, image.height).data;
        }),
      );
      const steps = a.map((value, i) => (i % 4 === 1 ? 128 + (b[i] - value) / 2 : 128));
      const share = (test) => (4 * steps.filter(test).length) / a.length;
      return [share((step) => step < 128 - 5), share((step) => step > 128 + 1)];
    },
    [one, other],
  );
}

describe('what can be done', () => {
  test('is said on every kind of page, until it is touched', async () => {
    const sentences = new Set();
    for (const name of kinds) {
      await open(name, {}, async (page) => {
        const hint = page.locator('#hint');
        assert.ok(await hint.isVisible(), name);
        sentences.add(await hint.textContent());
        const { x, y } = await boxOf(page, '#canvas');
        await page.mouse.move(x + 20, y + 20);
        assert.ok(await hint.isVisible(), name);
        await page.mouse.down();
        await page.mouse.up();
        assert.equal(await hint.isVisible(), false, name);
      });
    }
    assert.equal(sentences.size, kinds.length);
    await open('walk-path', {}, async (page) => {
      await page.keyboard.press('ArrowLeft');
      assert.equal(await page.locator('#hint').isVisible(), false);
    });
  });

  test('is said by the help, which opens by its button and by a key', async () => {
    for (const name of kinds) {
      for (const colorScheme of ['light', 'dark']) {
        const viewport = { width: colorScheme === 'light' ? 360 : 1280, height: 740 };
        await open(name, { viewport, colorScheme }, async (page) => {
          const help = page.locator('#help');
          assert.equal(await help.isVisible(), false);
          await page.locator('#help-open').click();
          assert.ok(await help.isVisible());
          await assertInSight(page, ['#help-title', '#help button']);
          assert.ok((await page.locator('#help-deeds li').count()) >= 2);
          assert.ok((await page.locator('#help-facts').textContent()).length > 0);
          assert.deepEqual(await page.evaluate(contrastFaults), []);
          assert.deepEqual(await page.evaluate(layoutFaults), []);
          assert.deepEqual(await page.evaluate(namelessControls), []);
          await help.getByRole('button').click();
          assert.equal(await help.isVisible(), false);
          await page.keyboard.press('?');
          assert.ok(await help.isVisible());
          await page.keyboard.press('Escape');
          assert.equal(await help.isVisible(), false);
        });
      }
    }
  });
});

describe('the view', () => {
  test('is rolled, and is as before when rolled back', async () => {
    await open('walk-path', {}, async (page) => {
      const first = await look(page);
      for (let i = 0; i < 6; ++i) await page.keyboard.press('r');
      const lies = await look(page);
      assert.ok((await difference(page, first, lies)) > 0.05);
      for (let i = 0; i < 6; ++i) await page.locator('#roll-left').click();
      assert.ok((await difference(page, first, await look(page))) < 0.002);
      await page.locator('#roll-right').click();
      await page.locator('#reset').click();
      assert.ok((await difference(page, first, await look(page))) < 0.002);
    });
  });

  // The directions in which the body moves on the screen when the view turns by an arrow key.
  test('turns about what is upright after it was rolled', async () => {
    await open('walk-path', {}, async (page) => {
      await page.locator('#turntable').focus();
      for (let i = 0; i < 6; ++i) await page.keyboard.press('r');
      const before = await look(page);
      await page.locator('#canvas').focus();
      for (let i = 0; i < 63; ++i) await page.keyboard.press('ArrowLeft'); // 6.3 radians: once round
      const after = await look(page);
      assert.ok((await difference(page, before, after)) < 0.05);
    });
  });

  test('turns by itself while asked to', async () => {
    await open('walk-path', {}, async (page) => {
      await page.locator('#turntable').check();
      await assertChanges(page, () => page.waitForTimeout(500), 0.01);
      await page.locator('#turntable').uncheck();
      const still = await look(page);
      await page.waitForTimeout(300);
      assert.ok((await difference(page, still, await look(page))) < 0.001);
    });
  });

  test('has a ground, with a shadow that is darker than what is there without', async () => {
    await open('walk-path', {}, async (page) => {
      const first = await look(page);
      await page.locator('#ground').uncheck();
      const [darker, brighter] = await darkerAndBrighter(page, await look(page), first);
      assert.ok(darker > 0.005 && brighter > 0.005, `${darker} is darker, ${brighter} brighter`);
      await page.locator('#ground').check();
      assert.ok((await difference(page, first, await look(page))) < 0.001);
    });
    await open('graph-path', {}, async (page) => {
      assert.equal(await page.locator('#ground').isVisible(), false);
    });
  });

  test('fills the screen, with the slider and without the panel', async () => {
    for (const name of ['walk-path', 'space']) {
      await open(name, {}, async (page) => {
        await page.locator('#fullscreen').click();
        await page.waitForFunction(() => document.fullscreenElement?.id === 'layout');
        await assertInSight(page, ['#canvas', '#play', '#time']);
        assert.equal(await page.locator('#panel').isVisible(), false);
        await page.keyboard.press('f');
        await page.waitForFunction(() => document.fullscreenElement === null);
        assert.ok(await page.locator('#panel').isVisible());
      });
    }
  });
});

describe('the poses', () => {
  test('are marked on the slider where its thumb is at each', async () => {
    await open('smooth', {}, async (page) => {
      const track = await boxOf(page, '#time');
      const marks = page.locator('#marks .pose');
      assert.equal(await marks.count(), 2 * 3);
      for (let i = 0; i < 6; ++i) {
        const { x, width } = await marks.nth(i).boundingBox();
        const thumb = track.x + 8 + ((i % 3) / 2) * (track.width - 16);
        assert.ok(Math.abs(x + width / 2 - thumb) < 1, `mark ${i} is at ${x}, the thumb at ${thumb}`);
        assert.equal(await marks.nth(i).getAttribute('title'), `step${i % 3}`);
      }
      const widths = page.locator('#marks .extrapolated');
      for (const strip of await widths.all()) assert.equal((await strip.boundingBox()).width, 0);
    });
    await open('beyond', {}, async (page) => {
      const [given, beyond] = await Promise.all([
        boxOf(page, '#marks .inserted'),
        boxOf(page, '#marks .extrapolated'),
      ]);
      assert.ok(given.width > beyond.width && beyond.width > 50);
      const last = await page.locator('#marks .pose').last().boundingBox();
      assert.ok(Math.abs(last.x + last.width / 2 - beyond.x) < 1);
    });
    await open('walk-glb', {}, async (page) => {
      assert.equal(await page.locator('#marks span').count(), 0);
    });
  });

  test('are named where the motion is', async () => {
    const clock = (page) => page.locator('#clock').textContent();
    await open('smooth', {}, async (page) => {
      assert.equal(await clock(page), 'step0');
      await setTime(page, 0.5);
      assert.equal(await clock(page), 'step1');
      await setTime(page, 0.6);
      assert.match(await clock(page), /step1.*step2.*20/);
      assert.equal(await page.locator('#time').getAttribute('aria-valuetext'), await clock(page));
    });
    await open('beyond', {}, async (page) => {
      await setTime(page, 1);
      assert.match(await clock(page), /animal1$/);
    });
  });

  test('stand as ghosts beside the body', async () => {
    await open('walk-path', {}, async (page) => {
      await setTime(page, 0.5);
      const without = await look(page);
      await assertChanges(page, () => page.locator('#ghosts').check(), 0.02);
      await page.locator('#ghosts').uncheck();
      assert.ok((await difference(page, without, await look(page))) < 0.001);
    });
    for (const name of ['walk-glb', 'mesh', 'space']) {
      await open(name, {}, async (page) => {
        assert.equal(await page.locator('#ghosts').isVisible(), false);
      });
    }
  });
});

describe('there is room', () => {
  test('for plots, whatever else is open', async () => {
    for (const height of [900, 800]) {
      await open('walk-path', { viewport: { width: 1440, height } }, async (page) => {
        await page.locator('#colour').selectOption('contacts');
        await page.locator('#pick-mode').selectOption('standing');
        for (let i = 0; i < 3; ++i) await page.locator('#pick-new').click();
        const plots = page.locator('.plot');
        assert.equal(await plots.count(), 3);
        for (const plot of await plots.all()) {
          const { y, height: own } = await plot.boundingBox();
          assert.ok(y > 0 && y + own <= height, `from ${y} to ${y + own}`);
        }
      });
    }
  });

  test('for the shape beside a plane', async () => {
    await open('space', { viewport: { width: 1000, height: 640 } }, async (page) => {
      assert.ok((await heightInSight(page, '#canvas')) > 0.4 * 640);
    });
  });

  // The right edges of fields, and the left ones, are each on one line.
  test('for fields in columns', async () => {
    await open('walk-path', {}, async (page) => {
      const fields = page.locator('#options select:visible');
      const boxes = await Promise.all((await fields.all()).map((field) => field.boundingBox()));
      const first = boxes.filter(({ y }) => Math.abs(y - boxes[0].y) < 60);
      for (const { x, width } of first) {
        assert.ok(Math.abs(x + width - first[0].x - first[0].width) < 1);
      }
    });
  });

  test('on a phone that lies, for the picture and its slider', async () => {
    for (const name of ['walk-path', 'two', 'herd']) {
      await open(name, lying, async (page) => {
        await assertInSight(page, ['#canvas', '#play', '#time']);
        assert.ok((await heightInSight(page, '#canvas')) > 200, name);
        assert.deepEqual(await page.evaluate(layoutFaults), [], name);
      });
    }
    await open('herd', lying, async (page) => {
      await assertInSight(page, ['#modes input >> nth=0']);
    });
    await open('space', lying, async (page) => {
      await assertInSight(page, ['#canvas', '#plane', '#draw', '#play']);
      assert.ok((await heightInSight(page, '#canvas')) > 150);
      assert.deepEqual(await page.evaluate(layoutFaults), []);
    });
  });

  test('on a phone for the body beside what changes it', async () => {
    await open('herd', upright, async (page) => {
      const sliders = page.locator('#modes input');
      for (let k = 0; k < 3; ++k) {
        await sliders.nth(k).scrollIntoViewIfNeeded();
        await assertInSight(page, ['#canvas', `#modes input >> nth=${k}`]);
      }
      assert.ok((await heightInSight(page, '#canvas')) > 250);
      if (pictures) await page.screenshot({ path: `${pictures}/phone-herd.png` });
    });
    await open('space', upright, async (page) => {
      await assertInSight(page, ['#plane', '#draw', '#add', '#clear', '#canvas', '#play']);
    });
  });
});

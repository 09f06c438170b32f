// What a person does with the page that solves, done by a program. Skipped where there is none: it
// contains the library as ./dev wasm compiles it.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import { describe, test } from 'node:test';
import { inflateRawSync } from 'node:zlib';
import { validateBytes } from 'gltf-validator';
import { contrastFaults, layoutFaults, namelessControls } from './faults.mjs';
import { assertChanges, difference, folder, look, open, pictures, saved, setTime, time } from './opened_page.mjs';

const skip = existsSync(`${folder}/solver.html`) ? false : 'no solver.html: ./dev wasm and ./dev viewer make it';

const animal = (k) => ({ name: `animal${k}.obj`, text: readFileSync(`${folder}/animal${k}.obj`, 'utf8') });

// Drops files, given as {name, text}, on the page.
async function drop(page, ...files) {
  await page.evaluate((given) => {
    const dataTransfer = new DataTransfer();
    for (const { name, text } of given) dataTransfer.items.add(new File([text], name));
    const at = document.querySelector('#stage');
    for (const type of ['dragover', 'drop']) {
      at.dispatchEvent(new DragEvent(type, { dataTransfer, bubbles: true, cancelable: true }));
    }
  }, files);
}

const text = (page, id) => page.locator(`#${id}`).innerText();

const appears = (page, id, words) =>
  page.waitForFunction(
    ([name, what]) => document.getElementById(name).innerText.includes(what),
    [id, words],
    { timeout: 120000 },
  );

const finished = (page) =>
  page.waitForFunction(
    () =>
      !document.getElementById('transport').hidden &&
      document.getElementById('stage').ariaBusy === 'false',
    null,
    { timeout: 120000 },
  );
const firstMotion = (page) =>
  page.waitForFunction(() => !document.getElementById('transport').hidden, null, { timeout: 60000 });

async function setSlider(page, id, value) {
  await page.locator(`#${id}`).evaluate((input, to) => {
    input.value = to;
    input.dispatchEvent(new Event('input', { bubbles: true }));
  }, value);
}

// Waits until so many pins are drawn.
const pins = (page, count) =>
  page.waitForFunction((wanted) => document.querySelectorAll('.pin').length === wanted, count);

const names = (page) => page.locator('#poses span').allInnerTexts();

// The motion between two animals, as the tools made walk.path.
async function walk(page) {
  await setSlider(page, 'shapes', 7);
  await drop(page, animal(0), animal(1));
  await finished(page);
}

// Drags over the picture, from and to shares of it.
async function drag(page, from, to) {
  const box = await page.locator('#canvas').boundingBox();
  const at = ([x, y]) => [box.x + x * box.width, box.y + y * box.height];
  await page.mouse.move(...at(from));
  await page.mouse.down();
  for (let i = 1; i <= 8; ++i) {
    const share = i / 8;
    await page.mouse.move(...at(from.map((start, k) => start + share * (to[k] - start))));
    await page.waitForTimeout(60);
  }
  await page.mouse.up();
}

// The positions of a glb's mesh and of its morph targets, added: one array for each shape.
function shapesOfGlb(bytes) {
  const length = bytes.readUInt32LE(12);
  const json = JSON.parse(bytes.subarray(20, 20 + length).toString('utf8'));
  const start = 20 + length + 8;
  const numbers = (accessor) => {
    const { bufferView, byteOffset = 0, count, componentType } = json.accessors[accessor];
    assert.equal(componentType, 5126);
    const view = json.bufferViews[bufferView];
    const at = start + (view.byteOffset ?? 0) + byteOffset;
    const stride = view.byteStride ?? 12;
    return Array.from({ length: 3 * count }, (_, i) =>
      bytes.readFloatLE(at + stride * Math.floor(i / 3) + 4 * (i % 3)),
    );
  };
  const [primitive] = json.meshes[0].primitives;
  const base = numbers(primitive.attributes.POSITION);
  const targets = primitive.targets.map(({ POSITION }) => numbers(POSITION));
  return [base, ...targets.map((offsets) => offsets.map((offset, i) => base[i] + offset))];
}

// The files in a zip: names and contents.
function unzipped(bytes) {
  const end = bytes.lastIndexOf(Buffer.from('PK\x05\x06', 'latin1'));
  const files = [];
  let at = bytes.readUInt32LE(end + 16);
  for (let i = bytes.readUInt16LE(end + 10); i > 0; --i) {
    const [nameLength, extraLength, commentLength] = [28, 30, 32].map((k) => bytes.readUInt16LE(at + k));
    const name = bytes.subarray(at + 46, at + 46 + nameLength).toString();
    const size = bytes.readUInt32LE(at + 20);
    const local = bytes.readUInt32LE(at + 42);
    const data = local + 30 + bytes.readUInt16LE(local + 26) + bytes.readUInt16LE(local + 28);
    files.push({ name, text: inflateRawSync(bytes.subarray(data, data + size)).toString() });
    at += 46 + nameLength + extraLength + commentLength;
  }
  return files;
}

describe('every size of the page', { skip }, () => {
  for (const [width, height] of [
    [1440, 900],
    [844, 390],
    [390, 844],
  ]) {
    for (const colorScheme of ['light', 'dark']) {
      test(`${width} x ${height}, ${colorScheme}`, async () => {
        await open('solver', { viewport: { width, height }, colorScheme }, async (page) => {
          const check = async (name) => {
            assert.deepEqual(await page.evaluate(contrastFaults), []);
            assert.deepEqual(await page.evaluate(layoutFaults), []);
            assert.deepEqual(await page.evaluate(namelessControls), []);
            if (!pictures) return;
            await page.screenshot({ path: `${pictures}/solver-${name}-${width}-${colorScheme}.png` });
          };
          await check('empty');
          await page.getByRole('button', { name: 'Try an example' }).click();
          await firstMotion(page);
          await check('first');
          await finished(page);
          await setTime(page, 0.6);
          await look(page);
          await check('motion');
          await drop(page, { name: 'notes.txt', text: 'No mesh.' });
          await appears(page, 'problem-text', 'notes.txt');
          await check('refused');
        });
      });
    }
  }
});

describe('a motion', { skip }, () => {
  test('is computed from files that are dropped, and plays', async () => {
    await open('solver', { reducedMotion: 'no-preference' }, async (page) => {
      await drop(page, animal(0), animal(1));
      await firstMotion(page);
      await page.waitForFunction(() => Number(document.getElementById('time').value) > 0.1);
      await finished(page);
      assert.match(await text(page, 'facts'), /^2 poses, 17 shapes, 1,520 vertices, 3,0\d\d triangles$/);
      assert.equal(await page.locator('#work').isVisible(), false);
      await page.locator('#play').click();
      await setTime(page, 0);
      await assertChanges(page, () => setTime(page, 1));
      assert.match(await text(page, 'clock'), /animal1/);
    });
  });

  test('becomes finer without moving the camera', async () => {
    await open('solver', {}, async (page) => {
      await drop(page, animal(0), animal(1));
      await firstMotion(page);
      await page.locator('#canvas').focus();
      for (let i = 0; i < 4; ++i) await page.keyboard.press('ArrowRight');
      const before = await look(page);
      await finished(page);
      assert.ok((await difference(page, before, await look(page))) < 0.002);
    });
  });

  test('is computed anew when an option changes, and ends when it is cancelled', async () => {
    await open('solver', {}, async (page) => {
      await walk(page);
      assert.match(await text(page, 'facts'), /, 9 shapes/);
      await setSlider(page, 'beyond', 3);
      await appears(page, 'facts', ', 12 shapes');
      assert.equal(await page.locator('#marks .extrapolated').count(), 1);
      await page.locator('#metric').selectOption('rigid');
      await setSlider(page, 'shapes', 31);
      await page.getByRole('button', { name: 'Cancel' }).click();
      await appears(page, 'status', 'Cancelled');
      assert.equal(await page.locator('#work').isVisible(), false);
      assert.match(await text(page, 'facts'), / shapes/);
      await assertChanges(page, () => setTime(page, 0.9));
      // And it goes on.
      await setSlider(page, 'beyond', 0);
      await setSlider(page, 'shapes', 1);
      await appears(page, 'facts', ', 3 shapes');
      await finished(page);
    });
  });

  test('goes through the poses in the order of the list', async () => {
    await open('solver', {}, async (page) => {
      await page.getByRole('button', { name: 'Try an example' }).click();
      await firstMotion(page);
      assert.deepEqual(await names(page), ['straight', 'bent', 'twisted']);
      await page.getByRole('button', { name: 'Move twisted up' }).focus();
      await page.keyboard.press('Enter');
      assert.deepEqual(await names(page), ['straight', 'twisted', 'bent']);
      assert.equal(await page.evaluate(() => document.activeElement.ariaLabel), 'Move twisted up');
      await finished(page);
      await setTime(page, 0.5);
      assert.match(await text(page, 'clock'), /twisted/);
      await page.getByRole('button', { name: 'Remove straight' }).click();
      await page.getByRole('button', { name: 'Remove twisted' }).click();
      assert.deepEqual(await names(page), ['bent']);
      assert.equal(await page.locator('#transport').isVisible(), false);
      assert.match(await text(page, 'need'), /Add another one/);
      await page.getByRole('button', { name: 'Remove all' }).click();
      assert.equal(await page.locator('#welcome').isVisible(), true);
    });
  });
});

describe('what cannot be used', { skip }, () => {
  test('is refused with a sentence, and the page goes on', async () => {
    await open('solver', {}, async (page) => {
      await drop(page, { name: 'notes.txt', text: 'No mesh.' });
      await appears(page, 'problem-text', "notes.txt: the extension '.txt' is not one of .obj");
      await drop(page, { name: 'broken.obj', text: 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n' });
      await appears(page, 'problem-text', 'broken.obj');
      await drop(page, animal(0), { name: 'notes.txt', text: 'No mesh.' }, animal(1));
      await appears(page, 'problem-text', 'notes.txt');
      assert.deepEqual(await names(page), ['animal0.obj', 'animal1.obj']);
      await finished(page);
      const problem = await text(page, 'problem-text');
      assert.doesNotMatch(problem, /\/files\//);
      await page.getByRole('button', { name: 'Close' }).click();
      assert.equal(await page.locator('#problems').isVisible(), false);
    });
  });

  test('is another mesh, which may begin another motion', async () => {
    await open('solver', {}, async (page) => {
      await walk(page);
      const [v, f] = ['v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n', 'f 1 2 3\nf 1 3 4\n'];
      await drop(page, { name: 'square.obj', text: v + f });
      await appears(page, 'problem-text', 'square.obj against animal0.obj: 4 vertices instead of 1520');
      assert.doesNotMatch(await text(page, 'problem-text'), /Correspond\b|allow[A-Z_]/);
      assert.equal((await names(page)).length, 2);
      await page.getByRole('button', { name: 'Begin anew with it' }).click();
      await appears(page, 'poses', 'square.obj');
      assert.deepEqual(await names(page), ['square.obj']);
      // Two files may have one name, and files may come while others are worked on.
      await drop(page, { name: 'square.obj', text: `${v.replace('1 1 0', '1 1 1')}${f}` });
      await drop(page, { name: 'third.obj', text: `${v.replace('1 1 0', '1 1 2')}${f}` });
      await appears(page, 'poses', 'third.obj');
      assert.deepEqual(await names(page), ['square.obj', 'square (2).obj', 'third.obj']);
      await finished(page);
      assert.equal(await page.locator('#problems').isVisible(), false);
    });
  });

  test('may be used all the same, if it is only doubtful', async () => {
    await open('solver', {}, async (page) => {
      const large = animal(0).text.replaceAll(/^v (.*)$/gm, (_, numbers) =>
        ['v', ...numbers.split(' ').map((number) => 100 * Number(number))].join(' '),
      );
      await drop(page, animal(0), { name: 'large.obj', text: large });
      await appears(page, 'problem-text', 'times as long');
      assert.deepEqual(await names(page), ['animal0.obj']);
      await page.getByRole('button', { name: 'It is right, use it' }).click();
      await appears(page, 'poses', 'large.obj');
      await finished(page);
    });
  });

  test('is too large: it is said, and nothing freezes', async () => {
    await open('solver', {}, async (page) => {
      // Two poses of a sheet with 2 million triangles, as binary PLY.
      await page.evaluate(() => {
        const n = 1001;
        const sheet = (bend) => {
          const header =
            `ply\nformat binary_little_endian 1.0\nelement vertex ${n * n}\nproperty float x\nproperty float y\n` +
            `property float z\nelement face ${2 * (n - 1) ** 2}\nproperty list uchar int vertex_indices\nend_header\n`;
          const positions = new Float32Array(3 * n * n);
          for (let v = 0; v < n * n; ++v) {
            const [x, y] = [v % n, Math.floor(v / n)];
            positions.set([x, y, bend * x * x], 3 * v);
          }
          const faces = new DataView(new ArrayBuffer(26 * (n - 1) ** 2));
          let at = 0;
          for (let y = 0; y + 1 < n; ++y) {
            for (let x = 0; x + 1 < n; ++x) {
              const a = y * n + x;
              for (const corners of [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]) {
                faces.setUint8(at, 3);
                corners.forEach((corner, k) => faces.setInt32(at + 1 + 4 * k, corner, true));
                at += 13;
              }
            }
          }
          return new File([header, positions, faces], `sheet${bend}.ply`);
        };
        const dataTransfer = new DataTransfer();
        for (const bend of [0, 0.0001]) dataTransfer.items.add(sheet(bend));
        window.longest = 0;
        let last = performance.now();
        const watch = () => {
          const now = performance.now();
          window.longest = Math.max(window.longest, now - last);
          last = now;
          setTimeout(watch, 10);
        };
        setTimeout(watch, 200);
        document.body.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }));
      });
      await appears(page, 'problem-text', 'this solve needs about');
      assert.match(await text(page, 'problem-text'), /insert fewer shapes/);
      console.log(`# the page stood still for ${Math.round(await page.evaluate(() => window.longest))} ms`);
      await page.getByRole('button', { name: 'Remove all' }).click();
      await page.getByRole('button', { name: 'Try an example' }).click();
      await finished(page);
    });
  });
});

describe('pulling', { skip }, () => {
  test('moves the body, and the result is a pose', async () => {
    await open('solver', {}, async (page) => {
      await page.getByRole('button', { name: 'Try an example' }).click();
      await finished(page);
      await setTime(page, 0);
      await page.getByRole('button', { name: 'Pull the body' }).click();
      await assertChanges(page, async () => {
        await drag(page, [0.5, 0.5], [0.55, 0.35]);
        await page.waitForFunction(() => !document.getElementById('keep').disabled, null, { timeout: 60000 });
      });
      // What was dragged, and the far end.
      await pins(page, 2);
      await page.getByRole('button', { name: 'Keep as a pose' }).click();
      assert.deepEqual(await names(page), ['straight', 'bent', 'twisted', 'pulled 1']);
      await appears(page, 'facts', '49 shapes');
      await finished(page);
    });
  });

  test('needs no mouse, and pins can be taken away', async () => {
    await open('solver', {}, async (page) => {
      await page.getByRole('button', { name: 'Try an example' }).click();
      await finished(page);
      await setTime(page, 0);
      await page.keyboard.press('p');
      assert.equal(await page.locator('#pull').getAttribute('aria-pressed'), 'true');
      await page.locator('#canvas').focus();
      await page.keyboard.press('Enter');
      await pins(page, 1);
      await assertChanges(page, async () => {
        for (let i = 0; i < 5; ++i) await page.keyboard.press('Shift+ArrowUp');
        await page.waitForFunction(() => !document.getElementById('keep').disabled, null, { timeout: 60000 });
      });
      await pins(page, 2);
      await page.keyboard.press('Delete');
      await pins(page, 1);
      await page.getByRole('button', { name: 'Clear pins' }).click();
      await pins(page, 0);
      assert.equal(await page.locator('#keep').isDisabled(), true);
      await page.keyboard.press('Escape');
      assert.equal(await page.locator('#pull').getAttribute('aria-pressed'), 'false');
    });
  });

  test('makes a second pose of a single mesh', async () => {
    await open('solver', {}, async (page) => {
      await drop(page, animal(0));
      await appears(page, 'need', 'One pose does not move');
      await page.getByRole('button', { name: 'Pull the body' }).click();
      await drag(page, [0.5, 0.45], [0.5, 0.3]);
      await page.waitForFunction(() => !document.getElementById('keep').disabled, null, { timeout: 60000 });
      await page.getByRole('button', { name: 'Keep as a pose' }).click();
      await finished(page);
      assert.deepEqual(await names(page), ['animal0.obj', 'pulled 1']);
    });
  });
});

describe('saving', { skip }, () => {
  test('writes the motion that the tools compute, as glb', async () => {
    await open('solver', {}, async (page) => {
      await walk(page);
      const { name, bytes } = await saved(page, '#save-glb');
      assert.equal(name, 'animal0.glb');
      const { issues } = await validateBytes(new Uint8Array(bytes));
      assert.equal(issues.numErrors, 0, JSON.stringify(issues.messages));
      const [shapes, native] = [bytes, readFileSync(`${folder}/walk.glb`)].map(shapesOfGlb);
      assert.equal(shapes.length, native.length);
      const size = Math.max(...native[0]) - Math.min(...native[0]);
      shapes.forEach((shape, s) => {
        assert.equal(shape.length, 3 * 1520);
        const most = shape.reduce((so, x, i) => Math.max(so, Math.abs(x - native[s][i])), 0);
        assert.ok(most < 1e-3 * size, `shape ${s} differs by ${most / size} of the size`);
      });
    });
  });

  test('writes frames, and a path file', async () => {
    await open('solver', {}, async (page) => {
      await walk(page);
      const frames = await saved(page, '#save-frames');
      assert.equal(frames.name, 'animal0-frames.zip');
      const files = unzipped(frames.bytes);
      assert.deepEqual(
        files.map(({ name }) => name),
        Array.from({ length: 9 }, (_, i) => `frame_00${i}.obj`),
      );
      for (const { text: obj } of files) assert.equal(obj.match(/^v /gm).length, 1520);
      const path = await saved(page, '#save-path');
      assert.equal(path.name, 'animal0.path');
      assert.ok(path.bytes.length > 9 * 1520 * 12);
      const picture = await saved(page, '#picture');
      assert.equal(picture.name, 'animal0.png');
    });
  });

  test('says when there is nothing to save yet', async () => {
    await open('solver', {}, async (page) => {
      await drop(page, animal(0));
      await appears(page, 'poses', 'animal0.obj');
      await page.locator('#save-glb').click();
      await appears(page, 'status', 'No file: there is no motion yet.');
    });
  });
});

test('help says what can be done', { skip }, async () => {
  await open('solver', {}, async (page) => {
    await page.getByRole('button', { name: 'Help' }).click();
    assert.match(await text(page, 'help-deeds'), /Drop two or more poses/);
    assert.match(await text(page, 'help-keys'), /pull the last pin/);
    await page.keyboard.press('Escape');
    await page.getByRole('button', { name: 'Try an example' }).click();
    await firstMotion(page);
    assert.match(await text(page, 'hint'), /Drag the picture/);
    await page.locator('#canvas').click();
    assert.equal(await page.locator('#hint').count(), 0);
  });
});

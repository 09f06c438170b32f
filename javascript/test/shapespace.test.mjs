import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { FileError, load, MeshError, MismatchError, OptionsError, ShapespaceError } from '../index.js';
import { edgeLengths, greatestDifference, sheet } from './shapes.mjs';

let shapespace;
before(async () => (shapespace = await load()));
after(() => shapespace.close());

const flat = sheet(12, 8, 0);
const rolled = sheet(12, 8, 2);

test('a path goes from one pose to the other, and a sheet is rolled without being stretched', async () => {
  const path = await shapespace.interpolate([flat, rolled], { shapes: 7 });
  assert.equal(path.shapes.length, 9);
  assert.deepEqual(path.poses, [0, 8]);
  assert.deepEqual([...path.times], [0, 1, 2, 3, 4, 5, 6, 7, 8].map((i) => i / 8));
  assert.ok(path.converged);
  assert.ok(greatestDifference(path.shapes[0], flat.positions) < 1e-12);
  assert.ok(greatestDifference(path.shapes[8], rolled.positions) < 1e-12);
  const rest = edgeLengths(flat.positions, flat.indices);
  for (const shape of path.shapes) {
    const lengths = edgeLengths(shape, path.indices);
    // The arc's chords are .1 % shorter than the arc.
    assert.ok(Math.max(...lengths.map((length, i) => Math.abs(length / rest[i] - 1))) < 0.005);
  }
  assert.ok(path.summary.energy > 0 && path.summary.energy >= path.summary.lower_bound);
  assert.match(path.report, /converged/);
});

test('the result has the unit and the place of the poses', async () => {
  const options = { shapes: 3 };
  const path = await shapespace.interpolate([flat, rolled], options);
  const placed = { scale: 1000, offset: 1e6 };
  const large = await shapespace.interpolate([sheet(12, 8, 0, placed), sheet(12, 8, 2, placed)], options);
  assert.ok(Math.abs(large.summary.energy / path.summary.energy - 1) < 1e-6);
  const expected = path.shapes[2].map((c) => 1000 * c + 1e6);
  assert.ok(greatestDifference(large.shapes[2], expected) < 1e-2);
});

test('positions between two shapes lie between them', async () => {
  const path = await shapespace.interpolate([flat, rolled], { shapes: 3 });
  assert.ok(greatestDifference(path.at(0.25, new Float64Array(flat.positions.length)), path.shapes[1]) === 0);
  const between = path.at(0.375, new Float64Array(flat.positions.length));
  const mean = path.shapes[1].map((c, i) => (c + path.shapes[2][i]) / 2);
  assert.ok(greatestDifference(between, mean) < 1e-12);
  assert.ok(path.at(7) instanceof Float32Array);
});

test('rigid copies cost nothing', async () => {
  const turned = flat.positions.map((_, i, all) => (i % 3 === 0 ? -all[i + 1] : i % 3 === 1 ? all[i - 1] : 5));
  const path = await shapespace.interpolate([flat, { positions: turned }], { shapes: 3 });
  assert.ok(path.summary.energy < 1e-15);
});

test('what is extrapolated goes on', async () => {
  const path = await shapespace.interpolate([flat, rolled], { shapes: 3, tolerance: 1e-10 });
  const longer = await shapespace.extrapolate(path, 2);
  assert.equal(longer.shapes.length, 7);
  assert.ok(Math.abs(longer.times[6] - 1.5) < 1e-12);
  // The sheet rolls on: its ends come nearer to each other.
  const width = (shape) => Math.hypot(shape[36] - shape[0], shape[37] - shape[1], shape[38] - shape[2]);
  const widths = longer.shapes.map(width);
  for (let i = 1; i < widths.length; ++i) assert.ok(widths[i] < widths[i - 1]);
});

test('a target that is larger makes the larger motion', async () => {
  const path = await shapespace.interpolate([flat, rolled], { shapes: 3 });
  const target = sheet(12, 8, 0, { scale: 2 });
  const moved = await shapespace.transfer(path, target);
  assert.equal(moved.shapes.length, 5);
  const expected = path.shapes[4].map((c) => 2 * c);
  assert.ok(greatestDifference(moved.shapes[4], expected) < 0.02);
});

test('the mean of two poses lies between them', async () => {
  const { positions, summary } = await shapespace.average([sheet(12, 8, -2), rolled]);
  const depth = (shape) => Math.max(...shape.filter((_, i) => i % 3 === 2)) - Math.min(...shape.filter((_, i) => i % 3 === 2));
  assert.ok(depth(positions) < 0.05 * depth(rolled.positions));
  assert.equal(summary.poses, 2);
});

test('handles are met, again and again', async () => {
  const deformation = await shapespace.deform(flat);
  const left = Array.from({ length: 9 }, (_, y) => 13 * y);
  const right = left.map((v) => v + 12);
  for (const height of [1, 1.2, 3]) {
    const positions = right.flatMap((v) => [flat.positions[3 * v], flat.positions[3 * v + 1], height]);
    const { shapes, summary } = await deformation.update([{ vertices: left }, { vertices: right, positions }]);
    const last = shapes.at(-1);
    right.forEach((v, k) => assert.ok(Math.abs(last[3 * v + 2] - positions[3 * k + 2]) < 1e-9));
    left.forEach((v) => assert.ok(Math.abs(last[3 * v + 2]) < 1e-9));
    assert.equal(summary.warm, height === 1.2);
  }
  await deformation.close();
});

test('previews have all shapes, and come before the result', async () => {
  const previews = [];
  const fine = [sheet(40, 30, 0), sheet(40, 30, 2)];
  const path = await shapespace.interpolate(fine, { shapes: 7, onPreview: (so_far) => previews.push(so_far) });
  assert.ok(previews.length > 0);
  for (const preview of previews) {
    assert.equal(preview.shapes.length, path.shapes.length);
    assert.ok(greatestDifference(preview.shapes.at(-1), path.shapes.at(-1)) < 1e-12);
  }
});

test('progress comes, and its share does not exceed the whole', async () => {
  const shares = [];
  const onProgress = ({ stage, share }) => shares.push(share) && assert.ok(stage.length > 0);
  await shapespace.interpolate([flat, rolled], { onProgress });
  assert.ok(shares.length > 0 && Math.max(...shares) <= 1 && Math.min(...shares) >= 0);
});

test('a call that is aborted ends, and others go on', async () => {
  const fine = [sheet(100, 80, 0), sheet(100, 80, 3)];
  const deformation = await shapespace.deform(flat);
  const controller = new AbortController();
  const solve = shapespace.interpolate(fine, {
    signal: controller.signal,
    onProgress: () => controller.abort(),
  });
  const later = shapespace.interpolate([flat, rolled], { shapes: 1 });
  await assert.rejects(solve, { name: 'AbortError' });
  assert.equal((await later).shapes.length, 3);
  // Its worker is gone, and it is made again: also where nothing else has come between, and where the
  // update waits already when the worker ends.
  assert.equal((await deformation.update([{ vertices: [0] }])).shapes.length, 6);
  const second = new AbortController();
  const stopped = shapespace.interpolate(fine, { signal: second.signal, onProgress: () => second.abort() });
  const waiting = deformation.update([{ vertices: [0] }]);
  await assert.rejects(stopped, { name: 'AbortError' });
  assert.equal((await waiting).shapes.length, 6);
  await assert.rejects(shapespace.interpolate([flat, rolled], { signal: AbortSignal.abort() }), {
    name: 'AbortError',
  });
});

test('what is closed ends its call, and can be called again', async () => {
  const other = await load();
  const solve = other.interpolate([sheet(100, 80, 0), sheet(100, 80, 3)], { onProgress: () => other.close() });
  await assert.rejects(solve, { name: 'SolverError' });
  assert.equal((await other.interpolate([flat, rolled], { shapes: 1 })).shapes.length, 3);
  other.close();
});

test('files are read as the tools read them, and written', async () => {
  const text = (mesh) =>
    [...Array(mesh.positions.length / 3).keys()]
      .map((v) => `v ${[...mesh.positions.subarray(3 * v, 3 * v + 3)].join(' ')}`)
      .concat([...Array(mesh.indices.length / 3).keys()].map((f) => `f ${[...mesh.indices.subarray(3 * f, 3 * f + 3)].map((v) => v + 1).join(' ')}`))
      .join('\n');
  const file = (name, mesh) => ({ name, data: new TextEncoder().encode(text(mesh)) });
  // Two files may have one name.
  const files = [file('sheet.obj', flat), file('sheet.obj', rolled)];
  const { shapes, names } = await shapespace.read(files);
  assert.deepEqual(names, ['sheet.obj', 'sheet.obj']);
  assert.ok(greatestDifference(shapes[1], rolled.positions) < 1e-12);
  const path = await shapespace.interpolate(files, { shapes: 3 });
  const [glb] = await shapespace.write(path, 'roll.glb', { duration: 2 });
  assert.equal(new TextDecoder().decode(glb.data.subarray(0, 4)), 'glTF');
  const frames = await shapespace.write(path, 'frame_%02d.obj');
  assert.deepEqual(frames.map(({ name }) => name), ['frame_00.obj', 'frame_01.obj', 'frame_02.obj', 'frame_03.obj', 'frame_04.obj']);
  const read = await shapespace.read([frames[4]]);
  assert.ok(greatestDifference(read.shapes[0], path.shapes[4]) === 0);
  await assert.rejects(shapespace.write(path, 'strip.png'), ShapespaceError);
});

test('what is wrong is refused with a sentence, by its kind', async () => {
  const other = sheet(11, 8, 0);
  const refusals = [
    [() => shapespace.interpolate([flat, other]), MismatchError],
    [() => shapespace.interpolate([flat]), MeshError],
    [() => shapespace.interpolate([flat, { positions: flat.positions.map(() => NaN) }]), MeshError],
    [() => shapespace.interpolate([{ positions: flat.positions }, rolled]), OptionsError],
    [() => shapespace.interpolate([flat, rolled], { shape: 3 }), OptionsError],
    [() => shapespace.interpolate([flat, rolled], { shapes: 'many' }), OptionsError],
    [() => shapespace.interpolate([flat, rolled], { metric: 'soft' }), OptionsError],
    [() => shapespace.interpolate([flat, rolled], { metric: { bend: 1 } }), OptionsError],
    [() => shapespace.read([{ name: 'notes.txt', data: new TextEncoder().encode('hello') }]), FileError],
    [() => shapespace.read([{ name: 'broken.obj', data: new TextEncoder().encode('v 1 2\nf 1 2 3') }]), FileError],
    [() => shapespace.interpolate([flat, rolled], { memoryLimit: 1e4 }), ShapespaceError],
    [() => shapespace.transfer({ file: new Uint8Array(10) }, flat), FileError],
  ];
  for (const [call, kind] of refusals) {
    await assert.rejects(call, (error) => {
      assert.ok(error instanceof kind, `${call}: ${error.name}: ${error.message}`);
      assert.ok(error.message.length > 20, error.message);
      return true;
    });
  }
  await assert.rejects(
    shapespace.read([{ name: 'broken.obj', data: new TextEncoder().encode('v 1 2') }]),
    (error) => error.message.startsWith('broken.obj:1'),
  );
  await assert.rejects(
    shapespace.interpolate([flat, rolled], { maxIterations: -1 }),
    (error) => error.fields[0] === 'maxIterations',
  );
  await assert.rejects(shapespace.interpolate([flat, rolled], { memoryLimit: 1e4 }), /memoryLimit/);
  const other_unit = { ...rolled, positions: rolled.positions.map((c) => 1000 * c) };
  await assert.rejects(
    shapespace.interpolate([flat, other_unit]),
    (error) => error.option === 'allowMismatch' && error.message.includes('allowMismatch'),
  );
});

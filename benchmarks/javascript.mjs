// The npm package against the native tool on one thread, in turn, on the same files: seconds of the
// solve, their ratio, and the relative difference of energies. ./dev wasm and ./dev build come first.
//
//   node benchmarks/javascript.mjs SHAPES TOLERANCE POSE_FILE...
//
// At the default tolerance, 1e-4, energies agree to about as much; at 1e-12 to rounding.
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { load } from '../javascript/index.js';

const [shapes, tolerance, ...files] = process.argv.slice(2);
if (files.length < 2) {
  console.error('usage: node benchmarks/javascript.mjs SHAPES TOLERANCE POSE_FILE POSE_FILE...');
  process.exit(2);
}
const rounds = 3;
const maxIterations = '5000';
const tool = new URL('../build/release/bin/shape-interpolate', import.meta.url).pathname;
const work = mkdtempSync(join(tmpdir(), 'shapespace-'));
const report = join(work, 'report.json');
const poses = files.map((file) => ({ name: basename(file), data: readFileSync(file) }));
const shapespace = await load();

const native = [];
const wasm = [];
const first = [];
for (let round = 0; round < rounds; ++round) {
  execFileSync(tool, [...files, '--shapes', shapes, '--tolerance', tolerance, '--max_iterations', maxIterations,
    '--threads', '1', '--output', join(work, 'a.path'),
    '--report', report], { stdio: 'ignore' });
  native.push(JSON.parse(readFileSync(report, 'utf8')));
  const begin = performance.now();
  let shown = 0;
  const options = {
    shapes: Number(shapes),
    tolerance: Number(tolerance),
    maxIterations: Number(maxIterations),
    onPreview: () => (shown ||= performance.now() - begin),
  };
  wasm.push((await shapespace.interpolate(poses, options)).summary);
  first.push(shown / 1000);
}
shapespace.close();
rmSync(work, { recursive: true });

const least = (values) => Math.min(...values);
const seconds = [native, wasm].map((all) => least(all.map(({ total_seconds }) => total_seconds)));
const difference = wasm[0].energy / native[0].energy - 1;
console.log(`native ${seconds[0].toFixed(2)} s, WebAssembly ${seconds[1].toFixed(2)} s: ` +
  `${(seconds[1] / seconds[0]).toFixed(2)} times; energies differ by ${difference.toExponential(1)}; ` +
  `first preview after ${least(first).toFixed(2)} s`);

// Makes the pages in dist/: viewer.html, which shape-view fills, and solver.html, which contains the
// library as ./dev wasm compiles it.
import { existsSync, rmSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { build } from 'vite';
import { config } from './vite.config.js';

const folder = fileURLToPath(new URL('.', import.meta.url));
const wasm = `${folder}../../javascript/shapespace-module.wasm`;

rmSync(`${folder}dist`, { recursive: true, force: true });
await build(config('viewer.html'));
if (existsSync(wasm)) await build(config('solver.html', wasm));
else console.log('No solver.html: javascript/shapespace-module.wasm is missing; ./dev wasm makes it.');

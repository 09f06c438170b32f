// Geodesic modeling of triangle meshes in shape space, solved in a worker: docs in index.d.ts.

import { FileError, Shapespace } from './core.js';

export * from './core.js';

const inNode = typeof process === 'object' && Boolean(process.versions?.node);

async function startWorker() {
  if (!inNode) return new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
  const { Worker: NodeWorker } = await import('node:worker_threads');
  return new NodeWorker(new URL('./node-worker.js', import.meta.url));
}

async function fetchModule(url) {
  if (inNode && url.protocol === 'file:') {
    return (await import('node:fs/promises')).readFile(url);
  }
  const answer = await fetch(url);
  if (!answer.ok) throw new FileError({ message: `${url}: ${answer.status} ${answer.statusText}` });
  return answer.arrayBuffer();
}

export async function load({ wasm, start = startWorker } = {}) {
  const given = wasm ?? (await fetchModule(new URL('./shapespace-module.wasm', import.meta.url)));
  const module = given instanceof WebAssembly.Module ? given : await WebAssembly.compile(given);
  return new Shapespace(module, start);
}

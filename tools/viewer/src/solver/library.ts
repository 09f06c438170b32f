// The library, compiled to WebAssembly, which runs in workers of this page.
// @ts-expect-error its types are those of the package, which follow
import * as core from '../../../../javascript/core.js';
import type * as Package from '../../../../javascript/index';
import { bytesFromBase64 } from '../decode';
import SolverWorker from '../../../../javascript/worker.js?worker&inline';

export type {
  Deformation,
  Handle,
  InterpolateOptions,
  MeshFile,
  MeshOptions,
  Path,
  Pose,
  Progress,
  Shapespace,
} from '../../../../javascript/index';

export const { MismatchError, ShapespaceError }: typeof Package = core;

const Solver: new (wasm: ArrayBuffer, start: () => Worker) => Package.Shapespace = core.Shapespace;

/** The module is in the page as text: base64 of what gzip made of it. */
async function moduleOfPage(): Promise<ArrayBuffer> {
  const element = document.getElementById('solver-module');
  if (!element?.textContent) throw new Error('the page has lost its solver');
  const packed = new Blob([bytesFromBase64(element.textContent)]);
  element.remove(); // the text is no longer needed
  const unpacked = packed.stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(unpacked).arrayBuffer();
}

/**
 * Two of them, each with a worker of its own: one solves, the other reads, writes and deforms
 * meanwhile, and does not end when a solve is cancelled.
 */
export async function loadLibrary(): Promise<{ solver: Package.Shapespace; helper: Package.Shapespace }> {
  const wasm = await moduleOfPage();
  const make = () => new Solver(wasm, () => new SolverWorker());
  return { solver: make(), helper: make() };
}

/** Starts the worker, which takes a moment, before it is needed. */
export function warmUp(library: Package.Shapespace): void {
  const triangle = { positions: [0, 0, 0, 1, 0, 0, 0, 1, 0], indices: [0, 1, 2] };
  library.read([triangle]).catch(() => {}); // what is needed later will say it
}

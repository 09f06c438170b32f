// The library, compiled to WebAssembly, which runs in workers of this page.
// @ts-expect-error its types are those of the package, which follow
import * as core from '../../../../javascript/core.js';
import type * as Package from '../../../../javascript/index';
import { bytesFromBase64 } from '../decode';
import { example } from './example';
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

const Solver: new (wasm: WebAssembly.Module, start: () => Worker) => Package.Shapespace = core.Shapespace;

/** The module is in the page as text: base64 of what gzip made of it. */
async function moduleOfPage(): Promise<WebAssembly.Module> {
  const element = document.getElementById('solver-module');
  if (!element?.textContent) throw new Error('the page has lost its solver');
  const packed = new Blob([bytesFromBase64(element.textContent)]);
  element.remove(); // the text is no longer needed
  const unpacked = packed.stream().pipeThrough(new DecompressionStream('gzip'));
  const headers = { 'Content-Type': 'application/wasm' };
  return WebAssembly.compileStreaming(new Response(unpacked, { headers }));
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

/** As an OBJ file. */
function asFile(name: string, positions: Float64Array, indices: Uint32Array): Package.MeshFile {
  const lines: string[] = [];
  for (let i = 0; i < positions.length; i += 3) lines.push(`v ${positions.slice(i, i + 3).join(' ')}`);
  for (let i = 0; i < indices.length; i += 3) {
    lines.push(`f ${Array.from(indices.slice(i, i + 3), (v) => v + 1).join(' ')}`);
  }
  return { name: `${name}.obj`, data: new TextEncoder().encode(lines.join('\n')) };
}

/**
 * Starts the workers before they are needed, and has one compute a motion. Browsers compile what runs
 * for the first time in haste, and well what runs often; both workers have what is compiled in common.
 */
export function warmUp(solver: Package.Shapespace, helper: Package.Shapespace): void {
  const { indices, poses } = example();
  const files = poses.slice(0, 2).map(({ name, positions }) => asFile(name, positions, indices));
  // What fails here will fail again when it is needed, and be said then.
  helper.read(files).catch(() => {});
  solver.interpolate(files, { shapes: 3 }).catch(() => {});
}

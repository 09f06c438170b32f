// Answers the calls that core.js sends, one at a time, in whichever kind of worker.

import makeModule from './shapespace-module.mjs';

const deformers = new Map();
let module;

/** All buffers of typed arrays in a result, so that they are handed over and not copied. */
function buffersOf(value, found = new Set()) {
  if (ArrayBuffer.isView(value)) found.add(value.buffer);
  else if (value !== null && typeof value === 'object') {
    for (const part of Object.values(value)) buffersOf(part, found);
  }
  return [...found];
}

let port;

function send(message) {
  port.postMessage(message, buffersOf(message));
}

const calls = {
  async load(wasm) {
    module = await makeModule({ wasmBinary: new Uint8Array(wasm), printErr() {} }); // the log of Ceres
    return {};
  },
  read: (id, poses, options) => module.read(poses, options),
  interpolate: (id, poses, options, { preview }) =>
    module.interpolate(poses, options, progressOf(id), preview ? previewOf(id) : null),
  extrapolate: (id, path, steps, options) =>
    module.extrapolate(path, steps, options, progressOf(id)),
  transfer: (id, path, target, options) => module.transfer(path, target, options, progressOf(id)),
  average: (id, poses, options) => module.average(poses, options, progressOf(id)),
  write: (id, path, name, options) => module.write(path, name, options),
  makeDeformer(id, key, mesh, options) {
    const { deformer, error } = module.makeDeformer(mesh, options);
    if (deformer) deformers.set(key, deformer);
    return error ? { error } : {};
  },
  deform: (id, key, handles) => deformers.get(key).update(handles, progressOf(id)),
  dropDeformer(id, key) {
    deformers.get(key)?.delete();
    deformers.delete(key);
    return {};
  },
};

const progressOf = (id) => (event) => send({ id, progress: event });
const previewOf = (id) => (path) => send({ id, preview: path });

async function answer({ id, name, args }) {
  let result;
  try {
    result = name === 'load' ? await calls.load(...args) : calls[name](id, ...args);
  } catch (error) {
    // Memory that has ended, or a fault of this library.
    result = { error: { kind: 'SolverError', message: String(error?.message ?? error), fatal: true } };
  }
  send({ id, result });
}

/** Answers what comes to a port with `postMessage`. Returns what is to be called with each message. */
export function serve(to) {
  port = to;
  return answer;
}

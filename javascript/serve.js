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

const onProgress = (progress) => send({ progress });
const onPreview = (preview) => send({ preview });

const calls = {
  async load(wasm) {
    module = await new Promise((resolve, reject) => {
      const instantiateWasm = (imports, done) => {
        WebAssembly.instantiate(wasm, imports).then(done).catch(reject);
        return {}; // what it exports comes later
      };
      const printErr = () => {}; // the log of Ceres
      makeModule({ instantiateWasm, printErr }).then(resolve, reject);
    });
    return {};
  },
  read: (poses, options) => module.read(poses, options),
  interpolate: (poses, options, { preview }) =>
    module.interpolate(poses, options, onProgress, preview ? onPreview : null),
  extrapolate: (path, steps, options) => module.extrapolate(path, steps, options, onProgress),
  transfer: (path, target, options) => module.transfer(path, target, options, onProgress),
  average: (poses, options) => module.average(poses, options, onProgress),
  write: (path, name, options) => module.write(path, name, options),
  makeDeformer(key, mesh, options) {
    const { deformer, error } = module.makeDeformer(mesh, options);
    if (deformer) deformers.set(key, deformer);
    return error ? { error } : {};
  },
  deform: (key, handles) => deformers.get(key).update(handles, onProgress),
  dropDeformer(key) {
    deformers.get(key)?.delete();
    deformers.delete(key);
    return {};
  },
};

async function answer({ name, args }) {
  let result;
  try {
    result = await calls[name](...args);
  } catch (error) {
    // Memory that has ended, or a fault of this library.
    result = { error: { kind: 'SolverError', message: String(error?.message ?? error), fatal: true } };
  }
  send({ result });
}

/** Answers what comes to a port with `postMessage`. Returns what is to be called with each message. */
export function serve(to) {
  port = to;
  return answer;
}

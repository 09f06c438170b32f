// What index.js offers, for any place of its files: docs in index.d.ts.

/** What the library refuses, or cannot do. */
export class ShapespaceError extends Error {
  name = 'ShapespaceError'; // bundlers shorten the class's own

  constructor({ message, option, fields }) {
    super(message);
    if (option) this.option = option;
    if (fields) this.fields = fields;
  }
}
export class OptionsError extends ShapespaceError {
  name = 'OptionsError';
}
export class MeshError extends ShapespaceError {
  name = 'MeshError';
}
export class MismatchError extends ShapespaceError {
  name = 'MismatchError';
}
export class FileError extends ShapespaceError {
  name = 'FileError';
}
export class SolverError extends ShapespaceError {
  name = 'SolverError';
}

const errorClasses = { OptionsError, MeshError, MismatchError, FileError, SolverError };

/** A motion: shapes at times, with all that is needed to continue it. */
export class Path {
  constructor(content) {
    Object.assign(this, content);
  }

  /** Positions at a time between the first and the last, linear between shapes; into `out` if given. */
  at(time, out = new Float32Array(this.shapes[0].length)) {
    const { times, shapes } = this;
    const last = times.length - 1;
    const t = Math.min(Math.max(time, times[0]), times[last]);
    let k = 0;
    while (k + 1 < last && times[k + 1] <= t) ++k;
    const next = Math.min(k + 1, last);
    const share = next === k ? 0 : (t - times[k]) / (times[next] - times[k]);
    const from = shapes[k];
    const to = shapes[next];
    for (let i = 0; i < from.length; ++i) out[i] = from[i] + share * (to[i] - from[i]);
    return out;
  }
}

/** Solves in workers that `start` makes, which have the compiled module `wasm` in common. */
export class Shapespace {
  #wasm;
  #start;
  #worker = null;
  #generation = 0; // of workers: deformers live in one
  #deformers = 0;
  #lastCall = Promise.resolve();
  #reject = null; // of the call that runs

  constructor(wasm, start) {
    this.#wasm = wasm;
    this.#start = start;
  }

  read(poses, options = {}) {
    const { signal, ...mesh } = options;
    return this.#call('read', [poses, { mesh }], { signal });
  }

  async interpolate(poses, options = {}) {
    const { events, rest } = split(options);
    const preview = Boolean(events.onPreview);
    return new Path(await this.#call('interpolate', [poses, rest, { preview }], events));
  }

  async extrapolate(path, steps, options = {}) {
    const { events, rest } = split(options);
    return new Path(await this.#call('extrapolate', [path.file, steps, rest], events));
  }

  async transfer(path, target, options = {}) {
    const { events, rest } = split(options);
    const positions = target?.positions ?? target;
    return new Path(await this.#call('transfer', [path.file, positions, rest], events));
  }

  average(poses, options = {}) {
    const { events, rest } = split(options);
    return this.#call('average', [poses, rest], events);
  }

  async write(path, name, options = {}) {
    return (await this.#call('write', [path.file, name, options], {})).files;
  }

  deform(mesh, options = {}) {
    const { rest } = split(options);
    const key = ++this.#deformers;
    let made = -1; // the worker in which it lives
    const make = async () => {
      if (made === this.#generation) return;
      await this.#exchange('makeDeformer', [key, mesh, rest], {});
      made = this.#generation;
    };
    const update = async (handles, events = {}) =>
      new Path(
        await this.#enqueue(async () => {
          await make();
          return this.#exchange('deform', [key, handles], events);
        }, events.signal),
      );
    const close = async () => {
      if (made === this.#generation) await this.#call('dropDeformer', [key], {});
    };
    return this.#enqueue(make).then(() => ({ update, close }));
  }

  close() {
    this.#worker?.terminate();
    this.#worker = null;
    ++this.#generation;
    this.#reject?.(new SolverError({ message: 'closed before it was finished' }));
  }

  #call(name, args, events) {
    return this.#enqueue(() => this.#exchange(name, args, events), events.signal);
  }

  // Runs what needs the worker after all that came before.
  #enqueue(task, signal) {
    const result = this.#lastCall.then(async () => {
      signal?.throwIfAborted();
      if (!this.#worker) {
        this.#worker = await this.#start();
        await this.#exchange('load', [this.#wasm], {});
      }
      return task();
    });
    this.#lastCall = result.catch(() => {});
    return result;
  }

  // Sends a call and waits for its result. A worker that solves hears nothing, so what is aborted
  // ends with its worker; the next call starts another.
  #exchange(name, args, { signal, onProgress, onPreview }) {
    const worker = this.#worker;
    return new Promise((resolve, reject) => {
      const done = (settle, value) => {
        this.#reject = null;
        signal?.removeEventListener('abort', abort);
        hear(worker, null);
        settle(value);
      };
      const abort = () => {
        done(reject, signal.reason);
        this.close();
      };
      this.#reject = (error) => done(reject, error);
      signal?.addEventListener('abort', abort);
      hear(worker, {
        message: ({ progress, preview, result }) => {
          if (progress) return onProgress?.(progress);
          if (preview) return onPreview?.(new Path(preview));
          if (!result.error) return done(resolve, result);
          done(reject, new errorClasses[result.error.kind](result.error));
          if (result.error.fatal) this.close();
        },
        error: (error) => {
          done(reject, new SolverError({ message: `the worker has ended: ${error.message}` }));
          this.close();
        },
      });
      worker.postMessage({ name, args });
    });
  }
}

// Sets what hears a worker's messages; null: nothing.
function hear(worker, listener) {
  const isOfNode = typeof worker.on === 'function';
  if (isOfNode) {
    worker.removeAllListeners('message');
    worker.removeAllListeners('error');
    if (!listener) return worker.unref(); // an idle worker keeps no program from ending
    worker.ref();
    worker.on('message', listener.message);
    worker.on('error', listener.error);
    return;
  }
  worker.onmessage = listener && (({ data }) => listener.message(data));
  worker.onerror = listener && listener.error;
}

function split(options) {
  const { signal, onProgress, onPreview, ...rest } = options;
  return { events: { signal, onProgress, onPreview }, rest };
}

// A worker of Node.
import { webcrypto } from 'node:crypto';
import { parentPort } from 'node:worker_threads';
import { serve } from './serve.js';

// Node 18 has no such global, from which the module takes its random numbers.
globalThis.crypto ??= webcrypto;

parentPort.on('message', serve(parentPort));

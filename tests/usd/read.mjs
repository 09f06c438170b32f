// Reads the .usda that is named first, and compares it with the OBJ files that are named after it:
// one for each of its time samples. run.sh installs the package that this needs.
import { readFileSync } from 'node:fs';

// The package is built for browsers. It takes a process with this type for one.
process.type = 'renderer';
globalThis.window = globalThis;
const { default: initialise } = await import('tinyusdz');

const binary = readFileSync(new URL('node_modules/tinyusdz/tinyusdz.wasm', import.meta.url));
const tinyusdz = await initialise({
  instantiateWasm(imports, done) {
    WebAssembly.instantiate(binary, imports).then(({ instance, module }) => done(instance, module));
    return {};
  },
});

function fail(problem) {
  console.error(`usd test: ${problem}`);
  process.exit(1);
}

const [usda, ...objs] = process.argv.slice(2);
const bytes = new Uint8Array(readFileSync(usda));
const numbersOf = (text) => (text.match(/-?\d[-+.e\d]*/g) ?? []).map(Number);

// As a scene: the reader triangulates the mesh, and so reads its faces.
const scene = new tinyusdz.TinyUSDZLoaderNative();
if (!scene.loadFromBinary(bytes, usda)) fail(`${usda}: ${scene.error()}`);
if (scene.numMeshes() !== 1) fail(`${usda}: ${scene.numMeshes()} meshes`);
const mesh = scene.getMesh(0);
const lines = readFileSync(objs[0], 'utf8').split('\n');
const triangles = lines.filter((line) => line.startsWith('f ')).length;
if (mesh.faceVertexCounts.length !== triangles) {
  fail(`${usda}: ${mesh.faceVertexCounts.length} triangles, ${objs[0]} has ${triangles}`);
}

// As a layer, which the reader writes again as it has understood it.
const layer = new tinyusdz.TinyUSDZLoaderNative();
if (!layer.loadAsLayerFromBinary(bytes, usda)) fail(`${usda}: ${layer.error()}`);
const text = layer.layerToString();
const value = (name) => numbersOf(text.match(new RegExp(`${name} = (.*)`))[1]);
const samples = (name) => {
  const begin = text.indexOf(`${name}.timeSamples = {`);
  if (begin < 0) fail(`${usda}: no samples of ${name}`);
  const rows = text.slice(begin, text.indexOf('}', begin)).split('\n').slice(1);
  return rows.filter((row) => row.includes(':')).map((row) => numbersOf(row.split(':')[1]));
};
if (value('metersPerUnit')[0] !== 0.01) fail(`${usda}: metersPerUnit is ${value('metersPerUnit')}`);
if (value('endTimeCode')[0] !== objs.length - 1) fail(`${usda}: endTimeCode ${value('endTimeCode')}`);

const centre = value('xformOp:translate');
const points = samples('points');
const colours = samples('primvars:displayColor');
if (points.length !== objs.length) fail(`${usda}: ${points.length} shapes of ${objs.length}`);
if (colours.length !== objs.length) fail(`${usda}: colours at ${colours.length} times`);
let greatest = 0;
objs.forEach((obj, i) => {
  const vertices = readFileSync(obj, 'utf8')
    .split('\n')
    .filter((line) => line.startsWith('v '))
    .flatMap((line) => line.split(/\s+/).slice(1, 4).map(Number));
  for (const array of [points[i], colours[i]]) {
    if (array.length !== vertices.length) fail(`${obj}: ${vertices.length}, not ${array.length}`);
  }
  vertices.forEach((x, k) => {
    greatest = Math.max(greatest, Math.abs(points[i][k] + centre[k % 3] - x));
  });
});
if (!(greatest < 1e-5)) fail(`${usda}: a coordinate is off by ${greatest}`);
console.log(
  `${usda}: ${triangles} triangles, ${points.length} shapes, coordinates within ${greatest}`,
);
console.log('usd test: passed');

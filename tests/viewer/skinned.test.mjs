// Whether three.js plays the bones of a glb as the library does: skinned.glb, and what the vertices do
// in skinned.pc2, evenly over the two seconds of the animation (tests/output/skinned_gltf_test.cc).
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { AnimationMixer, LoopOnce, SkinnedMesh, Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

const folder = process.env.SHAPESPACE_PAGE_DIR;
globalThis.self = globalThis; // GLTFLoader looks for what a browser's window has

function shapesOf(file) {
  const bytes = readFileSync(file);
  const vertices = bytes.readInt32LE(16);
  return Array.from({ length: bytes.readInt32LE(28) }, (_, i) =>
    Array.from({ length: vertices }, (_, v) => {
      const coordinate = (k) => bytes.readFloatLE(32 + 4 * (3 * (i * vertices + v) + k));
      return new Vector3(coordinate(0), coordinate(1), coordinate(2));
    }),
  );
}

test('three.js plays bones as the library does', async () => {
  const glb = readFileSync(`${folder}/skinned.glb`);
  const buffer = glb.buffer.slice(glb.byteOffset, glb.byteOffset + glb.byteLength);
  const { scene, animations } = await new GLTFLoader().parseAsync(buffer, '');
  const meshes = [];
  scene.traverse((object) => {
    if (object instanceof SkinnedMesh) meshes.push(object);
  });
  assert.equal(meshes.length, 1);
  const mixer = new AnimationMixer(scene);
  const action = mixer.clipAction(animations[0]).setLoop(LoopOnce);
  action.clampWhenFinished = true;
  action.play();
  const shapes = shapesOf(`${folder}/skinned.pc2`);
  assert.ok(shapes.length >= 10);
  let moved = 0;
  shapes.forEach((shape, i) => {
    mixer.setTime((2 * i) / (shapes.length - 1));
    scene.updateMatrixWorld(true);
    shape.forEach((place, v) => {
      const played = meshes[0].getVertexPosition(v, new Vector3()).applyMatrix4(meshes[0].matrixWorld);
      // Weights are rounded to 16 bits, and bones are up to 4 radii away.
      assert.ok(played.distanceTo(place) < 1e-4, `shape ${i}, vertex ${v}`);
      moved = Math.max(moved, place.distanceTo(shapes[0][v]));
    });
  });
  assert.ok(moved > 0.1);
});

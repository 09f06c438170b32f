// A curve in a space of poses as an animated glb.
import {
  AnimationClip,
  BufferGeometry,
  Float32BufferAttribute,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  NumberKeyframeTrack,
  Uint32BufferAttribute,
} from 'three';
import { GLTFExporter } from 'three/addons/exporters/GLTFExporter.js';
import type { Blend } from './blended_mesh';
import { vertexNormals } from './normals';
import type { Body } from './scene_data';

/** Keyframes per second; programs that show the file interpolate linearly between two of them. */
const rate = 30;

/** The weight of every node at one moment. */
function weightsOf({ nodes, weights }: Blend): Map<number, number> {
  const sums = new Map<number, number>();
  nodes.forEach((node, k) => {
    if (weights[k] !== 0) sums.set(node, (sums.get(node) ?? 0) + weights[k]);
  });
  return sums;
}

function positions(body: Body, node: number): Float32Array {
  const shape = body.shapes[node];
  const values = new Float32Array(3 * body.vertices);
  for (let v = 0; v < body.vertices; ++v) {
    for (let k = 0; k < 3; ++k) values[3 * v + k] = (shape[4 * v + k] / 65535 - 0.5) * body.side;
  }
  return values;
}

function normals(body: Body, node: number): Float32Array {
  const bytes = vertexNormals(body, body.shapes[node]);
  const values = new Float32Array(3 * body.vertices);
  for (let v = 0; v < body.vertices; ++v) {
    const [x, y, z] = bytes.subarray(4 * v, 4 * v + 3);
    const length = Math.hypot(x, y, z);
    // glTF requires unit vectors, also where all triangles have area 0; any is right there.
    values.set(length > 0 ? [x / length, y / length, z / length] : [0, 1, 0], 3 * v);
  }
  return values;
}

function minus(values: Float32Array, base: Float32Array): Float32Array {
  return values.map((value, i) => value - base[i]);
}

/**
 * The nodes that the curve touches become the mesh and its morph targets, so that the file holds no
 * shape twice, and the whole curve, in the positions that the page has.
 */
export async function curveToGlb(
  body: Body,
  blendAt: (place: number) => Blend,
  seconds: number,
): Promise<ArrayBuffer> {
  const count = Math.max(2, Math.round(rate * seconds) + 1);
  const moments = Array.from({ length: count }, (_, i) => weightsOf(blendAt(i / (count - 1))));
  const [base, ...targets] = [...new Set(moments.flatMap((weights) => [...weights.keys()]))];

  const isGraph = body.triangles.length === 0;
  const geometry = new BufferGeometry();
  const basePositions = positions(body, base);
  geometry.setIndex(new Uint32BufferAttribute(isGraph ? body.segments : body.triangles, 1));
  geometry.setAttribute('position', new Float32BufferAttribute(basePositions, 3));
  geometry.morphTargetsRelative = true;
  if (targets.length > 0) {
    geometry.morphAttributes.position = targets.map(
      (node) => new Float32BufferAttribute(minus(positions(body, node), basePositions), 3),
    );
  }
  if (!isGraph) {
    const baseNormals = normals(body, base);
    geometry.setAttribute('normal', new Float32BufferAttribute(baseNormals, 3));
    if (targets.length > 0) {
      geometry.morphAttributes.normal = targets.map(
        (node) => new Float32BufferAttribute(minus(normals(body, node), baseNormals), 3),
      );
    }
  }
  const mesh = isGraph
    ? new LineSegments(geometry, new LineBasicMaterial())
    : new Mesh(geometry, new MeshStandardMaterial({ roughness: 0.7, metalness: 0 }));
  mesh.name = 'shape';
  mesh.updateMorphTargets();
  // glTF's y is up.
  if (body.up[2] > 0.5) mesh.rotation.x = -Math.PI / 2;
  const animations: AnimationClip[] = [];
  if (targets.length > 0) {
    const times = moments.map((_, i) => (i / (count - 1)) * seconds);
    const values = moments.flatMap((weights) => targets.map((node) => weights.get(node) ?? 0));
    const track = new NumberKeyframeTrack('shape.morphTargetInfluences', times, values);
    animations.push(new AnimationClip('curve', seconds, [track]));
  }
  const glb = await new GLTFExporter().parseAsync(mesh, { binary: true, animations });
  return glb as ArrayBuffer;
}

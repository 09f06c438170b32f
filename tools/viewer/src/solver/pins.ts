// Patches of the surface that are held or pulled.
import { Vector3 } from 'three';

/** Of the size of the body: what is not farther from the vertex that was clicked is pinned with it. */
const reach = 0.04;

export interface Pin {
  /** The vertex that was clicked, and those around it, which the first of them is. */
  vertices: Uint32Array;
  /** Where they are to be: three numbers each, in the unit of the poses. */
  positions: Float64Array;
}

/** For each vertex those that it has edges to. */
export class Neighbours {
  private readonly begin: Uint32Array;
  private readonly ends: Uint32Array;

  constructor(triangles: Uint32Array, vertices: number) {
    this.begin = new Uint32Array(vertices + 1);
    for (const v of triangles) this.begin[v + 1] += 2;
    for (let v = 0; v < vertices; ++v) this.begin[v + 1] += this.begin[v];
    this.ends = new Uint32Array(2 * triangles.length);
    const next = this.begin.slice();
    for (let i = 0; i < triangles.length; i += 3) {
      for (let k = 0; k < 3; ++k) {
        const v = triangles[i + k];
        this.ends[next[v]++] = triangles[i + ((k + 1) % 3)];
        this.ends[next[v]++] = triangles[i + ((k + 2) % 3)];
      }
    }
  }

  of(vertex: number): Uint32Array {
    return this.ends.subarray(this.begin[vertex], this.begin[vertex + 1]);
  }
}

/** The vertices near one that are connected with it inside this reach. What lies close but on
 * another part of the body, such as the other leg, is not among them. */
function patchAround(vertex: number, shape: Float64Array, size: number, neighbours: Neighbours): Uint32Array {
  const centre = new Vector3().fromArray(shape, 3 * vertex);
  const point = new Vector3();
  const found = new Set([vertex]);
  for (const v of found) {
    for (const next of neighbours.of(v)) {
      if (point.fromArray(shape, 3 * next).distanceTo(centre) <= reach * size) found.add(next);
    }
  }
  return new Uint32Array(found);
}

/** A pin that holds a part of a shape where it is. */
export function pinAt(vertex: number, shape: Float64Array, size: number, neighbours: Neighbours): Pin {
  const vertices = patchAround(vertex, shape, size, neighbours);
  const positions = new Float64Array(3 * vertices.length);
  vertices.forEach((v, i) => positions.set(shape.subarray(3 * v, 3 * v + 3), 3 * i));
  return { vertices, positions };
}

/** The vertex, used by a triangle, that is farthest from another one. */
export function farthestFrom(vertex: number, shape: Float64Array, triangles: Uint32Array): number {
  const from = new Vector3().fromArray(shape, 3 * vertex);
  const point = new Vector3();
  let farthest = vertex;
  let most = -1;
  for (const v of triangles) {
    const distance = point.fromArray(shape, 3 * v).distanceToSquared(from);
    if (distance <= most) continue;
    most = distance;
    farthest = v;
  }
  return farthest;
}

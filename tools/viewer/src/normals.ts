import type { Body } from './scene_data';

type Surface = Pick<Body, 'vertices' | 'triangles'>;

/** Sums of triangles' normals at every vertex, weighted by area; three numbers for each vertex. */
function sums(body: Surface, shape: Uint16Array): Float32Array {
  const normals = new Float32Array(3 * body.vertices);
  const { triangles } = body;
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [4 * triangles[i], 4 * triangles[i + 1], 4 * triangles[i + 2]];
    const [ux, uy, uz] = [
      shape[b] - shape[a],
      shape[b + 1] - shape[a + 1],
      shape[b + 2] - shape[a + 2],
    ];
    const [vx, vy, vz] = [
      shape[c] - shape[a],
      shape[c + 1] - shape[a + 1],
      shape[c + 2] - shape[a + 2],
    ];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (let k = 0; k < 3; ++k) {
      const v = 3 * triangles[i + k];
      normals[v] += x;
      normals[v + 1] += y;
      normals[v + 2] += z;
    }
  }
  return normals;
}

/** Unit normals for smooth shading, times 127; four bytes for each vertex, which GPUs need. */
export function vertexNormals(body: Surface, shape: Uint16Array): Int8Array {
  const from = sums(body, shape);
  const normals = new Int8Array(4 * body.vertices);
  for (let v = 0; v < body.vertices; ++v) {
    const [x, y, z] = [from[3 * v], from[3 * v + 1], from[3 * v + 2]];
    const scale = 127 / (Math.hypot(x, y, z) || 1);
    normals[4 * v] = Math.round(x * scale);
    normals[4 * v + 1] = Math.round(y * scale);
    normals[4 * v + 2] = Math.round(z * scale);
  }
  return normals;
}

/**
 * Whether a shape should be shaded flat, as polyhedra and folded paper should. It should if at
 * vertices a large part of the triangles' normals, weighted by area, cancels out in the sum.
 */
export function isFaceted(body: Surface, shape: Uint16Array): boolean {
  const from = sums(body, shape);
  const { triangles } = body;
  let together = 0;
  for (let i = 0; i < from.length; i += 3) {
    together += Math.hypot(from[i], from[i + 1], from[i + 2]);
  }
  let apart = 0;
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [4 * triangles[i], 4 * triangles[i + 1], 4 * triangles[i + 2]];
    const u = [0, 1, 2].map((k) => shape[b + k] - shape[a + k]);
    const v = [0, 1, 2].map((k) => shape[c + k] - shape[a + k]);
    apart +=
      3 *
      Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]);
  }
  return together < 0.9 * apart;
}

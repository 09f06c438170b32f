// The vertex under the pointer.
import { Ray, Vector3 } from 'three';
import type { Body } from './scene_data';

/** Of the first triangle on the ray, the corner nearest to where the ray meets it; null if none. */
export function vertexOnRay(
  { triangles }: Pick<Body, 'triangles'>,
  positions: Float32Array,
  origin: Vector3,
  direction: Vector3,
): number | null {
  const ray = new Ray(origin, direction);
  const corners = [new Vector3(), new Vector3(), new Vector3()];
  const at = new Vector3();
  let first = Infinity;
  let nearest: number | null = null;
  for (let i = 0; i < triangles.length; i += 3) {
    corners.forEach((corner, k) => corner.fromArray(positions, 3 * triangles[i + k]));
    if (!ray.intersectTriangle(corners[0], corners[1], corners[2], false, at)) continue;
    const distance = at.distanceToSquared(origin);
    if (distance >= first) continue;
    first = distance;
    const away = corners.map((corner) => corner.distanceToSquared(at));
    nearest = triangles[i + away.indexOf(Math.min(...away))];
  }
  return nearest;
}

/** For each of some vertices, where its triangles begin in `triangles`. */
export function trianglesAt({ triangles }: Body, vertices: number[]): Map<number, number[]> {
  const found = new Map(vertices.map((vertex): [number, number[]] => [vertex, []]));
  triangles.forEach((vertex, i) => found.get(vertex)?.push(i - (i % 3)));
  return found;
}

/** Whether triangles, seen at corners of the canvas, show more of their backs than of their fronts. */
export function showBack(corners: [number, number][]): boolean {
  let twice = 0;
  for (let i = 0; i < corners.length; i += 3) {
    const [[ax, ay], [bx, by], [cx, cy]] = corners.slice(i, i + 3);
    twice += (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
  }
  return twice > 0; // y points down
}

/** The vertices that are seen inside a polygon of the canvas, also those behind others. */
export function verticesInside(
  positions: Float32Array,
  project: (point: Vector3) => [number, number],
  polygon: [number, number][],
): number[] {
  const inside: number[] = [];
  const point = new Vector3();
  for (let v = 0; v < positions.length / 3; ++v) {
    const [x, y] = project(point.fromArray(positions, 3 * v));
    let odd = false;
    polygon.forEach(([ax, ay], k) => {
      const [bx, by] = polygon[(k + 1) % polygon.length];
      if (ay > y !== by > y && x < ax + ((y - ay) / (by - ay)) * (bx - ax)) odd = !odd;
    });
    if (odd) inside.push(v);
  }
  return inside;
}

// Finds the triangle or segment of nodes in which a point of the plane lies.
import type { Blend } from './blended_mesh';
import type { SpaceScene } from './scene_data';

export type Point = [number, number];

export interface Located extends Blend {
  /** Where the blend is: the point itself or, outside, the nearest point of the hull. */
  point: Point;
  outside: boolean;
}

type Plane = Pick<SpaceScene, 'points' | 'planeTriangles' | 'planeSegments'>;

const tolerance = 1e-9;

function cross(a: Point, b: Point, c: Point): number {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/** Edges with a triangle on one side only; in a plane without triangles, all segments. */
export function hullEdges({ planeTriangles, planeSegments }: Plane): [number, number][] {
  if (planeTriangles.length === 0) return planeSegments;
  const edges = new Map<string, [number, number]>();
  for (const triangle of planeTriangles) {
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [triangle[k], triangle[(k + 1) % 3]];
      if (!edges.delete(`${b} ${a}`)) edges.set(`${a} ${b}`, [a, b]);
    }
  }
  return [...edges.values()];
}

function nearestOnEdge(point: Point, a: Point, b: Point): number {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const squared = dx * dx + dy * dy;
  if (squared === 0) return 0;
  const t = ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / squared;
  return Math.min(1, Math.max(0, t));
}

export class Locator {
  private readonly hull: [number, number][];
  private readonly size: number;

  constructor(private readonly plane: Plane) {
    this.hull = hullEdges(plane);
    const [xs, ys] = [0, 1].map((k) => plane.points.map((point) => point[k]));
    this.size = Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys));
  }

  at(point: Point): Located {
    return this.inside(point) ?? this.nearest(point);
  }

  private inside(point: Point): Located | null {
    const { points, planeTriangles } = this.plane;
    for (const nodes of planeTriangles) {
      const [a, b, c] = nodes.map((node) => points[node]);
      const area = cross(a, b, c);
      if (area === 0) continue;
      const wb = cross(a, point, c) / area;
      const wc = cross(a, b, point) / area;
      if (wb < -tolerance || wc < -tolerance || wb + wc > 1 + tolerance) continue;
      return { nodes, weights: [1 - wb - wc, wb, wc], point, outside: false };
    }
    return null;
  }

  private nearest(point: Point): Located {
    const { points } = this.plane;
    let best: Located = {
      nodes: [0, 0, 0],
      weights: [1, 0, 0],
      point: points[0],
      outside: Math.hypot(point[0] - points[0][0], point[1] - points[0][1]) > 0,
    };
    let least = Infinity;
    for (const [a, b] of this.hull) {
      const t = nearestOnEdge(point, points[a], points[b]);
      const there: Point = [
        (1 - t) * points[a][0] + t * points[b][0],
        (1 - t) * points[a][1] + t * points[b][1],
      ];
      const distance = Math.hypot(point[0] - there[0], point[1] - there[1]);
      if (distance >= least) continue;
      least = distance;
      const outside = distance > 1e-6 * this.size;
      best = { nodes: [a, b, b], weights: [1 - t, t, 0], point: there, outside };
    }
    return best;
  }
}

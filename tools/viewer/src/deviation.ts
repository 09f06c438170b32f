// Deviation of edge lengths from the first shape, of scenes that come without: as the program
// computes it, each edge weighted by a third of the triangles beside it in the first shape.
import type { Body } from './scene_data';

function length(shape: Uint16Array, a: number, b: number): number {
  return Math.hypot(
    shape[4 * b] - shape[4 * a],
    shape[4 * b + 1] - shape[4 * a + 1],
    shape[4 * b + 2] - shape[4 * a + 2],
  );
}

interface Edges {
  ends: Uint32Array; // two an edge; an edge between two triangles stands there twice
  weights: Float32Array;
  lengths: Float32Array; // in the first shape
}

function edgesOf(body: Body): Edges {
  const { triangles, segments } = body;
  const first = body.shapes[0];
  const count = triangles.length + segments.length / 2;
  const edges = {
    ends: new Uint32Array(2 * count),
    weights: new Float32Array(count).fill(1),
    lengths: new Float32Array(count),
  };
  edges.ends.set(segments, 2 * triangles.length);
  for (let i = 0; i < triangles.length; i += 3) {
    const sides = [0, 1, 2].map((k) =>
      length(first, triangles[i + k], triangles[i + ((k + 1) % 3)]),
    );
    const half = (sides[0] + sides[1] + sides[2]) / 2;
    const area = Math.sqrt(
      Math.max(0, half * (half - sides[0]) * (half - sides[1]) * (half - sides[2])),
    );
    for (let k = 0; k < 3; ++k) {
      edges.ends[2 * (i + k)] = triangles[i + k];
      edges.ends[2 * (i + k) + 1] = triangles[i + ((k + 1) % 3)];
      edges.weights[i + k] = area;
    }
  }
  for (let e = 0; e < count; ++e) {
    edges.lengths[e] = length(first, edges.ends[2 * e], edges.ends[2 * e + 1]);
  }
  return edges;
}

/** The 99th percentile, rounded up to 1, 2 or 5 times a power of ten; 1 % where all is 0. */
function endOfScale(values: Float32Array[]): number {
  const sample: number[] = [];
  const step = Math.max(1, Math.floor((values.length * values[0].length) / 200000));
  let at = 0;
  for (const list of values) {
    for (; at < list.length; at += step) sample.push(list[at]);
    at -= list.length;
  }
  sample.sort((a, b) => a - b);
  const high = sample[Math.floor(0.99 * (sample.length - 1))];
  if (!(high > 0)) return 0.01;
  const power = 10 ** Math.floor(Math.log10(high));
  return [1, 2, 5, 10].map((factor) => factor * power).find((end) => high <= end * (1 + 1e-9))!;
}

export interface Deviations {
  rms: number[];
  max: number[];
  scaleEnd: number;
}

/** Fills in the fourth number of every vertex of the shapes. */
export function measureDeviations(body: Body): Deviations {
  const { ends, weights, lengths } = edgesOf(body);
  const shortest = 1e-3 * Math.sqrt(lengths.reduce((sum, l) => sum + l * l, 0) / lengths.length);
  const rms: number[] = [];
  const max: number[] = [];
  const perVertex = body.shapes.map((shape) => {
    const sum = new Float32Array(body.vertices);
    const weight = new Float32Array(body.vertices);
    let squares = 0;
    let total = 0;
    let largest = 0;
    for (let e = 0; e < weights.length; ++e) {
      if (!(lengths[e] > shortest)) continue;
      const [a, b, w] = [ends[2 * e], ends[2 * e + 1], weights[e]];
      const off = Math.abs(length(shape, a, b) / lengths[e] - 1);
      sum[a] += w * off;
      sum[b] += w * off;
      weight[a] += w;
      weight[b] += w;
      squares += w * off * off;
      total += w;
      largest = Math.max(largest, off);
    }
    rms.push(total > 0 ? Math.sqrt(squares / total) : 0);
    max.push(largest);
    return sum.map((value, v) => (weight[v] > 0 ? value / weight[v] : 0));
  });
  const scaleEnd = endOfScale(perVertex);
  body.shapes.forEach((shape, s) => {
    for (let v = 0; v < body.vertices; ++v) {
      shape[4 * v + 3] = Math.round(65535 * Math.min(1, perVertex[s][v] / scaleEnd));
    }
  });
  return { rms, max, scaleEnd };
}

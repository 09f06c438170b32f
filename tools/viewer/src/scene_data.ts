// What the page shows, however it came in.

/** What all shapes of a scene share, and the shapes. */
export interface Body {
  name: string;
  vertices: number;
  triangles: Uint32Array;
  /** Of a graph, which has no triangles: pairs of vertices. */
  segments: Uint32Array;
  /** Red, green and blue of every vertex in sRGB, if there are any. */
  colours: Uint8Array | null;
  /** The cube that holds all shapes. */
  low: [number, number, number];
  side: number;
  up: [number, number, number];
  /** The direction to look from. */
  eye: [number, number, number];
  /** Four numbers a vertex: place in the cube, 0 .. 65535 along its side, and deviation, 0 .. 65535
   * of `scaleEnd`. */
  shapes: Uint16Array[];
}

export interface PathScene extends Body {
  kind: 'path';
  parameters: number[];
  poses: number[];
  metric: string;
  /** Squared speed of every segment; null where it is not known. */
  speeds: (number | null)[];
  /** Of every shape: deviation of edge lengths from the first shape. */
  rms: number[];
  max: number[];
  scaleEnd: number;
}

export interface SpaceScene extends Body {
  kind: 'space';
  /** Of the poses, which are the first nodes. */
  names: string[];
  points: [number, number][];
  planeTriangles: [number, number, number][];
  planeSegments: [number, number][];
  parents: [number, number][];
}

export type SceneData = PathScene | SpaceScene;

/** What was read is not what was written. */
export class Damaged extends Error {}

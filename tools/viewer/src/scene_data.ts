// The data of a page, whether they come from shape-view or from a glb file.

import type { Texture } from 'three';
import type { Triple } from './ramp';

/** The textures of a body. */
export interface Skin {
  /** The surface as it is drawn, if it is cut at seams: the body's vertex for each that is drawn, and
   * triangles of those that are drawn. Without, it is the body's own. */
  cut: { source: Uint32Array; triangles: Uint32Array } | null;
  /** Texture coordinates, two of every vertex that is drawn. */
  uv: Float32Array;
  /** Runs of the triangles that are drawn, from which number on and how many numbers, each with its
   * texture, and, without one, its colour in sRGB if it has its own. */
  parts: { start: number; count: number; map: Texture | null; colour?: Triple }[];
}

/** The bones of a glb. */
export interface Skeleton {
  /** The joint above each joint, which comes before it; -1 if there is none. */
  parents: number[];
  /** Of each shape three numbers a joint: its place in the cube, whose side is 1. */
  places: Float32Array[];
}

/** What all shapes of a scene share, and the shapes. */
export interface Body {
  name: string;
  vertices: number;
  triangles: Uint32Array;
  /** The edges of a graph, which has no triangles, as pairs of vertices. */
  segments: Uint32Array;
  /** Red, green and blue of every vertex in sRGB, if there are any. */
  colours: Uint8Array | null;
  /** The textures, if there are any. */
  skin: Skin | null;
  /** The cube that contains all shapes: its corner with the least coordinates, and its side. */
  low: [number, number, number];
  side: number;
  up: [number, number, number];
  /** The direction to look from. */
  eye: [number, number, number];
  /** Four numbers for each vertex: its position in the cube, where 65535 is the side, and the
   * deviation of its edges, where 65535 is `scaleEnd`. */
  shapes: Uint16Array[];
}

export interface PathScene extends Body {
  kind: 'path';
  /** Its name in command lines; empty if it has none. */
  file: string;
  parameters: number[];
  poses: number[];
  /** A name of each pose, or none. */
  poseNames: string[];
  /** How many of the last shapes go beyond the last pose. */
  extrapolated: number;
  /** Whether the velocity does not jump at the poses. */
  smooth: boolean;
  metric: string;
  /** Squared speed of every segment; null where it is not known. */
  speeds: (number | null)[];
  /** The deviation of edge lengths from those of the first shape, one number for each shape. */
  rms: number[];
  max: number[];
  scaleEnd: number;
  /** The energy at vertices that has the last colour; null where it is not known. */
  energyEnd: number | null;
  /** Of each shape a number a vertex, where 65535 is `energyEnd`; exchanged with the deviations in
   * `shapes` while they are shown. */
  energies: Uint16Array[];
  /** Red, green and blue of every vertex, by its near-rigid part; null if there are no parts. */
  partColours: Uint8Array | null;
  /** For each shape the number of pairs of triangles that intersect, and the vertices of these
   * triangles; null where it is not known. */
  intersections: { pairs: number; vertices: Uint32Array }[] | null;
  /** The bones that a glb has; null without. */
  skeleton: Skeleton | null;
}

export interface SpaceScene extends Body {
  kind: 'space';
  /** The names of the poses, which are the first nodes. */
  names: string[];
  points: [number, number][];
  planeTriangles: [number, number, number][];
  planeSegments: [number, number][];
  parents: [number, number][];
}

export interface ModesScene extends Body {
  kind: 'modes';
  /** The shapes are keys, of which others are made: docs/file-formats.md. */
  places: number[];
  pairPlace: number;
  /** Of what is shown from exact shapes, as a share of the diagonal of the mean. */
  error: number;
  /** Shares of the variance, one for each mode. */
  shares: number[];
  /** Of the poses; and their coordinates. */
  names: string[];
  coordinates: number[][];
  scalars: { name: string; least: number; most: number; value: number }[];
  intercept: number[];
  /** For each scalar, one number for each mode. */
  slopes: number[][];
  /** Its name in command lines. */
  file: string;
}

export interface MeshScene extends Body {
  kind: 'mesh';
  /** Its name in command lines. */
  file: string;
  /** Vertices that are picked already: those of two meshes with the same place in the list are a
   * marker. */
  markers: number[];
}

export type SceneData = PathScene | SpaceScene | ModesScene | MeshScene;

/** Thrown if the data in the page are damaged. */
export class Damaged extends Error {}

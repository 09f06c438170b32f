// Geodesic modeling of triangle meshes in shape space.
//
// Poses are shapes of one mesh: the same triangles, other positions. Positions are x0, y0, z0, x1, ...
// in any unit; results are in the same unit and place. Everything is solved in a worker, one call after
// the other, and every call can be aborted.

export type Numbers = Float32Array | Float64Array | readonly number[];

/** A pose as arrays. `indices` are three vertices of each triangle, needed of the first pose only. */
export interface MeshArrays {
  positions: Numbers;
  indices?: Uint32Array | Uint16Array | readonly number[];
  name?: string;
}

/** A pose, or several, as a file: OBJ, PLY, OFF, STL, glTF (.glb), VTK. */
export interface MeshFile {
  name: string;
  data: Uint8Array;
}

export type Pose = MeshArrays | MeshFile;

/** How meshes are taken that are doubtful. All are false, and without `mirror`, by default. */
export interface MeshOptions {
  /** Accept meshes in which more than two triangles have an edge in common. */
  allowNonmanifold?: boolean;
  /** Leave components loose, such as eyes and clothes, although they stay near others. */
  looseComponents?: boolean;
  /** Change the sign of this coordinate in poses that are mirror images of the first. */
  mirror?: 'x' | 'y' | 'z';
  allowMirrored?: boolean;
  /** Take poses although their unit, or order of vertices, seems to be another one. */
  allowMismatch?: boolean;
  /** Leave seams open, where borders of the surface lie on each other in all poses. */
  openSeams?: boolean;
}

export interface Progress {
  stage: string;
  done: number;
  /** 0 if it is not known. */
  total: number;
  /** Estimated share of the whole work, 0 to 1. */
  share: number;
}

export interface Events {
  /** Ends the call: it then rejects with the signal's reason. */
  signal?: AbortSignal;
  onProgress?: (progress: Progress) => void;
}

/** What motions cost: a preset's name, or its parts (docs/mathematics.md). */
export type Metric =
  | 'strain'
  | 'isometric'
  | 'rigid'
  | 'paper'
  | {
      preset?: 'strain' | 'isometric' | 'rigid' | 'paper';
      isometric?: number;
      strain?: number;
      rigid?: number;
      lambda?: number;
      bending?: number;
      volume?: number;
      weights?: 'area' | 'uniform';
      stretchingStiffness?: Numbers;
      bendingStiffness?: Numbers;
      stiffnessOn?: 'vertices' | 'edges';
    };

export interface InterpolateOptions extends Events {
  mesh?: MeshOptions;
  metric?: Metric;
  /** Shapes inserted between neighbouring poses: 15. */
  shapes?: number;
  /** A level is finished when an iteration lowers the energy by less than this share of it: 1e-4. */
  tolerance?: number;
  maxIterations?: number;
  solver?: 'automatic' | 'lbfgs' | 'threaded_lbfgs' | 'trust_region';
  schedule?: 'automatic' | 'paper' | 'flat';
  start?: 'best' | 'blend' | 'first' | 'last' | 'rigid';
  coarsest?: number;
  /** Bytes; 2e9 by default. What would need more is refused before it begins. */
  memoryLimit?: number;
  /** Whether intersections and quality are measured: true. */
  assess?: boolean;
  /** Whether the body must not pass through itself. */
  avoidContact?: boolean;
  /** Called with the motion as it is so far, which becomes finer. Such paths have no `file`. */
  onPreview?: (path: Path) => void;
}

export interface ExtrapolateOptions extends Events {
  tolerance?: number;
  maxIterations?: number;
  /** End where the body would pass through itself. */
  stopAtContact?: boolean;
  slideAtContact?: boolean;
}

export interface TransferOptions extends Events {
  tolerance?: number;
  maxIterations?: number;
  memoryLimit?: number;
}

export interface AverageOptions extends Events {
  mesh?: MeshOptions;
  metric?: Metric;
  weights?: Numbers;
  certify?: boolean;
  refine?: boolean;
}

export interface DeformOptions {
  mesh?: MeshOptions;
  metric?: Metric;
  /** Frames from the mesh to the deformed one: 5. */
  shapes?: number;
  /** Weight of the metric relative to soft handles, in (0, 1]: .01. */
  balance?: number;
  tolerance?: number;
  maxIterations?: number;
  memoryLimit?: number;
}

/** Some vertices, and where they are to be; without `positions` they stay where they are. */
export interface Handle {
  vertices: readonly number[] | Uint32Array;
  positions?: Numbers;
  /** Met exactly (the default), or as far as `weight` says. */
  hard?: boolean;
  weight?: number;
  name?: string;
}

/** How a solve ended: the fields of the tools' JSON reports (docs/file-formats.md). */
export type Summary = Record<string, unknown>;

/** A motion. */
export class Path {
  /** Three vertices of each triangle. */
  readonly indices: Uint32Array;
  /** Positions of each shape, as placed: in the unit and the frame of the poses. */
  readonly shapes: Float64Array[];
  /** Of each shape; the first is at 0, the last pose at 1, extrapolated shapes come after it. */
  readonly times: Float64Array;
  /** Which shapes were given. */
  readonly poses: number[];
  readonly names: string[];
  readonly converged: boolean;
  readonly summary: Summary;
  /** The summary as a text to be read. */
  readonly report: string;
  /** All of it as the content of a `.path` file, which the tools, Python and C++ read. */
  readonly file: Uint8Array;
  /** Positions at a time between the first and the last; into `out`, if it is given. */
  at(time: number): Float32Array;
  at<Out extends Float32Array | Float64Array>(time: number, out: Out): Out;
}

export interface Deformation {
  /** The deformed mesh is the last of the path's shapes. Small changes of handles are fast. */
  update(handles: readonly Handle[], events?: Events): Promise<Path>;
  /** Frees its memory. */
  close(): Promise<void>;
}

export interface Shapespace {
  /** Reads and checks meshes, as all other calls do. */
  read(
    poses: readonly Pose[],
    options?: MeshOptions & { signal?: AbortSignal },
  ): Promise<{
    indices: Uint32Array;
    shapes: Float64Array[];
    names: string[];
    /** What was done with the mesh that is right as a rule. */
    notes: string[];
    warnings: string[];
  }>;
  /** The geodesic through two or more poses (Kilian et al. 2007, section 3). */
  interpolate(poses: readonly Pose[], options?: InterpolateOptions): Promise<Path>;
  /** Continues a path by some shapes along its geodesic (section 4). */
  extrapolate(path: Path, steps: number, options?: ExtrapolateOptions): Promise<Path>;
  /** The motion of a path, made by another shape of the same mesh (section 5). */
  transfer(path: Path, target: MeshArrays | Numbers, options?: TransferOptions): Promise<Path>;
  /** The mean of poses. */
  average(
    poses: readonly Pose[],
    options?: AverageOptions,
  ): Promise<{ positions: Float64Array; indices: Uint32Array; summary: Summary; report: string }>;
  /** Prepares a mesh to be deformed by handles again and again (section 5, Figure 10). */
  deform(mesh: Pose, options?: DeformOptions): Promise<Deformation>;
  /** A path as files, by the name's ending: .glb, .usda, .pc2, .mdd, frame_%03d.obj, ... */
  write(
    path: Path,
    name: string,
    options?: { duration?: number; fps?: number; ease?: boolean; playback?: string; unit?: number },
  ): Promise<{ name: string; data: Uint8Array }[]>;
  /** Ends the worker. What is called later starts another. */
  close(): void;
}

/**
 * Loads the library. `wasm` is the content of shapespace-module.wasm, or what WebAssembly.compile made
 * of it, and `start` makes the worker, for programs that have these files elsewhere than beside this
 * module.
 */
export function load(options?: {
  wasm?: ArrayBuffer | Uint8Array | WebAssembly.Module;
  start?: () => Worker | Promise<Worker>;
}): Promise<Shapespace>;

/** What the library refuses or cannot do; the message says what helps. */
export class ShapespaceError extends Error {
  /** The option with which the call would do what it has refused, if there is one. */
  readonly option?: string;
  /** Of an OptionsError: the options or arguments that are wrong. */
  readonly fields?: string[];
}
export class OptionsError extends ShapespaceError {}
export class MeshError extends ShapespaceError {}
export class MismatchError extends ShapespaceError {}
export class FileError extends ShapespaceError {}
export class SolverError extends ShapespaceError {}

// Draws a surface whose positions are computed anew for each frame.
import {
  BufferAttribute,
  BufferGeometry,
  Group,
  Mesh,
  type MeshBasicMaterial,
  type MeshStandardMaterial,
  Sphere,
  Vector3,
  type Color,
} from 'three';
import { back, clay, surfaceMaterial, wireMaterial } from '../material';
import { isFaceted } from '../normals';
import type { Body } from '../scene_data';
import type { Shown } from '../stage';
import { viewOf } from './viewpoint';

type Frame = Pick<Body, 'triangles' | 'vertices' | 'low' | 'side' | 'up' | 'eye'>;

/** Polyhedra and folded paper have few vertices; meshes of more are smooth. */
const mostJudged = 100000;

const everywhere = new Sphere(new Vector3(), Infinity);

/** The cube around shapes: its lowest corner, and its side. */
function cubeAround(shapes: Float64Array[]): Pick<Body, 'low' | 'side'> {
  const low: [number, number, number] = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const shape of shapes) {
    for (let i = 0; i < shape.length; ++i) {
      const axis = i % 3;
      if (shape[i] < low[axis]) low[axis] = shape[i];
      if (shape[i] > high[axis]) high[axis] = shape[i];
    }
  }
  return { low, side: Math.max(...high.map((value, axis) => value - low[axis])) || 1 };
}

/** Sums of triangles' normals at their vertices, which GPUs need not have as unit vectors. */
function writeNormals(triangles: Uint32Array, positions: Float32Array, normals: Float32Array): void {
  normals.fill(0);
  for (let i = 0; i < triangles.length; i += 3) {
    const a = 3 * triangles[i];
    const b = 3 * triangles[i + 1];
    const c = 3 * triangles[i + 2];
    const ux = positions[b] - positions[a];
    const uy = positions[b + 1] - positions[a + 1];
    const uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a];
    const vy = positions[c + 1] - positions[a + 1];
    const vz = positions[c + 2] - positions[a + 2];
    // Far above the least floats, although triangles are small.
    const x = 1e6 * (uy * vz - uz * vy);
    const y = 1e6 * (uz * vx - ux * vz);
    const z = 1e6 * (ux * vy - uy * vx);
    for (const v of [a, b, c]) {
      normals[v] += x;
      normals[v + 1] += y;
      normals[v + 2] += z;
    }
  }
}

/** In the cube around the poses, with its lowest corner in the origin and side 1. */
export class LiveMesh extends Group implements Shown {
  body: Frame;
  /** Of the motion: what there is to be seen. */
  shapes: Float64Array[];
  /** Positions as they are shown, in the unit of the poses. */
  positions: Float64Array;
  private geometry = new BufferGeometry();
  private readonly surface: Mesh<BufferGeometry, MeshStandardMaterial>;
  private readonly wires: Mesh<BufferGeometry, MeshBasicMaterial>;

  constructor(indices: Uint32Array, shapes: Float64Array[]) {
    super();
    const material = surfaceMaterial();
    material.vertexColors = true;
    material.onBeforeCompile = (shader) => {
      shader.uniforms.backColour = { value: back };
      shader.fragmentShader = shader.fragmentShader
        .replace('#include <common>', '#include <common>\nuniform vec3 backColour;')
        .replace(
          '#include <color_fragment>',
          '#include <color_fragment>\nif (!gl_FrontFacing) diffuseColor.rgb = backColour;',
        );
    };
    this.surface = new Mesh(this.geometry, material);
    this.surface.castShadow = true;
    this.wires = new Mesh(this.geometry, wireMaterial());
    this.wires.visible = false;
    for (const mesh of [this.surface, this.wires]) mesh.frustumCulled = false;
    this.add(this.surface, this.wires);
    this.shapes = shapes;
    [this.positions] = shapes;
    this.body = this.become(indices, shapes);
  }

  /** Becomes another mesh, and shows the first of its shapes. */
  become(indices: Uint32Array, shapes: Float64Array[]): Frame {
    const vertices = shapes[0].length / 3;
    this.geometry.dispose();
    this.geometry = new BufferGeometry();
    this.geometry.setIndex(new BufferAttribute(indices, 1));
    for (const name of ['position', 'normal', 'color']) {
      this.geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * vertices), 3));
    }
    this.geometry.boundingSphere = everywhere;
    this.surface.geometry = this.wires.geometry = this.geometry;
    const cube = cubeAround(shapes);
    this.body = { triangles: indices, vertices, ...cube, ...viewOf(shapes) };
    this.shapes = shapes;
    this.flat = vertices < mostJudged && isFaceted(this.body, this.rounded(shapes[0]));
    this.colour(new Map());
    this.show(shapes[0]);
    return this.body;
  }

  show(positions: Float64Array): void {
    this.positions = positions;
    const { low, side, triangles } = this.body;
    const position = this.geometry.getAttribute('position') as BufferAttribute;
    const normal = this.geometry.getAttribute('normal') as BufferAttribute;
    const values = position.array as Float32Array;
    for (let i = 0; i < values.length; i += 3) {
      values[i] = (positions[i] - low[0]) / side;
      values[i + 1] = (positions[i + 1] - low[1]) / side;
      values[i + 2] = (positions[i + 2] - low[2]) / side;
    }
    writeNormals(triangles, values, normal.array as Float32Array);
    position.needsUpdate = normal.needsUpdate = true;
  }

  /** Positions as they are shown, in the unit cube. */
  get inCube(): Float32Array {
    return this.geometry.getAttribute('position').array as Float32Array;
  }

  /** Gives some vertices colours of their own, and clay's to the others. */
  colour(own: Map<Color, Iterable<number>>): void {
    const attribute = this.geometry.getAttribute('color') as BufferAttribute;
    const values = attribute.array as Float32Array;
    for (let i = 0; i < values.length; i += 3) clay.toArray(values, i);
    for (const [colour, vertices] of own) for (const v of vertices) colour.toArray(values, 3 * v);
    attribute.needsUpdate = true;
  }

  someVertices(most: number): Vector3[] {
    const { low, side, vertices } = this.body;
    const corner = new Vector3().fromArray(low);
    const step = Math.max(1, Math.floor((this.shapes.length * vertices) / most));
    const points: Vector3[] = [];
    for (const shape of this.shapes) {
      for (let v = 0; v < vertices; v += step) {
        points.push(new Vector3().fromArray(shape, 3 * v).sub(corner).divideScalar(side));
      }
    }
    return points;
  }

  /** Polygons are cut by the shapes of all poses, so others may cut them along other diagonals. */
  set triangles(indices: Uint32Array) {
    const now = this.body.triangles;
    if (indices.length === now.length && indices.every((v, i) => v === now[i])) return;
    this.body.triangles = indices;
    this.geometry.setIndex(new BufferAttribute(indices, 1));
  }

  set wireframe(on: boolean) {
    this.wires.visible = on;
    this.surface.material.polygonOffset = on; // so that the surface does not hide its edges
  }

  get flat(): boolean {
    return this.surface.material.flatShading;
  }
  set flat(on: boolean) {
    const { material } = this.surface;
    if (material.flatShading === on) return;
    material.flatShading = on;
    material.needsUpdate = true;
  }

  /** A shape as bodies of shape-view have it. */
  private rounded(shape: Float64Array): Uint16Array {
    const { low, side, vertices } = this.body;
    const values = new Uint16Array(4 * vertices);
    for (let v = 0; v < vertices; ++v) {
      for (let k = 0; k < 3; ++k) {
        values[4 * v + k] = Math.round((65535 * (shape[3 * v + k] - low[k])) / side);
      }
    }
    return values;
  }
}

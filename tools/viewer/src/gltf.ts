// Makes a path of a glb file: its first animation, sampled at its keyframes.
import {
  AnimationMixer,
  Color,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  SkinnedMesh,
  Vector3,
  type AnimationClip,
  type Object3D,
} from 'three';
import { GLTFLoader, type GLTF } from 'three/addons/loaders/GLTFLoader.js';
import { bytesFromBase64 } from './decode';
import { measureDeviations } from './deviation';
import { Damaged, type Body, type PathScene, type Skin } from './scene_data';
import { jointsIn } from './skeleton';

/** An animation with more keyframes is sampled at this number of evenly spaced moments. */
const mostShapes = 64;

type Drawn = Mesh | LineSegments;

function drawnIn(root: Object3D): Drawn[] {
  const drawn: Drawn[] = [];
  root.traverse((object) => {
    if (object instanceof Mesh || object instanceof LineSegments) drawn.push(object);
  });
  const hasTriangles = drawn.some((object) => object instanceof Mesh);
  return drawn.filter((object) => object instanceof Mesh === hasTriangles);
}

/** Between the keys of morph targets vertices move along lines, between those of bones on arcs. */
function momentsOf(clip: AnimationClip | undefined, hasBones: boolean): number[] {
  if (!clip || clip.duration === 0) return [0];
  const keys = [...new Set(clip.tracks.flatMap((track) => [...track.times]))];
  keys.sort((a, b) => a - b);
  if (!hasBones && keys.length >= 2 && keys.length <= mostShapes) return keys;
  return Array.from({ length: mostShapes }, (_, i) => (i / (mostShapes - 1)) * clip.duration);
}

/** Positions of all vertices as they are now, three numbers each. */
function positionsNow(drawn: Drawn[], vertices: number): Float64Array {
  const positions = new Float64Array(3 * vertices);
  const point = new Vector3();
  // LineSegments does not have the method getVertexPosition, but all the members that it reads.
  const { getVertexPosition } = Mesh.prototype;
  let at = 0;
  for (const object of drawn) {
    const count = object.geometry.getAttribute('position').count;
    const read = object instanceof Mesh ? object.getVertexPosition : getVertexPosition;
    for (let v = 0; v < count; ++v, at += 3) {
      read.call(object as Mesh, v, point).applyMatrix4(object.matrixWorld).toArray(positions, at);
    }
  }
  return positions;
}

function indicesOf(drawn: Drawn[]): Uint32Array {
  const lists: number[] = [];
  let first = 0;
  for (const { geometry } of drawn) {
    const count = geometry.getAttribute('position').count;
    const index = geometry.getIndex();
    for (let i = 0; i < (index ? index.count : count); ++i) {
      lists.push(first + (index ? index.getX(i) : i));
    }
    first += count;
  }
  return Uint32Array.from(lists);
}

/** Vertex colours times those of materials; nothing where all are white. */
function coloursOf(drawn: Drawn[], vertices: number): Uint8Array | null {
  const colours = new Uint8Array(3 * vertices);
  const colour = new Color();
  let at = 0;
  let isWhite = true;
  for (const { geometry, material } of drawn) {
    const own = geometry.getAttribute('color');
    const first = Array.isArray(material) ? material[0] : material;
    const tint = first instanceof MeshStandardMaterial ? first.color : new Color(1, 1, 1);
    for (let v = 0; v < geometry.getAttribute('position').count; ++v, at += 3) {
      colour.copy(tint);
      if (own) colour.multiply(new Color(own.getX(v), own.getY(v), own.getZ(v)));
      const bytes = [16, 8, 0].map((shift) => (colour.getHex() >> shift) & 255);
      colours.set(bytes, at);
      isWhite &&= bytes.every((byte) => byte === 255);
    }
  }
  return isWhite ? null : colours;
}

/** Textures and where they are; null where there are none. */
function skinOf(drawn: Drawn[], vertices: number): Skin | null {
  const uv = new Float32Array(2 * vertices);
  const parts: Skin['parts'] = [];
  let at = 0;
  let start = 0;
  for (const { geometry, material } of drawn) {
    const map = material instanceof MeshStandardMaterial ? material.map : null;
    const own = geometry.getAttribute(map?.channel ? `uv${map.channel}` : 'uv');
    const count = geometry.getAttribute('position').count;
    for (let v = 0; own && v < count; ++v) uv.set([own.getX(v), own.getY(v)], at + 2 * v);
    if (map) map.channel = 0;
    parts.push({ start, count: geometry.getIndex()?.count ?? count, map: own ? map : null });
    start += parts[parts.length - 1].count;
    at += 2 * count;
  }
  return parts.some(({ map }) => map) ? { cut: null, uv, parts } : null;
}

/** The smallest cube that contains all points and has its corner at their least coordinates. */
function cubeAround(shapes: Float64Array[]): Pick<Body, 'low' | 'side'> {
  const low: Body['low'] = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const shape of shapes) {
    for (let i = 0; i < shape.length; ++i) {
      low[i % 3] = Math.min(low[i % 3], shape[i]);
      high[i % 3] = Math.max(high[i % 3], shape[i]);
    }
  }
  return { low, side: Math.max(...low.map((value, axis) => high[axis] - value)) };
}

function quantise(shape: Float64Array, low: number[], side: number): Uint16Array {
  const scale = side > 0 ? 65535 / side : 0;
  const steps = new Uint16Array((4 * shape.length) / 3);
  for (let i = 0; i < shape.length; ++i) {
    const axis = i % 3;
    steps[(4 * (i - axis)) / 3 + axis] = Math.round((shape[i] - low[axis]) * scale);
  }
  return steps;
}

function toPath(name: string, { scene, animations }: GLTF): PathScene {
  const drawn = drawnIn(scene);
  const vertices = drawn.reduce((sum, o) => sum + o.geometry.getAttribute('position').count, 0);
  if (vertices === 0) throw new Damaged('it holds nothing to draw');
  const mixer = new AnimationMixer(scene);
  if (animations.length > 0) mixer.clipAction(animations[0]).play();
  const { joints, parents } = jointsIn(scene);
  const hasBones = drawn.some((object) => object instanceof SkinnedMesh);
  const moments = momentsOf(animations[0], hasBones);
  const ofJoints: Vector3[][] = [];
  const shapes = moments.map((moment) => {
    // Not quite the end of the animation, at which a clip that repeats is at its start again.
    mixer.setTime(Math.min(moment, (animations[0]?.duration ?? 0) * (1 - 1e-6)));
    scene.updateMatrixWorld(true);
    ofJoints.push(joints.map((joint) => joint.getWorldPosition(new Vector3())));
    return positionsNow(drawn, vertices);
  });
  const { low, side } = cubeAround(shapes);
  const corner = new Vector3().fromArray(low);
  const places = ofJoints.map((points) =>
    Float32Array.from(points.flatMap((point) => point.sub(corner).divideScalar(side || 1).toArray())),
  );
  const isGraph = !(drawn[0] instanceof Mesh);
  const indices = indicesOf(drawn);
  const body: Body = {
    name,
    vertices,
    triangles: isGraph ? new Uint32Array() : indices,
    segments: isGraph ? indices : new Uint32Array(),
    colours: coloursOf(drawn, vertices),
    skin: skinOf(drawn, vertices),
    low,
    side,
    up: [0, 1, 0],
    eye: [0.6, 0.35, 0.72],
    shapes: shapes.map((shape) => quantise(shape, low, side)),
  };
  return {
    kind: 'path',
    ...body,
    ...measureDeviations(body),
    parameters: moments.map((moment) => moment / (moments[moments.length - 1] || 1)),
    file: '',
    poses: [],
    poseNames: [],
    extrapolated: 0,
    smooth: false,
    metric: '',
    speeds: moments.slice(1).map(() => null),
    energyEnd: null,
    energies: [],
    partColours: null,
    intersections: null,
    skeleton: hasBones ? { parents, places } : null,
  };
}

export async function decodeGlb(name: string, text: string): Promise<PathScene> {
  const bytes = bytesFromBase64(text);
  let gltf: GLTF;
  try {
    gltf = await new GLTFLoader().parseAsync(bytes.buffer, '');
  } catch {
    throw new Damaged('it is no glTF file that can be read');
  }
  return toPath(name, gltf);
}

// Reads the scenes that shape-view writes: docs/file-formats.md, HTML.
import { RepeatWrapping, SRGBColorSpace, Texture } from 'three';
import { tell } from './dom';
import { Damaged, type Body, type PathScene, type SceneData, type Skin } from './scene_data';

export function bytesFromBase64(text: string): Uint8Array<ArrayBuffer> {
  let binary: string;
  try {
    binary = atob(text);
  } catch {
    throw new Damaged('its text is no base64');
  }
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<Uint8Array> {
  try {
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
    return new Uint8Array(await new Response(stream).arrayBuffer());
  } catch {
    throw new Damaged('it cannot be decompressed');
  }
}

/** Takes arrays from the bytes, one after the other. */
class Reader {
  private at = 0;
  constructor(private readonly bytes: Uint8Array) {}

  take(count: number): Uint8Array {
    if (!Number.isInteger(count) || count < 0 || this.at + count > this.bytes.length) {
      throw new Damaged('it ends too early');
    }
    this.at += count;
    return this.bytes.subarray(this.at - count, this.at);
  }

  end(): void {
    if (this.at !== this.bytes.length) throw new Damaged('it is longer than it says');
  }
}

function unZigZag(code: number): number {
  return (code >>> 1) ^ -(code & 1);
}

function readIndices(reader: Reader, count: number, vertices: number): Uint32Array {
  const planes = reader.take(4 * count);
  const indices = new Uint32Array(count);
  let last = 0;
  for (let k = 0; k < count; ++k) {
    const code =
      planes[k] |
      (planes[count + k] << 8) |
      (planes[2 * count + k] << 16) |
      (planes[3 * count + k] << 24);
    last = (last + unZigZag(code)) >>> 0;
    if (last >= vertices) throw new Damaged('it names a vertex that is not there');
    indices[k] = last;
  }
  return indices;
}

/** Predicts a coordinate from earlier shapes, as shape-view did; the file has the differences. */
type Predict = (shape: number, index: number) => number;

function readPositions(reader: Reader, shapes: Uint16Array[], vertices: number, predict: Predict) {
  for (let s = 0; s < shapes.length; ++s) {
    const shape = shapes[s];
    for (let axis = 0; axis < 3; ++axis) {
      const low = reader.take(vertices);
      const high = reader.take(vertices);
      let off = 0;
      for (let v = 0, index = axis; v < vertices; ++v, index += 4) {
        off += unZigZag(low[v] | (high[v] << 8));
        shape[index] = predict(s, index) + off;
      }
    }
  }
}

/** Of each shape a number a vertex, with 65535 for the last colour. */
function readShades(reader: Reader, shapes: number, vertices: number): Uint16Array[] {
  const last = new Uint8Array(vertices);
  return Array.from({ length: shapes }, () => {
    const differences = reader.take(vertices);
    const shades = new Uint16Array(vertices);
    for (let v = 0; v < vertices; ++v) {
      last[v] += differences[v];
      shades[v] = 257 * last[v];
    }
    return shades;
  });
}

function readDeviations(reader: Reader, shapes: Uint16Array[], vertices: number) {
  readShades(reader, shapes.length, vertices).forEach((shades, s) =>
    shades.forEach((shade, v) => (shapes[s][4 * v + 3] = shade)),
  );
}

function readIntersections(
  reader: Reader,
  counts: { pairs: number; vertices: number }[],
  vertices: number,
): PathScene['intersections'] {
  const total = counts.reduce((sum, ofShape) => sum + ofShape.vertices, 0);
  const all = readIndices(reader, total, vertices);
  let end = 0;
  return counts.map((ofShape) => {
    const start = end;
    end += ofShape.vertices;
    return { pairs: ofShape.pairs, vertices: all.subarray(start, end) };
  });
}

/** Numbers in single precision, coded as indices are. */
function readFloats(reader: Reader, count: number): Float32Array {
  return new Float32Array(readIndices(reader, count, 2 ** 32).buffer);
}

async function readImage(reader: Reader, { type, bytes }: any): Promise<Texture | null> {
  const blob = new Blob([reader.take(bytes).slice()], { type });
  let image: ImageBitmap;
  try {
    image = await createImageBitmap(blob);
  } catch {
    tell('A texture cannot be shown, because its image is damaged.');
    return null;
  }
  const texture = new Texture(image);
  Object.assign(texture, { flipY: false, colorSpace: SRGBColorSpace, needsUpdate: true });
  texture.wrapS = texture.wrapT = RepeatWrapping;
  return texture;
}

async function readSkin(reader: Reader, textures: any, vertices: number): Promise<Skin> {
  const source = readIndices(reader, textures.vertices, vertices);
  const sizes: number[] = textures.parts.map(({ triangles }: any) => 3 * triangles);
  const corners = sizes.reduce((sum, size) => sum + size, 0);
  const triangles = readIndices(reader, corners, textures.vertices);
  const uv = new Float32Array(2 * textures.vertices);
  for (const axis of [0, 1]) {
    readFloats(reader, textures.vertices).forEach((value, v) => (uv[2 * v + axis] = value));
  }
  const images: (Texture | null)[] = [];
  for (const image of textures.images) images.push(await readImage(reader, image));
  let start = 0;
  const parts = textures.parts.map(({ image, colour }: any, i: number) => {
    const part = { start, count: sizes[i], map: images[image] ?? null, colour: colour ?? undefined };
    start += sizes[i];
    return part;
  });
  return { cut: { source, triangles }, uv, parts };
}

function along(shapes: Uint16Array[]): Predict {
  return (s, index) => {
    if (s === 0) return 0;
    if (s === 1) return shapes[0][index];
    return 2 * shapes[s - 1][index] - shapes[s - 2][index];
  };
}

function betweenParents(shapes: Uint16Array[], parents: [number, number][]): Predict {
  const poses = shapes.length - parents.length;
  return (s, index) => {
    if (s === 0) return 0;
    if (s < poses) return shapes[s - 1][index];
    const [a, b] = parents[s - poses];
    return (shapes[a][index] + shapes[b][index]) >> 1;
  };
}

/** Every key is predicted to be the mean, which is the first. */
function likeFirst(shapes: Uint16Array[]): Predict {
  return (s, index) => (s === 0 ? 0 : shapes[0][index]);
}

function check(condition: boolean) {
  if (!condition) throw new Damaged('its header does not fit its content');
}

function isCount(value: unknown): value is number {
  return Number.isInteger(value) && (value as number) >= 0;
}

function areNodes(lists: number[][], size: number, nodes: number): boolean {
  return lists.every(
    (list) => list.length === size && list.every((node) => isCount(node) && node < nodes),
  );
}

function areRows(rows: number[][], size: number): boolean {
  return rows.every((row) => row.length === size && row.every(Number.isFinite));
}

function checkHeader(header: any) {
  check(['path', 'space', 'modes', 'mesh'].includes(header.kind));
  check([header.vertices, header.triangles, header.segments, header.shapes].every(isCount));
  check(header.vertices > 0 && header.shapes > 0 && header.side >= 0);
  check([header.low, header.up, header.eye].every((vector) => vector.length === 3));
  check(header.kind === 'space' || typeof header.file === 'string');
  if (header.kind === 'path') {
    check(areNodes([header.poses], header.poses.length, header.shapes));
    check([0, header.poses.length].includes(header.poseNames.length));
    check(isCount(header.extrapolated) && header.extrapolated < header.shapes);
    check(header.parameters.length === header.shapes && header.rms.length === header.shapes);
    check(header.max.length === header.shapes && header.scaleEnd > 0);
    check(header.speeds.length === header.shapes - 1);
    check(header.energyEnd === null || header.energyEnd > 0);
    check(isCount(header.parts));
    if (header.textures !== null) {
      const { vertices, parts, images } = header.textures;
      check([vertices, ...parts.map(({ triangles }: any) => triangles)].every(isCount));
      check(images.every(({ bytes }: any) => isCount(bytes)));
    }
    if (header.intersections !== null) {
      check(header.intersections.length === header.shapes);
      check(header.intersections.every(({ pairs, vertices }: any) => [pairs, vertices].every(isCount)));
    }
  } else if (header.kind === 'modes') {
    const modes = header.shares.length;
    check(modes > 0 && header.places.length > 0 && header.pairPlace > 0);
    check(header.shapes === 1 + modes * header.places.length + (modes * (modes - 1)) / 2);
    check(header.coordinates.length === header.names.length);
    check(areRows(header.coordinates, modes) && areRows(header.slopes, modes));
    check(header.slopes.length === header.scalars.length);
    check(header.scalars.length === 0 || header.intercept.length === modes);
  } else if (header.kind === 'mesh') {
    check(header.shapes === 1);
    check(header.markers.every((v: unknown) => isCount(v) && (v as number) < header.vertices));
  } else {
    check(header.names.length > 0 && header.points.length === header.shapes);
    check(header.names.length + header.parents.length === header.shapes);
    check(areNodes(header.planeTriangles, 3, header.shapes));
    check(areNodes(header.planeSegments, 2, header.shapes));
    check(areNodes(header.parents, 2, header.shapes));
  }
}

export async function decodeScene(text: string): Promise<SceneData> {
  const reader = new Reader(await inflate(bytesFromBase64(text)));
  const length = reader.take(4);
  const size = new DataView(length.buffer, length.byteOffset).getUint32(0, true);
  let header;
  try {
    header = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(reader.take(size)));
    if (header.version !== 1) throw new Damaged(`its version is ${header.version}, not 1`);
    checkHeader(header);
  } catch (error) {
    throw error instanceof Damaged ? error : new Damaged('its header cannot be read');
  }
  const { vertices } = header;
  const triangles = readIndices(reader, 3 * header.triangles, vertices);
  const segments = readIndices(reader, 2 * header.segments, vertices);
  if (6 * vertices * header.shapes > 2 ** 31) throw new Damaged('its header does not fit its content');
  const shapes: Uint16Array[] = [];
  for (let s = 0; s < header.shapes; ++s) shapes.push(new Uint16Array(4 * vertices));
  const predictions: Record<string, () => Predict> = {
    path: () => along(shapes),
    space: () => betweenParents(shapes, header.parents),
    modes: () => likeFirst(shapes),
    mesh: () => likeFirst(shapes),
  };
  const predict = predictions[header.kind]();
  readPositions(reader, shapes, vertices, predict);
  let ofPath: Pick<PathScene, 'energies' | 'partColours' | 'intersections' | 'skeleton'> | undefined;
  if (header.kind === 'path') {
    readDeviations(reader, shapes, vertices);
    ofPath = {
      energies: header.energyEnd === null ? [] : readShades(reader, header.shapes, vertices),
      partColours: header.parts > 0 ? reader.take(3 * vertices) : null,
      intersections: header.intersections && readIntersections(reader, header.intersections, vertices),
      skeleton: null,
    };
  }
  const colours = header.colours ? reader.take(3 * vertices) : null;
  const skin = header.textures ? await readSkin(reader, header.textures, vertices) : null;
  reader.end();
  const body: Omit<Body, 'name'> = {
    vertices,
    triangles,
    segments,
    colours,
    skin,
    shapes,
    low: header.low,
    side: header.side,
    up: header.up,
    eye: header.eye,
  };
  return { ...header, ...body, ...ofPath };
}

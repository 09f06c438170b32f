// The poses that the user has, in their order.
import type { MeshFile, MeshOptions, Pose, Shapespace } from './library';

export interface ListedPose {
  name: string;
  positions: Float64Array;
  /** Where it comes from; null if it was pulled into its shape here. */
  file: MeshFile | null;
}

type Reading = Awaited<ReturnType<Shapespace['read']>>;

/** What the library refuses, and of which file. */
export interface Refused {
  file: MeshFile;
  error: Error;
}

export class PoseSet {
  readonly list: ListedPose[] = [];
  indices = new Uint32Array();
  notes: string[] = [];
  warnings: string[] = [];
  /** How doubtful meshes are taken, as the user has answered. */
  meshOptions: MeshOptions = {};
  /** In the order in which they are read: the first one's faces are those of all. */
  private files: MeshFile[] = [];

  constructor(private readonly library: Shapespace) {}

  get vertices(): number {
    return this.list.length > 0 ? this.list[0].positions.length / 3 : 0;
  }
  get triangles(): number {
    return this.indices.length / 3;
  }

  /** Reads files with those that are here already, because only all together tell how a mesh is
   * cut and where it has seams. What is right stays, and the rest is returned. */
  async add(files: MeshFile[], signal: AbortSignal): Promise<Refused[]> {
    const renamed = this.withNamesOfTheirOwn(files);
    const before = this.given();
    try {
      const reading = await this.read([...before.poses, ...renamed], signal);
      // Otherwise some of the files have several poses, and reading them one by one tells which.
      if (reading.names.length === before.count + renamed.length) {
        renamed.forEach((file, i) => this.append(reading, before.count + i, file));
        this.take(reading, renamed);
        return [];
      }
    } catch (error) {
      if (renamed.length === 1) return [{ file: renamed[0], error: error as Error }];
    }
    const refused: Refused[] = [];
    for (const file of renamed) {
      const { poses, count } = this.given();
      try {
        const reading = await this.read([...poses, file], signal);
        for (let i = count; i < reading.names.length; ++i) this.append(reading, i, file);
        this.take(reading, [file]);
      } catch (error) {
        refused.push({ file, error: error as Error });
      }
    }
    return refused;
  }

  /** Takes meshes that are made here, which have the same triangles. */
  takeMade(poses: { name: string; positions: Float64Array }[], indices: Uint32Array<ArrayBuffer>): void {
    if (this.list.length === 0) this.indices = indices;
    for (const { name, positions } of poses) this.list.push({ name, positions, file: null });
  }

  move(from: number, to: number): void {
    const [pose] = this.list.splice(from, 1);
    this.list.splice(to, 0, pose);
  }

  remove(index: number): void {
    this.list.splice(index, 1);
    this.files = this.files.filter((file) => this.list.some((pose) => pose.file === file));
    if (this.list.length === 0) this.clear();
  }

  clear(): void {
    this.list.length = 0;
    this.files = [];
    this.meshOptions = {};
    this.notes = [];
    this.warnings = [];
  }

  /**
   * What is handed to a solver: files where they have colours or texture coordinates, which saved
   * motions then have too; else positions, which need not be read a second time.
   */
  forSolver(): Pose[] {
    const whole: MeshFile[] = [];
    for (const { file } of this.list) {
      if (file && whole[whole.length - 1] !== file) whole.push(file);
    }
    const inOrder = whole.flatMap((file) => this.posesOf.get(file) ?? []);
    const fits = inOrder.length === this.list.length && inOrder.every((pose, i) => pose === this.list[i]);
    if (fits && whole.some(hasLooks)) return whole;
    const { indices } = this;
    return this.list.map(({ name, positions }) => ({ name, positions, indices }));
  }

  /** The poses that each file has, in its order. */
  private readonly posesOf = new WeakMap<MeshFile, ListedPose[]>();

  private read(poses: Pose[], signal: AbortSignal): Promise<Reading> {
    return this.library.read(poses, { ...this.meshOptions, signal });
  }

  /** What new files are read with, and how many poses that is. */
  private given(): { poses: Pose[]; count: number } {
    if (this.files.length > 0) {
      const count = this.files.reduce((sum, file) => sum + this.posesOf.get(file)!.length, 0);
      return { poses: this.files, count };
    }
    const [first] = this.list;
    if (!first) return { poses: [], count: 0 };
    const { name, positions } = first;
    return { poses: [{ name, positions, indices: this.indices }], count: 1 };
  }

  private append(reading: Reading, i: number, file: MeshFile): void {
    const pose = { name: reading.names[i], positions: reading.shapes[i], file };
    this.list.push(pose);
    this.posesOf.set(file, [...(this.posesOf.get(file) ?? []), pose]);
  }

  private take(reading: Reading, files: MeshFile[]): void {
    this.files.push(...files);
    this.indices = reading.indices as Uint32Array<ArrayBuffer>;
    this.notes = reading.notes;
    this.warnings = reading.warnings;
  }

  /** Two files may have one name; here the second is another. */
  private withNamesOfTheirOwn(files: MeshFile[]): MeshFile[] {
    const taken = new Set(this.files.map(({ name }) => name));
    return files.map(({ name, data }) => {
      let own = name;
      for (let k = 2; taken.has(own); ++k) own = name.replace(/(\.[^.]*)?$/, ` (${k})$1`);
      taken.add(own);
      return { name: own, data };
    });
  }
}

/** Whether a file may have colours or texture coordinates. */
function hasLooks({ name, data }: MeshFile): boolean {
  if (/\.(off|stl)$/i.test(name)) return false;
  if (!/\.obj$/i.test(name)) return true;
  const start = new TextDecoder('latin1').decode(data.subarray(0, 4096));
  if (/^v(\s+\S+){6}\s*$/m.test(start)) return true;
  const [v, t, space, newline] = [118, 116, 32, 10];
  for (let i = data.indexOf(v); i >= 0; i = data.indexOf(v, i + 1)) {
    if (data[i + 1] === t && data[i + 2] === space && (i === 0 || data[i - 1] === newline)) return true;
  }
  return false;
}

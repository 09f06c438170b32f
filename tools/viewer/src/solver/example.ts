// Poses of a bar, made here, for who has no files at hand.

const around = 40;
const along = 52;
const halfWidth = 0.5;
const length = 6;
/** How far from its ends the bar becomes thinner. */
const rounding = 0.3;

export interface Example {
  indices: Uint32Array<ArrayBuffer>;
  poses: { name: string; positions: Float64Array }[];
}

/** Where a point of the bar is: `x` along it, from the middle; `y` and `z` across it. */
type Pose = (x: number, y: number, z: number) => [number, number, number];

const straight: Pose = (x, y, z) => [x, y, z];

/** As an arch that turns by `angle` in all, with its middle where that of the straight bar is. */
const bent =
  (angle: number): Pose =>
  (x, y, z) => {
    const radius = length / angle;
    const turned = x / radius;
    const middle = (radius * Math.sin(angle / 2)) / (angle / 2);
    return [(radius + y) * Math.sin(turned), (radius + y) * Math.cos(turned) - middle, z];
  };

const twisted =
  (angle: number): Pose =>
  (x, y, z) => {
    const turned = (angle * x) / length;
    const [cos, sin] = [Math.cos(turned), Math.sin(turned)];
    return [x, y * cos - z * sin, y * sin + z * cos];
  };

/** A point on the outline of a square with round corners. */
function outline(k: number): [number, number] {
  const angle = (2 * Math.PI * (k + 0.5)) / around;
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const radius = halfWidth / (cos ** 4 + sin ** 4) ** (1 / 4);
  return [radius * cos, radius * sin];
}

/** Rings of vertices from one end to the other, and the middles of both ends. */
function positionsOf(pose: Pose): Float64Array {
  const points: [number, number, number][] = [];
  for (let ring = 0; ring <= along; ++ring) {
    // Rings are dense near the ends, which are round.
    const share = (1 - Math.cos((Math.PI * ring) / along)) / 2;
    const x = length * ((share + ring / along) / 2 - 0.5);
    const inside = Math.min(1, (length / 2 - Math.abs(x)) / rounding);
    const scale = 0.55 + 0.45 * Math.sqrt(1 - (1 - inside) ** 2);
    for (let k = 0; k < around; ++k) {
      const [y, z] = outline(k);
      points.push(pose(x, scale * y, scale * z));
    }
  }
  for (const x of [-length / 2, length / 2]) points.push(pose(x, 0, 0));
  return new Float64Array(points.flat());
}

function triangles(): Uint32Array<ArrayBuffer> {
  const indices: number[] = [];
  const last = along * around;
  const [start, end] = [last + around, last + around + 1];
  for (let k = 0; k < around; ++k) {
    const next = (k + 1) % around;
    for (let ring = 0; ring < last; ring += around) {
      const to = ring + around;
      indices.push(ring + k, ring + next, to + next, ring + k, to + next, to + k);
    }
    indices.push(start, next, k, end, last + k, last + next);
  }
  return new Uint32Array(indices);
}

export function example(): Example {
  return {
    indices: triangles(),
    poses: [
      { name: 'straight', positions: positionsOf(straight) },
      { name: 'bent', positions: positionsOf(bent(2.6)) },
      { name: 'twisted', positions: positionsOf(twisted(2.8)) },
    ],
  };
}

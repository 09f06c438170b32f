// Poses of a bar, made here, for who has no files at hand.

const around = 32;
const along = 56;
const halfWidth = 0.5;
const height = 5;

export interface Example {
  indices: Uint32Array<ArrayBuffer>;
  poses: { name: string; positions: Float64Array }[];
}

/** Where a point of the bar is: `x` and `z` across it, `y` along it, from 0 to `height`. */
type Pose = (x: number, y: number, z: number) => [number, number, number];

/** Along an arc that turns by `angle` in all. */
const bent =
  (angle: number): Pose =>
  (x, y, z) => {
    const radius = height / angle;
    const turned = y / radius;
    return [radius - (radius - x) * Math.cos(turned), (radius - x) * Math.sin(turned), z];
  };

const twisted =
  (angle: number): Pose =>
  (x, y, z) => {
    const turned = (angle * y) / height;
    return [
      x * Math.cos(turned) + z * Math.sin(turned),
      y,
      z * Math.cos(turned) - x * Math.sin(turned),
    ];
  };

/** Points of a square with round corners. */
function outline(k: number): [number, number] {
  const angle = (2 * Math.PI * (k + 0.5)) / around;
  const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
  const radius = halfWidth / (cos ** 6 + sin ** 6) ** (1 / 6);
  return [radius * cos, radius * sin];
}

function positionsOf(pose: Pose): Float64Array {
  const points: [number, number, number][] = [];
  for (let ring = 0; ring <= along; ++ring) {
    for (let k = 0; k < around; ++k) {
      const [x, z] = outline(k);
      points.push(pose(x, (height * ring) / along, z));
    }
  }
  // The ends: a smaller ring, and the middle.
  for (const y of [0, height]) {
    for (let k = 0; k < around; ++k) {
      const [x, z] = outline(k);
      points.push(pose(x / 2, y, z / 2));
    }
    points.push(pose(0, y, 0));
  }
  return new Float64Array(points.flat());
}

function triangles(): Uint32Array<ArrayBuffer> {
  const indices: number[] = [];
  /** Between two rings, the first of which lies before the second, seen from outside. */
  const band = (from: number, to: number) => {
    for (let k = 0; k < around; ++k) {
      const next = (k + 1) % around;
      indices.push(from + k, to + k, to + next, from + k, to + next, from + next);
    }
  };
  const fan = (ring: number, middle: number, isLast: boolean) => {
    for (let k = 0; k < around; ++k) {
      const next = (k + 1) % around;
      indices.push(middle, ...(isLast ? [ring + next, ring + k] : [ring + k, ring + next]));
    }
  };
  for (let ring = 0; ring < along; ++ring) band(ring * around, (ring + 1) * around);
  const first = (along + 1) * around;
  const last = first + around + 1;
  band(first, 0);
  fan(first, first + around, false);
  band(along * around, last);
  fan(last, last + around, true);
  return new Uint32Array(indices);
}

export function example(): Example {
  return {
    indices: triangles(),
    poses: [
      { name: 'straight', positions: positionsOf((x, y, z) => [x, y, z]) },
      { name: 'bent', positions: positionsOf(bent(2.4)) },
      { name: 'twisted', positions: positionsOf(twisted(2.8)) },
    ],
  };
}

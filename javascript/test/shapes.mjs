// A rectangular sheet of columns x rows squares of side 1, flat or rolled up by an angle in all.

export function sheet(columns, rows, angle, { scale = 1, offset = 0 } = {}) {
  const positions = [];
  const radius = columns / angle;
  for (let y = 0; y <= rows; ++y) {
    for (let x = 0; x <= columns; ++x) {
      const turn = x / radius;
      const point = angle === 0 ? [x, y, 0] : [radius * Math.sin(turn), y, radius * (1 - Math.cos(turn))];
      positions.push(...point.map((c) => scale * c + offset));
    }
  }
  const indices = [];
  for (let y = 0; y < rows; ++y) {
    for (let x = 0; x < columns; ++x) {
      const a = y * (columns + 1) + x;
      const b = a + columns + 1;
      indices.push(a, a + 1, b + 1, a, b + 1, b);
    }
  }
  return { positions: new Float64Array(positions), indices: new Uint32Array(indices) };
}

/** Lengths of all edges of triangles. */
export function edgeLengths(positions, indices) {
  const lengths = [];
  for (let i = 0; i < indices.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [indices[i + k], indices[i + ((k + 1) % 3)]];
      lengths.push(Math.hypot(...[0, 1, 2].map((axis) => positions[3 * a + axis] - positions[3 * b + axis])));
    }
  }
  return lengths;
}

export function greatestDifference(a, b) {
  let greatest = 0;
  for (let i = 0; i < a.length; ++i) greatest = Math.max(greatest, Math.abs(a[i] - b[i]));
  return a.length === b.length ? greatest : NaN;
}

// What has been picked, as the files that the tools read: docs/file-formats.md. Vertices are counted
// from 0 here and from 1 in files.

export interface Part {
  name: string;
  vertices: Set<number>;
  /** Of a handle: by which it moves; all zero: it stays where it is. */
  translation: [number, number, number];
  /** Of a standing part: the first and the last pose, counted from 1. */
  poses: [number, number];
}

export type Marker = [number, number];

export function markersText(names: string[], markers: Marker[]): string {
  const lines = markers.map(([a, b]) => `${a + 1} ${b + 1}\n`);
  return `# ${names.join('  ').replaceAll(/[\r\n]/g, ' ')}\n${lines.join('')}`;
}

/** Numbers in ascending order, and runs of them as ranges. */
function selection({ vertices }: Part): { vertices: (number | [number, number])[] } {
  const runs: [number, number][] = [];
  for (const vertex of [...vertices].map((v) => v + 1).sort((a, b) => a - b)) {
    const last = runs[runs.length - 1];
    if (last && last[1] === vertex - 1) last[1] = vertex;
    else runs.push([vertex, vertex]);
  }
  return { vertices: runs.map(([a, b]) => (a === b ? a : [a, b])) };
}

export function selectionText(part: Part): string {
  return `${JSON.stringify(selection(part))}\n`;
}

export function handlesText(parts: Part[]): string {
  const handles = parts.map((part) => ({
    name: part.name,
    select: selection(part),
    ...(part.translation.every((x) => x === 0)
      ? { fixed: true }
      : { translation: part.translation }),
  }));
  return `${JSON.stringify({ handles }, null, 1)}\n`;
}

export function standingText(parts: Part[]): string {
  const list = parts.map((part) => ({
    name: part.name,
    select: selection(part),
    poses: part.poses,
  }));
  return `${JSON.stringify(list)}\n`;
}

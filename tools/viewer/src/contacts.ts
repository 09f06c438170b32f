// Where surfaces pass through themselves: the triangles that intersect, shape by shape.
import type { PathScene } from './scene_data';

/** Of each shape a number a vertex: 65535 where one of its triangles intersects another, 0 elsewhere. */
export function contactValues({ vertices, intersections }: PathScene): Uint16Array[] {
  return (intersections ?? []).map((ofShape) => {
    const values = new Uint16Array(vertices);
    for (const vertex of ofShape.vertices) values[vertex] = 65535;
    return values;
  });
}

/** How many triangles intersect in one shape, and in how many shapes any do. */
export function contactFigures({ intersections }: PathScene, shape: number): string {
  const all = intersections ?? [];
  const some = all.filter(({ pairs }) => pairs > 0).length;
  return (
    `Intersecting pairs of triangles: ${all[shape].pairs.toLocaleString('en')} ` +
    `in shape ${shape + 1}. Shapes with such pairs: ${some} of ${all.length}.`
  );
}

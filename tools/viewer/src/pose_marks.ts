// What of a motion was given, on the slider, in the colours of film strips.
import { byId } from './dom';
import { placeOf, type Timeline } from './place';

function part(kind: string, from: number, to: number): HTMLSpanElement {
  const span = document.createElement('span');
  span.className = kind;
  span.style.left = `${100 * from}%`;
  span.style.width = `${100 * (to - from)}%`;
  return span;
}

/** A strip: green between the poses, violet beyond them, and a blue mark at every pose. */
function strip(scene: Timeline): HTMLDivElement {
  const { parameters, poses, poseNames, extrapolated } = scene;
  const end = placeOf(scene, parameters.length - 1 - extrapolated);
  const marks = poses.map((shape, pose) => {
    const mark = part('pose', placeOf(scene, shape), placeOf(scene, shape));
    mark.title = poseNames[pose] ?? '';
    return mark;
  });
  const line = document.createElement('div');
  line.append(part('inserted', 0, end), part('extrapolated', end, 1), ...marks);
  return line;
}

/** One strip for each path that has poses and moves. */
export function markPoses(scenes: Timeline[]): void {
  const moving = scenes.filter(({ parameters, poses }) => parameters.length > 1 && poses.length > 0);
  byId('marks').replaceChildren(...moving.map(strip));
}

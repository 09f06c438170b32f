// Places in a motion, from 0 (start) to 1 (end), and what is there.
import type { Blend } from './blended_mesh';
import type { PathScene } from './scene_data';

/** When a motion has its shapes, and which of these are poses. */
export type Timeline = Pick<PathScene, 'parameters' | 'poses' | 'poseNames' | 'extrapolated'>;

export function timeAt({ parameters }: Timeline, place: number): number {
  const first = parameters[0];
  return first + place * (parameters[parameters.length - 1] - first);
}

export function placeOf({ parameters }: Timeline, shape: number): number {
  const length = parameters[parameters.length - 1] - parameters[0];
  return length > 0 ? (parameters[shape] - parameters[0]) / length : 0;
}

export function blendAt(scene: PathScene, place: number): Blend {
  const { parameters } = scene;
  const time = timeAt(scene, place);
  const after = parameters.findIndex((parameter) => parameter >= time);
  if (after <= 0) {
    const end = after < 0 ? parameters.length - 1 : 0;
    return { nodes: [end, end, end], weights: [1, 0, 0] };
  }
  const t = (time - parameters[after - 1]) / (parameters[after] - parameters[after - 1]);
  return { nodes: [after - 1, after, after], weights: [1 - t, t, 0] };
}

/** Between which poses a place is, by their names, or by their numbers from 1. */
export function whereabouts(scene: Timeline, place: number): string {
  const { poses, poseNames } = scene;
  const perCent = (share: number) => `${Math.round(100 * share)}\u2009%`;
  if (poses.length < 2) return perCent(place);
  const name = (pose: number) => poseNames[pose] ?? `pose ${pose + 1}`;
  const places = poses.map((shape) => placeOf(scene, shape));
  const last = places.length - 1;
  const next = places.findIndex((at) => at >= place - 1e-9);
  if (next < 0) return `beyond ${name(last)}`;
  if (next === 0 || places[next] - place < 1e-9) return name(next);
  const share = (place - places[next - 1]) / (places[next] - places[next - 1]);
  return `${name(next - 1)} \u2192 ${name(next)}, ${perCent(share)}`;
}

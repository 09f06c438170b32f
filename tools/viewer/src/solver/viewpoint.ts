// What is up in meshes that do not say it, and from where much of them is seen. Simpler than what
// shape-view does (output/internal/view.h), which looks at the drawn picture.
import { Matrix3, Vector3 } from 'three';
import type { Body } from '../scene_data';

/** Of the diagonal: what is not farther from the lowest point touches the floor. */
const floorSlab = 0.02;
const mostVertices = 5000;
/** Degrees around the body, from the front, and up; the first of several that are alike is taken. */
const azimuths = [35, -35, 65, -65, 10];
const elevation = 14;

/** Whether the middle of the vertices is above the part that touches a floor across the axis. */
function stands(shape: Float64Array, axis: number): boolean {
  const low = new Vector3(Infinity, Infinity, Infinity);
  const high = low.clone().negate();
  const middle = new Vector3();
  const point = new Vector3();
  for (let i = 0; i < shape.length; i += 3) {
    point.fromArray(shape, i);
    low.min(point);
    high.max(point);
    middle.add(point);
  }
  middle.divideScalar(shape.length / 3);
  const slab = floorSlab * low.distanceTo(high);
  const floor = low.getComponent(axis) + slab;
  const least = new Vector3(Infinity, Infinity, Infinity);
  const most = least.clone().negate();
  for (let i = 0; i < shape.length; i += 3) {
    if (shape[i + axis] > floor) continue;
    point.fromArray(shape, i);
    least.min(point);
    most.max(point);
  }
  return [0, 1, 2].every(
    (k) =>
      k === axis ||
      (middle.getComponent(k) >= least.getComponent(k) - slab &&
        middle.getComponent(k) <= most.getComponent(k) + slab),
  );
}

function chooseUp(shapes: Float64Array[]): Vector3 {
  let balance = 0;
  for (const shape of shapes) balance += Number(stands(shape, 2)) - Number(stands(shape, 1));
  return balance > 0 ? new Vector3(0, 0, 1) : new Vector3(0, 1, 0);
}

/** The second moments of the vertices of all shapes, each about its own middle. */
function moments(shapes: Float64Array[]): Matrix3 {
  const sums = new Matrix3().multiplyScalar(0);
  const { elements } = sums;
  for (const shape of shapes) {
    const count = shape.length / 3;
    const middle = [0, 0, 0];
    for (let i = 0; i < shape.length; ++i) middle[i % 3] += shape[i] / count;
    for (let i = 0; i < shape.length; i += 3) {
      for (let a = 0; a < 3; ++a) {
        for (let b = 0; b < 3; ++b) {
          elements[3 * a + b] += (shape[i + a] - middle[a]) * (shape[i + b] - middle[b]);
        }
      }
    }
  }
  return sums;
}

/** The square of the area, up to a factor, that the body takes up across two axes. */
function seenArea(spread: Matrix3, right: Vector3, above: Vector3): number {
  const product = (a: Vector3, b: Vector3) => a.dot(b.clone().applyMatrix3(spread));
  return product(right, right) * product(above, above) - product(right, above) ** 2;
}

/** Some of the vertices: enough to choose a view by, and soon counted. */
function sample(shape: Float64Array): Float64Array {
  const vertices = shape.length / 3;
  const step = Math.max(1, Math.floor(vertices / mostVertices));
  const values = new Float64Array(3 * Math.ceil(vertices / step));
  for (let i = 0; i < values.length; i += 3) {
    values.set(shape.subarray(step * i, step * i + 3), i);
  }
  return values;
}

export function viewOf(all: Float64Array[]): Pick<Body, 'up' | 'eye'> {
  const shapes = all.map(sample);
  const up = chooseUp(shapes);
  const front = up.z > 0 ? new Vector3(0, -1, 0) : new Vector3(0, 0, 1);
  const spread = moments(shapes);
  let eye = front;
  let most = -Infinity;
  for (const azimuth of azimuths) {
    const direction = front
      .clone()
      .applyAxisAngle(up, (azimuth * Math.PI) / 180)
      .multiplyScalar(Math.cos((elevation * Math.PI) / 180))
      .addScaledVector(up, Math.sin((elevation * Math.PI) / 180));
    const right = up.clone().cross(direction).normalize();
    const area = seenArea(spread, right, direction.clone().cross(right));
    if (area <= 1.02 * most) continue;
    most = area;
    eye = direction;
  }
  return { up: [up.x, up.y, up.z], eye: [eye.x, eye.y, eye.z] };
}

// The shapes of a model at coordinates, made of keys: docs/file-formats.md.
import type { Body, ModesScene } from './scene_data';

/** The polynomial that is 1 at one of the places, and 0 at the others and at 0. */
function weightAt(places: number[], place: number, x: number): number {
  return places.reduce(
    (weight, other) => (other === place ? weight : (weight * (x - other)) / (place - other)),
    x / place,
  );
}

export class KeyShapes {
  /** What is shown: one shape, which changes, and some more, for the camera. */
  readonly body: Pick<Body, 'shapes' | 'low' | 'side'>;
  private readonly mean: Float32Array;
  private readonly differences: Float32Array[];
  private readonly sum: Float32Array;

  constructor(private readonly scene: ModesScene) {
    // The cube around the keys becomes the middle of one of twice its side, because shapes may reach
    // beyond the keys.
    const { low, side, shapes, places } = scene;
    for (const shape of shapes) {
      for (let i = 0; i < shape.length; ++i) shape[i] = 16384 + (shape[i] >> 1);
    }
    const [mean, ...others] = shapes;
    const own = mean.slice();
    const near = others.filter((_, key) => {
      const place = places[key % places.length];
      return key < places.length * scene.shares.length && Math.abs(place) < 2;
    });
    this.body = {
      shapes: [own, mean, ...near],
      low: low.map((value) => value - side / 2) as Body['low'],
      side: 2 * side,
    };
    this.mean = Float32Array.from(mean);
    this.differences = others.map((shape) => Float32Array.from(shape, (x, i) => x - mean[i]));
    this.sum = new Float32Array(mean.length);
  }

  /** Makes the first shape of the body that at the coordinates. */
  showAt(coordinates: number[]): void {
    const { places, pairPlace } = this.scene;
    const { sum } = this;
    sum.set(this.mean);
    let key = 0;
    const add = (weight: number) => {
      const difference = this.differences[key++];
      if (weight === 0) return;
      for (let i = 0; i < sum.length; ++i) sum[i] += weight * difference[i];
    };
    for (const x of coordinates) {
      for (const place of places) add(weightAt(places, place, x));
    }
    coordinates.forEach((x, k) => {
      for (const y of coordinates.slice(k + 1)) add((x * y) / pairPlace ** 2);
    });
    const [own] = this.body.shapes;
    for (let i = 0; i < sum.length; ++i) own[i] = Math.min(65535, Math.max(0, sum[i]));
  }
}

import type { Point } from './locate';

/** A polyline in the plane, along which a point goes at one speed. */
export class Curve {
  readonly points: Point[] = [];
  private readonly lengths: number[] = [];

  get isEmpty(): boolean {
    return this.points.length === 0;
  }
  get length(): number {
    return this.lengths.length > 0 ? this.lengths[this.lengths.length - 1] : 0;
  }

  /** Adds a point, unless it is the last one again. */
  add(point: Point): void {
    const last = this.points[this.points.length - 1];
    const step = last ? Math.hypot(point[0] - last[0], point[1] - last[1]) : 0;
    if (last && step === 0) return;
    this.lengths.push(this.length + step);
    this.points.push(point);
  }

  clear(): void {
    this.points.length = 0;
    this.lengths.length = 0;
  }

  /** The point at a share of the length. */
  at(place: number): Point {
    const along = place * this.length;
    const next = this.lengths.findIndex((length) => length >= along);
    if (next <= 0) return this.points[0];
    const [before, after] = [this.lengths[next - 1], this.lengths[next]];
    const t = after > before ? (along - before) / (after - before) : 1;
    const [a, b] = [this.points[next - 1], this.points[next]];
    return [(1 - t) * a[0] + t * b[0], (1 - t) * a[1] + t * b[1]];
  }
}

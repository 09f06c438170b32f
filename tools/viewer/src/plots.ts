// Plots of numbers over time, with a mark at the place that the player shows.
import { svg } from './dom';

export interface Series {
  /** Of the line, before its value; empty if it is the only one. */
  name: string;
  /** Place (0 .. 1) and value, from left to right. */
  points: [number, number][];
  /** The number of a colour of the theme; the line of the second is dashed, too. */
  colour: 1 | 2;
  /** Whether a value holds until the next place; otherwise it changes evenly. */
  steps?: boolean;
}

const height = 84;
const [left, right, top, bottom] = [8, 8, 18, 6];

function valueAt({ points, steps }: Series, place: number): number {
  const next = points.findIndex(([x]) => x >= place);
  if (next <= 0) return points[next < 0 ? points.length - 1 : 0][1];
  const [[x0, y0], [x1, y1]] = [points[next - 1], points[next]];
  return steps || x1 === x0 ? y0 : y0 + ((y1 - y0) * (place - x0)) / (x1 - x0);
}

export class Plot {
  private readonly picture = svg('svg', { role: 'img', height, class: 'plot' });
  private readout: SVGTextElement | null = null;
  private readonly largest: number;
  private cursor: SVGLineElement | null = null;
  private width = 0;
  private place = 0;

  constructor(
    parent: HTMLElement,
    title: string,
    private readonly series: Series[],
    /** Places of poses, which are marked. */
    private readonly poses: number[],
    private readonly format: (value: number) => string,
    private readonly onSeek: (place: number) => void,
  ) {
    this.largest = Math.max(...series.flatMap(({ points }) => points.map(([, y]) => y)), 1e-300);
    const figure = document.createElement('figure');
    const caption = document.createElement('figcaption');
    caption.textContent = title;
    figure.append(caption, this.picture);
    parent.append(figure);
    const extremes = series.map(({ name, points }) => {
      const values = points.map(([, y]) => y);
      return `${name}from ${format(Math.min(...values))} to ${format(Math.max(...values))}`;
    });
    this.picture.setAttribute('aria-label', `${title}: ${extremes.join('; ')}`);
    new ResizeObserver(() => this.layOut()).observe(figure);
    this.picture.addEventListener('pointerdown', (event) => {
      this.picture.setPointerCapture(event.pointerId);
      this.seek(event);
    });
    this.picture.addEventListener('pointermove', (event) => {
      if (this.picture.hasPointerCapture(event.pointerId)) this.seek(event);
    });
  }

  show(place: number): void {
    this.place = place;
    const x = this.x(place);
    this.cursor?.setAttribute('x1', String(x));
    this.cursor?.setAttribute('x2', String(x));
    if (!this.readout) return;
    const values = this.series.map((one) => `${one.name}${this.format(valueAt(one, place))}`);
    this.readout.textContent = `now ${values.join(' \u00b7 ')}`;
  }

  private seek(event: PointerEvent): void {
    const place = (event.offsetX - left) / (this.width - left - right);
    this.onSeek(Math.min(1, Math.max(0, place)));
  }

  private x(place: number): number {
    return left + place * (this.width - left - right);
  }

  private y(value: number): number {
    return height - bottom - (value / this.largest) * (height - top - bottom);
  }

  private layOut(): void {
    const width = this.picture.parentElement!.clientWidth;
    if (width === this.width || width === 0) return;
    this.width = width;
    this.picture.setAttribute('width', String(width));
    this.picture.replaceChildren();
    const line = (x1: number, y1: number, x2: number, y2: number, name: string) =>
      svg('line', { x1, y1, x2, y2, class: name }, this.picture);
    line(left, this.y(0), width - right, this.y(0), 'axis');
    line(left, this.y(this.largest), width - right, this.y(this.largest), 'axis');
    for (const pose of this.poses) {
      line(this.x(pose), this.y(0) - 4, this.x(pose), this.y(0) + 4, 'pose');
    }
    const label = svg('text', { x: left, y: top - 5 }, this.picture);
    label.textContent = `up to ${this.format(this.largest)}`;
    const here = { x: width - right, y: top - 5, 'text-anchor': 'end', class: 'readout' };
    this.readout = svg('text', here, this.picture);
    for (const { points, colour, steps } of this.series) {
      const corners = points.map(([x, y], i) => {
        const before = steps && i > 0 ? `${this.x(x)},${this.y(points[i - 1][1])} ` : '';
        return `${before}${this.x(x)},${this.y(y)}`;
      });
      svg('polyline', { points: corners.join(' '), class: `series-${colour}` }, this.picture);
    }
    this.cursor = line(0, top, 0, height - bottom, 'cursor');
    this.show(this.place);
  }
}

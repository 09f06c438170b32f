// The plane in which poses lie, drawn: a point to move, and a curve to draw.
import { svg } from './dom';
import type { Point } from './locate';
import type { SpaceScene } from './scene_data';

export const thumbnailWidth = 132;
export const thumbnailHeight = 99;
const shownWidth = 66;
const shownHeight = 49.5;
const border = 84; // room for thumbnails around the poses
const step = 0.02; // of the plane's size, for one key
/** Pixels between two points of a drawn curve. */
const stroke = 4;

export interface PlaneEvents {
  onMove(point: Point): void;
  /** A curve is drawn: its first point, every further one, and its end. */
  onStroke(point: Point, isFirst: boolean): void;
  onStrokeEnd(): void;
  onEnter(): void;
}

export class PlaneView {
  drawing = false;
  private readonly picture = svg('svg', { class: 'plane' });
  private readonly handle: SVGGElement;
  private readonly curve = svg('polyline', { class: 'curve' });
  private curvePoints: Point[] = [];
  private point: Point = [0, 0];
  private low: Point;
  private size: Point;
  private scale = 1;
  private offset: Point = [0, 0];
  private lastStroke: Point | null = null;

  constructor(
    parent: HTMLElement,
    private readonly scene: SpaceScene,
    private readonly thumbnails: string[],
    private readonly events: PlaneEvents,
  ) {
    const [xs, ys] = [0, 1].map((axis) => scene.points.map((point) => point[axis]));
    this.low = [Math.min(...xs), Math.min(...ys)];
    this.size = [Math.max(...xs) - this.low[0], Math.max(...ys) - this.low[1]];
    this.handle = svg('g', {
      class: 'handle',
      tabindex: 0,
      role: 'slider',
      'aria-label': 'Point in the plane. Arrow keys move it, Enter adds it to the curve.',
      'aria-valuemin': 0,
      'aria-valuemax': 100,
    });
    svg('circle', { r: 22, class: 'target' }, this.handle);
    svg('circle', { r: 9, class: 'dot' }, this.handle);
    parent.append(this.picture);
    this.listen();
    new ResizeObserver(() => this.layOut()).observe(parent);
  }

  /** Moves the point; `words` tell where it is. */
  setPoint(point: Point, words: string): void {
    this.point = point;
    const [x, y] = this.toPixels(point);
    this.handle.setAttribute('transform', `translate(${x} ${y})`);
    const along = this.size[0] > 0 ? (point[0] - this.low[0]) / this.size[0] : 0;
    this.handle.setAttribute('aria-valuenow', String(Math.round(100 * along)));
    this.handle.setAttribute('aria-valuetext', words);
  }

  setCurve(points: Point[]): void {
    this.curvePoints = points;
    const corners = points.map((point) => this.toPixels(point).join(','));
    this.curve.setAttribute('points', corners.join(' '));
  }

  private toPixels([x, y]: Point): Point {
    return [
      this.offset[0] + (x - this.low[0]) * this.scale,
      this.offset[1] - (y - this.low[1]) * this.scale,
    ];
  }

  private toPlane(x: number, y: number): Point {
    return [
      this.low[0] + (x - this.offset[0]) / this.scale,
      this.low[1] + (this.offset[1] - y) / this.scale,
    ];
  }

  private layOut(): void {
    const { clientWidth: width, clientHeight: height } = this.picture.parentElement!;
    if (width === 0 || height === 0) return;
    this.picture.setAttribute('width', String(width));
    this.picture.setAttribute('height', String(height));
    const fit = [0, 1].map((axis) => {
      const room = Math.max(40, (axis === 0 ? width : height) - 2 * border);
      return this.size[axis] > 0 ? room / this.size[axis] : Infinity;
    });
    this.scale = Math.min(...fit);
    if (!Number.isFinite(this.scale)) this.scale = 1;
    this.offset = [
      (width - this.size[0] * this.scale) / 2,
      (height + this.size[1] * this.scale) / 2,
    ];
    this.drawPlane();
    this.picture.append(this.curve, this.handle);
    this.setCurve(this.curvePoints);
    this.setPoint(this.point, this.handle.getAttribute('aria-valuetext') ?? '');
  }

  private drawPlane(): void {
    const { points, planeTriangles, planeSegments, names } = this.scene;
    this.picture.replaceChildren();
    const edges = svg('g', { class: 'edges' }, this.picture);
    for (const nodes of [...planeTriangles, ...planeSegments]) {
      const corners = nodes.map((node) => this.toPixels(points[node]).join(',')).join(' ');
      svg('polygon', { points: corners }, edges);
    }
    const dots = svg('g', { class: 'nodes' }, this.picture);
    points.forEach((point, node) => {
      const [cx, cy] = this.toPixels(point);
      svg('circle', { cx, cy, r: node < names.length ? 4.5 : 2.5 }, dots);
    });
    const [mx, my] = this.toPixels([
      this.low[0] + this.size[0] / 2,
      this.low[1] + this.size[1] / 2,
    ]);
    names.forEach((name, pose) => {
      const [x, y] = this.toPixels(points[pose]);
      this.drawThumbnail(name, this.thumbnails[pose], x, y, x - mx, y - my);
    });
  }

  /** A pose's picture beside its node, on the side (dx, dy) that points out of the plane's middle. */
  private drawThumbnail(
    name: string,
    picture: string,
    x: number,
    y: number,
    dx: number,
    dy: number,
  ): void {
    const length = Math.hypot(dx, dy) || 1;
    const [ux, uy] = length > 1 ? [dx / length, dy / length] : [0, -1];
    const [cx, cy] = [x + ux * 46, y + uy * 44];
    const group = svg('g', { class: 'pose' }, this.picture);
    svg('title', {}, group).textContent = name;
    const box = { x: cx - shownWidth / 2, y: cy - shownHeight / 2 };
    svg('image', { ...box, width: shownWidth, height: shownHeight, href: picture }, group);
    svg('rect', { ...box, width: shownWidth, height: shownHeight, rx: 4 }, group);
    const below = uy > -0.5;
    const label = svg(
      'text',
      { x: cx, y: below ? cy + shownHeight / 2 + 13 : cy - shownHeight / 2 - 5 },
      group,
    );
    label.textContent = name.length > 14 ? `${name.slice(0, 13)}\u2026` : name;
  }

  private listen(): void {
    const { picture } = this;
    const place = (event: PointerEvent): Point => {
      const box = picture.getBoundingClientRect();
      return this.toPlane(event.clientX - box.left, event.clientY - box.top);
    };
    picture.addEventListener('pointerdown', (event) => {
      picture.setPointerCapture(event.pointerId);
      event.preventDefault();
      this.handle.focus({ preventScroll: true });
      if (!this.drawing) return this.events.onMove(place(event));
      this.lastStroke = [event.clientX, event.clientY];
      this.events.onStroke(place(event), true);
    });
    picture.addEventListener('pointermove', (event) => {
      if (!picture.hasPointerCapture(event.pointerId)) return;
      if (!this.lastStroke) return this.events.onMove(place(event));
      const [x, y] = this.lastStroke;
      if (Math.hypot(event.clientX - x, event.clientY - y) < stroke) return;
      this.lastStroke = [event.clientX, event.clientY];
      this.events.onStroke(place(event), false);
    });
    const end = () => {
      if (!this.lastStroke) return;
      this.lastStroke = null;
      this.events.onStrokeEnd();
    };
    picture.addEventListener('pointerup', end);
    picture.addEventListener('pointercancel', end);
    this.handle.addEventListener('keydown', (event) => this.onKey(event));
  }

  private onKey(event: KeyboardEvent): void {
    const length = Math.max(...this.size) * step * (event.shiftKey ? 0.25 : 1);
    const moves: Record<string, Point> = {
      ArrowLeft: [-length, 0],
      ArrowRight: [length, 0],
      ArrowUp: [0, length],
      ArrowDown: [0, -length],
    };
    if (event.key === 'Enter') this.events.onEnter();
    else if (event.key in moves) {
      const [dx, dy] = moves[event.key];
      this.events.onMove([this.point[0] + dx, this.point[1] + dy]);
    } else return;
    event.preventDefault();
  }
}

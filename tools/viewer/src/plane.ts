// The plane of poses, in which the user moves a point or draws a curve.
import { svg } from './dom';
import { hullEdges, type Point } from './locate';
import type { SpaceScene } from './scene_data';

export const thumbnailWidth = 132;
export const thumbnailHeight = 99;
const shownWidth = 66;
const border = 92; // room for thumbnails around the poses
const narrow = 500; // planes narrower than that have smaller thumbnails
/** Poses inside the hull have smaller thumbnails, which cover less of the plane. */
const innerShare = 0.75;
const step = 0.02; // of the plane's size, for one key
/** Pixels between two points of a drawn curve. */
const stroke = 4;

export interface PlaneEvents {
  onMove(point: Point): void;
  /** Called while the user draws a curve: at its first point, at each further one, and at its end. */
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
  private thumbnailScale = 1;
  private readonly hull: Set<number>;
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
    this.hull = new Set(hullEdges(scene).flat());
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

  /** Moves the point; `words` describe the place for screen readers. */
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
    this.thumbnailScale = width < narrow ? 0.75 : 1;
    const fit = [0, 1].map((axis) => {
      const all = axis === 0 ? width : height;
      const room = Math.max(40, all - 2 * border * this.thumbnailScale);
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
    names.forEach((_, pose) => {
      const [x, y] = this.toPixels(points[pose]);
      this.drawThumbnail(pose, x, y, Math.hypot(x - mx, y - my) > 1 ? [x - mx, y - my] : [0, -1]);
    });
  }

  /** A pose's picture beside its node at (x, y), on the side that points out of the plane's middle. */
  private drawThumbnail(pose: number, x: number, y: number, [dx, dy]: Point): void {
    const isInner = !this.hull.has(pose);
    const width = shownWidth * this.thumbnailScale * (isInner ? innerShare : 1);
    const height = (width * thumbnailHeight) / thumbnailWidth;
    const length = Math.hypot(dx, dy);
    const [cx, cy] = [x + (0.7 * width * dx) / length, y + (0.9 * height * dy) / length];
    const name = this.scene.names[pose];
    const group = svg('g', { class: `pose${isInner ? ' inner' : ''}` }, this.picture);
    svg('title', {}, group).textContent = name;
    const box = { x: cx - width / 2, y: cy - height / 2, width, height };
    svg('rect', { ...box, rx: 4 }, group);
    svg('image', { ...box, href: this.thumbnails[pose] }, group);
    const isBelow = dy > -0.5 * length;
    const baseline = isBelow ? cy + height / 2 + 13 : cy - height / 2 - 5;
    const label = svg('text', { x: cx, y: baseline }, group);
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

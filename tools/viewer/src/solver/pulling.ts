// A mode in which the body is pinned and pulled.
import { Color, Plane, Ray, Vector3 } from 'three';
import { svg } from '../dom';
import { vertexOnRay } from '../hit';
import { onKey } from '../keys';
import type { Stage } from '../stage';
import type { Deformation } from './library';
import type { LiveMesh } from './live_mesh';
import { farthestFrom, Neighbours, pinAt, type Pin } from './pins';

/** Pixels that the pointer may move in a click, and how near to a pin it takes hold of that one. */
const clickReach = 5;
const grip = 16;
/** By which a key pulls, as a share of the body's size. */
const keyStep = 0.03;

/** An update is so rough that the body follows the pointer; others go on from it, so many at most. */
const mostRounds = 12;

const pinned = new Color(0x1f5fae);

export interface Surroundings {
  stage: Stage;
  mesh: LiveMesh;
  /** Where pins are drawn, over the canvas. */
  labels: Element;
  /** Prepares a shape to be deformed. */
  deform(shape: Float64Array): Promise<Deformation>;
  /** When pins have changed, or what they make of the body. */
  onChange(): void;
  onError(error: Error): void;
  tell(sentence: string): void;
}

interface Drag {
  pin: Pin;
  /** The pin's places before, and where on the plane the pointer took hold of it. */
  before: Float64Array;
  plane: Plane;
  from: Vector3;
}

interface Press {
  x: number;
  y: number;
  vertex: number;
  pin: Pin | null;
  drag: Drag | null;
}

export class Pulling {
  private pins: Pin[] = [];
  private base: Float64Array | null = null; // the shape that is deformed; null while the mode is off
  private deformation: Promise<Deformation> | null = null;
  private neighbours: Neighbours | null = null;
  private press: Press | null = null;
  private wanted = false;
  private updating = false;
  private moved = false; // whether the body is no longer as it was
  private news = ''; // a sentence that is still to be read when the body is ready
  private rounds = 0; // updates for the places that pins have now

  constructor(private readonly around: Surroundings) {
    this.listen();
  }

  get on(): boolean {
    return this.base !== null;
  }
  get count(): number {
    return this.pins.length;
  }
  /** The shape into which the body was pulled; null if it was not. */
  get result(): Float64Array | null {
    return this.moved ? this.around.mesh.positions : null;
  }

  start(): void {
    const { mesh } = this.around;
    this.base = mesh.positions.slice();
    this.neighbours = new Neighbours(mesh.body.triangles, mesh.body.vertices);
    this.deformation = this.around.deform(this.base);
    this.deformation.catch((error: Error) => {
      if (this.on) this.around.onError(error);
    });
    this.news = '';
    this.change();
  }

  stop(): void {
    if (!this.on) return;
    void this.deformation?.then((deformation) => deformation.close()).catch(() => {});
    this.deformation = this.base = this.neighbours = this.press = null;
    this.pins = [];
    this.wanted = this.moved = false;
    this.around.stage.turnable = true;
    this.change();
  }

  /** Takes all pins away, and shows the body as it was. */
  clear(): void {
    this.pins = [];
    this.restore();
    this.change();
  }

  removeLast(): void {
    this.pins.pop();
    if (this.pins.length === 0) this.restore();
    else if (this.moved) this.update();
    this.change();
  }

  /** Draws the pins at their places in the picture. */
  place(): void {
    const { stage, mesh, labels } = this.around;
    labels.replaceChildren();
    if (this.pins.length === 0) return;
    const project = stage.projector(0);
    const point = new Vector3();
    this.pins.forEach(({ vertices }, i) => {
      const [cx, cy] = project(point.fromArray(mesh.inCube, 3 * vertices[0]));
      const isPulled = this.press?.drag?.pin === this.pins[i];
      svg('circle', { class: isPulled ? 'pin pulled' : 'pin', cx, cy, r: 9 }, labels);
    });
  }

  private restore(): void {
    this.wanted = this.moved = false;
    if (this.base) this.around.mesh.show(this.base);
  }

  private change(): void {
    const { mesh, stage, onChange } = this.around;
    mesh.colour(new Map(this.pins.length > 0 ? [[pinned, this.pins.flatMap((pin) => [...pin.vertices])]] : []));
    stage.draw();
    onChange();
  }

  private listen(): void {
    const { stage } = this.around;
    const area = stage.canvas.parentElement!;
    // Before the camera's controls hear of it.
    area.addEventListener(
      'pointerdown',
      (event) => {
        if (!this.on || event.target !== stage.canvas) return;
        // A second finger turns and moves the view, as always.
        if (!event.isPrimary || event.button !== 0) return this.endPress();
        const [x, y] = [event.clientX, event.clientY];
        const pin = this.pinNear(x, y);
        const vertex = pin ? pin.vertices[0] : this.vertexAt(x, y);
        if (vertex === null) return;
        this.press = { x, y, vertex, pin, drag: null };
        stage.turnable = false;
        stage.canvas.setPointerCapture(event.pointerId);
      },
      { capture: true },
    );
    area.addEventListener('pointermove', (event) => {
      const { press } = this;
      if (!press || !event.isPrimary) return;
      const distance = Math.hypot(event.clientX - press.x, event.clientY - press.y);
      if (!press.drag && distance > clickReach) press.drag = this.beginDrag(press);
      if (press.drag) this.dragTo(press.drag, event.clientX, event.clientY);
    });
    area.addEventListener('pointerup', () => {
      if (this.press && !this.press.drag && !this.press.pin) {
        this.addPin(this.press.vertex);
        this.around.tell('Pinned. Drag from a pin, or from anywhere on the body, to pull it.');
      }
      this.endPress();
    });
    area.addEventListener('pointercancel', () => this.endPress());
    area.addEventListener(
      'keydown',
      (event) => {
        if (this.on && event.target === stage.canvas && this.key(event)) {
          event.preventDefault();
          event.stopPropagation(); // the camera stays
        }
      },
      { capture: true },
    );
    onKey('Delete', () => this.removeLast());
    onKey('Backspace', () => this.removeLast());
  }

  private endPress(): void {
    if (!this.press) return;
    this.press = null;
    this.around.stage.turnable = true;
    this.around.stage.draw();
  }

  /** Whether a key on the picture was one of this mode. */
  private key({ key, shiftKey }: KeyboardEvent): boolean {
    const { left, top, width, height } = this.around.stage.canvas.getBoundingClientRect();
    const [x, y] = [left + width / 2, top + height / 2];
    if (key === 'Enter') {
      const vertex = this.vertexAt(x, y);
      if (vertex === null) this.around.tell('The body is not in the middle of the picture; turn it.');
      else this.addPin(vertex);
      return true;
    }
    const steps: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, -1],
      ArrowDown: [0, 1],
    };
    const pin = this.pins[this.pins.length - 1];
    if (!shiftKey || !(key in steps) || !pin) return false;
    const drag = this.beginDrag({ x, y, vertex: pin.vertices[0], pin, drag: null });
    const [[fromX, fromY], [toX]] = [0, keyStep].map((right) => this.seen(pin, right));
    const pixels = Math.abs(toX - fromX);
    if (drag) {
      drag.from = this.onPlane(drag.plane, left + fromX, top + fromY) ?? drag.from;
      this.dragTo(drag, left + fromX + pixels * steps[key][0], top + fromY + pixels * steps[key][1]);
    }
    return true;
  }

  /** Where a pin is in the picture, and where a place to the right of it is. */
  private seen({ vertices }: Pin, right: number): [number, number] {
    const { stage, mesh } = this.around;
    const at = new Vector3().fromArray(mesh.inCube, 3 * vertices[0]);
    const { left, top } = stage.canvas.getBoundingClientRect();
    const [x, y] = stage.projector(0)(at);
    const plane = this.facing(at);
    const [here, there] = [0, 10].map((dx) => this.onPlane(plane, left + x + dx, top + y));
    if (!here || !there || right === 0) return [x, y];
    return [x + (10 * right) / here.distanceTo(there), y];
  }

  private vertexAt(x: number, y: number): number | null {
    const { stage, mesh } = this.around;
    const ray = stage.rayAt(x, y);
    return ray && vertexOnRay(mesh.body, mesh.inCube, ray.origin, ray.direction);
  }

  private pinNear(clientX: number, clientY: number): Pin | null {
    const { left, top } = this.around.stage.canvas.getBoundingClientRect();
    let nearest: Pin | null = null;
    let least = grip;
    for (const pin of this.pins) {
      const [x, y] = this.seen(pin, 0);
      const distance = Math.hypot(left + x - clientX, top + y - clientY);
      if (distance > least) continue;
      least = distance;
      nearest = pin;
    }
    return nearest;
  }

  private addPin(vertex: number): Pin {
    const { mesh } = this.around;
    const pin = pinAt(vertex, mesh.positions, mesh.body.side, this.neighbours!);
    // A vertex is pinned once.
    const taken = new Set(pin.vertices);
    this.pins = this.pins.filter(({ vertices }) => !vertices.some((v) => taken.has(v)));
    this.pins.push(pin);
    this.change();
    return pin;
  }

  private beginDrag(press: Press): Drag | null {
    const { mesh, tell } = this.around;
    const pin = press.pin ?? this.addPin(press.vertex);
    if (this.pins.length === 1) {
      // Nothing would hold the body: it would go along as a whole.
      const far = farthestFrom(press.vertex, mesh.positions, mesh.body.triangles);
      this.pins.unshift(pinAt(far, mesh.positions, mesh.body.side, this.neighbours!));
      this.news = 'The far end is pinned, so that it stays. Click the body to pin other parts.';
      tell(this.news);
      this.change();
    }
    const plane = this.facing(new Vector3().fromArray(mesh.inCube, 3 * pin.vertices[0]));
    const from = this.onPlane(plane, press.x, press.y);
    if (!this.moved) this.update(); // the first one takes long: it begins before the body is moved
    return from && { pin, before: pin.positions.slice(), plane, from };
  }

  /** The plane through a point that faces the eye. */
  private facing(point: Vector3): Plane {
    const { stage } = this.around;
    const { left, top, width, height } = stage.canvas.getBoundingClientRect();
    const middle = stage.rayAt(left + width / 2, top + height / 2)!;
    return new Plane().setFromNormalAndCoplanarPoint(middle.direction.normalize(), point);
  }

  private onPlane(plane: Plane, x: number, y: number): Vector3 | null {
    const ray = this.around.stage.rayAt(x, y);
    return ray && new Ray(ray.origin, ray.direction).intersectPlane(plane, new Vector3());
  }

  private dragTo({ pin, before, plane, from }: Drag, x: number, y: number): void {
    const { left, top, right, bottom } = this.around.stage.canvas.getBoundingClientRect();
    const inside = (value: number, low: number, high: number) => Math.min(Math.max(value, low), high - 1);
    const to = this.onPlane(plane, inside(x, left, right), inside(y, top, bottom));
    if (!to) return;
    const by = to.sub(from).multiplyScalar(this.around.mesh.body.side);
    const shift = [by.x, by.y, by.z];
    pin.positions = before.map((value, i) => value + shift[i % 3]);
    this.update();
  }

  /** One update is computed at a time, and after it the one for what is wanted then. */
  private update(): void {
    this.wanted = true;
    this.rounds = 0;
    if (!this.updating) void this.updateAll();
  }

  private async updateAll(): Promise<void> {
    const { deformation } = this;
    if (!deformation) return;
    this.updating = true;
    if (!this.moved) this.around.tell('One moment: the body is made ready to be pulled.');
    const isCurrent = () => this.deformation === deformation && this.pins.length > 0;
    try {
      const { update } = await deformation;
      while (this.wanted && isCurrent()) {
        this.wanted = false;
        const handles = this.pins.map(({ vertices, positions }) => ({ vertices, positions }));
        const { shapes, converged } = await update(handles);
        if (!isCurrent()) break;
        if (!this.moved) this.around.tell(this.news);
        this.moved = true;
        this.around.mesh.show(shapes[shapes.length - 1]);
        this.change();
        this.wanted ||= !converged && ++this.rounds < mostRounds;
      }
    } catch (error) {
      if (isCurrent()) this.around.onError(error as Error);
    } finally {
      this.updating = false;
      if (this.wanted && this.on) void this.updateAll();
    }
  }
}

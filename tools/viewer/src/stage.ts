// Draws bodies on one canvas with one camera. Each body has a part of the canvas.
import {
  Box3,
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  type Object3D,
  PerspectiveCamera,
  Scene,
  Quaternion,
  Raycaster,
  Spherical,
  Vector2,
  Vector3,
  VSMShadowMap,
  WebGLRenderer,
} from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { Ground } from './ground';
import type { Body } from './scene_data';

const fieldOfView = 30;
const margin = 1.06;
/** Bodies whose sizes have a larger ratio than this are drawn in the same size. */
const largestRatio = 3;
/** Of the turntable. */
const turnsAMinute = 3;
/** The number of vertices from which the distance of the camera is computed. */
const mostSamples = 20000;

/** What a stage shows, in its unit cube. */
export interface Shown extends Object3D {
  readonly body: Pick<Body, 'up' | 'eye' | 'side'>;
  /** Vertices of all of its shapes, some `most` of them at the most. */
  someVertices(most: number): Vector3[];
}

interface Cell {
  scene: Scene;
  lights: Group;
  sky: HemisphereLight;
  ground: Ground;
  mesh: Shown;
}

export class Stage {
  private readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(fieldOfView, 1, 0.01, 100);
  private controls: OrbitControls;
  private readonly cells: Cell[] = [];
  private samples: Vector3[] = [];
  private readonly eye = new Vector3();
  private readonly up = new Vector3(); // at first; that of the camera when the user has rolled it
  private moved = false; // by the user: then resizing leaves the camera alone
  private background = new Color();
  private wanted = false;
  private last = 0;
  /** Called after every frame, to place what lies over the canvas. */
  onDrawn: () => void = () => {};

  /** `advance` is called with the seconds that have passed, and returns whether to draw again. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    meshes: Shown[],
    private readonly advance: (seconds: number) => boolean,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.renderer.setScissorTest(true);
    this.renderer.setClearAlpha(0);
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = VSMShadowMap;
    for (const mesh of meshes) this.cells.push(this.cell(mesh));
    this.controls = this.newControls();
    canvas.addEventListener('keydown', (event) => this.onKey(event));
    new ResizeObserver(() => {
      this.resize();
      this.drawNow(); // a canvas of another size is empty
    }).observe(canvas.parentElement!);
    this.place();
  }

  /** Puts the bodies into their parts of the canvas, by their size and all of their shapes. */
  place(): void {
    const [{ body }] = this.cells.map(({ mesh }) => mesh);
    this.up.fromArray(body.up);
    this.eye.fromArray(body.eye).normalize();
    const sides = this.cells.map(({ mesh }) => mesh.body.side || 1);
    const largest = Math.max(...sides);
    for (const { mesh } of this.cells) {
      const alike = largest <= largestRatio * Math.min(...sides);
      const scale = alike ? (mesh.body.side || 1) / largest : 1;
      const centre = new Box3().setFromPoints(mesh.someVertices(mostSamples)).getCenter(new Vector3());
      mesh.scale.setScalar(scale);
      mesh.position.copy(centre).multiplyScalar(-scale);
    }
    this.showAll();
  }

  /** Looks at all shapes again, after some of these are others, unless the user chose the view. */
  refit(): void {
    if (!this.moved) this.showAll();
  }

  setBackground(colour: string): void {
    this.background = new Color(colour);
    this.draw();
  }

  set ground(on: boolean) {
    for (const { ground } of this.cells) ground.visible = on;
    this.draw();
  }

  /** Whether the view turns by itself. */
  set turning(on: boolean) {
    this.moved = true;
    this.controls.autoRotate = on;
    this.draw();
  }

  /** Requests that the next frame is drawn. */
  draw(): void {
    if (this.wanted) return;
    this.wanted = true;
    requestAnimationFrame((now) => this.frame(now));
  }

  /** Draws at once, so that the canvas can be read. */
  drawNow(): void {
    const size = this.renderer.getSize(new Vector2());
    const areas = this.areas(size.x, size.y);
    this.cells.forEach(({ scene, lights, ground }, i) => {
      const { x, y, width, height } = areas[i];
      scene.background = this.background;
      ground.background = this.background;
      lights.quaternion.copy(this.camera.quaternion);
      this.renderer.setViewport(x, y, width, height);
      this.renderer.setScissor(x, y, width, height);
      this.renderer.render(scene, this.camera);
    });
    this.onDrawn();
  }

  /** The body under a point of the window, and the ray through it in the body's unit cube. */
  rayAt(clientX: number, clientY: number): { body: number; origin: Vector3; direction: Vector3 } | null {
    const { left, top } = this.canvas.getBoundingClientRect();
    const size = this.renderer.getSize(new Vector2());
    const [px, py] = [clientX - left, size.y - (clientY - top)];
    const body = this.areas(size.x, size.y).findIndex(
      ({ x, y, width, height }) => px >= x && px < x + width && py >= y && py < y + height,
    );
    if (body < 0) return null;
    const { x, y, width, height } = this.areas(size.x, size.y)[body];
    const caster = new Raycaster();
    caster.setFromCamera(
      new Vector2((2 * (px - x)) / width - 1, (2 * (py - y)) / height - 1),
      this.camera,
    );
    const toLocal = this.cells[body].mesh.matrixWorld.clone().invert();
    const { origin, direction } = caster.ray.clone().applyMatrix4(toLocal);
    return { body, origin, direction };
  }

  /** Where points of a body's unit cube are seen, in pixels of the canvas. */
  projector(body: number): (point: Vector3) => [number, number] {
    const size = this.renderer.getSize(new Vector2());
    const { x, y, width, height } = this.areas(size.x, size.y)[body];
    this.camera.updateMatrixWorld();
    this.cells[body].mesh.updateMatrixWorld(true);
    const matrix = this.camera.projectionMatrix
      .clone()
      .multiply(this.camera.matrixWorldInverse)
      .multiply(this.cells[body].mesh.matrixWorld);
    return (point) => {
      const seen = point.clone().applyMatrix4(matrix);
      return [x + ((seen.x + 1) / 2) * width, size.y - (y + ((seen.y + 1) / 2) * height)];
    };
  }

  /** Whether dragging turns the view. */
  set turnable(on: boolean) {
    this.controls.enabled = on;
  }

  /** A small picture of the first body as it is now, without background and ground. */
  thumbnail(width: number, height: number): string {
    const picture = document.createElement('canvas');
    picture.width = width;
    picture.height = height;
    const { scene, lights, ground } = this.cells[0];
    const hasGround = ground.visible;
    ground.visible = false;
    const ratio = this.renderer.getPixelRatio();
    this.renderer.setPixelRatio(1);
    this.renderer.setSize(width, height, false);
    this.fit(width / height);
    scene.background = null;
    lights.quaternion.copy(this.camera.quaternion);
    this.renderer.setViewport(0, 0, width, height);
    this.renderer.setScissor(0, 0, width, height);
    this.renderer.render(scene, this.camera);
    picture.getContext('2d')!.drawImage(this.renderer.domElement, 0, 0);
    this.renderer.setPixelRatio(ratio);
    ground.visible = hasGround;
    return picture.toDataURL();
  }

  /** Looks from the first direction again, at all of every shape. */
  showAll(): void {
    this.moved = false;
    this.samples = this.cells.flatMap(({ mesh, ground }) => {
      const points = mesh.someVertices(mostSamples);
      for (const point of points) point.multiplyScalar(mesh.scale.x).add(mesh.position);
      ground.points = points;
      return points;
    });
    this.setUp(this.up);
    this.resize();
  }

  /** Turns the picture by an angle, clockwise. The body then stands on what is below it. */
  roll(angle: number): void {
    const ahead = this.camera.getWorldDirection(new Vector3());
    this.setUp(this.camera.up.clone().applyAxisAngle(ahead, -angle));
    this.afterKeys();
  }

  resize(): void {
    const { clientWidth, clientHeight } = this.canvas.parentElement!;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.canvas.parentElement!.classList.toggle('stacked', clientWidth < clientHeight);
    const { width, height } = this.areas(clientWidth, clientHeight)[0];
    if (this.moved) {
      this.camera.aspect = width / height;
      this.camera.updateProjectionMatrix();
    } else {
      this.fit(width / height);
    }
    this.draw();
  }

  private newControls(): OrbitControls {
    const controls = new OrbitControls(this.camera, this.canvas);
    controls.autoRotateSpeed = turnsAMinute;
    controls.addEventListener('change', () => this.draw());
    controls.addEventListener('start', () => (this.moved = true));
    return controls;
  }

  /** Chooses what is upright. Controls turn about what the camera's up is when they are made. */
  private setUp(up: Vector3): void {
    const { target, autoRotate, enabled } = this.controls;
    this.camera.up.copy(up);
    this.controls.dispose();
    this.controls = this.newControls();
    this.controls.target.copy(target);
    Object.assign(this.controls, { autoRotate, enabled });
    for (const { sky, ground } of this.cells) {
      sky.position.copy(up);
      ground.place(up);
    }
  }

  private cell(mesh: Shown): Cell {
    const scene = new Scene();
    const lights = new Group();
    const key = new DirectionalLight(0xffffff, 2.0);
    key.position.set(-0.5, 0.8, 1);
    const fill = new DirectionalLight(0xdfe8ff, 0.7);
    fill.position.set(1, 0.1, 0.6);
    const sky = new HemisphereLight(0xffffff, 0x8a8f99, 1.1);
    const ground = new Ground();
    lights.add(key, key.target, fill, fill.target);
    scene.add(mesh, lights, sky, ground);
    return { scene, lights, sky, ground, mesh };
  }

  /** The parts of the canvas: side by side, or one above the other where it is high. */
  private areas(width: number, height: number) {
    const count = this.cells.length;
    return this.cells.map((_, i) =>
      width >= height
        ? { x: (i * width) / count, y: 0, width: width / count, height }
        : { x: 0, y: ((count - 1 - i) * height) / count, width, height: height / count },
    );
  }

  private fit(aspect: number): void {
    const { camera } = this;
    const up = camera.up.clone();
    const right = up.cross(this.eye).normalize();
    const above = this.eye.clone().cross(right);
    const tangent = Math.tan((fieldOfView * Math.PI) / 360);
    // In perspective the middle of the box is not the middle of the picture, because near parts
    // look larger.
    const target = new Vector3();
    let distance = 10;
    for (let round = 0; round < 4; ++round) {
      const [x, y] = [right, above].map((axis) => this.range(axis, target, distance));
      target.addScaledVector(right, (distance * (x.low + x.high)) / 2);
      target.addScaledVector(above, (distance * (y.low + y.high)) / 2);
      distance = 0.1;
      for (const point of this.samples) {
        const from = point.clone().sub(target);
        const [dx, dy] = [Math.abs(from.dot(right)), Math.abs(from.dot(above))];
        const needed = from.dot(this.eye) + (margin * Math.max(dy, dx / aspect)) / tangent;
        distance = Math.max(distance, needed);
      }
    }
    camera.aspect = aspect;
    camera.near = distance / 50;
    camera.far = 10 * distance;
    camera.position.copy(target).addScaledVector(this.eye, distance);
    camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    this.controls.update();
  }

  /** The extent of the shapes along `axis` seen from `distance`, as tangents of angles of view. */
  private range(axis: Vector3, target: Vector3, distance: number) {
    let [low, high] = [Infinity, -Infinity];
    for (const point of this.samples) {
      const from = point.clone().sub(target);
      const tangent = from.dot(axis) / Math.max(1e-3, distance - from.dot(this.eye));
      low = Math.min(low, tangent);
      high = Math.max(high, tangent);
    }
    return { low, high };
  }

  private frame(now: number): void {
    this.wanted = false;
    const seconds = this.last > 0 ? Math.min(0.25, (now - this.last) / 1000) : 0;
    const turns = this.controls.autoRotate;
    if (turns) this.controls.update(seconds);
    const again = this.advance(seconds) || turns;
    this.drawNow();
    this.last = again ? now : 0;
    if (again) this.draw();
  }

  private onKey(event: KeyboardEvent): void {
    const turns: Record<string, [number, number]> = {
      ArrowLeft: [-0.1, 0],
      ArrowRight: [0.1, 0],
      ArrowUp: [0, -0.1],
      ArrowDown: [0, 0.1],
    };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key in turns) this.turn(...turns[event.key]);
    else if (event.key === '+' || event.key === '=') this.zoom(1 / 1.1);
    else if (event.key === '-') this.zoom(1.1);
    else if (event.key === 'Home') this.showAll();
    else return;
    event.preventDefault();
  }

  private turn(around: number, down: number): void {
    const { camera, controls } = this;
    const toY = new Quaternion().setFromUnitVectors(camera.up, new Vector3(0, 1, 0));
    const offset = camera.position.clone().sub(controls.target).applyQuaternion(toY);
    const spherical = new Spherical().setFromVector3(offset);
    spherical.theta += around;
    spherical.phi += down;
    spherical.makeSafe();
    offset.setFromSpherical(spherical).applyQuaternion(toY.invert());
    camera.position.copy(controls.target).add(offset);
    this.afterKeys();
  }

  private zoom(factor: number): void {
    const { camera, controls } = this;
    camera.position.sub(controls.target).multiplyScalar(factor).add(controls.target);
    this.afterKeys();
  }

  private afterKeys(): void {
    this.moved = true;
    this.controls.update();
    this.draw();
  }
}

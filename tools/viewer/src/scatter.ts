// The poses at their coordinates in two modes.
import { svg } from './dom';
import type { ModesScene } from './scene_data';

const height = 220;
const border = 22;

export class Scatter {
  private readonly picture = svg('svg', { class: 'scatter', height, role: 'group' });
  private modes: [number, number] = [0, 0];
  private coordinates: number[] = [];
  private here: SVGCircleElement | null = null;

  constructor(
    private readonly parent: HTMLElement,
    private readonly scene: ModesScene,
    private readonly onPose: (pose: number) => void,
  ) {
    this.picture.setAttribute('aria-label', 'The poses in two modes');
    parent.append(this.picture);
    new ResizeObserver(() => this.layOut()).observe(parent);
  }

  /** The modes across and upward. */
  choose(across: number, upward: number): void {
    this.modes = [across, upward];
    this.layOut();
  }

  /** Marks the coordinates that are shown. */
  show(coordinates: number[]): void {
    this.coordinates = coordinates;
    const [x, y] = this.place(coordinates);
    this.here?.setAttribute('transform', `translate(${x} ${y})`);
  }

  private get width(): number {
    return Math.max(1, this.parent.clientWidth);
  }

  private place(coordinates: number[]): [number, number] {
    const { places } = this.scene;
    const most = Math.max(Math.abs(places[0]), places[places.length - 1]);
    const [x, y] = this.modes.map((mode) => (coordinates[mode] ?? 0) / most);
    return [
      (this.width * (1 + x)) / 2 - x * border,
      (height * (1 - y)) / 2 + y * border,
    ];
  }

  private layOut(): void {
    const { picture, width } = this;
    picture.replaceChildren();
    picture.setAttribute('width', String(width));
    const [across, upward] = this.modes;
    svg('line', { class: 'axis', x1: 0, x2: width, y1: height / 2, y2: height / 2 }, picture);
    svg('line', { class: 'axis', x1: width / 2, x2: width / 2, y1: 0, y2: height }, picture);
    const right = svg('text', { x: width - 4, y: height / 2 - 5, 'text-anchor': 'end' }, picture);
    right.textContent = `mode ${across + 1}`;
    svg('text', { x: width / 2 + 5, y: 13 }, picture).textContent = `mode ${upward + 1}`;
    this.here = svg('circle', { class: 'here', r: 8 }, picture);
    this.scene.names.forEach((name, pose) => {
      const [x, y] = this.place(this.scene.coordinates[pose]);
      const mark = svg(
        'g',
        { class: 'pose', tabindex: 0, role: 'button', transform: `translate(${x} ${y})` },
        picture,
      );
      mark.setAttribute('aria-label', name);
      svg('title', {}, mark).textContent = name;
      svg('circle', { class: 'target', r: 14 }, mark);
      svg('circle', { class: 'dot', r: 5 }, mark);
      mark.addEventListener('click', () => this.onPose(pose));
      mark.addEventListener('keydown', (event) => {
        if (event.key !== 'Enter' && event.key !== ' ') return;
        event.preventDefault();
        event.stopPropagation();
        this.onPose(pose);
      });
    });
    this.show(this.coordinates);
  }
}

// Picking vertices: markers on two bodies, or parts of one.
import { Vector3 } from 'three';
import type { BlendedMesh } from './blended_mesh';
import { quoted, startCopy } from './command_line';
import { byId, svg, tell } from './dom';
import { showBack, trianglesAt, vertexOnRay, verticesInside } from './hit';
import {
  handlesText,
  markersText,
  selectionText,
  standingText,
  type Marker,
  type Part,
} from './picked_files';
import { download } from './record';
import type { Stage } from './stage';

type Mode = 'none' | 'markers' | 'selection' | 'handles' | 'standing';

const titles: Record<Mode, string> = {
  none: 'no',
  markers: 'markers',
  selection: 'a selection',
  handles: 'handles',
  standing: 'standing parts',
};
const colours = [0xd1495b, 0x1f5fae, 0x2a7f3f, 0x8a4fbf, 0xb0640c, 0x0b7a86];
/** Pixels that the pointer may move in a click. */
const clickReach = 5;

interface Picked {
  markers: Marker[];
  /** The vertices of a marker that is not complete. */
  pending: [number | null, number | null];
  parts: Part[];
  current: number;
}

export class Picking {
  private mode: Mode = 'none';
  private picked: Picked;
  private readonly before: Picked[] = [];
  private outline: [number, number][] | null = null;
  /** Of each body, where the triangles at its markers begin. */
  private around: Map<number, number[]>[] = [];
  private readonly labels = byId<HTMLElement>('labels');

  /** `poses` is the number of a path's poses, 0 for a mesh; `markers` are picked already. */
  constructor(
    private readonly stage: Stage,
    private readonly meshes: BlendedMesh[],
    private readonly files: string[],
    private readonly poses: number,
    markers: Marker[] = [],
  ) {
    this.picked = { markers, pending: [null, null], parts: [this.newPart(1)], current: 0 };
    const modes: Mode[] =
      meshes.length > 1
        ? ['markers']
        : poses > 0
          ? ['none', 'selection', 'standing']
          : ['none', 'selection', 'handles', 'standing'];
    const select = byId<HTMLSelectElement>('pick-mode');
    for (const mode of modes) select.add(new Option(titles[mode], mode));
    select.addEventListener('change', () => this.choose(select.value as Mode));
    byId('pick-panel').hidden = false;
    byId('pick-mode-option').hidden = modes.length < 2;
    byId('pick-new').addEventListener('click', () =>
      this.change((picked) => {
        picked.parts.push(this.newPart(picked.parts.length + 1));
        picked.current = picked.parts.length - 1;
      }),
    );
    byId('pick-undo').addEventListener('click', () => {
      const last = this.before.pop();
      if (!last) return tell('There is nothing to undo.');
      this.picked = last;
      this.show();
    });
    byId('pick-save').addEventListener('click', () => this.save());
    startCopy(byId<HTMLTextAreaElement>('pick-command'), byId('pick-copy'));
    this.listen();
    stage.onDrawn = () => this.placeLabels();
    this.choose(modes[0]);
  }

  private newPart(number: number): Part {
    return {
      name: `part ${number}`,
      vertices: new Set(),
      translation: [0, 0, 0],
      poses: [1, Math.max(2, this.poses)],
    };
  }

  private choose(mode: Mode): void {
    this.mode = mode;
    for (const id of ['picked', 'pick-undo', 'pick-save', 'pick-then']) {
      byId(id).hidden = mode === 'none';
    }
    byId('pick-tool-option').hidden = mode === 'none' || mode === 'markers';
    byId('pick-new').hidden = mode !== 'handles' && mode !== 'standing';
    byId<HTMLTextAreaElement>('pick-command').value = this.command();
    this.show();
  }

  private command(): string {
    const files = this.files.map(quoted).join(' ');
    if (this.mode === 'markers') {
      return `shape-correspond ${files} --markers markers.txt --output fitted.obj,map.txt,check.png`;
    }
    if (this.mode === 'handles') {
      return `shape-deform ${files} --handles handles.json --output deformed.obj`;
    }
    const file = this.mode === 'selection' ? 'selection.json' : 'anchor.json';
    const tool = this.poses > 0 ? `shape-export ${files}` : `shape-interpolate ${files} OTHER`;
    return `${tool} --anchor "$(cat ${file})" --output anchored%03d.obj`;
  }

  private get lasso(): boolean {
    const drawn = byId<HTMLSelectElement>('pick-tool').value !== 'click';
    return drawn && this.mode !== 'none' && this.mode !== 'markers';
  }

  private listen(): void {
    const { canvas } = this.stage;
    const area = canvas.parentElement!;
    let down: [number, number] | null = null;
    const place = (event: PointerEvent): [number, number] => {
      const { left, top } = canvas.getBoundingClientRect();
      return [event.clientX - left, event.clientY - top];
    };
    // Before the camera's controls hear of it.
    area.addEventListener(
      'pointerdown',
      (event) => {
        down = event.button === 0 && event.isPrimary ? place(event) : null;
        if (!down || !this.lasso || event.target !== canvas) return;
        this.stage.turnable = false;
        this.outline = [down];
        canvas.setPointerCapture(event.pointerId);
      },
      { capture: true },
    );
    area.addEventListener('pointermove', (event) => {
      if (!this.outline) return;
      this.outline.push(place(event));
      this.placeLabels();
    });
    const end = (event: PointerEvent, isDone: boolean) => {
      const { outline } = this;
      this.outline = null;
      this.stage.turnable = true;
      const start = down;
      down = null;
      if (!isDone || !start || this.mode === 'none') return;
      if (outline) return this.takeInside(outline);
      const [x, y] = place(event);
      if (Math.hypot(x - start[0], y - start[1]) > clickReach) return;
      this.click(event.clientX, event.clientY);
    };
    area.addEventListener('pointerup', (event) => end(event, true));
    area.addEventListener('pointercancel', (event) => end(event, false));
  }

  private click(clientX: number, clientY: number): void {
    const ray = this.stage.rayAt(clientX, clientY);
    if (!ray) return;
    const mesh = this.meshes[ray.body];
    const vertex = vertexOnRay(mesh.body, mesh.positionsShown(), ray.origin, ray.direction);
    if (vertex === null) return;
    if (this.mode === 'markers') this.takeMarker(ray.body, vertex);
    else {
      this.change(({ parts, current }) => {
        if (!parts[current].vertices.delete(vertex)) parts[current].vertices.add(vertex);
      });
    }
  }

  private takeMarker(body: number, vertex: number): void {
    const taken = this.picked.markers.findIndex((marker) => marker[body] === vertex);
    if (taken >= 0) return tell(`Vertex ${vertex + 1} has marker ${taken + 1} already.`);
    tell('');
    this.change((picked) => {
      picked.pending[body] = vertex;
      const [a, b] = picked.pending;
      if (a === null || b === null) return;
      picked.markers.push([a, b]);
      picked.pending = [null, null];
    });
  }

  private takeInside(outline: [number, number][]): void {
    const positions = this.meshes[0].positionsShown();
    const inside = verticesInside(positions, this.stage.projector(0), outline);
    const leaveOut = byId<HTMLSelectElement>('pick-tool').value === 'without';
    this.change(({ parts, current }) => {
      for (const vertex of inside) {
        if (leaveOut) parts[current].vertices.delete(vertex);
        else parts[current].vertices.add(vertex);
      }
    });
  }

  /** Changes what is picked so that it can be undone. A vertex is in one part at the most. */
  private change(act: (picked: Picked) => void): void {
    this.before.push(structuredClone(this.picked));
    act(this.picked);
    const { parts, current } = this.picked;
    parts.forEach(({ vertices }, i) => {
      if (i === current) return;
      for (const vertex of parts[current].vertices) vertices.delete(vertex);
    });
    this.show();
  }

  private show(): void {
    this.meshes.forEach((mesh, body) => {
      const marked = new Map<number, number>();
      if (this.mode === 'markers') {
        this.markersOf(body).forEach(([number, vertex]) =>
          marked.set(vertex, colours[(number - 1) % colours.length]),
        );
      } else if (this.mode !== 'none') {
        this.partsShown().forEach(({ vertices }, i) => {
          for (const vertex of vertices) marked.set(vertex, colours[i % colours.length]);
        });
      }
      mesh.mark(marked);
    });
    this.around = this.meshes.map(({ body }, i) =>
      trianglesAt(
        body,
        this.markersOf(i).map(([, vertex]) => vertex),
      ),
    );
    byId('picked').replaceChildren(
      ...(this.mode === 'markers' ? this.markerRows() : this.partRows()),
    );
    this.stage.draw();
  }

  private partsShown(): Part[] {
    return this.mode === 'selection' ? [this.picked.parts[this.picked.current]] : this.picked.parts;
  }

  /** The numbers of markers and their vertices on a body, and that of the incomplete one. */
  private markersOf(body: number): [number, number][] {
    const { markers, pending } = this.picked;
    const list = markers.map((marker, i): [number, number] => [i + 1, marker[body]]);
    const open = pending[body];
    return open === null ? list : [...list, [markers.length + 1, open]];
  }

  private row(text: string, onRemove: () => void, number: number): HTMLLIElement {
    const row = document.createElement('li');
    const label = document.createElement('span');
    label.textContent = text;
    const remove = document.createElement('button');
    remove.type = 'button';
    remove.textContent = 'Remove';
    remove.setAttribute('aria-label', `Remove ${number}`);
    remove.addEventListener('click', onRemove);
    row.append(label, remove);
    return row;
  }

  private markerRows(): HTMLLIElement[] {
    const { markers, pending } = this.picked;
    const text = (vertex: number | null) => (vertex === null ? '\u2026' : String(vertex + 1));
    const open = pending.some((vertex) => vertex !== null);
    return [...markers, ...(open ? [pending] : [])].map(([a, b], i) =>
      this.row(
        `${text(a)} \u2013 ${text(b)}`,
        () =>
          this.change((picked) => {
            if (i < picked.markers.length) picked.markers.splice(i, 1);
            else picked.pending = [null, null];
          }),
        i + 1,
      ),
    );
  }

  private partRows(): HTMLLIElement[] {
    return this.partsShown().map((part, i) => {
      const count = part.vertices.size;
      const row = this.row(
        `${part.name}: ${count} ${count === 1 ? 'vertex' : 'vertices'}`,
        () =>
          this.change((picked) => {
            picked.parts.splice(picked.parts.indexOf(part), 1);
            if (picked.parts.length === 0) picked.parts.push(this.newPart(1));
            picked.current = Math.min(picked.current, picked.parts.length - 1);
          }),
        i + 1,
      );
      if (this.mode === 'selection') return row;
      const choose = document.createElement('button');
      choose.type = 'button';
      choose.textContent = 'Pick';
      choose.setAttribute('aria-label', `Pick vertices of ${part.name}`);
      choose.setAttribute('aria-pressed', String(i === this.picked.current));
      choose.addEventListener('click', () => {
        this.picked.current = i;
        this.show();
      });
      row.prepend(choose);
      const numbers = this.mode === 'handles' ? part.translation : part.poses;
      const names =
        this.mode === 'handles' ? ['moves by x', 'y', 'z'] : ['stands from pose', 'to pose'];
      const fields = names.map((name, k) => this.field(name, numbers, k));
      const line = document.createElement('div');
      line.append(...fields);
      row.append(line);
      return row;
    });
  }

  private field(name: string, numbers: number[], k: number): HTMLLabelElement {
    const label = document.createElement('label');
    const input = document.createElement('input');
    Object.assign(input, { type: 'number', value: String(numbers[k]) });
    if (this.mode === 'standing') {
      input.min = '1';
      if (this.poses > 0) input.max = String(this.poses);
    } else {
      input.step = 'any';
    }
    input.addEventListener('change', () => {
      if (input.value !== '' && input.checkValidity()) numbers[k] = Number(input.value);
      input.value = String(numbers[k]);
      this.stage.draw();
    });
    label.append(name, input);
    return label;
  }

  /** Numbers beside markers, pale on the side that is not seen, and the outline that is being drawn. */
  private placeLabels(): void {
    this.labels.replaceChildren();
    if (this.outline) {
      svg('polyline', { class: 'outline', points: this.outline.join(' ') }, this.labels);
    }
    if (this.mode !== 'markers') return;
    const point = new Vector3();
    this.meshes.forEach((mesh, body) => {
      const project = this.stage.projector(body);
      const { shapes, triangles } = mesh.body;
      const seen = (vertex: number) =>
        project(point.fromArray(shapes[0], 4 * vertex).divideScalar(65535));
      for (const [number, vertex] of this.markersOf(body)) {
        const [x, y] = seen(vertex);
        const corners = this.around[body]
          .get(vertex)!
          .flatMap((first) => [0, 1, 2].map((k) => seen(triangles[first + k])));
        const at = { class: showBack(corners) ? 'behind' : '', x: x + 7, y: y - 7 };
        svg('text', at, this.labels).textContent = String(number);
      }
    });
  }

  private save(): void {
    const { markers } = this.picked;
    if (this.mode === 'markers') {
      if (markers.length === 0) return tell('No file: no marker is complete.');
      return this.write('markers.txt', markersText(this.files, markers));
    }
    const parts = this.partsShown();
    const empty = parts.find(({ vertices }) => vertices.size === 0);
    if (empty) return tell(`No file: ${empty.name} has no vertex.`);
    if (this.mode === 'selection') return this.write('selection.json', selectionText(parts[0]));
    if (this.mode === 'handles') return this.write('handles.json', handlesText(parts));
    const backward = parts.find(({ poses }) => poses[1] < poses[0]);
    if (backward) return tell(`No file: ${backward.name} stands until before it begins.`);
    this.write('anchor.json', standingText(parts));
  }

  private write(name: string, text: string): void {
    download(new Blob([text], { type: 'text/plain' }), name);
    tell(`${name} is saved.`);
  }
}

// A shape model: sliders of its modes and of scalars, and the poses at their coordinates.
import { BlendedMesh } from './blended_mesh';
import { quoted, startCopy } from './command_line';
import { byId, perCent, shortNumber, themeValue } from './dom';
import { ofModes } from './explanations';
import { explain } from './help';
import { KeyShapes } from './key_shapes';
import { startOptions, stem } from './options';
import { Scatter } from './scatter';
import type { ModesScene } from './scene_data';
import { Stage } from './stage';
import { onTheme } from './theme';
import { startTransport } from './transport';

/** How far playing takes a mode, in standard deviations. */
const reach = 2;

function facts({ names, vertices, triangles }: ModesScene): string {
  return (
    `${names.length} poses, ${vertices.toLocaleString('en')} vertices, ` +
    `${(triangles.length / 3).toLocaleString('en')} triangles`
  );
}

class Slider {
  private readonly input = document.createElement('input');
  private readonly output = document.createElement('output');

  constructor(parent: HTMLElement, name: string, least: number, most: number, onInput: () => void) {
    const label = document.createElement('label');
    label.className = 'slider';
    const text = document.createElement('span');
    text.textContent = name;
    Object.assign(this.input, { type: 'range', min: least, max: most, step: 'any' });
    label.append(text, this.output, this.input);
    parent.append(label);
    this.input.addEventListener('input', () => {
      this.value = Number(this.input.value);
      onInput();
    });
  }

  get value(): number {
    return Number(this.input.value);
  }
  set value(value: number) {
    this.input.value = String(value);
    this.output.textContent = shortNumber(value);
    this.input.setAttribute('aria-valuetext', shortNumber(value));
  }
}

function fillWithModes(select: HTMLSelectElement, count: number, chosen: number): void {
  for (let k = 0; k < count; ++k) {
    select.add(new Option(`mode ${k + 1}`, String(k), false, k === chosen));
  }
}

export function showModes(scene: ModesScene): void {
  byId('title').textContent = scene.name;
  byId('facts').textContent = facts(scene);
  byId('modes-panel').hidden = false;
  byId('colour-option').hidden = true;
  byId('film').hidden = true;
  byId('preview').textContent =
    `What is shown is a preview, typically ${perCent(scene.error)} of the body's size away from the ` +
    'exact shape, which this command writes:';

  const modes = scene.shares.length;
  const [least, most] = [scene.places[0], scene.places[scene.places.length - 1]];
  const keys = new KeyShapes(scene);
  const mesh = new BlendedMesh({ ...scene, ...keys.body });
  const stage: Stage = new Stage(byId<HTMLCanvasElement>('canvas'), [mesh], (seconds) =>
    player.advance(seconds),
  );
  onTheme(() => stage.setBackground(themeValue('--stage')));

  let coordinates = scene.shares.map(() => 0);
  const command = byId<HTMLTextAreaElement>('command');
  const show = () => {
    keys.showAt(coordinates);
    mesh.refresh();
    stage.draw();
    scatter.show(coordinates);
    const words = coordinates.map((value) => shortNumber(Math.round(1000 * value) / 1000));
    command.value =
      `shape-statistics ${quoted(scene.file)} --at ${words.join(',')} --output shape.obj`;
  };
  const go = (to: number[]) => {
    coordinates = to.map((value) => Math.min(most, Math.max(least, value)));
    sliders.forEach((slider, k) => (slider.value = coordinates[k]));
    show();
  };

  let playing = 0; // the mode that was moved last
  const player = startTransport(
    (place) => {
      if (!player || !player.playing) return;
      go(coordinates.map((value, k) => (k === playing ? reach * (2 * place - 1) : value)));
    },
    () => stage.draw(),
    () => `mode ${playing + 1}`,
  );
  const scalarSliders = scene.scalars.map(({ name, least, most, value }) => {
    const slider = new Slider(byId('scalars'), name, least, most, () => {
      player.pause();
      go(
        scene.intercept.map((start, k) =>
          scalarSliders.reduce((sum, { value }, s) => sum + value * scene.slopes[s][k], start),
        ),
      );
    });
    slider.value = value;
    return slider;
  });
  const sliders = scene.shares.map((share, k) => {
    const name = `Mode ${k + 1}, ${perCent(share)} of the differences`;
    return new Slider(byId('modes'), name, least, most, () => {
      player.pause();
      playing = k;
      coordinates[k] = sliders[k].value;
      show();
    });
  });
  const across = byId<HTMLSelectElement>('across');
  const upward = byId<HTMLSelectElement>('upward');
  fillWithModes(across, modes, 0);
  fillWithModes(upward, modes, Math.min(1, modes - 1));
  const scatter = new Scatter(byId('scatter'), scene, (pose) => {
    player.pause();
    go(scene.coordinates[pose]);
    byId('pose').textContent = `The shape at the coordinates of ${scene.names[pose]}.`;
  });
  const choose = () => scatter.choose(Number(across.value), Number(upward.value));
  across.addEventListener('change', choose);
  upward.addEventListener('change', choose);
  choose();

  byId('to-mean').addEventListener('click', () => {
    player.pause();
    go(scene.shares.map(() => 0));
  });
  startCopy(command, byId('copy'));
  startOptions(stage, [mesh], player, () => stem(scene.name));
  go(coordinates);
  explain(ofModes, `${facts(scene)}.`);
}

// One path, or two side by side.
import { BlendedMesh } from './blended_mesh';
import { contactFigures, contactValues } from './contacts';
import { byId, perCent, shortNumber, showNames, themeValue } from './dom';
import { ofPaths } from './explanations';
import { ghostsOf } from './ghosts';
import { explain } from './help';
import { box, prefersStillness, prepareWhenIdle, startOptions, stem } from './options';
import { Picking } from './picking';
import { blendAt, placeOf, whereabouts } from './place';
import { Plot, type Series } from './plots';
import { markPoses } from './pose_marks';
import { markGradient, rampGradient } from './ramp';
import type { PathScene } from './scene_data';
import { Bones } from './skeleton';
import { Stage } from './stage';
import { onTheme } from './theme';
import { setRepeat, startTransport } from './transport';

function facts({ vertices, triangles, shapes }: PathScene): string {
  const faces = triangles.length > 0 ? `, ${(triangles.length / 3).toLocaleString('en')} triangles` : '';
  return `${shapes.length} shapes, ${vertices.toLocaleString('en')} vertices${faces}`;
}

/** With the metric, which few want to know at first. */
function allFacts(scene: PathScene): string {
  const by = scene.metric ? `, found with the metric ${scene.metric}` : '';
  return `${scene.name}: ${facts(scene)}${by}.`;
}

/** The poses as ghosts, where there are any and they are not all that is shown. */
function offerGhosts(scenes: PathScene[], meshes: BlendedMesh[], stage: Stage): void {
  const canHave = ({ poses, shapes, triangles }: PathScene) =>
    poses.length > 0 && shapes.length > 1 && triangles.length > 0;
  byId('ghosts-option').hidden = !scenes.every(canHave);
  let ghosts: ReturnType<typeof ghostsOf>[] = [];
  box('ghosts', false, (on) => {
    if (ghosts.length === 0) {
      ghosts = scenes.map(ghostsOf);
      meshes.forEach((mesh, i) => mesh.add(ghosts[i]));
    }
    for (const group of ghosts) group.visible = on;
    stage.draw();
  });
}

/** The bones, where there are any. Returns what is to be called when another shape is shown. */
function offerBones(scenes: PathScene[], meshes: BlendedMesh[], stage: Stage): (place: number) => void {
  const all = scenes.map(({ skeleton }) => (skeleton ? new Bones(skeleton) : null));
  byId('bones-option').hidden = all.every((bones) => bones === null);
  all.forEach((bones, i) => {
    if (!bones) return;
    bones.visible = false;
    meshes[i].add(bones);
  });
  let shown = 0;
  const place = () =>
    all.forEach((bones, i) => {
      if (bones?.visible) bones.show(blendAt(scenes[i], shown));
    });
  box('bones', false, (on) => {
    for (const bones of all) if (bones) bones.visible = on;
    place();
    stage.draw();
  });
  return (now) => {
    shown = now;
    place();
  };
}

function showLegend(title: string, colours: string, start: string, end: string): void {
  byId('legend-title').textContent = title;
  byId('ramp').style.background = colours;
  byId('ramp-start').textContent = start;
  byId('ramp-end').textContent = end;
}

/** Returns what is to be called when another shape is shown. */
function showColours(scenes: PathScene[], meshes: BlendedMesh[], stage: Stage): () => void {
  const select = byId<HTMLSelectElement>('colour');
  const hide = (value: string, hidden: boolean) => {
    const option = select.querySelector<HTMLOptionElement>(`option[value=${value}]`);
    if (option) option.hidden = option.disabled = hidden;
  };
  hide('energy', scenes.some(({ energyEnd }) => energyEnd === null));
  hide('parts', scenes.some(({ partColours }) => partColours === null));
  hide('contacts', scenes.some(({ intersections }) => intersections === null));
  select.value = 'plain';
  const showFigures = () => {
    if (select.value !== 'contacts') return;
    const figures = scenes.map((scene, i) => contactFigures(scene, meshes[i].nearest));
    byId('contacts').textContent = figures
      .map((text, i) => (scenes.length > 1 ? `${'AB'[i]}: ${text}` : text))
      .join('\n');
  };
  const showScale = (title: string, ends: number[], format: (value: number) => string) => {
    const end = Math.max(...ends);
    meshes.forEach((mesh, i) => mesh.colourByValue(ends[i], end));
    showLegend(title, rampGradient(), '0', `${format(end)} and more`);
  };
  const exchange = (values: Uint16Array[][]) =>
    values.forEach((ofScene, i) => meshes[i].exchangeValues(ofScene));
  let instead: Uint16Array[][] = []; // shown in place of the deviations, which it holds meanwhile
  select.addEventListener('change', () => {
    exchange(instead);
    instead = [];
    if (select.value === 'energy') instead = scenes.map(({ energies }) => energies);
    if (select.value === 'contacts') instead = scenes.map(contactValues);
    exchange(instead);
    byId('legend').hidden = select.value === 'plain';
    byId('ramp').hidden = byId('ramp-numbers').hidden = select.value === 'parts';
    byId('contacts').hidden = select.value !== 'contacts';
    if (select.value === 'deviation') {
      const ends = scenes.map(({ scaleEnd }) => scaleEnd);
      showScale('Edges longer or shorter than in the first shape, by', ends, perCent);
    } else if (select.value === 'energy') {
      const ends = scenes.map(({ energyEnd }) => energyEnd ?? 0);
      showScale('Energy of the motion (squared speed per area)', ends, shortNumber);
    } else if (select.value === 'contacts') {
      for (const mesh of meshes) mesh.colourByMark();
      showLegend('Where the surface passes through itself', markGradient(), 'it does not', 'it does');
    } else {
      meshes.forEach((mesh, i) => {
        const { partColours } = scenes[i];
        if (select.value === 'parts' && partColours) {
          mesh.colourBy(partColours);
          byId('legend-title').textContent =
            'Each colour is a part that keeps its shape nearly. What bends is grey.';
        }
        else mesh.colourAsItIs();
      });
    }
    showFigures();
    stage.draw();
  });
  return showFigures;
}

/** The squared speed: of a smooth path in the middle of every segment, of another one where it begins. */
function energyPoints(scene: PathScene): [number, number][] {
  const speeds = scene.speeds as number[];
  const [first, last] = [speeds[0], speeds[speeds.length - 1]];
  if (!scene.smooth) return [...speeds, last].map((speed, k) => [placeOf(scene, k), speed]);
  const inner = speeds.map((speed, k): [number, number] => [
    (placeOf(scene, k) + placeOf(scene, k + 1)) / 2,
    speed,
  ]);
  return [[0, first], ...inner, [1, last]];
}

function showPlots(scenes: PathScene[], onSeek: (place: number) => void): Plot[] {
  const parent = byId('plots');
  const plots: Plot[] = [];
  const prefix = (i: number) => (scenes.length > 1 ? `${'AB'[i]}: ` : '');
  const colour = (i: number) => (i === 0 ? 1 : 2);
  const poses = scenes.flatMap((scene) => scene.poses.map((shape) => placeOf(scene, shape)));
  const moving = scenes.flatMap((scene, i) => (scene.shapes.length > 1 ? [{ scene, i }] : []));
  const energies: Series[] = moving
    .filter(({ scene }) => scene.speeds.every((speed) => speed !== null))
    .map(({ scene, i }) => ({
      name: prefix(i),
      points: energyPoints(scene),
      colour: colour(i),
      steps: !scene.smooth,
    }));
  if (energies.length > 0) {
    plots.push(new Plot(parent, 'Energy of the motion', energies, poses, shortNumber, onSeek));
  }
  for (const [figure, title] of [
    ['rms', 'Edges longer or shorter, typically by'],
    ['max', 'Edges longer or shorter, at most by'],
  ] as const) {
    const deviations: Series[] = moving.map(({ scene, i }) => ({
      name: prefix(i),
      points: scene[figure].map((value, k) => [placeOf(scene, k), value]),
      colour: colour(i),
    }));
    if (deviations.length === 0) continue;
    plots.push(new Plot(parent, title, deviations, poses, perCent, onSeek));
  }
  return plots;
}

/** Whether a motion ends as it began. */
function isClosed({ shapes }: PathScene): boolean {
  const [first, last] = [shapes[0], shapes[shapes.length - 1]];
  return shapes.length > 2 && first.every((value, i) => Math.abs(value - last[i]) < 655);
}

export function showPaths(scenes: PathScene[]): void {
  const names = scenes.map(({ name }) => name);
  showNames(names, scenes.map(facts));
  const meshes = scenes.map((scene) => new BlendedMesh(scene));
  const stage: Stage = new Stage(byId<HTMLCanvasElement>('canvas'), meshes, (seconds) =>
    player.advance(seconds),
  );
  const showFigures = showColours(scenes, meshes, stage);
  const showBones = offerBones(scenes, meshes, stage);
  let plots: Plot[] = [];
  const player = startTransport(
    (place) => {
      meshes.forEach((mesh, i) => mesh.show(blendAt(scenes[i], place)));
      for (const plot of plots) plot.show(place);
      showBones(place);
      showFigures();
      stage.draw();
    },
    () => stage.draw(),
    (place) => whereabouts(scenes[0], place),
  );
  plots = showPlots(scenes, (place) => {
    player.pause();
    player.seek(place);
  });
  markPoses(scenes);
  startOptions(stage, meshes, player, () => names.map(stem).join('-'));
  offerGhosts(scenes, meshes, stage);
  // A glb has no poses, and its vertices are not those of the mesh it was made of; a click finds a
  // triangle, which graphs do not have.
  const [{ poses, triangles }] = scenes;
  if (scenes.length === 1 && poses.length > 0 && triangles.length > 0) {
    new Picking(stage, meshes, [scenes[0].file || names[0]], poses.length);
  }
  onTheme(() => stage.setBackground(themeValue('--stage')));
  if (scenes.every(isClosed)) setRepeat(player, 'loop');
  player.seek(0);
  prepareWhenIdle(meshes);
  const canMove = scenes.some((scene) => scene.shapes.length > 1);
  byId('transport').hidden = !canMove;
  explain(ofPaths(scenes.length, canMove), scenes.map(allFacts).join(' '));
  if (canMove && !prefersStillness()) player.play();
}

// A space of poses: its plane, and the shape at a point of it.
import { BlendedMesh } from './blended_mesh';
import { Curve } from './curve';
import { byId, shortNumber, tell, themeValue } from './dom';
import { ofSpace } from './explanations';
import { curveToGlb } from './export_glb';
import { explain } from './help';
import { Locator, type Located, type Point } from './locate';
import { prefersStillness, prepareWhenIdle, startOptions, stem } from './options';
import { PlaneView, thumbnailHeight, thumbnailWidth } from './plane';
import { download } from './record';
import type { SpaceScene } from './scene_data';
import { Stage } from './stage';
import { onTheme } from './theme';
import { setRepeat, startTransport } from './transport';

function facts({ names, shapes, vertices, triangles }: SpaceScene): string {
  return (
    `${names.length} poses, ${shapes.length} nodes, ${vertices.toLocaleString('en')} vertices, ` +
    `${(triangles.length / 3).toLocaleString('en')} triangles`
  );
}

function mean(points: Point[]): Point {
  return [0, 1].map((k) => points.reduce((sum, p) => sum + p[k], 0) / points.length) as Point;
}

/** The poses of which the nodes of a blend are made, with their shares. */
function poseWeights({ names, parents }: SpaceScene, { nodes, weights }: Located): number[] {
  const sums = new Array<number>(names.length + parents.length).fill(0);
  nodes.forEach((node, k) => (sums[node] += weights[k]));
  for (let node = sums.length - 1; node >= names.length; --node) {
    for (const parent of parents[node - names.length]) sums[parent] += sums[node] / 2;
  }
  return sums.slice(0, names.length);
}

function describe(scene: SpaceScene, located: Located): string {
  const weights = poseWeights(scene, located);
  const parts = scene.names
    .map((name, pose) => ({ name, share: Math.round(100 * weights[pose]) }))
    .filter(({ share }) => share > 0)
    .sort((a, b) => b.share - a.share)
    .map(({ name, share }) => `${name} ${share}\u2009%`);
  return parts.join(', ');
}

export function showSpace(scene: SpaceScene): void {
  byId('title').textContent = scene.name;
  byId('facts').textContent = facts(scene);
  byId('layout').classList.add('with-plane');
  byId('plane-panel').hidden = false;
  byId('colour-option').hidden = true;
  byId('glb').hidden = false;

  const mesh = new BlendedMesh(scene);
  const locator = new Locator(scene);
  const curve = new Curve();
  const stage: Stage = new Stage(byId<HTMLCanvasElement>('canvas'), [mesh], (seconds) =>
    player.advance(seconds),
  );
  onTheme(() => stage.setBackground(themeValue('--stage')));
  const thumbnails = scene.names.map((_, pose) => {
    mesh.show({ nodes: [pose, pose, pose], weights: [1, 0, 0] });
    return stage.thumbnail(thumbnailWidth, thumbnailHeight);
  });
  stage.resize();

  const status = byId('plane-status');
  const go = (point: Point) => {
    const located = locator.at(point);
    mesh.show(located);
    const words = describe(scene, located);
    plane.setPoint(located.point, words);
    const outside = located.outside
      ? ' That point lies outside: this is the nearest one of the hull.'
      : '';
    status.textContent = words + '.' + outside;
    stage.draw();
    return located;
  };
  const player = startTransport(
    (place) => {
      if (!curve.isEmpty) go(curve.at(place));
    },
    () => {
      if (player.playing && curve.isEmpty) {
        player.pause();
        tell('Draw a curve first, or add points to it.');
      }
      // Screen readers do not read the text while it changes with every frame.
      status.setAttribute('aria-live', player.playing ? 'off' : 'polite');
      stage.draw();
    },
    (place) => `${shortNumber(Math.round(100 * place))}\u2009%`,
  );
  setRepeat(player, 'loop');
  const addPoint = (point: Point) => {
    const located = go(point);
    curve.add(located.point);
    plane.setCurve(curve.points);
    return located;
  };
  const draw = byId<HTMLButtonElement>('draw');
  const setDrawing = (on: boolean) => {
    plane.drawing = on;
    draw.setAttribute('aria-pressed', String(on));
    if (on) tell('Drag across the plane.');
  };
  const clear = () => {
    player.pause();
    curve.clear();
    plane.setCurve([]);
    player.seek(0);
  };
  let point = mean(scene.points.slice(0, scene.names.length));
  const add = () => {
    player.pause();
    const before = curve.points.length;
    addPoint(point);
    const count = curve.points.length;
    tell(count > before ? `The curve has ${count} points.` : 'That point is the last already.');
  };
  const plane: PlaneView = new PlaneView(byId('plane'), scene, thumbnails, {
    onMove: (to) => {
      player.pause();
      point = go(to).point;
    },
    onStroke: (to, isFirst) => {
      if (isFirst) clear();
      point = addPoint(to).point;
    },
    onStrokeEnd: () => {
      setDrawing(false);
      tell('');
      player.seek(0);
      if (!prefersStillness() && curve.points.length > 1) player.play();
    },
    onEnter: add,
  });
  draw.addEventListener('click', () => setDrawing(!plane.drawing));
  byId('add').addEventListener('click', add);
  byId('clear').addEventListener('click', () => {
    clear();
    tell('The curve is cleared.');
  });
  byId('glb').addEventListener('click', () => {
    if (curve.isEmpty) return tell('No glb: draw a curve first.');
    const seconds = player.duration / player.speed;
    curveToGlb(scene, (place) => locator.at(curve.at(place)), seconds).then(
      (glb) => {
        download(new Blob([glb], { type: 'model/gltf-binary' }), `${stem(scene.name)}-curve.glb`);
        tell('The curve is saved.');
      },
      (error: Error) => tell(`No glb: ${error.message}.`),
    );
  });
  startOptions(stage, [mesh], player, () => stem(scene.name), () =>
    curve.isEmpty ? 'draw a curve first' : null,
  );
  player.seek(0);
  point = go(point).point;
  prepareWhenIdle([mesh]);
  explain(ofSpace, `${facts(scene)}.`);
}

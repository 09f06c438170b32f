// The page: poses go in, a motion comes out.
import { byId, tell, themeValue } from '../dom';
import { ofSolver } from '../explanations';
import { showHint } from '../help';
import { onKey } from '../keys';
import { prefersStillness, startOptions, stem } from '../options';
import { timeAt, whereabouts, type Timeline } from '../place';
import type { Player } from '../player';
import { markPoses } from '../pose_marks';
import { Stage } from '../stage';
import { onTheme } from '../theme';
import { startTransport } from '../transport';
import { startDropping } from './dropping';
import { example } from './example';
import { MismatchError, type MeshFile, type Path, type Progress, type Shapespace } from './library';
import { LiveMesh } from './live_mesh';
import { showFindings, showRows } from './pose_rows';
import { PoseSet, type Refused } from './pose_set';
import { answerTo, sentenceOf, showProblems, type Remedy } from './problems';
import { Pulling } from './pulling';
import { save, type Format } from './saving';
import { settings, startSettings } from './settings';
import { Solving } from './solving';
import { hideWork, showWork } from './work';

/** Of a motion through two poses; others take so long for each part. */
const leastSeconds = 3;
const secondsAPart = 2;

/** The last shape alone is shown, and it should follow the pointer. */
const whilePulling = { shapes: 1, tolerance: 0.01, maxIterations: 4 };

/** About what solvers need for each vertex of each shape, and from how much on it is said. */
const bytesAVertex = 600;
const saidFrom = 200e6;

const unfinished =
  'The solver has ended before the motion was as smooth as it could be. Fewer shapes may help.';

/** Previews have no names: these are those of the list. */
function timelineOf({ times, poses }: Path, poseNames: string[]): Timeline {
  return {
    parameters: [...times],
    poses,
    poseNames,
    extrapolated: times.length - 1 - poses[poses.length - 1],
  };
}

const megabytes = (files: MeshFile[]) => files.reduce((sum, { data }) => sum + data.length, 0) / 1e6;

export class SolverPage {
  private readonly poses: PoseSet;
  private readonly solving: Solving;
  private readonly player: Player;
  private mesh: LiveMesh | null = null;
  private stage: Stage | null = null;
  private pulling: Pulling | null = null;
  private path: Path | null = null;
  private timeline: Timeline | null = null;
  private frame = new Float64Array(); // positions of the motion, as they are shown
  private reading: Promise<void> = Promise.resolve();
  private readings = 0;
  private stopReading = new AbortController();
  private pulled = 0;

  constructor(
    solver: Shapespace,
    private readonly helper: Shapespace,
  ) {
    this.poses = new PoseSet(helper);
    this.solving = new Solving(solver, {
      onProgress: (progress) => this.showProgress(progress),
      onPath: (path, isFinal) => this.showPath(path, isFinal),
      onError: (error) => showProblems([sentenceOf(error)]),
      onBusy: (busy) => this.showBusy(busy),
    });
    this.player = startTransport(
      () => this.showMoment(),
      () => this.stage?.draw(),
      (place) => (this.timeline ? whereabouts(this.timeline, place) : ''),
    );
    startSettings(() => this.solve());
    startDropping(
      (files) => this.take(files),
      (sentence) => showProblems([sentence]),
    );
    byId('example').addEventListener('click', () => this.takeExample());
    byId('remove-all').addEventListener('click', () => {
      this.poses.clear();
      showProblems([]);
      this.listChanged();
    });
    byId('cancel').addEventListener('click', () => this.cancel());
    byId('pull').addEventListener('click', () => this.togglePulling());
    onKey('p', () => this.togglePulling());
    onKey('Escape', () => {
      if (this.pulling?.on) this.togglePulling();
    });
    byId('keep').addEventListener('click', () => this.keepPulled());
    byId('unpin').addEventListener('click', () => this.pulling?.removeLast());
    byId('clear-pins').addEventListener('click', () => this.pulling?.clear());
    for (const [id, format] of [
      ['save-glb', 'glb'],
      ['save-frames', 'zip'],
      ['save-path', 'path'],
    ] as [string, Format][]) {
      byId(id).addEventListener('click', () => void this.save(format));
    }
  }

  private get name(): string {
    return this.poses.list.length > 0 ? stem(this.poses.list[0].name) : 'shape';
  }

  // Reading

  /** Reads files after those that came before. */
  private take(files: MeshFile[]): void {
    ++this.readings;
    const { signal } = this.stopReading;
    this.reading = this.reading.then(async () => {
      const what = files.length === 1 ? files[0].name : `${files.length} files`;
      const size = megabytes(files);
      showWork(`Reading ${what}${size < 1 ? '' : `, ${Math.round(size)} MB`}`, null);
      const refused = await this.poses.add(files, signal);
      --this.readings;
      this.showBusy(this.solving.busy);
      if (refused.length < files.length) this.listChanged();
      if (!signal.aborted) this.showRefused(refused, files);
    });
  }

  private showRefused(refused: Refused[], files: MeshFile[]): void {
    if (refused.length === 0) return showProblems([]);
    const remedies: Remedy[] = [];
    const [{ error }] = refused;
    const answer = answerTo(error);
    if (answer) {
      remedies.push({
        text: answer.text,
        act: () => {
          Object.assign(this.poses.meshOptions, answer.options);
          this.take(refused.map(({ file }) => file));
        },
      });
    }
    // Another mesh may well be meant to be the beginning of another motion.
    const isOther = error instanceof MismatchError && !answer && refused.length === files.length;
    if (isOther && this.poses.list.length > 0) {
      remedies.push({
        text: 'Begin anew with it',
        act: () => {
          this.poses.clear();
          this.listChanged();
          this.take(refused.map(({ file }) => file));
        },
      });
    }
    showProblems([...new Set(refused.map((one) => sentenceOf(one.error)))], remedies);
  }

  private takeExample(): void {
    const { indices, poses } = example();
    this.poses.takeMade(poses, indices);
    showProblems([]);
    this.listChanged();
  }

  /** Shows the poses that there are now, and the motion through them as soon as there is one. */
  private listChanged(): void {
    const { list, indices } = this.poses;
    showRows(this.poses, () => this.listChanged());
    showFindings(this.poses);
    byId('layout').classList.toggle('empty', list.length === 0);
    byId('need').hidden = list.length !== 1;
    byId('need').textContent =
      'One pose does not move. Add another one, or pull this one into another pose and keep that.';
    if (list.length < 2) {
      this.solving.cancel();
      this.forgetPath();
    }
    if (list.length === 0) {
      this.pulling?.stop();
      byId('facts').textContent = '';
      return;
    }
    if (indices.length === 0) {
      this.poses.clear();
      this.listChanged();
      return showProblems(['These files have lines and no triangles, and this page shows surfaces only.']);
    }
    this.showBody();
    this.showFacts();
    if (list.length > 1) this.solve(this.path ? undefined : 0);
  }

  /** Shows the mesh in its first pose, if it is another mesh, or there is no motion. */
  private showBody(): void {
    const { list, indices, vertices } = this.poses;
    const shapes = list.map(({ positions }) => positions);
    const { mesh } = this;
    if (!mesh) return this.begin(indices, shapes);
    const isOther = mesh.body.vertices !== vertices || mesh.body.triangles.length !== indices.length;
    if (isOther || !this.path) {
      this.pulling?.stop();
      this.forgetPath();
      mesh.become(indices, shapes);
      byId<HTMLInputElement>('facets').checked = mesh.flat;
    } else {
      mesh.shapes = shapes;
    }
    if (isOther) this.stage!.place();
    else this.stage!.refit();
  }

  /** The first mesh: from now on there is a stage. */
  private begin(indices: Uint32Array, shapes: Float64Array[]): void {
    const mesh = new LiveMesh(indices, shapes);
    const stage = new Stage(byId<HTMLCanvasElement>('canvas'), [mesh], (seconds) =>
      this.player.advance(seconds),
    );
    this.mesh = mesh;
    this.stage = stage;
    const pulling = new Pulling({
      stage,
      mesh,
      labels: byId('labels'),
      deform: (positions) =>
        this.helper.deform(
          { positions, indices: mesh.body.triangles },
          { mesh: this.poses.meshOptions, ...whilePulling },
        ),
      onChange: () => this.showPulling(),
      onError: (error) => showProblems([sentenceOf(error)]),
      tell,
    });
    this.pulling = pulling;
    stage.onDrawn = () => pulling.place();
    startOptions(stage, [mesh], this.player, () => this.name, () =>
      this.path ? null : 'there is no motion yet',
    );
    onTheme(() => stage.setBackground(themeValue('--stage')));
    showHint(ofSolver.hint);
  }

  private showFacts(): void {
    const { list, vertices, triangles } = this.poses;
    const count = (number: number, one: string, more: string) =>
      `${number.toLocaleString('en')} ${number === 1 ? one : more}`;
    const shapes = this.path ? `, ${this.path.shapes.length} shapes` : '';
    byId('facts').textContent =
      `${count(list.length, 'pose', 'poses')}${shapes}, ${count(vertices, 'vertex', 'vertices')}, ` +
      count(triangles, 'triangle', 'triangles');
    document.title = `${this.name} \u2013 shapespace`;
  }

  // Solving

  private solve(delay?: number): void {
    if (this.poses.list.length < 2) return;
    const { options, beyond } = settings();
    showProblems([]);
    const mesh = this.poses.meshOptions;
    this.solving.wish({ poses: this.poses.forSolver(), options: { ...options, mesh }, beyond }, delay);
  }

  private cancel(): void {
    if (this.readings > 0) {
      this.stopReading.abort();
      this.stopReading = new AbortController();
      return tell('Cancelled: the files were not read.');
    }
    this.solving.cancel();
    tell(
      this.path
        ? 'Cancelled: what is shown is not finished. Change an option to compute it again.'
        : 'Cancelled. Change an option to compute the motion.',
    );
  }

  private showProgress({ stage, share }: Progress): void {
    if (this.readings > 0) return;
    showWork(`${this.path ? 'Refining' : 'Computing'}: ${stage}`, share);
  }

  private showBusy(busy: boolean): void {
    if (this.readings > 0) return;
    if (!busy) return hideWork();
    const { list, vertices } = this.poses;
    const shapes = list.length + (list.length - 1) * settings().options.shapes!;
    const bytes = bytesAVertex * vertices * shapes;
    const memory = bytes < saidFrom ? '' : `, which needs about ${Math.round(bytes / 1e6)} MB of memory`;
    showWork(`Computing the motion${memory}`, 0);
  }

  private showPath(path: Path, isFinal: boolean): void {
    const mesh = this.mesh!;
    const isFirst = this.path === null;
    const time = this.timeline ? timeAt(this.timeline, this.player.place) : path.times[0];
    this.path = path;
    this.timeline = timelineOf(
      path,
      this.poses.list.map(({ name }) => name),
    );
    mesh.shapes = path.shapes;
    mesh.triangles = path.indices;
    this.frame = new Float64Array(path.shapes[0].length);
    const { parameters, poses } = this.timeline;
    const parts = (poses.length - 1) * (parameters[parameters.length - 1] - parameters[0]);
    this.player.duration = Math.max(leastSeconds, secondsAPart * parts);
    markPoses([this.timeline]);
    byId('transport').hidden = false;
    this.showFacts();
    if (this.pulling?.on) return;
    const [first, last] = [parameters[0], parameters[parameters.length - 1]];
    this.player.seek((time - first) / (last - first));
    if (isFirst && !prefersStillness()) this.player.play();
    if (isFinal) tell(path.converged ? 'The motion is finished.' : unfinished);
  }

  private forgetPath(): void {
    this.path = this.timeline = null;
    this.player.pause();
    byId('transport').hidden = true;
  }

  /** Shows the body where the player is, which ends pulling. */
  private showMoment(): void {
    const { path, timeline, mesh } = this;
    if (!path || !timeline || !mesh) return;
    this.pulling?.stop();
    mesh.show(path.at(timeAt(timeline, this.player.place), this.frame));
    this.stage!.draw();
  }

  // Pulling

  private togglePulling(): void {
    const { pulling } = this;
    if (!pulling) return;
    if (pulling.on) {
      pulling.stop();
      return this.restoreMoment();
    }
    this.player.pause();
    pulling.start();
    tell('Click the body to set pins, which hold it, and drag to pull it. P or Escape ends this.');
  }

  /** Shows the motion, or the only pose, again. */
  private restoreMoment(): void {
    if (this.path) this.showMoment();
    else if (this.poses.list.length > 0) this.mesh!.show(this.poses.list[0].positions);
    this.stage!.draw();
  }

  private showPulling(): void {
    const pulling = this.pulling!;
    byId('pull').setAttribute('aria-pressed', String(pulling.on));
    byId('pull').textContent = pulling.on ? 'Stop pulling' : 'Pull the body';
    byId('layout').classList.toggle('pulling', pulling.on);
    byId<HTMLButtonElement>('keep').disabled = pulling.result === null;
    for (const id of ['unpin', 'clear-pins']) {
      byId<HTMLButtonElement>(id).disabled = pulling.count === 0;
    }
  }

  private keepPulled(): void {
    const result = this.pulling?.result;
    if (!result) return;
    const name = `pulled ${++this.pulled}`;
    this.poses.takeMade([{ name, positions: result.slice() }], this.poses.indices);
    this.pulling!.stop();
    this.listChanged();
    this.restoreMoment();
    tell(`${name} is now the last pose.`);
  }

  // Saving

  private async save(format: Format): Promise<void> {
    const { path } = this;
    if (!path) return tell('No file: there is no motion yet.');
    if (!path.file) return tell('No file: the motion is not finished.');
    tell('Writing the file\u2026');
    try {
      const name = await save(this.helper, path, format, this.name, this.player.duration);
      tell(`${name} is saved.`);
    } catch (error) {
      tell('');
      showProblems([sentenceOf(error as Error)]);
    }
  }
}

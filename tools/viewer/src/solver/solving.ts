// Computes the motion through the poses, anew whenever what is wanted changes.
import type { InterpolateOptions, Path, Pose, Progress, Shapespace } from './library';

export interface Wish {
  poses: Pose[];
  options: Pick<InterpolateOptions, 'mesh' | 'metric' | 'shapes' | 'avoidContact'>;
  /** How many shapes go beyond the last pose. */
  beyond: number;
}

/** What is told of the computation. */
export interface Listener {
  onProgress(progress: Progress): void;
  /** A motion that is to be shown; `isFinal` if it stays. */
  onPath(path: Path, isFinal: boolean): void;
  onError(error: Error): void;
  /** Whether something is computed. */
  onBusy(busy: boolean): void;
}

/** Sliders are moved through many values: what they are set to when this time has passed counts. */
const settlingTime = 300;

export class Solving {
  private running: AbortController | null = null;
  /** The motion from the first pose to the last, which extrapolation goes on from. */
  private base: { poses: Pose[]; options: string; path: Path } | null = null;

  constructor(
    private readonly library: Shapespace,
    private readonly listener: Listener,
  ) {}

  get busy(): boolean {
    return this.running !== null;
  }

  /** Starts soon, or at once and not after the next picture is drawn, and ends what is running now. */
  wish(wish: Wish, delay = settlingTime): void {
    this.running?.abort();
    const controller = new AbortController();
    this.running = controller;
    this.listener.onBusy(true);
    const run = () => {
      if (this.running === controller) void this.run(wish, controller);
    };
    if (delay > 0) setTimeout(run, delay);
    else run();
  }

  cancel(): void {
    this.running?.abort();
    this.running = null;
    this.listener.onBusy(false);
  }

  private async run(wish: Wish, controller: AbortController): Promise<void> {
    const { listener } = this;
    const { signal } = controller;
    const isCurrent = () => this.running === controller;
    const onProgress = (progress: Progress) => {
      if (isCurrent()) listener.onProgress(progress);
    };
    try {
      let path = await this.interpolate(wish, { signal, onProgress }, isCurrent);
      if (!isCurrent()) return;
      if (wish.beyond > 0) {
        listener.onPath(path, false);
        path = await this.library.extrapolate(path, wish.beyond, { signal, onProgress });
      }
      if (isCurrent()) listener.onPath(path, true);
    } catch (error) {
      if (isCurrent()) listener.onError(error as Error);
    } finally {
      if (isCurrent()) this.cancel();
    }
  }

  private async interpolate(
    { poses, options }: Wish,
    events: Pick<InterpolateOptions, 'signal' | 'onProgress'>,
    isCurrent: () => boolean,
  ): Promise<Path> {
    const key = JSON.stringify(options);
    const { base } = this;
    const isSame =
      base?.options === key &&
      base.poses.length === poses.length &&
      base.poses.every((pose, i) => sameShape(pose, poses[i]));
    if (isSame) return base.path;
    const onPreview = (path: Path) => {
      if (isCurrent()) this.listener.onPath(path, false);
    };
    const path = await this.library.interpolate(poses, { ...options, ...events, onPreview });
    this.base = { poses, options: key, path };
    return path;
  }
}

/** Whether two poses have one array, or are one file. */
function sameShape(a: Pose, b: Pose): boolean {
  if ('data' in a || 'data' in b) return a === b;
  return a.positions === b.positions && a.indices === b.indices;
}

export type Repeat = 'once' | 'loop' | 'swing';

/** Plays a motion of `duration` seconds. A place in it is a number from 0 (start) to 1 (end). */
export class Player {
  duration = 4;
  speed = 1;
  repeat: Repeat = 'swing';
  private at = 0;
  private direction = 1;
  private running = false;

  /** `onMove` is called with every new place, `onState` when playing begins or ends. */
  constructor(
    private readonly onMove: (place: number) => void,
    private readonly onState: (playing: boolean) => void,
  ) {}

  get place(): number {
    return this.at;
  }
  get playing(): boolean {
    return this.running;
  }

  play(): void {
    if (this.repeat === 'once' && this.at >= 1) this.move(0);
    if (this.repeat !== 'swing') this.direction = 1;
    this.run(true);
  }

  pause(): void {
    this.run(false);
  }

  toggle(): void {
    if (this.running) this.pause();
    else this.play();
  }

  seek(place: number): void {
    this.move(Math.min(1, Math.max(0, place)));
  }

  /** Advances by some seconds. Returns whether the player is still playing. */
  advance(seconds: number): boolean {
    if (!this.running) return false;
    const there = this.at + (this.direction * this.speed * seconds) / this.duration;
    let place = there;
    if (this.repeat === 'loop') place -= Math.floor(place);
    if (this.repeat === 'swing') {
      place = Math.abs(place % 2);
      if (place > 1) place = 2 - place;
      if (Math.abs(Math.floor(there)) % 2 === 1) this.direction = -this.direction;
    }
    this.move(Math.min(1, place));
    if (this.repeat === 'once' && place >= 1) this.pause();
    return this.running;
  }

  private move(place: number): void {
    this.at = place;
    this.onMove(place);
  }

  private run(on: boolean): void {
    if (on === this.running) return;
    this.running = on;
    this.onState(on);
  }
}

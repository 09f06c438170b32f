// The controls that say how a player plays.
import { byId } from './dom';
import { Player, type Repeat } from './player';

const repeats: [Repeat, string][] = [
  ['swing', 'There and back'],
  ['loop', 'From the start'],
  ['once', 'No'],
];
const speeds = [0.1, 0.25, 0.5, 1, 2, 4];

function fill(select: HTMLSelectElement, options: [string, string][], chosen: string): void {
  for (const [value, text] of options) select.add(new Option(text, value, false, value === chosen));
}

export function setRepeat(player: Player, repeat: Repeat): void {
  player.repeat = repeat;
  byId<HTMLSelectElement>('loop').value = repeat;
}

/** `clock` returns a place as text; `onMove` is called with every new place. */
export function startTransport(
  onMove: (place: number) => void,
  onState: () => void,
  clock: (place: number) => string,
): Player {
  const play = byId<HTMLButtonElement>('play');
  const time = byId<HTMLInputElement>('time');
  const loop = byId<HTMLSelectElement>('loop');
  const speed = byId<HTMLSelectElement>('speed');
  const player = new Player(
    (place) => {
      time.value = String(place);
      const text = clock(place);
      time.setAttribute('aria-valuetext', text);
      byId('clock').textContent = text;
      onMove(place);
    },
    (playing) => {
      play.textContent = playing ? 'Pause' : 'Play';
      onState();
    },
  );
  fill(loop, repeats, player.repeat);
  fill(
    speed,
    speeds.map((factor) => [String(factor), `${factor}\u2009\u00d7`]),
    '1',
  );
  play.addEventListener('click', () => player.toggle());
  time.addEventListener('input', () => {
    player.pause();
    player.seek(Number(time.value));
  });
  time.addEventListener('keydown', (event) => {
    const steps: Record<string, number> = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 };
    if (!(event.key in steps)) return;
    event.preventDefault();
    player.pause();
    player.seek(player.place + steps[event.key] * (event.shiftKey ? 0.1 : 0.01));
  });
  loop.addEventListener('change', () => {
    player.repeat = loop.value as Repeat;
    if (player.playing) player.play();
  });
  speed.addEventListener('change', () => (player.speed = Number(speed.value)));
  document.addEventListener('keydown', (event) => {
    const element = event.target as Element;
    if (event.key !== ' ' || element.closest('button, select, input[type=checkbox]')) return;
    event.preventDefault();
    player.toggle();
  });
  return player;
}

// The controls that say which motion is wanted.
import { byId } from '../dom';
import type { Wish } from './solving';

const ids = ['shapes', 'metric', 'beyond', 'avoid'];

export type Settings = Pick<Wish, 'options' | 'beyond'>;

export function settings(): Settings {
  const number = (id: string) => Number(byId<HTMLInputElement>(id).value);
  return {
    options: {
      shapes: number('shapes'),
      metric: byId<HTMLSelectElement>('metric').value as 'strain' | 'isometric' | 'rigid',
      avoidContact: byId<HTMLInputElement>('avoid').checked,
    },
    beyond: number('beyond'),
  };
}

/** Shows the sliders' numbers, and calls `onChange` when something else is wanted. */
export function startSettings(onChange: () => void): void {
  const showNumbers = () => {
    for (const id of ['shapes', 'beyond']) {
      byId(`${id}-number`).textContent = byId<HTMLInputElement>(id).value;
    }
  };
  for (const id of ids) {
    byId(id).addEventListener('input', () => {
      showNumbers();
      onChange();
    });
  }
  showNumbers();
}

// What is being computed, over the picture: in words, as a bar, and with a button that ends it.
import { byId } from '../dom';

/** `share` is null where it is not known. */
export function showWork(text: string, share: number | null): void {
  byId('work').hidden = false;
  byId('stage').ariaBusy = 'true';
  const name = byId('stage-name');
  if (name.textContent !== text) name.textContent = text;
  const bar = byId<HTMLProgressElement>('share');
  if (share === null) bar.removeAttribute('value');
  else bar.value = share;
}

export function hideWork(): void {
  byId('work').hidden = true;
  byId('stage').ariaBusy = 'false';
}

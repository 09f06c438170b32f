// The hint that is gone after the first touch, and the help.
import { byId } from './dom';
import type { Explanation } from './explanations';
import { onKey } from './keys';

function keysOf({ plays, hasPlane, pulls }: Explanation): [string, string][] {
  const playing: [string, string][] = [
    ['Space', 'play or stop'],
    ['\u2190 \u2192 on the slider', 'a hundredth of the motion; with Shift a thousandth'],
  ];
  const plane: [string, string][] = [
    ['Arrows on the blue point', 'move it; with Shift by less'],
    ['Enter on the blue point', 'add it to the curve'],
  ];
  const pulling: [string, string][] = [
    ['P', 'pull the body, or stop pulling'],
    ['Enter on the picture', 'while pulling: a pin in the middle of the picture'],
    ['Shift and arrows on the picture', 'while pulling: pull the last pin'],
    ['Delete', 'while pulling: remove the last pin'],
  ];
  return [
    ...(plays ? playing : []),
    ...(hasPlane ? plane : []),
    ...(pulls ? pulling : []),
    ['Arrows on the picture', 'turn'],
    ['+ and \u2212 on the picture', 'nearer, farther'],
    ['Home on the picture', 'show all, as at first'],
    ['R', 'roll to the right; with Shift to the left'],
    ['F', 'full screen'],
    ['Tab', 'the next control'],
    ['?', 'this help'],
  ];
}

function item(text: string): HTMLLIElement {
  const line = document.createElement('li');
  line.textContent = text;
  return line;
}

function row([key, what]: [string, string]): HTMLTableRowElement {
  const line = document.createElement('tr');
  const name = document.createElement('th');
  name.scope = 'row';
  name.textContent = key;
  line.append(name);
  line.insertCell().textContent = what;
  return line;
}

/** `facts` say what is shown. */
export function explain(explanation: Explanation, facts: string): void {
  startHelp(explanation, facts);
  showHint(explanation.hint);
}

export function startHelp(explanation: Explanation, facts: string): void {
  byId('help-deeds').replaceChildren(...explanation.deeds.map(item));
  byId('help-keys').replaceChildren(...keysOf(explanation).map(row));
  byId('help-facts').textContent = facts;
  const help = byId<HTMLDialogElement>('help');
  const open = () => {
    if (!help.open) help.showModal();
  };
  byId('help-open').addEventListener('click', open);
  onKey('?', open);
}

/** Shows a sentence until the page is touched. */
export function showHint(text: string): void {
  const hint = byId('hint');
  hint.textContent = text;
  const touched = new AbortController();
  const remove = () => {
    hint.remove();
    touched.abort();
  };
  for (const event of ['pointerdown', 'keydown', 'wheel']) {
    document.addEventListener(event, remove, { capture: true, signal: touched.signal });
  }
}

// The list of poses in the panel, with buttons that change it.
import { byId } from '../dom';
import type { PoseSet } from './pose_set';

function button(text: string, label: string, disabled: boolean, act: () => void): HTMLButtonElement {
  const element = document.createElement('button');
  element.type = 'button';
  element.textContent = text;
  element.title = label;
  element.setAttribute('aria-label', label);
  element.disabled = disabled;
  element.addEventListener('click', act);
  return element;
}

/** `onChange` is called when a button has changed the list. */
export function showRows(poses: PoseSet, onChange: () => void): void {
  const rows = byId('poses');
  const last = poses.list.length - 1;
  /** The row and the button that have the keyboard after the list is shown again. */
  const change = (act: () => void, row: number, column: number) => {
    act();
    onChange();
    const buttons = rows.children[Math.min(row, rows.children.length - 1)]?.querySelectorAll('button');
    const next = buttons?.[column];
    if (next && !next.disabled) next.focus();
    else [...(buttons ?? [])].find(({ disabled }) => !disabled)?.focus();
  };
  rows.replaceChildren(
    ...poses.list.map(({ name }, i) => {
      const row = document.createElement('li');
      const label = document.createElement('span');
      label.textContent = name;
      label.title = name;
      row.append(
        label,
        button('\u2191', `Move ${name} up`, i === 0, () =>
          change(() => poses.move(i, i - 1), i - 1, 0),
        ),
        button('\u2193', `Move ${name} down`, i === last, () =>
          change(() => poses.move(i, i + 1), i + 1, 1),
        ),
        button('\u00d7', `Remove ${name}`, false, () => change(() => poses.remove(i), i, 2)),
      );
      return row;
    }),
  );
}

/** What was found when the meshes were read. */
export function showFindings({ warnings, notes }: PoseSet): void {
  const sentences = [...warnings, ...notes];
  const details = byId<HTMLDetailsElement>('findings');
  details.hidden = sentences.length === 0;
  details.open = warnings.length > 0;
  const count = (number: number, what: string) =>
    number > 0 ? [`${number} ${what}${number > 1 ? 's' : ''}`] : [];
  byId('findings-title').textContent = [
    ...count(warnings.length, 'warning'),
    ...count(notes.length, 'note'),
  ].join(', ');
  byId('findings-list').replaceChildren(
    ...sentences.map((sentence) => {
      const item = document.createElement('li');
      item.textContent = sentence;
      return item;
    }),
  );
}

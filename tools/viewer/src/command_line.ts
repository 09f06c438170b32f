// Command lines on the page.
import { tell } from './dom';

/** An argument for a shell. */
export function quoted(name: string): string {
  return /^[\w.,/+-]+$/.test(name) ? name : `'${name.replaceAll("'", "'\\''")}'`;
}

/** A field selects all of its text when it is entered, and the button copies it. */
export function startCopy(field: HTMLTextAreaElement, button: HTMLElement): void {
  field.addEventListener('focus', () => field.select());
  button.addEventListener('click', () => {
    field.select();
    const copied = navigator.clipboard
      ? navigator.clipboard.writeText(field.value)
      : Promise.reject();
    copied.then(
      () => tell('The command is copied.'),
      () => tell('The command is selected; copy it with the keyboard.'),
    );
  });
}

// Sentences about what went wrong, over the picture until they are closed.
import { byId } from '../dom';
import { ShapespaceError, type MeshOptions } from './library';

export interface Remedy {
  text: string;
  act: () => void;
}

/** What is meant for programs, in the words of this page. */
const words: [RegExp, string][] = [
  [/\. If the pose is right, say so by allowMismatch/g, ''],
  [/\. If it was turned over on purpose, say so by allowMirrored/g, ''],
  [/more than the memory limit/g, 'more than the 2,000 MB that this page takes'],
  [/ or raise memoryLimit/g, ''],
  [
    /If they never were one mesh, fit .* onto .* with Correspond/g,
    'If they never were one mesh, the program shape-correspond of shapespace fits one onto the other; this page cannot',
  ],
];

/** A sentence of the library, or of the browser, as it is shown. */
export function sentenceOf(error: Error): string {
  if (!(error instanceof ShapespaceError)) return `That has failed: ${error.message}.`;
  const text = words.reduce((so, [from, to]) => so.replace(from, to), error.message);
  const remedies = new Set<string>();
  const lines = text.split('\n').filter((line) => {
    // Several findings may have one remedy, which is read once.
    const [, remedy = line] = line.match(/;(.*)/) ?? [];
    return !remedies.has(remedy) && remedies.add(remedy);
  });
  return lines.map((line) => (/[.!?]$/.test(line) ? line : `${line}.`)).join('\n');
}

/** What can be answered to a refusal: options of meshes, and the words on the button. */
export function answerTo(error: Error): { text: string; options: MeshOptions } | null {
  if (!(error instanceof ShapespaceError)) return null;
  switch (error.option) {
    case 'mirror':
      return { text: 'Mirror it back', options: { mirror: 'x' } };
    case 'allowMismatch':
      return { text: 'It is right, use it', options: { allowMismatch: true } };
    case 'allowNonmanifold':
      return { text: 'Use it as it is', options: { allowNonmanifold: true } };
    default:
      return null;
  }
}

/** Shows sentences instead of those before; with none, nothing. */
export function showProblems(sentences: string[], remedies: Remedy[] = []): void {
  byId('problems').hidden = sentences.length === 0;
  byId('problem-text').replaceChildren(
    ...sentences.join('\n').split('\n').map((sentence) => {
      const paragraph = document.createElement('p');
      paragraph.textContent = sentence;
      return paragraph;
    }),
  );
  const close = { text: 'Close', act: () => {} };
  byId('problem-buttons').replaceChildren(
    ...[...remedies, close].map(({ text, act }) => {
      const button = document.createElement('button');
      button.type = 'button';
      button.textContent = text;
      button.addEventListener('click', () => {
        showProblems([]);
        act();
      });
      return button;
    }),
  );
}

// Files that are dropped on the page, or chosen with a button.
import { byId } from '../dom';
import type { MeshFile } from './library';

async function contentOf(file: File): Promise<MeshFile> {
  return { name: file.name, data: new Uint8Array(await file.arrayBuffer()) };
}

/** `take` gets what was dropped, in the order of the names, as a row of frames is numbered. */
export function startDropping(take: (files: MeshFile[]) => void, refuse: (sentence: string) => void): void {
  const read = async (files: File[]) => {
    const inOrder = files.sort((a, b) => a.name.localeCompare(b.name, 'en', { numeric: true }));
    try {
      const contents = await Promise.all(inOrder.map(contentOf));
      if (contents.length > 0) take(contents);
    } catch {
      refuse('The browser could not read what was dropped. Drop files, and no folders.');
    }
  };
  const input = byId<HTMLInputElement>('files');
  for (const button of document.querySelectorAll('.choose-files')) {
    button.addEventListener('click', () => input.click());
  }
  input.addEventListener('change', () => {
    void read([...(input.files ?? [])]);
    input.value = ''; // so that the same file can be chosen again
  });

  const { classList } = document.body;
  const hasFiles = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false;
  document.addEventListener('dragover', (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    classList.add('dropping');
  });
  document.addEventListener('dragleave', (event) => {
    if (event.relatedTarget === null) classList.remove('dropping'); // out of the window
  });
  document.addEventListener('drop', (event) => {
    classList.remove('dropping');
    if (!hasFiles(event)) return;
    event.preventDefault();
    void read([...(event.dataTransfer?.files ?? [])]);
  });
}

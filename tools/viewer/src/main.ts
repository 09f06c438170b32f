import './style.css';
import { decodeScene } from './decode';
import { byId, tell } from './dom';
import { decodeGlb } from './gltf';
import { showMeshes } from './mesh_view';
import { showModes } from './modes_view';
import { showPaths } from './path_view';
import { Damaged, type SceneData } from './scene_data';
import { showSpace } from './space_view';
import { startTheme } from './theme';

function showMessage(text: string): void {
  const message = byId('message');
  message.hidden = false;
  message.textContent = text;
  byId('layout').hidden = true;
}

/** A sentence that says what this browser cannot do; null if it can show the page. */
function missing(): string | null {
  if (typeof DecompressionStream === 'undefined') {
    return 'This browser is too old for this page: it cannot decompress data.';
  }
  if (document.createElement('canvas').getContext('webgl2') === null) {
    return 'This browser does not draw in three dimensions: WebGL 2 is missing or switched off.';
  }
  return null;
}

async function read(element: HTMLScriptElement): Promise<SceneData> {
  const text = element.textContent ?? '';
  const name = element.dataset.name ?? '';
  const isGlb = element.type === 'model/gltf-binary';
  const scene = await (isGlb ? decodeGlb(name, text) : decodeScene(text));
  element.remove(); // the text is no longer needed
  return scene;
}

async function start(): Promise<void> {
  startTheme();
  const elements = [...document.querySelectorAll<HTMLScriptElement>('script[data-scene]')];
  if (elements.length === 0) {
    return showMessage('This page holds nothing to show. shape-view makes pages that do.');
  }
  const lack = missing();
  if (lack) return showMessage(lack);
  const scenes: SceneData[] = [];
  for (const element of elements) {
    try {
      scenes.push(await read(element));
    } catch (error) {
      if (error instanceof RangeError) {
        return showMessage(`There is not enough memory to show ${element.dataset.name}.`);
      }
      const why = error instanceof Damaged ? error.message : 'it cannot be read';
      return showMessage(
        `The data of ${element.dataset.name} in this page is damaged: ${why}. ` +
          'Make the page again with shape-view.',
      );
    }
  }
  byId('message').hidden = true;
  byId('layout').hidden = false;
  document.title = scenes.map(({ name }) => name).join(' and ');
  const [first] = scenes;
  try {
    if (first.kind === 'space') showSpace(first);
    else if (first.kind === 'modes') showModes(first);
    else if (first.kind === 'mesh') showMeshes(scenes.filter((scene) => scene.kind === 'mesh'));
    else showPaths(scenes.filter((scene) => scene.kind === 'path'));
  } catch (error) {
    const why =
      error instanceof RangeError ? 'there is not enough memory for it' : (error as Error).message;
    return showMessage(`${document.title} cannot be shown: ${why}.`);
  }
  byId('canvas').addEventListener('webglcontextlost', () =>
    showMessage('The graphics card has stopped drawing. Load the page again.'),
  );
  window.addEventListener('error', ({ message }) => tell(`That has failed: ${message}.`));
}

void start();

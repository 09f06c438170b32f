import '../style.css';
import './solver.css';
import { byId, tell } from '../dom';
import { ofSolver } from '../explanations';
import { startHelp } from '../help';
import { startTheme } from '../theme';
import { loadLibrary, warmUp } from './library';
import { SolverPage } from './solver_page';

const about =
  'shapespace finds natural motions between poses of a mesh: geodesics in a space of shapes ' +
  '(Kilian, Mitra and Pottmann 2007). This page is one file, which works without a network; save it ' +
  'to keep it. Your meshes do not leave this device.';

/** Sentences over the picture go away after this many milliseconds. */
const statusTime = 9000;

/** A sentence that says what this browser cannot do; null if it can show the page. */
function missing(): string | null {
  if (typeof DecompressionStream === 'undefined' || typeof WebAssembly === 'undefined') {
    return 'This browser is too old for this page: it does not run WebAssembly from compressed data.';
  }
  if (document.createElement('canvas').getContext('webgl2') === null) {
    return 'This browser does not draw in three dimensions: WebGL 2 is missing or switched off.';
  }
  return null;
}

function showMessage(text: string): void {
  byId('message').hidden = false;
  byId('message').textContent = text;
  byId('layout').hidden = true;
}

function startStatus(): void {
  let timer = 0;
  new MutationObserver(() => {
    clearTimeout(timer);
    timer = setTimeout(() => tell(''), statusTime);
  }).observe(byId('status'), { childList: true });
}

async function start(): Promise<void> {
  startTheme();
  const lack = missing();
  if (lack) return showMessage(lack);
  try {
    const { solver, helper } = await loadLibrary();
    startStatus();
    startHelp(ofSolver, about);
    new SolverPage(solver, helper);
    byId('message').hidden = true;
    byId('layout').hidden = false;
    warmUp(solver, helper);
  } catch (error) {
    return showMessage(`This page is damaged: ${(error as Error).message}. Get the file again.`);
  }
  byId('canvas').addEventListener('webglcontextlost', () =>
    showMessage('The graphics card has stopped drawing. Load the page again.'),
  );
  window.addEventListener('error', ({ message }) => tell(`That has failed: ${message}.`));
}

void start();

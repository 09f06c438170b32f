// Check boxes and buttons that all views have.
import type { BlendedMesh } from './blended_mesh';
import { byId, tell } from './dom';
import { startFullScreen } from './full_screen';
import { onKey } from './keys';
import type { Player } from './player';
import { canFilm, saveFilm, savePicture } from './record';
import type { Body } from './scene_data';
import type { Stage } from './stage';

export function box(id: string, checked: boolean, onChange: (on: boolean) => void): void {
  const input = byId<HTMLInputElement>(id);
  input.checked = checked;
  input.addEventListener('change', () => onChange(input.checked));
}

/** An even part of a right angle. */
const rollDegrees = 15;

/** What can be chosen of how a body is drawn. */
export interface Drawn {
  readonly body: Pick<Body, 'triangles'>;
  wireframe: boolean;
  flat: boolean;
}

/** File names begin with what `name` returns. `mayFilm` returns why no film can be made, or null if one can. */
export function startOptions(
  stage: Stage,
  meshes: Drawn[],
  player: Player,
  name: () => string,
  mayFilm: () => string | null = () => null,
): void {
  box('wireframe', false, (on) => {
    for (const mesh of meshes) mesh.wireframe = on;
    stage.draw();
  });
  box('facets', meshes[0].flat, (on) => {
    for (const mesh of meshes) mesh.flat = on;
    stage.draw();
  });
  const areGraphs = meshes.every((mesh) => mesh.body.triangles.length === 0);
  for (const id of ['wireframe-option', 'facets-option', 'ground-option']) {
    byId(id).hidden = areGraphs;
  }
  box('ground', !areGraphs, (on) => (stage.ground = on));
  stage.ground = !areGraphs;
  box('turntable', false, (on) => (stage.turning = on));
  byId('reset').addEventListener('click', () => stage.showAll());
  const roll = (direction: 1 | -1) => () => stage.roll((direction * rollDegrees * Math.PI) / 180);
  byId('roll-left').addEventListener('click', roll(-1));
  byId('roll-right').addEventListener('click', roll(1));
  onKey('R', roll(-1));
  onKey('r', roll(1));
  startFullScreen();
  byId('picture').addEventListener('click', () => {
    savePicture(stage, `${name()}.png`).then(
      () => tell('The picture is saved.'),
      (error: Error) => tell(`No picture: ${error.message}.`),
    );
  });
  const film = byId<HTMLButtonElement>('film');
  film.addEventListener('click', () => {
    const missing = canFilm() ? mayFilm() : 'this browser cannot record films';
    if (missing) return tell(`No film: ${missing}.`);
    film.disabled = true;
    tell('Recording, from the start to the end\u2026');
    saveFilm(stage, player, name())
      .then(
        () => tell('The film is saved.'),
        (error: Error) => tell(`No film: ${error.message}.`),
      )
      .finally(() => (film.disabled = false));
  });
}

/** Prepares shapes while the browser is idle, so that playing does not wait for them. */
export function prepareWhenIdle(meshes: BlendedMesh[]): void {
  const next = () => {
    if (meshes.map((mesh) => mesh.prepareNext()).some(Boolean)) setTimeout(next, 10);
  };
  setTimeout(next, 100);
}

export function prefersStillness(): boolean {
  return matchMedia('(prefers-reduced-motion: reduce)').matches;
}

/** The name of a file without its extension. */
export function stem(name: string): string {
  return name.replace(/\.[^.]*$/, '') || 'shape';
}

// One mesh, or two side by side, whose vertices are picked.
import { BlendedMesh } from './blended_mesh';
import { byId, showNames, themeValue } from './dom';
import { ofMarkers, ofMesh } from './explanations';
import { explain } from './help';
import { startOptions, stem } from './options';
import type { Marker } from './picked_files';
import { Picking } from './picking';
import { Player } from './player';
import type { MeshScene } from './scene_data';
import { Stage } from './stage';
import { onTheme } from './theme';

function facts({ vertices, triangles }: MeshScene): string {
  return (
    `${vertices.toLocaleString('en')} vertices, ` +
    `${(triangles.length / 3).toLocaleString('en')} triangles`
  );
}

function markersOf([first, second]: MeshScene[]): Marker[] {
  if (!second) return [];
  return first.markers.slice(0, second.markers.length).map((v, i) => [v, second.markers[i]]);
}

export function showMeshes(scenes: MeshScene[]): void {
  const names = scenes.map(({ name }) => name);
  showNames(names, scenes.map(facts));
  for (const id of ['colour-option', 'film', 'transport', 'playing-options']) {
    byId(id).hidden = true;
  }
  const meshes = scenes.map((scene) => new BlendedMesh(scene));
  const stage = new Stage(byId<HTMLCanvasElement>('canvas'), meshes, () => false);
  onTheme(() => stage.setBackground(themeValue('--stage')));
  const still = new Player(
    () => {},
    () => {},
  );
  startOptions(stage, meshes, still, () => names.map(stem).join('-'));
  // A click finds a triangle, which graphs do not have.
  if (scenes.every(({ triangles }) => triangles.length > 0)) {
    const files = scenes.map(({ file, name }) => file || name);
    new Picking(stage, meshes, files, 0, markersOf(scenes));
    byId('options').prepend(byId('pick-panel'));
  }
  const all = scenes.map((scene) => `${scene.name}: ${facts(scene)}.`).join(' ');
  explain(scenes.length > 1 ? ofMarkers : ofMesh, all);
}

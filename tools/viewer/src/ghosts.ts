// The given poses of a path, seen through.
import { BufferAttribute, BufferGeometry, Group, Mesh, MeshStandardMaterial } from 'three';
import { vertexNormals } from './normals';
import type { PathScene } from './scene_data';

const poseColour = 0x4a86c8; // that of poses in film strips

/** In the unit cube, as the body is. */
export function ghostsOf(scene: PathScene): Group {
  const index = new BufferAttribute(scene.triangles, 1);
  const material = new MeshStandardMaterial({
    color: poseColour,
    roughness: 0.75,
    transparent: true,
    opacity: 0.22,
  });
  const ghosts = scene.poses.map((pose) => {
    const shape = scene.shapes[pose];
    const geometry = new BufferGeometry();
    geometry.setIndex(index);
    geometry.setAttribute('position', new BufferAttribute(shape, 4, true));
    geometry.setAttribute('normal', new BufferAttribute(vertexNormals(scene, shape), 4, true));
    return new Mesh(geometry, material);
  });
  return new Group().add(...ghosts);
}

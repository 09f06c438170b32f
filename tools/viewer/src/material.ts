// What bodies without colours of their own look like, from both sides.
import { Color, DoubleSide, MeshBasicMaterial, MeshStandardMaterial } from 'three';

export const clay = new Color(0xbfae9a);
export const back = new Color(0xd9822b);

export function surfaceMaterial(): MeshStandardMaterial {
  return new MeshStandardMaterial({
    side: DoubleSide,
    roughness: 0.75,
    polygonOffsetFactor: 1,
    polygonOffsetUnits: 1,
  });
}

/** Of the edges, drawn over the surface. */
export function wireMaterial(): MeshBasicMaterial {
  const material = new MeshBasicMaterial({ color: 0x1b2430, wireframe: true });
  material.transparent = true;
  material.opacity = 0.4;
  return material;
}

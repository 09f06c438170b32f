// Points at some vertices of a body, which follow its blend.
import { BufferAttribute, type BufferGeometry, type IUniform, Points, ShaderMaterial } from 'three';
import { declarations } from './blend_shader';

const vertexShader = /* glsl */ `
${declarations}
attribute vec4 picked;
varying vec3 colour;
void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(blendedShape().xyz, 1.0);
  // A little in front of the surface; and out of sight where nothing is picked.
  gl_Position.z -= 0.001 * gl_Position.w;
  if (picked.a < 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = ${(9 * Math.min(2, globalThis.devicePixelRatio)).toFixed(1)};
  colour = picked.rgb;
}`;

const fragmentShader = /* glsl */ `
varying vec3 colour;
void main() {
  float radius = length(gl_PointCoord - 0.5);
  if (radius > 0.5) discard;
  gl_FragColor = vec4(radius > 0.36 ? vec3(1.0) : colour, 1.0);
}`;

export class Marks extends Points<BufferGeometry, ShaderMaterial> {
  private readonly picked: BufferAttribute;

  /** `geometry` and `uniforms` are those of the body. */
  constructor(geometry: BufferGeometry, vertices: number, uniforms: Record<string, IUniform>) {
    super(geometry, new ShaderMaterial({ vertexShader, fragmentShader, uniforms }));
    this.picked = new BufferAttribute(new Uint8Array(4 * vertices), 4, true);
    geometry.setAttribute('picked', this.picked);
    this.frustumCulled = false;
  }

  show(colours: Map<number, number>): void {
    const bytes = this.picked.array as Uint8Array;
    bytes.fill(0);
    for (const [vertex, colour] of colours) {
      bytes.set([colour >> 16, (colour >> 8) & 255, colour & 255, 255], 4 * vertex);
    }
    this.picked.needsUpdate = true;
  }
}

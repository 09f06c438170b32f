// Draws a body as a weighted blend of three of its shapes, which the GPU computes.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DataTexture,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshDepthMaterial,
  MeshStandardMaterial,
  RGBADepthPacking,
  Sphere,
  SRGBColorSpace,
  Vector3,
  type Material,
} from 'three';
import { declarations } from './blend_shader';
import { Marks } from './marks';
import { isFaceted, vertexNormals } from './normals';
import { back, clay, surfaceMaterial, wireMaterial } from './material';
import { markColour, rampColour, type Triple } from './ramp';
import type { Body, Skin } from './scene_data';
import type { Shown } from './stage';


function rampTexture(colourOf: (value: number) => Triple): DataTexture {
  const pixels = new Uint8Array(4 * 256);
  for (let i = 0; i < 256; ++i) pixels.set([...colourOf(i / 255), 255], 4 * i);
  const texture = new DataTexture(pixels, 256, 1);
  texture.colorSpace = SRGBColorSpace;
  texture.needsUpdate = true;
  return texture;
}

const normalDeclarations = /* glsl */ `
attribute vec3 normalA, normalB, normalC;
vec3 blendedNormal() {
  return normalize(
      normalA + weightB * (normalB - normalA) + weightC * (normalC - normalA) + vec3(1e-6));
}
`;

/** The three nearest shapes, of which the body is the blend with these weights. */
export interface Blend {
  nodes: [number, number, number];
  weights: [number, number, number];
}

/**
 * A body whose geometry has the positions of three shapes as attributes. The GPU blends them, and
 * takes the weights of the second and the third as uniforms. The arrays of a shape are sent to the
 * GPU when it is first shown, and stay there, so that showing it again only exchanges attributes.
 *
 * The body is scaled to the cube of side 1 with its lowest corner in the origin.
 */
export class BlendedMesh extends Group implements Shown {
  private readonly geometry = new BufferGeometry();
  private readonly positions: BufferAttribute[] = [];
  private readonly normals: BufferAttribute[] = [];
  private readonly manyColours = rampTexture(rampColour);
  private readonly twoColours = rampTexture(markColour);
  private readonly uniforms = {
    weightB: { value: 0 },
    weightC: { value: 0 },
    byDeviation: { value: 0 },
    deviationScale: { value: 1 },
    ramp: { value: this.manyColours },
    backColour: { value: back },
  };
  private readonly isGraph: boolean;
  private readonly surface: Mesh | LineSegments;
  private readonly wires: Mesh | null = null;
  private marks: Marks | null = null;
  private shown: Blend = { nodes: [0, 0, 0], weights: [1, 0, 0] };

  constructor(readonly body: Body) {
    super();
    this.isGraph = body.triangles.length === 0;
    const triangles = body.skin?.cut?.triangles ?? body.triangles;
    this.geometry.setIndex(new BufferAttribute(this.isGraph ? body.segments : triangles, 1));
    this.geometry.boundingSphere = new Sphere(new Vector3(0.5, 0.5, 0.5), Math.sqrt(3) / 2);
    if (this.isGraph) {
      const material = new LineBasicMaterial();
      this.surface = new LineSegments(this.geometry, this.patch(material));
    } else {
      const flatShading = [0, body.shapes.length >> 1, body.shapes.length - 1].some((shape) =>
        isFaceted(body, body.shapes[shape]),
      );
      const parts = body.skin?.parts ?? [{ start: 0, count: body.triangles.length }];
      const materials = parts.map(({ start, count }, i) => {
        this.geometry.addGroup(start, count, i);
        const material = surfaceMaterial();
        material.flatShading = flatShading;
        return this.patch(material);
      });
      if (body.skin) this.geometry.setAttribute('uv', new BufferAttribute(body.skin.uv, 2));
      this.surface = new Mesh(this.geometry, materials);
      this.surface.castShadow = true;
      this.surface.customDepthMaterial = this.patch(
        new MeshDepthMaterial({ depthPacking: RGBADepthPacking }),
      );
      this.wires = new Mesh(this.geometry, this.patch(wireMaterial()));
      this.wires.visible = false;
      this.add(this.wires);
    }
    this.add(this.surface);
    this.colourAsItIs();
    for (const child of this.children) child.frustumCulled = false;
    this.show(this.shown);
  }

  /** Shows a blend of three shapes. */
  show(blend: Blend): void {
    this.shown = blend;
    blend.nodes.forEach((node, k) => {
      const letter = 'ABC'[k];
      this.geometry.setAttribute(`shape${letter}`, this.positionsOf(node));
      if (!this.isGraph) this.geometry.setAttribute(`normal${letter}`, this.normalsOf(node));
    });
    // three.js takes the number of vertices from the attribute `position`.
    this.geometry.setAttribute('position', this.positionsOf(blend.nodes[0]));
    this.uniforms.weightB.value = blend.weights[1];
    this.uniforms.weightC.value = blend.weights[2];
  }

  /** The shape of which the blend has most. */
  get nearest(): number {
    const { nodes, weights } = this.shown;
    return nodes[weights.indexOf(Math.max(...weights))];
  }

  /** Shows the first shape again, after its array has changed. */
  refresh(): void {
    this.sendAgain(0);
    if (this.isGraph) return;
    const normals = this.normalsOf(0);
    normals.array.set(this.drawn(vertexNormals(this.body, this.body.shapes[0]), 4));
    normals.needsUpdate = true;
  }

  /** Prepares the arrays of one more shape. Returns false if those of all shapes are ready. */
  prepareNext(): boolean {
    const next = this.body.shapes.findIndex((_, node) => !this.positions[node]);
    if (next < 0) return false;
    this.positionsOf(next);
    if (!this.isGraph) this.normalsOf(next);
    return true;
  }

  /** Draws points at vertices: for each its colour, 0xrrggbb. */
  mark(colours: Map<number, number>): void {
    if (!this.marks) {
      const drawn = this.body.skin?.cut?.source.length ?? this.body.vertices;
      this.marks = new Marks(this.geometry, drawn, this.uniforms);
      this.add(this.marks);
    }
    this.marks.show(colours);
  }

  someVertices(most: number): Vector3[] {
    const { shapes, vertices } = this.body;
    const points: Vector3[] = [];
    const step = Math.max(1, Math.floor((shapes.length * vertices) / most));
    for (const shape of shapes) {
      for (let v = 0; v < vertices; v += step) {
        const point = new Vector3(shape[4 * v], shape[4 * v + 1], shape[4 * v + 2]);
        points.push(point.divideScalar(65535));
      }
    }
    return points;
  }

  /** The vertices' positions as they are shown, in the unit cube: three numbers for each. */
  positionsShown(): Float32Array {
    const { nodes, weights } = this.shown;
    const positions = new Float32Array(3 * this.body.vertices);
    nodes.forEach((node, k) => {
      const shape = this.body.shapes[node];
      for (let i = 0; i < positions.length; ++i) {
        const at = 4 * Math.floor(i / 3) + (i % 3);
        positions[i] += (weights[k] * shape[at]) / 65535;
      }
    });
    return positions;
  }

  set wireframe(on: boolean) {
    if (!this.wires) return;
    this.wires.visible = on;
    // While edges are drawn, the surface is moved back a little, so that it does not hide them. It
    // is not moved otherwise, because at the outline the back of the body would show through.
    for (const material of this.materials()) material.polygonOffset = on;
  }

  get flat(): boolean {
    const [material] = this.materials();
    return material instanceof MeshStandardMaterial && material.flatShading;
  }
  set flat(on: boolean) {
    for (const material of this.materials()) {
      if (!(material instanceof MeshStandardMaterial) || material.flatShading === on) continue;
      material.flatShading = on;
      material.needsUpdate = true;
    }
  }

  /** Colours by the fourth numbers of shapes: `end` has the last colour, and `own` is 65535. */
  colourByValue(own: number, end: number): void {
    this.uniforms.byDeviation.value = 1;
    this.uniforms.deviationScale.value = own / end;
    this.uniforms.ramp.value = this.manyColours;
  }

  /** Colours by the fourth numbers of shapes, which are 65535 at marked vertices and 0 elsewhere. */
  colourByMark(): void {
    this.colourByValue(1, 1);
    this.uniforms.ramp.value = this.twoColours;
  }

  /** Colours by red, green and blue of every vertex in sRGB. */
  colourBy(colours: Uint8Array): void {
    this.setColours(colours, []);
  }

  /** Shows the body's own colours and textures; plain if it has none. */
  colourAsItIs(): void {
    this.setColours(this.body.colours, this.body.skin?.parts ?? []);
  }

  private setColours(colours: Uint8Array | null, parts: Skin['parts']): void {
    this.uniforms.byDeviation.value = 0;
    if (colours) this.geometry.setAttribute('color', linearColours(this.drawn(colours, 3)));
    this.materials().forEach((material, i) => {
      const { map = null, colour = null } = parts[i] ?? {};
      material.color.copy(colours || map ? new Color(1, 1, 1) : clay);
      if (colour) material.color.setRGB(...colour, SRGBColorSpace);
      material.vertexColors = colours !== null;
      material.map = map;
      material.needsUpdate = true;
    });
  }

  private materials(): (LineBasicMaterial | MeshStandardMaterial)[] {
    const { material } = this.surface;
    return (Array.isArray(material) ? material : [material]) as MeshStandardMaterial[];
  }

  /** Exchanges the fourth numbers of all shapes with these, of each shape one a vertex. */
  exchangeValues(values: Uint16Array[]): void {
    values.forEach((of, s) => {
      const shape = this.body.shapes[s];
      for (let v = 0; v < of.length; ++v) {
        [shape[4 * v + 3], of[v]] = [of[v], shape[4 * v + 3]];
      }
      if (this.positions[s]) this.sendAgain(s);
    });
  }

  /** Of the body's vertices a few numbers each; the same of those that are drawn. */
  private drawn<Values extends Uint8Array | Int8Array | Uint16Array>(values: Values, size: number): Values {
    const source = this.body.skin?.cut?.source;
    if (!source) return values;
    const spread = new (values.constructor as new (length: number) => Values)(size * source.length);
    source.forEach((from, v) => {
      for (let k = 0; k < size; ++k) spread[size * v + k] = values[size * from + k];
    });
    return spread;
  }

  /** To the GPU, a shape whose array has changed. */
  private sendAgain(node: number): void {
    const positions = this.positionsOf(node);
    positions.array.set(this.drawn(this.body.shapes[node], 4));
    positions.needsUpdate = true;
  }

  private positionsOf(node: number): BufferAttribute {
    const values = () => this.drawn(this.body.shapes[node], 4);
    return (this.positions[node] ??= new BufferAttribute(values(), 4, true));
  }

  private normalsOf(node: number): BufferAttribute {
    return (this.normals[node] ??= new BufferAttribute(
      this.drawn(vertexNormals(this.body, this.body.shapes[node]), 4),
      4,
      true,
    ));
  }

  /** Has a material's shaders draw the blend, and its colours. */
  private patch<Kind extends Material>(material: Kind): Kind {
    const hasNormals = material instanceof MeshStandardMaterial;
    const isSurface = hasNormals || this.isGraph;
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      shader.vertexShader = shader.vertexShader
        .replace(
          '#include <common>',
          `#include <common>\n${declarations}varying float vDeviation;\n${hasNormals ? normalDeclarations : ''}`,
        )
        .replace(
          '#include <begin_vertex>',
          'vec4 blended = blendedShape();\nvDeviation = blended.w;\nvec3 transformed = blended.xyz;',
        );
      if (hasNormals) {
        shader.vertexShader = shader.vertexShader.replace(
          '#include <beginnormal_vertex>',
          'vec3 objectNormal = blendedNormal();',
        );
      }
      if (!isSurface) return;
      shader.fragmentShader = shader.fragmentShader
        .replace(
          '#include <common>',
          `#include <common>
          varying float vDeviation;
          uniform float byDeviation, deviationScale;
          uniform sampler2D ramp;
          uniform vec3 backColour;`,
        )
        .replace(
          '#include <color_fragment>',
          `#include <color_fragment>
          if (byDeviation > 0.5) {
            float place = clamp(vDeviation * deviationScale, 0.0, 1.0) * 255.0 / 256.0 + 0.5 / 256.0;
            diffuseColor.rgb = texture2D(ramp, vec2(place, 0.5)).rgb;
            ${hasNormals ? 'if (!gl_FrontFacing) diffuseColor.rgb *= 0.5;' : ''}
          }
          ${hasNormals ? 'else if (!gl_FrontFacing) diffuseColor.rgb = backColour;' : ''}`,
        );
    };
    return material;
  }
}

function linearColours(colours: Uint8Array): BufferAttribute {
  const colour = new Color();
  const linear = new Float32Array(colours.length);
  for (let i = 0; i < colours.length; i += 3) {
    colour
      .setRGB(colours[i] / 255, colours[i + 1] / 255, colours[i + 2] / 255, SRGBColorSpace)
      .toArray(linear, i);
  }
  return new BufferAttribute(linear, 3);
}

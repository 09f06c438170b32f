// The bones of a glb, drawn over its body.
import {
  Bone,
  BufferGeometry,
  Float32BufferAttribute,
  Group,
  InstancedMesh,
  Matrix4,
  MeshStandardMaterial,
  OctahedronGeometry,
  Quaternion,
  Vector3,
  type Object3D,
} from 'three';
import type { Blend } from './blended_mesh';
import type { Skeleton } from './scene_data';

const boneColour = 0xe8c84a;
/** In sides of the cube around all shapes. */
const jointRadius = 0.008;
/** The widest place of a bone: where, and how wide, in its lengths. */
const waist = { at: 0.15, radius: 0.07 };

/** The joints below an object, each with the joint above it, and without places. */
export function jointsIn(root: Object3D): { joints: Bone[]; parents: number[] } {
  const joints: Bone[] = [];
  const parents: number[] = [];
  root.traverse((object) => {
    if (!(object instanceof Bone)) return;
    parents.push(joints.indexOf(object.parent as Bone));
    joints.push(object);
  });
  return { joints, parents };
}

/** From the origin to (0, 1, 0). */
function boneGeometry(): BufferGeometry {
  const { at, radius } = waist;
  const ring = [0, 1, 2, 3].map((k) => [
    radius * Math.cos((k * Math.PI) / 2),
    at,
    radius * Math.sin((k * Math.PI) / 2),
  ]);
  const [start, end] = [
    [0, 0, 0],
    [0, 1, 0],
  ];
  const triangles = ring.flatMap((corner, k) => {
    const next = ring[(k + 1) % 4];
    return [start, corner, next, end, next, corner];
  });
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(triangles.flat(), 3));
  geometry.computeVertexNormals();
  return geometry;
}

/** In the unit cube, as the body is. */
export class Bones extends Group {
  private readonly joints: InstancedMesh;
  private readonly bones: InstancedMesh;
  /** The joints at which bones end that begin at their parents. */
  private readonly ends: number[];

  constructor(private readonly skeleton: Skeleton) {
    super();
    const { parents } = skeleton;
    this.ends = parents.flatMap((parent, joint) => (parent < 0 ? [] : [joint]));
    // Seen through the body: whatever is nearer does not hide them.
    const material = new MeshStandardMaterial({
      color: boneColour,
      roughness: 0.8,
      flatShading: true,
      depthTest: false,
      transparent: true,
      opacity: 0.9,
    });
    this.joints = new InstancedMesh(new OctahedronGeometry(jointRadius), material, parents.length);
    this.bones = new InstancedMesh(boneGeometry(), material, this.ends.length);
    for (const mesh of [this.bones, this.joints]) {
      mesh.renderOrder = 1;
      mesh.frustumCulled = false;
      this.add(mesh);
    }
  }

  show({ nodes, weights }: Blend): void {
    const placeOf = (joint: number) => {
      const place = new Vector3();
      nodes.forEach((node, k) => {
        place.addScaledVector(new Vector3().fromArray(this.skeleton.places[node], 3 * joint), weights[k]);
      });
      return place;
    };
    const places = this.skeleton.parents.map((_, joint) => placeOf(joint));
    places.forEach((place, joint) => this.joints.setMatrixAt(joint, new Matrix4().setPosition(place)));
    this.ends.forEach((end, i) => {
      const start = places[this.skeleton.parents[end]];
      const along = places[end].clone().sub(start);
      const length = along.length();
      const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 1, 0), along.normalize());
      this.bones.setMatrixAt(i, new Matrix4().compose(start, turn, new Vector3(length, length, length)));
    });
    this.joints.instanceMatrix.needsUpdate = this.bones.instanceMatrix.needsUpdate = true;
  }
}

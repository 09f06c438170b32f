// The ground below a body, and the body's soft shadow on it.
import {
  Box3,
  CircleGeometry,
  Color,
  DirectionalLight,
  Float32BufferAttribute,
  Group,
  Mesh,
  MeshBasicMaterial,
  ShadowMaterial,
  Vector3,
} from 'three';

/** The radius of the ground, in half diagonals of what stands on it. */
const reach = 1.5;
/** Below the body, so that flat soles are not drawn through the ground. */
const gap = 0.002;
const shadowPixels = 256;
/** The ground is in its own shadow map, whose depths have 16 bits: nearer than this is the ground itself. */
const ownDepth = 1e-3;

/** A disc of radius 1, which fades towards its rim. */
function disc(): CircleGeometry {
  const circle = new CircleGeometry(1, 64);
  const count = circle.getAttribute('position').count;
  const colours = Array.from({ length: count }, (_, i) => [1, 1, 1, i === 0 ? 1 : 0]);
  circle.setAttribute('color', new Float32BufferAttribute(colours.flat(), 4));
  return circle;
}

export class Ground extends Group {
  private readonly floor = new MeshBasicMaterial({ vertexColors: true });
  private readonly shade = new ShadowMaterial({ opacity: 0.25 });
  /** Above, without light of its own: what it does not reach is in the shadow. */
  private readonly light = new DirectionalLight(0xffffff, 0);

  /** Some of the body's points in all of its shapes. */
  points: Vector3[] = [];

  constructor() {
    super();
    const shape = disc();
    for (const material of [this.floor, this.shade]) {
      material.transparent = true;
      material.depthWrite = false;
      const mesh = new Mesh(shape, material);
      mesh.receiveShadow = true;
      mesh.renderOrder = material === this.floor ? -2 : -1;
      this.add(mesh);
    }
    this.light.castShadow = true;
    this.light.shadow.mapSize.set(shadowPixels, shadowPixels);
    this.light.shadow.bias = -ownDepth;
    this.light.shadow.radius = 5;
    this.light.shadow.blurSamples = 8;
    this.add(this.light, this.light.target);
  }

  /** Puts the ground where the body stands if `up` is up. */
  place(up: Vector3): void {
    this.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), up.clone().normalize());
    const toGround = this.quaternion.clone().invert();
    const box = new Box3();
    for (const point of this.points) box.expandByPoint(point.clone().applyQuaternion(toGround));
    const middle = box.getCenter(new Vector3()).setZ(box.min.z - gap);
    this.position.copy(middle.applyQuaternion(this.quaternion));
    const size = box.getSize(new Vector3());
    const radius = reach * 0.5 * Math.hypot(size.x, size.y);
    for (const mesh of this.children) if (mesh instanceof Mesh) mesh.scale.setScalar(radius);
    this.light.position.set(0, 0, 2 * size.z + radius);
    const { camera } = this.light.shadow;
    Object.assign(camera, { left: -radius, right: radius, bottom: -radius, top: radius });
    camera.near = 0.1 * radius;
    camera.far = 2 * this.light.position.z;
    camera.updateProjectionMatrix();
  }

  /** Brighter than what is behind it. */
  set background(colour: Color) {
    this.floor.opacity = 0.05 + 0.6 * colour.getHSL({ h: 0, s: 0, l: 0 }).l;
  }
}

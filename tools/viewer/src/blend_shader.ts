// What shaders that draw a blend of three shapes begin with.
export const declarations = /* glsl */ `
attribute vec4 shapeA, shapeB, shapeC;
uniform float weightB, weightC;
vec4 blendedShape() {
  return shapeA + weightB * (shapeB - shapeA) + weightC * (shapeC - shapeA);
}
`;

// Colours of the deviation: those of film strips, mixed in Oklab (Ottosson 2020), in which equal
// steps look equal.
const stops = [0xb9cadc, 0xdfc18f, 0xe8923f, 0xcf3f2b, 0x861426];

export type Triple = [number, number, number];

function toLinear(srgb: number): number {
  return srgb <= 0.04045 ? srgb / 12.92 : ((srgb + 0.055) / 1.055) ** 2.4;
}

function toByte(linear: number): number {
  const c = Math.min(1, Math.max(0, linear));
  return Math.round(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055));
}

function cubeRoots(hex: number): Triple {
  const [r, g, b] = [16, 8, 0].map((shift) => toLinear(((hex >> shift) & 255) / 255));
  return [
    Math.cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b),
    Math.cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b),
    Math.cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b),
  ];
}

function toRgb(roots: Triple): Triple {
  const [l, m, s] = roots.map((root) => root ** 3);
  return [
    toByte(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
    toByte(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
    toByte(-0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s),
  ];
}

/** The colour of a value in 0 .. 1, in sRGB bytes. */
export function rampColour(value: number): Triple {
  const place = Math.min(1, Math.max(0, value)) * (stops.length - 1);
  const span = Math.min(Math.floor(place), stops.length - 2);
  const t = place - span;
  const [a, b] = [cubeRoots(stops[span]), cubeRoots(stops[span + 1])];
  return toRgb([0, 1, 2].map((k) => (1 - t) * a[k] + t * b[k]) as Triple);
}

// Less than a half, so that halfway between two shapes what is marked in either has the colour.
const leastMarked = 0.45;

/** The colour of what is marked, with the value 1, or not, with 0: one of two, also in between. */
export function markColour(value: number): Triple {
  return rampColour(value < leastMarked ? 0 : 0.75);
}

/** The whole scale, from left to right, for a style. */
export function rampGradient(): string {
  const colours = Array.from({ length: 17 }, (_, i) => `rgb(${rampColour(i / 16).join(' ')})`);
  return `linear-gradient(to right, ${colours.join(', ')})`;
}

/** The two colours of marks, side by side, for a style. */
export function markGradient(): string {
  const [no, yes] = [0, 1].map((value) => `rgb(${markColour(value).join(' ')})`);
  return `linear-gradient(to right, ${no} 50%, ${yes} 50%)`;
}

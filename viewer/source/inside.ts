import type { Frame, Welcome } from "./protocol";

/** Slices of one wavelength in which the spheres of an elastic wall tell its radius. */
const SLICES = 24;

/** Whether a grain is inside the tube: its centre is no farther from the axis than the radius there and its own. */
export function insideOf(frame: Frame, tube: Welcome): (grain: number) => boolean {
  const { position, diameter } = frame;
  const radius = radiusOf(frame, tube);
  const least = frame.wall_spheres === 0 ? frame.ringRadius.reduce((a, b) => Math.min(a, b)) : 0;
  return (grain) => {
    const [x, y] = [position[3 * grain], position[3 * grain + 1]];
    const [square, half] = [x * x + y * y, 0.5 * diameter[grain]];
    // Nearly all grains are within the throat, and need no look at the wall where they are.
    if (square <= (least + half) ** 2) return true;
    // NaN, of one that waits outside, is inside of nothing.
    return square <= (radius(position[3 * grain + 2]) + half) ** 2;
  };
}

/** Radius of the tube at any z, to the centres of the wall's spheres. */
function radiusOf(frame: Frame, tube: Welcome): (z: number) => number {
  const { wall, ringRadius, rings } = frame;
  if (frame.wall_spheres === 0) {
    const each = tube.wavelength / rings;
    return (z) => {
      const ring = Math.floor(z / each);
      const part = z / each - ring;
      return (1 - part) * ringRadius[folded(ring, rings)] + part * ringRadius[folded(ring + 1, rings)];
    };
  }
  const slices = SLICES * tube.waves;
  const [sums, counts] = [new Float64Array(slices), new Float64Array(slices)];
  const slice = (z: number) => folded(Math.floor((slices * z) / tube.length), slices);
  for (let i = 0; i < frame.wall_spheres; i++) {
    const at = slice(wall[3 * i + 2]);
    sums[at] += Math.hypot(wall[3 * i], wall[3 * i + 1]);
    counts[at] += 1;
  }
  return (z) => (counts[slice(z)] > 0 ? sums[slice(z)] / counts[slice(z)] : tube.radius);
}

const folded = (number: number, period: number): number => ((number % period) + period) % period;

import type { Frame, Welcome } from "./protocol";

/** A quantity that colours grains. */
export interface Field {
  name: string;
  /** Ends of the scale as they are written below it. */
  ends: [string, string];
  diverging: boolean;
  /** From -1 to 1 where it diverges, from 0 to 1 otherwise. */
  values(frame: Frame, tube: Welcome, into: Float32Array): void;
}

const speed = (frame: Frame) => frame.wave_speed || NaN;

export const FIELDS: Record<string, Field> = {
  axial: {
    name: "axial velocity",
    ends: ["−c", "c"],
    diverging: true,
    values(frame, tube, into) {
      const scale = tube.heading / speed(frame);
      for (let i = 0; i < into.length; i++) into[i] = scale * frame.velocity[3 * i + 2];
    },
  },
  total: {
    name: "speed",
    ends: ["0", "c"],
    diverging: false,
    values(frame, _, into) {
      const { velocity } = frame;
      for (let i = 0; i < into.length; i++)
        into[i] = Math.hypot(velocity[3 * i], velocity[3 * i + 1], velocity[3 * i + 2]) / speed(frame);
    },
  },
  place: {
    name: "distance from the axis",
    ends: ["0", "R"],
    diverging: false,
    values(frame, tube, into) {
      const reach = tube.control === "strain" ? tube.radius : 1.6 * tube.radius;
      for (let i = 0; i < into.length; i++)
        into[i] = Math.hypot(frame.position[3 * i], frame.position[3 * i + 1]) / reach;
    },
  },
  wave: {
    name: "place in the wave",
    ends: ["0", "λ"],
    diverging: false,
    values(frame, tube, into) {
      for (let i = 0; i < into.length; i++) into[i] = inWave(frame, tube, frame.position[3 * i + 2]);
    },
  },
  size: {
    name: "diameter",
    ends: ["0.8 d", "1 d"],
    diverging: false,
    values(frame, _, into) {
      for (let i = 0; i < into.length; i++) into[i] = (frame.diameter[i] - 0.8) / 0.2;
    },
  },
  number: {
    name: "number (to follow mixing)",
    ends: ["first", "last"],
    diverging: false,
    values(_, __, into) {
      for (let i = 0; i < into.length; i++) into[i] = i / Math.max(1, into.length - 1);
    },
  },
};

/** Position in the frame of the wave, in wavelengths from 0 to 1. */
export function inWave(frame: Frame, tube: Welcome, z: number): number {
  const position = (tube.heading * z) / tube.wavelength - frame.period;
  return position - Math.floor(position);
}

export type Colour = [number, number, number];
/** Blue, white, red: equal steps of lightness on both sides. */
const BLUE_RED: Colour[] = [[20, 70, 160], [110, 165, 215], [246, 244, 240], [240, 140, 105], [165, 15, 30]];
/** Light rises from end to end, for every eye. */
const BLUE_YELLOW: Colour[] = [[0, 34, 88], [64, 82, 108], [123, 123, 120], [187, 169, 108], [253, 234, 95]];
const SEQUENTIAL: Colour[] = [[48, 18, 90], [38, 92, 150], [36, 150, 140], [130, 200, 90], [250, 230, 60]];

/** The scale of colours of a field. */
export function stops(field: Field, lightness: boolean): Colour[] {
  if (lightness) return BLUE_YELLOW;
  return field.diverging ? BLUE_RED : SEQUENTIAL;
}

/** Colour at a place from 0 to 1 of a scale. */
export function colourAt(scale: Colour[], part: number): Colour {
  if (Number.isNaN(part)) return [150, 150, 150];
  const at = Math.min(1, Math.max(0, part)) * (scale.length - 1);
  const below = Math.min(scale.length - 2, Math.floor(at));
  const mix = at - below;
  return [0, 1, 2].map((k) => scale[below][k] + mix * (scale[below + 1][k] - scale[below][k])) as Colour;
}

export const css = ([red, green, blue]: Colour) => `rgb(${red.toFixed(0)} ${green.toFixed(0)} ${blue.toFixed(0)})`;

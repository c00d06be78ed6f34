import { written } from "./charts";
import { GRAINS_COVERED, MOST_CONTACTS } from "./messages";
import type { Frame, Welcome } from "./protocol";

/** A quantity that colours grains. */
export interface Field {
  name: string;
  /** Ends of the scale as they are written below it; of some, where they come to be known with the values. */
  ends: [string, string];
  diverging: boolean;
  /** Whether its last value is its first again. */
  cyclic?: boolean;
  /** Whether it is made of the contacts, which are sent where they are asked for. */
  ofContacts?: boolean;
  /** From -1 to 1 where it diverges, from 0 to 1 otherwise. */
  values(frame: Frame, tube: Welcome, into: Float32Array): void;
}

/** The speed that colours reach to: that of the wave, or where it stands a round one that few grains exceed. */
export function speedOf({ wave_speed, grains, position, velocity }: Frame): number {
  if (wave_speed !== 0) return wave_speed;
  const speeds: number[] = [];
  for (let i = 0; i < grains; i++)
    if (!Number.isNaN(position[3 * i])) speeds.push(Math.hypot(velocity[3 * i], velocity[3 * i + 1], velocity[3 * i + 2]));
  const most = Float64Array.from(speeds).sort()[Math.floor(GRAINS_COVERED * (speeds.length - 1))];
  if (!(most > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(most));
  return power * ([1, 2, 5].find((it) => it * power >= most) ?? 10);
}

export const FIELDS: Record<string, Field> = {
  axial: {
    name: "axial velocity",
    ends: ["−c against", "c along"],
    diverging: true,
    values(frame, tube, into) {
      const speed = speedOf(frame);
      this.ends = frame.wave_speed === 0 ? [`−${written(speed)} d/t`, `${written(speed)} d/t`] : ["−c against", "c along"];
      const scale = tube.heading / speed;
      for (let i = 0; i < into.length; i++) into[i] = scale * frame.velocity[3 * i + 2];
    },
  },
  total: {
    name: "speed",
    ends: ["0", "c"],
    diverging: false,
    values(frame, _, into) {
      const { velocity } = frame;
      const speed = speedOf(frame);
      this.ends[1] = frame.wave_speed === 0 ? `${written(speed)} d/t` : "c";
      for (let i = 0; i < into.length; i++)
        into[i] = Math.hypot(velocity[3 * i], velocity[3 * i + 1], velocity[3 * i + 2]) / speed;
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
    name: "position in the wave",
    ends: ["0", "λ"],
    diverging: false,
    cyclic: true,
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
  coordination: {
    name: "contacts of a grain",
    ends: ["0", String(MOST_CONTACTS)],
    diverging: false,
    ofContacts: true,
    values(frame, _, into) {
      into.fill(lacks(this, frame) ? NaN : 0);
      eachContact(frame, (grain) => (into[grain] += 1 / MOST_CONTACTS));
    },
  },
  pressure: {
    name: "pressure on a grain",
    ends: ["0", "p"],
    diverging: false,
    ofContacts: true,
    values(frame, tube, into) {
      if (lacks(this, frame)) return void into.fill(NaN);
      // Sum of f r/(3 V), V = pi d^3/6 and r = d/2: f/(pi d^2).
      into.fill(0);
      eachContact(frame, (grain, force) => (into[grain] += force / (Math.PI * frame.diameter[grain] ** 2)));
      const largest = into.slice().sort()[Math.floor(GRAINS_COVERED * (into.length - 1))];
      if (scaled !== tube) [scaled, usual] = [tube, 0];
      usual = usual > 0 ? usual + 0.05 * (largest - usual) : largest;
      this.ends[1] = `${written(usual, 2)} m/(d t²)`;
      for (let i = 0; i < into.length; i++) into[i] /= usual || 1;
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

/** The pressure that the colours reach to, which follows slowly, and the tube that it is of. */
let usual = 0;
let scaled: Welcome | null = null;

/** Whether a frame has not the contacts that a field is made of. */
export const lacks = ({ ofContacts }: Field, { contacts, sample }: Frame): boolean =>
  ofContacts === true && contacts === 0 && sample?.contacts !== 0;

/** Each contact from the side of each of its grains. */
function eachContact({ touching, contacts }: Frame, see: (grain: number, force: number) => void): void {
  for (let k = 0; k < contacts; k++) {
    const force = touching[6 * k + 5];
    see(touching[6 * k], force);
    if (touching[6 * k + 1] >= 0) see(touching[6 * k + 1], force);
  }
}

/** Position in the wave frame, in wavelengths from 0 to 1. */
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
/** Its end is its begin. */
const ROUND: Colour[] = [[226, 217, 226], [98, 118, 186], [47, 20, 54], [178, 84, 82], [226, 217, 226]];

/** Each grain's place on the scale of a field, from 0 to 1; no number where it has none. */
export function partsOf(field: Field, frame: Frame, tube: Welcome, into = new Float32Array(frame.grains)): Float32Array {
  field.values(frame, tube, into);
  if (field.diverging) for (let i = 0; i < into.length; i++) into[i] = 0.5 + 0.5 * into[i];
  return into;
}

/** The scale of colours of a field. */
export function stops(field: Field, lightness: boolean): Colour[] {
  if (field.cyclic) return ROUND;
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

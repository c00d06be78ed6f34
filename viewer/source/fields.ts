import { written } from "./charts";
import { type Colour, CYCLIC, DIVERGING, GRAINS_COVERED, MOST_CONTACTS, SEQUENTIAL } from "./messages";
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
    ends: ["", ""],
    diverging: false,
    values(frame, _, into) {
      const sizes = frame.diameter.slice(0, into.length).sort();
      let [least, largest] = [sizes[0], sizes[sizes.length - 1]];
      if (!(largest > least)) [least, largest] = [least - 0.5, largest + 0.5];
      this.ends = [`${written(least)} d`, `${written(largest)} d`];
      for (let i = 0; i < into.length; i++) into[i] = (frame.diameter[i] - least) / (largest - least);
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

/** Each grain's place on the scale of a field, from 0 to 1; no number where it has none. */
export function partsOf(field: Field, frame: Frame, tube: Welcome, into = new Float32Array(frame.grains)): Float32Array {
  field.values(frame, tube, into);
  if (field.diverging) for (let i = 0; i < into.length; i++) into[i] = 0.5 + 0.5 * into[i];
  return into;
}

/** The scale of colours of a field; by lightness one whose light rises from end to end, for every eye. */
export function stops(field: Field, lightness: boolean): Colour[] {
  if (field.cyclic) return CYCLIC;
  return field.diverging && !lightness ? DIVERGING : SEQUENTIAL;
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

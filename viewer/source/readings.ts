/** Numbers of a frame in words: names with values. */
import { written } from "./charts";
import { inWave } from "./fields";
import { type Driven, type Frame, type Steered, unitOfTime, type Welcome } from "./protocol";

type Facts = [string, string][];

/** How much of a recording there is to see. */
export function extent({ recorded }: Welcome): string {
  if (!recorded) return "";
  const lost = recorded.lost_frames > 0 ? ", cut short" : "";
  return ` · ${recorded.clocks.length.toLocaleString("en")} recorded frames${lost}`;
}

/** The sample that was taken last. */
export function factsOfSample({ sample }: Frame, tube: Welcome): Facts {
  const ends: Facts = [
    ["discharge rate", sample ? `${written(sample.discharge_rate)} m/t` : "–"],
    ["hold-up", sample ? `${written(sample.hold_up, 4)} m` : "–"],
  ];
  return [
    ...(tube.open ? ends : []),
    ["bottleneck w", sample ? `${written(sample.bottleneck)} d` : "–"],
    ["contacts of a grain Z, escaped too", sample ? written(sample.contacts) : "–"],
    ["granular temperature, escaped too", sample ? `${written(sample.granular_temperature)} m d²/t²` : "–"],
    ["power of the wall", sample ? `${written(sample.wall_power)} m d²/t³` : "–"],
    ["escaped grains", sample ? String(sample.escaped) : "–"],
    ["energy unaccounted, part", sample ? written(sample.energy_residual ?? NaN, 2) : "–"],
  ];
}

/** One grain. */
export function factsOfGrain(frame: Frame, tube: Welcome, grain: number): Facts {
  const [x, y, z] = frame.position.subarray(3 * grain, 3 * grain + 3);
  const [vx, vy, vz] = frame.velocity.subarray(3 * grain, 3 * grain + 3);
  const [c, unit] = frame.wave_speed === 0 ? [1, "d/t"] : [frame.wave_speed, "c"];
  const itself: Facts = [
    ["grain", String(grain)],
    ["diameter dᵢ", `${written(frame.diameter[grain])} d`],
  ];
  if (Number.isNaN(x)) return [...itself, ["place", "waits outside"]];
  const facts: Facts = [
    ...itself,
    ["from the axis", `${written(Math.hypot(x, y))} d`],
    ["along the tube", `${written(z, 4)} d`],
    ["position in the wave", `${written(inWave(frame, tube, z))} λ`],
    ["along the wave", `${written((tube.heading * vz) / c)} ${unit}`],
    ["speed", `${written(Math.hypot(vx, vy, vz) / c)} ${unit}`],
  ];
  if (frame.turning) {
    const spin = frame.spin.subarray(3 * grain, 3 * grain + 3);
    facts.push(["spin |ω|", `${written(Math.hypot(spin[0], spin[1], spin[2]))} t⁻¹`]);
  }
  return facts;
}

/** What drove a recorded run. */
export function factsOfDrive(values: Driven): Facts {
  const of = (key: Steered, name: string, unit: string): Facts => {
    const value = values[key];
    return value === null ? [] : [[name, written(value) + unit]];
  };
  return [
    ...of("width", "width w", " d"),
    ...of("force_amplitude", "force amplitude fᴾ", " m d/t²"),
    ...of("strain_rate", "strain rate ε̇", " t⁻¹"),
    ...of("friction", "kinetic friction μₖ", ""),
  ];
}

/** A number that another state would hardly have. */
function digest(frame: Frame): number {
  let sum = 0;
  for (const numbers of [frame.position, frame.velocity]) {
    const bits = new Uint32Array(numbers.buffer, numbers.byteOffset, numbers.length);
    for (const word of bits) sum = (Math.imul(sum, 16777619) ^ word) >>> 0;
  }
  return sum;
}

/** The unit of clocks, for who does not see the page. */
export const inWords = (tube: Welcome): string => (unitOfTime(tube) === "T" ? "periods" : "units of time");

/** The state in a sentence, for who does not see the page. */
export function summaryOf(frame: Frame, tube: Welcome, ratio: number): string {
  const { width, force_amplitude } = frame.driven;
  const drive = width !== null ? `width ${written(width)}` : force_amplitude !== null ? `force ${written(force_amplitude)}` : "";
  const flow = Number.isNaN(ratio) ? "" : `flow rate ${written(ratio, 2)} of the largest, `;
  return `${frame.clock.toFixed(1)} ${inWords(tube)}: ${flow}${drive}${frame.playing ? "" : ", paused"}`;
}

/** What tests look at of a frame. */
export const measuredOf = (frame: Frame | null | undefined) => ({
  clock: frame?.clock ?? 0,
  number: frame?.number ?? null,
  ratio: frame?.sample?.flow_rate_ratio ?? null,
  contacts: frame?.contacts ?? 0,
  step: frame?.step ?? 0,
  digest: frame ? digest(frame) : 0,
});

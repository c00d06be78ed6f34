/** What the server sends and takes; crates/viewer/src/{frame,welcome,message}.rs say the same. */

export type Range = [number, number] | null;
export type Steered = "width" | "force_amplitude" | "strain_rate" | "friction";
export type Driven = Record<Steered, number | null>;

/** A row of the time series. */
export interface Row {
  number: number;
  /** Time in periods of the drive's own strain rate. */
  clock: number;
  flow_rate_ratio: number | null;
  bottleneck: number | null;
  /** Of an open tube. */
  discharge_rate: number | null;
  /** Width or force amplitude. */
  amplitude: number;
  strain_rate: number;
  /** J/Jmax averaged over the period that ends here: the page works it out, but of rows that come thinned. */
  average: number;
  /** Friction at this time, as far as the page knows it. */
  friction: number | null;
}

export interface Welcome {
  type: "welcome";
  version: string;
  title: string;
  control: "strain" | "stress";
  grains: number;
  length: number;
  /** Whether grains leave the tube at its ends; otherwise it is periodic. */
  open: boolean;
  wavelength: number;
  waves: number;
  radius: number;
  spheres_per_ring: number;
  rings_per_wave: number;
  wall_sphere_diameter: number;
  heading: number;
  reach: number;
  /** Duration of a period, the unit of every clock; null where the wave stands, and clocks tell t. */
  unit_period: number | null;
  ranges: Record<Steered, Range>;
  /** J/Jmax of a Newtonian fluid by the width. */
  newtonian: [number, number][];
  driven: Driven;
  record: [number, number | null][];
  rows: Row[];
  end: number;
  /** Samples after which a watched run stops. */
  most_samples: number;
  /** The frames of a recording; null where the run is computed. */
  recorded: { clocks: number[]; lost_frames: number } | null;
  /** The study that it was opened from. */
  within: { study: string; number: number; siblings: { number: number; replicate: number }[] } | null;
}

/** The unit of clocks. */
export const unitOfTime = ({ unit_period }: Welcome): "T" | "t" => (unit_period === null ? "t" : "T");

/** The label of an axis of time. */
export const timeAxis = (tube: Welcome): string => (unitOfTime(tube) === "T" ? "time / periods T" : "time / t");

export interface Saved {
  type: "saved";
  /** Null where the page keeps the state. */
  folder: string | null;
  command: string;
  toml: string;
  /** The checkpoint in base64, where the page keeps it. */
  state: string | null;
  period: number;
}

export interface Problem {
  type: "problem";
  message: string;
}

/** A frame of a recording that cannot be had. */
export interface Missing {
  type: "missing";
  number: number;
  message: string;
}

/** How a run was steered: at which step, which parameter, to which value. */
export type Turn = [number, Steered, number];

/** What takes a run like this one to the same bits. */
export interface Course {
  type: "course";
  turns: Turn[];
  step: number;
}

export type Told = Welcome | Saved | Problem | Missing | Course;

export interface Head {
  /** Number of a recorded frame. */
  number: number | null;
  /** A frame from before the page came. */
  past: boolean;
  epoch: number;
  playing: boolean;
  ended: boolean;
  /** Periods a second that were asked for. */
  speed: number | null;
  step: number;
  time: number;
  clock: number;
  period: number;
  wave_speed: number;
  grains: number;
  wall_spheres: number;
  rings: number;
  turning: boolean;
  contacts: number;
  driven: Driven;
  /** Where the sliders lead. */
  aims: Driven;
  rows: Row[];
  sample: {
    flow_rate: number;
    flow_rate_ratio: number | null;
    granular_temperature: number;
    contacts: number;
    escaped: number;
    bottleneck: number;
    wall_power: number;
    energy_residual: number | null;
    /** Of an open tube, as is the next. */
    discharge_rate: number | null;
    hold_up: number | null;
  } | null;
  /** What is doubtful of the run so far, each with the key to change. */
  warnings: { key: string; message: string }[];
}

/** The spheres at one time; vectors as x y z x y z ... in the frame of the tube. */
export interface Frame extends Head {
  bytes: number;
  /** NaN of a grain that waits outside an open tube. */
  position: Float32Array;
  velocity: Float32Array;
  diameter: Float32Array;
  /** Angular velocities, or nothing where grains do not turn. */
  spin: Float32Array;
  /** Centres of the spheres of an elastic wall. */
  wall: Float32Array;
  /** Radii of the rings of one wavelength of a prescribed wall. */
  ringRadius: Float32Array;
  /** Contacts: grain, partner or -1 for the wall, x y z of the partner, normal force. */
  touching: Float32Array;
}

export type Command =
  | { type: "play"; playing: boolean }
  | { type: "speed"; periods_per_second: number | null }
  | { type: "step" }
  | { type: "steer"; parameter: Steered; value: number }
  | { type: "seek"; period: number }
  | { type: "save" }
  | { type: "course" }
  | { type: "follow"; turns: Turn[]; step: number }
  | { type: "contacts"; shown: boolean }
  | { type: "frame"; number: number };

/** Takes a frame apart; its arrays look into the bytes, nothing is copied. */
export function decode(bytes: ArrayBuffer): Frame {
  const headBytes = new DataView(bytes).getUint32(0, true);
  const text = new TextDecoder().decode(new Uint8Array(bytes, 4, headBytes));
  const head = JSON.parse(text) as Head;
  let at = 4 + headBytes;
  const take = (count: number) => {
    const numbers = new Float32Array(bytes, at, count);
    at += 4 * count;
    return numbers;
  };
  return {
    ...head,
    bytes: bytes.byteLength,
    position: take(3 * head.grains),
    velocity: take(3 * head.grains),
    diameter: take(head.grains),
    spin: take(head.turning ? 3 * head.grains : 0),
    wall: take(3 * head.wall_spheres),
    ringRadius: take(head.rings),
    touching: take(6 * head.contacts),
  };
}

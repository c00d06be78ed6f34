// What program and page say to each other, from the types in crates/viewer/src; made by
// UPDATE_EXPECT=1 cargo test -p peristalsis-viewer --lib typescript
// A number that is not finite is sent as null.

/** The tube and the ranges of its sliders. */
export type Welcome = {
  type: "welcome",
  version: string,
  title: string,
  control: "strain" | "stress",
  grains: number,
  length: number,
  /** Whether grains leave the tube at its ends; otherwise it is periodic. */
  open: boolean,
  wavelength: number,
  waves: number,
  radius: number,
  spheres_per_ring: number,
  rings_per_wave: number,
  wall_sphere_diameter: number,
  heading: number,
  /** Largest expected radius. */
  reach: number,
  /** Duration of a period at the strain rate of the drive, the unit of every clock; null where the wave stands, and clocks tell t. */
  unit_period: number | null,
  ranges: Sliders<[number, number]>,
  /** J/Jmax of a Newtonian fluid against no pressure by the width \[d\]; empty where the force is prescribed, and where the wave is no sine that moves. */
  newtonian: Array<[number, number]>,
  driven: Sliders<number>,
  /** The preset that differs in nothing but what sliders and the length of the tube may change: published branches are of some presets. */
  published: string | null,
  /** The whole time series of a run that was computed before: (time in periods, J/Jmax). */
  record: Array<[number, number | null]>,
  /** The time series since the viewer began, or of a recording. */
  rows: Array<Row>,
  /** Time in periods of the state that the viewer began with. */
  begin: number,
  /** Duration of the run in periods. */
  end: number,
  /** Samples after which a watched run stops. */
  most_samples: number,
  /** The frames of a recording; null where the run is computed. */
  recorded: Recorded | null,
  /** The study that it was opened from; null where it was opened by itself. */
  within: Within | null,
};

/** What belongs to each parameter that may have a slider; nothing for a parameter that cannot be changed. */
export type Sliders<T> = {
  width: T | null,
  force_amplitude: T | null,
  strain_rate: T | null,
  friction: T | null,
};

/** A parameter that can be changed while a run goes on. */
export type Steered = "width" | "force_amplitude" | "strain_rate" | "friction";

/** A row of the time series, for the charts. */
export type Row = {
  number: number,
  /** Time in periods of the drive's own strain rate. */
  clock: number,
  flow_rate_ratio: number | null,
  /** Its mean over the period that ends here. */
  average: number | null,
  bottleneck: number | null,
  /** Of an open tube. */
  discharge_rate: number | null,
  /** Width or force amplitude. */
  amplitude: number | null,
  strain_rate: number | null,
};

/** The frames of a recording. */
export type Recorded = {
  /** Time of each in periods. */
  clocks: Array<number>,
  /** Number of frames lost where the file was cut short. */
  lost_frames: number,
};

/** The place of a run in its study. */
export type Within = {
  /** Name of the study. */
  study: string,
  /** Number of the run in the addresses of pages. */
  number: number,
  /** The finished runs of the same point, and this one. */
  siblings: Array<Sibling>,
};

/** A run of the same point with other random numbers. */
export type Sibling = {
  number: number,
  /** Number of the replicate, from 0. */
  replicate: number,
};

/** The head of a frame. */
export type Head = {
  /** Number of a recorded frame, counted from 0; null where the run is computed. */
  number: number | null,
  /** Whether the run has gone on from here since; such frames come after a welcome, without rows. */
  past: boolean,
  /** Grows when the run jumps back, which makes frames after that time void. */
  epoch: number,
  playing: boolean,
  /** Whether the run diverged, so that no frame follows. */
  ended: boolean,
  /** Speed asked for in periods per second; null is as fast as possible. */
  speed: number | null,
  step: number,
  time: number,
  /** Time in periods of the drive's own strain rate. */
  clock: number,
  /** Wavelengths that the wave has run. */
  period: number,
  wave_speed: number,
  grains: number,
  wall_spheres: number,
  rings: number,
  turning: boolean,
  /** Number of contacts; 0 where nobody asked for them. */
  contacts: number,
  driven: Sliders<number>,
  /** Where the sliders lead: the driven values, unless a parameter is on its way. */
  aims: Sliders<number>,
  /** The last rows of the time series; clients know by their numbers which they have. */
  rows: Array<Row>,
  /** The last sample. */
  sample: Shown | null,
  /** Warnings about the run so far; about the whole run if it is a recording. */
  warnings: Array<{ key: string, message: string }>,
};

/** Numbers of a sample that are shown. */
export type Shown = {
  flow_rate: number,
  flow_rate_ratio: number | null,
  granular_temperature: number,
  contacts: number,
  escaped: number,
  bottleneck: number,
  wall_power: number,
  energy_residual: number | null,
  /** Mass that an open tube discharges a time, 0 of a periodic one; `hold_up` is the mass inside. */
  discharge_rate: number,
  hold_up: number,
};

/** A message to clients other than a frame. */
export type Notice = {
  "type": "saved",
  /** The folder; none where the page keeps the state. */
  folder: string | null,
  /** What goes on from there. */
  command: string,
  /** The configuration. */
  toml: string,
  /** Whether it makes the same run from the start: a change of friction does not stand in it. */
  repeats: boolean,
  /** The checkpoint in base64, where the page is to keep it. */
  state: string | null,
  /** Time in periods. */
  period: number,
} | {
  "type": "course",
  /** In the order of time. */
  turns: Array<Turn>,
  /** The present step. */
  step: number,
} | {
  "type": "missing",
  /** Which, counted from 0. */
  number: number,
  /** Why, in words. */
  message: string,
} | {
  "type": "problem",
  /** What, in words. */
  message: string,
};

/** A parameter that was led to a value at a step. */
export type Turn = [number, Steered, number];

/** A command of a client. */
export type Command = {
  "type": "play",
  /** Whether to go on. */
  playing: boolean,
} | {
  "type": "speed",
  /** Periods of the wave a second, at most; as fast as possible where it is missing. */
  periods_per_second: number | null,
} | {
  "type": "step",
} | {
  "type": "steer",
  /** Which. */
  parameter: Steered,
  /** The value, in the unit of its key. */
  value: number,
} | {
  "type": "seek",
  /** Time in periods of the drive's own strain rate. */
  period: number,
} | {
  "type": "save",
} | {
  "type": "course",
} | {
  "type": "follow",
  /** In the order of time. */
  turns: Array<Turn>,
  /** Where to stop. */
  step: number,
} | {
  "type": "contacts",
  /** Whether to send them. */
  shown: boolean,
} | {
  "type": "frame",
  /** Which, counted from 0. */
  number: number,
};

/** Studies and figures, for the page of results. */
export type List = {
  studies: Array<Listed>,
  figures: Array<Figure>,
};

/** A study in the list. */
export type Listed = {
  name: string,
  title: string,
  /** Finished runs in it. */
  rows: number,
};

/** A figure with its caption, and the names of the studies behind it. */
export type Figure = {
  /** Short name of the claim. */
  claim: string,
  /** Title of the claim, in markup. */
  title: string,
  verdict: string,
  /** Caption, in markup. */
  caption: string,
  studies: Array<string>,
};

/** A study in JSON, for its page. */
export type Study = {
  version: number,
  name: string,
  title: string,
  columns: Array<Column>,
  /** Number of the run of each row; null where it cannot be watched. */
  runs: Array<number | null>,
  counts: { [key in string]: number },
  /** Whether there may be more rows later. */
  growing: boolean,
  /** The folder of its runs, as a word of a shell; null for a table alone. */
  store: string | null,
};

/** A column of its table. */
export type Column = {
  name: string,
  /** Words or symbol at an axis, with the unit. */
  label: string,
  description: string,
  /** NaN, a missing number, is null. */
  values: Array<number | string | boolean | null>,
};

// What crates/run/src/scene/drawn.rs says of each.
export const STONE = [207, 202, 193];
export const SHRUNK = 0.32;
export const ROD = [0.02, 0.11];
export const FORCES_COVERED = 0.97;
export const GRAINS_COVERED = 0.98;
export const MOST_CONTACTS = 12;
export type Colour = [number, number, number];
export const DIVERGING: Colour[] = [[12, 66, 130], [40, 112, 178], [98, 164, 207], [172, 210, 229], [250, 250, 250], [251, 205, 180], [236, 142, 112], [204, 64, 66], [134, 8, 36]];
export const SEQUENTIAL: Colour[] = [[68, 1, 84], [72, 36, 117], [65, 68, 135], [53, 95, 141], [42, 120, 142], [33, 145, 140], [34, 168, 132], [68, 191, 112], [122, 209, 81], [189, 223, 38], [253, 231, 37]];
export const CYCLIC: Colour[] = [[226, 217, 226], [154, 186, 201], [97, 119, 186], [93, 60, 156], [47, 20, 54], [118, 34, 79], [178, 86, 82], [207, 166, 143], [226, 217, 226]];
export const FORCE: Colour[] = [[70, 60, 110], [150, 50, 120], [225, 80, 60], [255, 170, 50], [255, 250, 190]];

/** The rows of a study: what was varied, what was measured, and points with their errors. */

import type { Study } from "./messages";

export type Value = number | string;

/** A column that rows are told apart by. */
export interface Parameter {
  name: string;
  label: string;
  /** Its values, ascending. */
  values: Value[];
}

/** A column of numbers that were measured. */
export interface Quantity {
  name: string;
  label: string;
  description: string;
}

/** Rows that differ by their random numbers alone. */
export interface Point {
  rows: number[];
  start: string;
  x: number;
  /** The member of the family, or the place on the other axis; null where there is none. */
  other: Value | null;
  /** What tube it is, where tubes differ and none of what they differ in goes across. */
  tube: string;
  value: number;
  /** Standard error; NaN where it is not known. */
  error: number;
  /** Runs behind the value. */
  number: number;
  /** Whether the value is a lower limit: runs ended before what it is the time of. */
  atLeast: boolean;
  /** Runs that ended before. */
  censored: number;
}

/** Columns that say how a run was made, in the order in which they are offered. */
const PARAMETERS = [
  "width", "force_amplitude", "strain_rate", "wave_speed", "volume_fraction", "number_density", "body_force",
  "pressure_rise", "radius", "wavelength", "waves", "spheres_per_ring", "rings_per_wave", "kinetic_friction",
  "time_step",
];

/** Columns that are asked for most. */
const QUANTITIES = [
  "flow_rate_ratio", "transition_time", "granular_temperature", "contacts", "flow_rate", "wall_power",
  "dissipated_power", "pumping_efficiency", "useful_power", "flow_rate_ratio_variance", "residence_time",
  "axial_dispersion", "bottleneck", "escaped", "energy_residual",
];

/** Columns that say what tube it is: no line joins tubes unlike each other, unless one of these goes across. */
export const TUBE = ["tube.radius", "tube.wavelength", "tube.arrangement", "tube.spheres_per_ring", "tube.rings_per_wave"];

/** The fluctuation across an ensemble, of the late means of its runs; and how many runs tell of one. */
export const FLUCTUATION = { name: "variance_over_runs", label: "variance of J/Jmax over runs", of: "flow_rate_ratio", least: 5 };

/** Columns of numbers that are neither. */
const NEITHER = new Set(["replicate", "seed", "grains", "transition_threshold", "steps"]);

const order = (one: Value, other: Value) =>
  typeof one === "number" && typeof other === "number" ? one - other : String(one).localeCompare(String(other));

/** A study as the page asks it. */
export class Results {
  readonly parameters: Parameter[];
  readonly quantities: Quantity[];
  readonly starts: string[];
  readonly rows: number;
  private readonly columns: Map<string, (number | string | boolean | null)[]>;
  private readonly labels: Map<string, string>;

  constructor(readonly study: Study) {
    this.columns = new Map(study.columns.map((column) => [column.name, column.values]));
    this.labels = new Map(study.columns.map((column) => [column.name, column.label]));
    this.rows = study.runs.length;
    const keys = study.columns.map(({ name }) => name).filter((name) => name.includes("."));
    this.parameters = this.findParameters(keys);
    const parameters = new Set([...PARAMETERS, ...keys]);
    const measured = study.columns.filter(
      ({ name, values }) => values.some((value) => typeof value === "number") && !parameters.has(name) &&
        !NEITHER.has(name) && !name.endsWith("_error"),
    );
    const rank = (name: string) => (QUANTITIES.includes(name) ? QUANTITIES.indexOf(name) : QUANTITIES.length);
    this.quantities = measured
      .map(({ name, label, description }) => ({ name, label, description }))
      .sort((one, other) => rank(one.name) - rank(other.name));
    const { name, label, of, least } = FLUCTUATION;
    const isLarge = this.all().some((row) => this.number("replicate", row) + 1 >= least);
    if (isLarge && this.columns.has(of))
      this.quantities.push({ name, label, description: `variance of the late means of J/Jmax of runs that differ in their random numbers alone, at least ${least}; jackknife error` });
    const starts = new Set((this.columns.get("initial_state") ?? []).map(String));
    this.starts = [...starts].sort().reverse();
  }

  /** The keys of the study's axes; of a table without them, the columns that say how a run was made. */
  private findParameters(keys: string[]): Parameter[] {
    const names = keys.length > 0 ? keys : PARAMETERS;
    const all = names.filter((name) => this.columns.has(name)).map((name) => ({
      name,
      label: this.labels.get(name) ?? name,
      values: this.valuesOf(name, this.all()),
    }));
    return all.filter(({ values }) => values.length > 1);
  }

  all(): number[] {
    return Array.from({ length: this.rows }, (_, row) => row);
  }

  /** Values of a column in these rows, ascending. */
  valuesOf(name: string, rows: number[]): Value[] {
    const column = this.columns.get(name) ?? [];
    const found = new Set(rows.map((row) => this.plain(column[row])).filter((value) => value !== null));
    return [...found].sort(order);
  }

  value(name: string, row: number): Value | null {
    return this.plain(this.columns.get(name)?.[row] ?? null);
  }

  private plain(value: number | string | boolean | null): Value | null {
    return typeof value === "boolean" ? String(value) : value;
  }

  number(name: string, row: number): number {
    const value = this.columns.get(name)?.[row];
    return typeof value === "number" ? value : NaN;
  }

  /** Duration of a period of a row's run. */
  periodOf(row: number): number {
    return this.number("time", row) / this.number("periods", row);
  }

  /** Time up to which a row's run was watched; tables of older programs say only how long it was. */
  private watched(row: number): number {
    const watched = this.number("watched", row);
    return Number.isNaN(watched) ? this.number("time", row) : watched;
  }

  /** Rows in which all these columns have these values. */
  where(rows: number[], fixed: Map<string, Value>): number[] {
    return rows.filter((row) => [...fixed].every(([name, value]) => this.value(name, row) === value));
  }

  parameter(name: string): Parameter | undefined {
    return this.parameters.find((it) => it.name === name);
  }

  /** Rows as points: replicates averaged, starts apart. */
  points(rows: number[], quantity: string, x: string, other: string | null): Point[] {
    const groups = new Map<string, number[]>();
    for (const row of rows) {
      const place = [this.value("initial_state", row), this.value(x, row), other && this.value(other, row)];
      const key = JSON.stringify(place);
      groups.set(key, [...(groups.get(key) ?? []), row]);
    }
    const points = [...groups.values()].map((group) => this.point(group, quantity, x, other));
    return points.filter(({ value }) => Number.isFinite(value)).sort((one, next) => one.x - next.x);
  }

  private point(rows: number[], quantity: string, x: string, other: string | null): Point {
    if (quantity === FLUCTUATION.name) return this.fluctuation(rows, x, other);
    const isTime = quantity.startsWith("transition_time");
    // A run that ended before its transition says that its time is longer than it went.
    const ended = rows.filter((row) => isTime && Number.isNaN(this.number(quantity, row)));
    const values = rows
      .map((row) => (ended.includes(row) ? this.watched(row) : this.number(quantity, row)))
      .filter(Number.isFinite);
    const number = values.length;
    const mean = values.reduce((sum, value) => sum + value, 0) / number;
    const squares = values.reduce((sum, value) => sum + (value - mean) ** 2, 0);
    const alone = number === 1 ? this.number(`${quantity}_error`, rows[0]) : NaN;
    return {
      rows,
      start: String(this.value("initial_state", rows[0]) ?? ""),
      x: this.number(x, rows[0]),
      other: other === null ? null : this.value(other, rows[0]),
      tube: TUBE.includes(x) ? "" : JSON.stringify(TUBE.map((name) => this.value(name, rows[0]))),
      value: mean,
      error: number > 1 ? Math.sqrt(squares / (number - 1) / number) : alone,
      number,
      atLeast: ended.length > 0,
      censored: ended.length,
    };
  }

  /** The variance over the runs of a place, in the point of their mean. */
  private fluctuation(rows: number[], x: string, other: string | null): Point {
    const point = this.point(rows, FLUCTUATION.of, x, other);
    const flows = rows.map((row) => this.number(FLUCTUATION.of, row)).filter(Number.isFinite);
    const enough = flows.length >= FLUCTUATION.least;
    const without = flows.map((_, left) => variance(flows.filter((_, k) => k !== left)));
    const error = Math.sqrt(((flows.length - 1) ** 2 / flows.length) * variance(without));
    return { ...point, value: enough ? variance(flows) : NaN, error };
  }

  /** Of the rows of a point, the one that is nearest to what the point shows, of those that can be watched. */
  typical(point: Point, quantity: string): number | null {
    const name = quantity === FLUCTUATION.name ? FLUCTUATION.of : quantity;
    const middle = this.point(point.rows, name, name, null).value;
    const away = (row: number) => {
      const value = this.number(name, row);
      return Number.isNaN(value) ? Number.MAX_VALUE : Math.abs(value - middle);
    };
    const watchable = point.rows.filter((row) => this.study.runs[row] !== null);
    return watchable.toSorted((one, other) => away(one) - away(other)).at(0) ?? null;
  }
}

/** Sample variance. */
function variance(values: number[]): number {
  const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
  return values.reduce((sum, value) => sum + (value - mean) ** 2, 0) / (values.length - 1);
}

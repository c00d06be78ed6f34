/** Makes the choice of a study page one that the study has. */
import type { Choice } from "./choice";
import { firstFamily, firstQuantity } from "./first";
import { type Parameter, type Results, TUBE, type Value } from "./results";

/** What may go across: columns of numbers. */
export const numeric = ({ parameters }: Results): Parameter[] =>
  parameters.filter(({ values }) => values.every((value) => typeof value === "number"));

/** What is neither axis. */
export const fixable = ({ parameters }: Results, { x, other }: Choice): Parameter[] =>
  parameters.filter(({ name }) => name !== x && name !== other);

export function settle(choice: Choice, results: Results): void {
  const numbers = numeric(results);
  const has = (name: string, among: { name: string }[]) => among.some((it) => it.name === name);
  // What drives the transition goes across, else what was varied most.
  const drives = ({ name, values }: Parameter) => values.length > 2 && /(^|\.)(width|force_amplitude)$/.test(name);
  const weight = (it: Parameter) => it.values.length + (drives(it) ? 1e6 : 0);
  const most = numbers.toSorted((one, other) => weight(other) - weight(one));
  if (!has(choice.value, results.quantities)) {
    choice.value = firstQuantity(results);
    choice.logarithmic = choice.value.startsWith("transition_time");
  }
  if (!has(choice.x, numbers)) choice.x = most.at(0)?.name ?? "";
  const others = results.parameters.filter(({ name }) => name !== choice.x);
  if (!has(choice.other, others) && choice.other !== "none") choice.other = firstFamily(results, choice.x);
  if (choice.view === "heat" && choice.other === "none") choice.other = others.at(0)?.name ?? "none";
  if (!results.starts.includes(choice.start)) choice.start = "both";
  choice.fixed = fixed(choice, results);
}

/** One value at a time of what is neither axis; what follows from the others is not asked. */
function fixed(choice: Choice, results: Results): Map<string, Value> {
  const found = new Map<string, Value>();
  let rows = results.all();
  for (const { name } of fixable(results, choice)) {
    const values = results.valuesOf(name, rows);
    if (values.length < 2 || !isOpen(choice, results, name, rows)) continue;
    const wanted = choice.fixed.get(name);
    const value = wanted !== undefined && values.includes(wanted) ? wanted : commonest(results, name, rows, values);
    found.set(name, value);
    rows = results.where(rows, new Map([[name, value]]));
  }
  return found;
}

/** What a curve must be of one of: the tube, and how wide or strongly it is driven. */
const OF_A_CURVE = new Set([...TUBE, "drive.width", "drive.force_amplitude"]);

/** Whether rows at one place of both axes, or of one curve, differ in this column. */
function isOpen({ x, other }: Choice, results: Results, name: string, rows: number[]): boolean {
  const seen = new Map<string, Value | null>();
  const isAcross = TUBE.includes(x) && TUBE.includes(name);
  return rows.some((row) => {
    const along = OF_A_CURVE.has(name) && !isAcross ? null : results.value(x, row);
    const place = JSON.stringify([along, results.value(other, row)]);
    const value = results.value(name, row);
    if (!seen.has(place)) seen.set(place, value);
    return seen.get(place) !== value;
  });
}

function commonest(results: Results, name: string, rows: number[], values: Value[]): Value {
  const count = (value: Value) => results.where(rows, new Map([[name, value]])).length;
  return values.toSorted((one, other) => count(other) - count(one))[0];
}

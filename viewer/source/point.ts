/** What a chosen point of a study says: in its tip, and in the panel beside the plot with its runs. */
import { textOf, written } from "./charts";
import type { Choice } from "./choice";
import { element, fill } from "./page";
import type { Point, Results } from "./results";
import { valueOf } from "./words";

type Facts = [string, string][];

export function factsOf(point: Point, results: Results, { x, other }: Choice): Facts {
  const facts: Facts = [[results.parameter(x)?.label ?? x, written(point.x, 4)]];
  const family = results.parameter(other);
  if (family && point.other !== null)
    facts.push([family.label, textOf(point.other, 4)]);
  if (point.start) facts.push(["start", `from ${point.start}`]);
  facts.push(["replicates", String(point.number)]);
  if (point.atLeast) facts.push(["without a transition", String(point.censored)]);
  return facts;
}

/**
 * Fills the tip; `quantity` says what its value is, with the unit, and `opens` what opens the point's run, null where its runs
 * cannot be watched.
 */
export function showTip(quantity: string, point: Point, facts: Facts, opens: string | null): void {
  element("tip-value").textContent = `${quantity}: ${valueOf(point)}`;
  fill(element("tip-facts"), facts);
  element("tip-open").textContent = opens ?? "the design of this table is not known: its runs cannot be watched";
}

/** The point with the values of its runs; `address` is that of a row's run. */
export function showPoint(quantity: string, point: Point, results: Results, choice: Choice, address: (row: number) => string): void {
  element("point-value").textContent = `${quantity}: ${valueOf(point)}`;
  fill(element("point-facts"), factsOf(point, results, choice));
  const replicate = (row: number) => results.number("replicate", row);
  const lines = point.rows.toSorted((one, other) => replicate(one) - replicate(other)).map((row) => {
    const line = document.createElement("li");
    const name = document.createElement(results.study.runs[row] === null ? "span" : "a");
    name.textContent = `run ${(replicate(row) || 0) + 1}`;
    if (name instanceof HTMLAnchorElement) name.href = address(row);
    const value = results.number(choice.value, row);
    const shown = document.createElement("span");
    const isNone = Number.isNaN(value) && choice.value.startsWith("transition_time");
    shown.textContent = isNone ? "no transition" : written(value, 4);
    line.append(name, shown);
    return line;
  });
  element("runs").replaceChildren(...lines);
}

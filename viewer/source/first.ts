import { FLUCTUATION, type Results } from "./results";

/** Periods before the transition at which a run is shown. */
const JUMP = 5;

/** The quantity that a study is about: the one that its title names, else the flow. */
export function firstQuantity({ quantities, study }: Results): string {
  const title = study.title.toLowerCase();
  const about: [RegExp, string][] = [
    [/transition time|lifetime|time until/, "transition_time"],
    [/pumping/, "pumping_efficiency"],
    [/fluctuation/, FLUCTUATION.name],
    [/discharge|silo|outlet/, "discharge_rate"],
  ];
  for (const [words, name] of about) if (words.test(title) && quantities.some((it) => it.name === name)) return name;
  return quantities.at(0)?.name ?? "";
}

/** The column whose values part the points into most curves, of two places and more; "none" where there are not two. */
export function firstFamily(results: Results, x: string): string {
  const curves = (name: string) => {
    const places = new Map<unknown, Set<unknown>>();
    for (const row of results.all()) {
      const member = results.value(name, row);
      places.set(member, (places.get(member) ?? new Set()).add(results.value(x, row)));
    }
    return [...places.values()].filter((it) => it.size > 1).length;
  };
  const others = results.parameters.filter(({ name }) => name !== x).map(({ name }) => ({ name, number: curves(name) }));
  const most = others.toSorted((one, other) => other.number - one.number).at(0);
  return most && most.number > 1 ? most.name : "none";
}

/** What the address of a row's run says of where there is something to see: shortly before its transition. */
export function momentOf(results: Results, row: number): string {
  const moment = results.number("transition_time", row) / results.periodOf(row) - JUMP;
  return Number.isFinite(moment) ? `#jump=${Math.max(0, moment).toFixed(2)}` : "";
}

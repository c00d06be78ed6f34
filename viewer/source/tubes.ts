import type { Wanted } from "./connection";

/** Tubes to begin with, where the page computes them itself. */
const TUBES: (Wanted & { name: string })[] = [
  { name: "wide, slipping back", preset: "frictionless", settings: ["tube.waves=4", "drive.width=2.9"], speed: 3 },
  { name: "narrow, jamming", preset: "frictionless", settings: ["tube.waves=4", "drive.width=2.6"], speed: 3 },
  { name: "fine lattice", preset: "frictionless-fine", settings: ["tube.waves=4"], speed: 3 },
  { name: "long, jamming wave by wave", preset: "frictionless", settings: ["tube.waves=12", "drive.width=2.75"], speed: 10 },
  { name: "friction, soft wall", preset: "frictional", settings: ["tube.waves=2"], speed: 0.3 },
  {
    name: "friction, flowing back", preset: "frictional",
    settings: ["tube.waves=2", "initial.state=rest", "drive.force_amplitude=0.002"], speed: 0.3,
  },
];

/** A tube of the choice by its name. */
export const named = (begin: string): Wanted => TUBES.find(({ name }) => name.startsWith(begin)) ?? TUBES[0];

/** The tube that the address asks for, such as #preset=frictional&set=tube.waves=2; else the first. */
export function wanted(): Wanted {
  const parts = new URLSearchParams(location.hash.slice(1));
  const preset = parts.get("preset");
  if (!preset) return TUBES[0];
  const asked = { preset, settings: parts.getAll("set") };
  return TUBES.find((tube) => is(tube, asked)) ?? { ...asked, speed: preset === "frictional" ? 0.3 : 1 };
}

const is = (tube: Wanted, other: Wanted) => tube.preset === other.preset && tube.settings.join() === other.settings.join();

/** A choice among the tubes. */
export function choice(now: Wanted, open: (tube: Wanted) => void): HTMLElement {
  const label = document.createElement("label");
  const select = document.createElement("select");
  select.id = "tube";
  TUBES.forEach((tube, k) => select.add(new Option(tube.name, String(k), false, is(tube, now))));
  if (!TUBES.some((tube) => is(tube, now))) select.add(new Option(now.preset, "", true, true));
  select.onchange = () => select.value && open(TUBES[Number(select.value)]);
  label.append("begins ", select);
  return label;
}

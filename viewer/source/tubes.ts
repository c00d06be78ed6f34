import type { Wanted } from "./connection";

/** Tubes to begin with, where the page computes them itself. */
const TUBES: { name: string; preset: string; settings: string[] }[] = [
  { name: "narrow: it jams", preset: "frictionless", settings: ["tube.waves=4", "drive.width=2.6"] },
  { name: "wide: it slips back", preset: "frictionless", settings: ["tube.waves=4", "drive.width=2.9"] },
  { name: "fine lattice", preset: "frictionless-fine", settings: ["tube.waves=4"] },
  { name: "friction, elastic wall", preset: "frictional", settings: ["tube.waves=2"] },
  { name: "friction: back flow", preset: "frictional", settings: ["tube.waves=2", "initial.state=rest", "drive.force_amplitude=0.002"] },
];

/** The tube that the address asks for, such as #preset=frictional&set=tube.waves=2; else the first. */
export function wanted(): Wanted {
  const parts = new URLSearchParams(location.hash.slice(1));
  const preset = parts.get("preset");
  if (preset) return { preset, settings: parts.getAll("set") };
  const [{ preset: first, settings }] = TUBES;
  return { preset: first, settings };
}

/** A choice among the tubes; another is another page. */
export function choice(): HTMLElement {
  const label = document.createElement("label");
  const select = document.createElement("select");
  select.id = "tube";
  const { preset, settings } = wanted();
  const is = (tube: Wanted) => tube.preset === preset && tube.settings.join() === settings.join();
  for (const tube of TUBES) select.add(new Option(tube.name, String(TUBES.indexOf(tube)), false, is(tube)));
  if (!TUBES.some(is)) select.add(new Option(preset, "", true, true));
  select.onchange = () => {
    const tube = TUBES[Number(select.value)];
    location.hash = String(new URLSearchParams([["preset", tube.preset], ...tube.settings.map((it) => ["set", it])]));
    location.reload();
  };
  label.append("tube ", select);
  return label;
}

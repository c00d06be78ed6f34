import type { Value } from "./results";

export type View = "curves" | "heat" | "figures";

/** What is shown of a study, as the address keeps it. */
export interface Choice {
  study: number;
  view: View;
  value: string;
  x: string;
  other: string;
  start: string;
  logarithmic: boolean;
  fixed: Map<string, Value>;
}

/** Nothing chosen yet. */
export const untouched = (): Choice => ({
  study: 0, view: "curves", value: "", x: "", other: "", start: "both", logarithmic: false, fixed: new Map(),
});

/** The choice that the address keeps; what it does not say is empty. */
export function read(): Choice {
  const parts = new URLSearchParams(location.hash.slice(1));
  const view = parts.get("view");
  const fixed = new Map<string, Value>();
  for (const [name, text] of parts)
    if (name.startsWith("at.")) fixed.set(name.slice(3), Number.isNaN(Number(text)) ? text : Number(text));
  return {
    study: Math.max(0, Number.parseInt(parts.get("study") ?? "0", 10) || 0),
    view: view === "heat" || view === "figures" ? view : "curves",
    value: parts.get("value") ?? "",
    x: parts.get("x") ?? "",
    other: parts.get("other") ?? "",
    start: parts.get("start") ?? "both",
    logarithmic: parts.get("log") === "1",
    fixed,
  };
}

/** Keeps the choice in the address, so that one comes back to it. */
export function keep({ study, view, value, x, other, start, logarithmic, fixed }: Choice): void {
  const parts = new URLSearchParams({ study: String(study), view, value, x, other, start });
  if (logarithmic) parts.set("log", "1");
  for (const [name, it] of fixed) parts.set(`at.${name}`, String(it));
  history.replaceState(null, "", `#${parts}`);
  sessionStorage.setItem("study", location.hash);
}

import { element } from "./page";
import type { Welcome } from "./protocol";

/** The way back to the study that the run is of, and to the other runs of its point. */
export function showWithin({ within }: Welcome): void {
  element("within").hidden = within === null;
  if (!within) return;
  const link = element<HTMLAnchorElement>("to-study");
  link.textContent = `← ${within.study}`;
  link.href = `../../../../${sessionStorage.getItem("study") ?? ""}`;
  const siblings = element<HTMLSelectElement>("siblings");
  const all = within.siblings.map(({ number, replicate }) => new Option(String(replicate + 1), String(number)));
  siblings.replaceChildren(...all);
  siblings.value = String(within.number);
  element("siblings-number").textContent = within.siblings.length === 1 ? "the only one" : `one of ${within.siblings.length}`;
  siblings.onchange = () => location.assign(`../${siblings.value}/`);
}

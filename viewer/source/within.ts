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
  const all = within.siblings.map(({ number, replicate }) => new Option(`${replicate + 1} of ${within.siblings.length}`, String(number)));
  siblings.replaceChildren(...all);
  siblings.value = String(within.number);
  siblings.onchange = () => location.assign(`../${siblings.value}/`);
}

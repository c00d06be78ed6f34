import { written } from "./charts";
import { colourAt, css, type Field, stops } from "./fields";
import { type Colour, FORCE } from "./messages";
import { element } from "./page";

/** The colours of the grains, or that there are none, by lightness alone or with marks for the sign, and those of the forces up to the largest. */
export function showField(field: Field, isLacking: boolean, lightness: boolean, marks: boolean, force: number | null): void {
  element("bar").style.background = gradient(stops(field, lightness));
  element("bar-name").textContent = isLacking ? `${field.name}: not kept of this time` : field.name;
  element("bar-from").textContent = field.ends[0];
  element("bar-to").textContent = field.ends[1];
  element("bar-middle").textContent = field.diverging ? "0" : "";
  element("key").hidden = !marks || !field.diverging;
  element("force-legend").hidden = force === null;
  element("force-bar").style.background = gradient(FORCE);
  element("force-to").textContent = force === null ? "" : `${written(force, 2)} m d/t²`;
}

function gradient(scale: Colour[]): string {
  return `linear-gradient(90deg, ${Array.from({ length: 9 }, (_, k) => css(colourAt(scale, k / 8))).join(",")})`;
}

import { colourAt, css, type Field, stops } from "./fields";
import { element } from "./page";

/** The colours of the grains: by lightness alone, or with marks for the sign. */
export function showField(field: Field, lightness: boolean, marks: boolean): void {
  const scale = stops(field, lightness);
  const parts = Array.from({ length: 9 }, (_, k) => css(colourAt(scale, k / 8)));
  element("bar").style.background = `linear-gradient(90deg, ${parts.join(",")})`;
  element("bar-from").textContent = field.ends[0];
  element("bar-to").textContent = field.ends[1];
  element("bar-middle").textContent = field.diverging ? "0" : "";
  element("key").hidden = !marks || !field.diverging;
}

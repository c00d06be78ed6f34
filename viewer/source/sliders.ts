import { element, say } from "./page";
import type { Driven, Steered, Welcome } from "./protocol";

/** What a run can be steered by. */
export const NAMES: Record<Steered, { name: string; digits: number }> = {
  width: { name: "Width <i>w</i> / <i>d</i>", digits: 3 },
  force_amplitude: { name: "Force amplitude <i>f</i><sup>P</sup> / (m d/t²)", digits: 5 },
  strain_rate: { name: "Strain rate <i>ε̇</i> / t⁻¹", digits: 5 },
  friction: { name: "Kinetic friction <i>μ</i><sub>k</sub>", digits: 2 },
};

/** Steps of a slider, about: 1, 2 or 5 of a power of ten. */
const STEPS = 400;

function stepOf([from, to]: [number, number]): number {
  const rough = (to - from) / STEPS;
  const power = Math.floor(Math.log10(rough));
  const digit = [1, 2, 5, 10].find((it) => it * 10 ** power >= rough) ?? 10;
  return Number(`${digit}e${power}`);
}

/** Decimals that tell the steps of a slider apart, as many as its quantity usually has or more. */
const decimals = (range: [number, number], usual: number): number => Math.max(usual, -Math.floor(Math.log10(stepOf(range))));

/** A value with so many decimals, and three significant digits at least. */
const inDecimals = (value: number, digits: number): string =>
  value.toFixed(value === 0 ? digits : Math.min(100, Math.max(digits, 2 - Math.floor(Math.log10(Math.abs(value))))));

/** Puts a slider to a value, which may lie between its steps, and says it as the number beside it does. */
function put(slider: HTMLInputElement, value: number, digits: number): void {
  slider.value = String(value);
  slider.setAttribute("aria-valuetext", inDecimals(value, digits));
}

/** The sliders that steer a run. */
export class Sliders {
  private readonly digits: Partial<Record<Steered, number>> = {};

  constructor(private readonly steered: (parameter: Steered, value: number) => void) {}

  /** The sliders of what this tube can be steered by. */
  make(tube: Welcome): void {
    const box = element("sliders");
    box.replaceChildren();
    for (const [key, { name, digits: usual }] of Object.entries(NAMES) as [Steered, (typeof NAMES)[Steered]][]) {
      const range = tube.ranges[key];
      if (!range) continue;
      const digits = (this.digits[key] = decimals(range, usual));
      const label = document.createElement("label");
      label.innerHTML = `<span>${name}</span><input type="text" inputmode="decimal" autocomplete="off"><input type="range">`;
      const [number, slider] = label.querySelectorAll("input");
      slider.min = String(range[0]);
      slider.max = String(range[1]);
      slider.step = String(stepOf(range));
      slider.setAttribute("aria-label", label.textContent ?? key);
      slider.id = `slider-${key}`;
      number.id = `number-${key}`;
      let known = "";
      const steer = (value: number) => {
        const within = Math.min(range[1], Math.max(range[0], value));
        known = number.value = inDecimals(within, digits);
        put(slider, Number(known), digits);
        this.steered(key, Math.min(range[1], Math.max(range[0], Number(known))));
      };
      slider.oninput = () => steer(slider.valueAsNumber);
      number.onfocus = () => (known = number.value);
      number.onchange = () => {
        // A comma is a point, as many write it.
        const text = number.value.trim().replace(",", ".");
        const value = text === "" ? NaN : Number(text);
        if (Number.isFinite(value)) {
          steer(value);
          if (value >= range[0] && value <= range[1]) say("");
          else say(`${slider.ariaLabel}: ${text} is outside ${range[0]} to ${range[1]}, and ${value < range[0] ? range[0] : range[1]} is taken`, true);
        } else {
          say(`${slider.ariaLabel}: “${number.value}” is no number`, true);
          number.value = known;
        }
      };
      box.append(label);
    }
    this.show(tube.driven, tube.driven);
  }

  /** Where the run is and where it is led to; sliders follow, but for those in a hand. */
  show(driven: Driven, aims: Driven): void {
    for (const key of Object.keys(NAMES) as Steered[]) {
      const value = driven[key];
      const slider = document.getElementById(`slider-${key}`) as HTMLInputElement | null;
      const number = document.getElementById(`number-${key}`) as HTMLInputElement | null;
      if (value === null || !slider || !number) continue;
      // A mark shows where the run is, also beside a slider in a hand.
      const low = Number(slider.min);
      slider.style.setProperty("--now", `${(100 * (value - low)) / (Number(slider.max) - low)}%`);
      const aim = aims[key] ?? value;
      const digits = this.digits[key] ?? NAMES[key].digits;
      if (!slider.matches(":active")) put(slider, aim, digits);
      if (number !== document.activeElement) number.value = inDecimals(aim, digits);
    }
  }
}

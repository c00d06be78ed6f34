import { type Chart, type Ink, written } from "./charts";
import { colourAt, css, FIELDS, stops } from "./fields";
import type { Frame, Welcome } from "./protocol";

/** Waves from which on it is worth while to look at each by itself. */
export const FEWEST_WAVES = 6;
/** Looks that are kept. */
const MOST = 400;

/** The flow of the grains that travel with each wave, as time goes on: where in a long tube a jam begins. */
export class SpaceTime {
  /** A look: a time in periods, and the mean velocity of the grains of each wave over its speed. */
  private looks: { clock: number; flows: Float32Array; grains: Float32Array; frames: number }[] = [];
  /** Periods that a look takes. */
  private each = 0.5;

  see(frame: Frame, tube: Welcome): void {
    if (tube.waves < FEWEST_WAVES) return;
    this.looks = this.looks.filter(({ clock }) => clock <= frame.clock);
    let last = this.looks.at(-1);
    if (!last || frame.clock >= last.clock + this.each) {
      last = { clock: frame.clock, flows: new Float32Array(tube.waves), grains: new Float32Array(tube.waves), frames: 0 };
      this.looks.push(last);
      if (this.looks.length > MOST) {
        this.looks = this.looks.filter((_, k) => k % 2 === 0);
        this.each *= 2;
      }
    }
    last.frames += 1;
    for (let i = 0; i < frame.grains; i++) {
      const z = frame.position[3 * i + 2];
      const along = Math.floor((tube.heading * z) / tube.wavelength - frame.period);
      const wave = ((along % tube.waves) + tube.waves) % tube.waves;
      last.flows[wave] += (tube.heading * frame.velocity[3 * i + 2]) / (frame.wave_speed || NaN);
      last.grains[wave] += 1;
    }
  }

  draw(chart: Chart, tube: Welcome, lightness: boolean, colours: Ink): void {
    const end = Math.max(this.looks.at(-1)?.clock ?? 0, 2);
    chart.begin([0, end], [0.5, tube.waves + 0.5], ["time / periods T", "wave"], colours, {
      legend: [
        { text: "against the wave", colour: css(colourAt(stops(FIELDS.axial, lightness), 0.1)) },
        { text: "jammed: ⟨v_z⟩ = c", colour: css(colourAt(stops(FIELDS.axial, lightness), 0.97)) },
      ],
    });
    const scale = stops(FIELDS.axial, lightness);
    const { context, x, y } = chart;
    this.looks.forEach(({ clock, flows, grains }, k) => {
      const left = x.at(clock);
      const right = x.at(this.looks.at(k + 1)?.clock ?? Math.min(end, clock + this.each));
      flows.forEach((sum, wave) => {
        context.fillStyle = css(colourAt(scale, 0.5 + 0.5 * (sum / grains[wave])));
        const top = y.at(wave + 1.5);
        context.fillRect(left, top, Math.max(1, right - left + 0.5), y.at(wave + 0.5) - top);
      });
    });
  }

  /** What it shows, in words. */
  words(): string {
    const last = this.looks.at(-1);
    if (!last) return "";
    const ratios = Array.from(last.flows, (sum, wave) => sum / last.grains[wave]);
    const jammed = ratios.filter((ratio) => ratio > 0.5).length;
    return `${jammed} of ${ratios.length} waves jammed after ${written(last.clock)} T`;
  }
}

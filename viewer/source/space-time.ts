import { type Chart, type Ink, written } from "./charts";
import { colourAt, css, FIELDS, stops } from "./fields";
import type { Colour } from "./messages";
import { insideOf } from "./inside";
import { type Frame, timeAxis, type Welcome } from "./protocol";

/** Waves from which on it is worth while to look at each by itself. */
export const FEWEST_WAVES = 6;
/** Looks that are kept. */
const MOST = 400;

/** A look: a time in periods, and the velocities of the grains in each wave, over its speed, with their number. */
interface Look {
  clock: number;
  flows: Float32Array;
  grains: Float32Array;
}

/** The flow of the grains that travel with each wave, as time goes on: where in a long tube a jam begins. */
export class SpaceTime {
  private looks: Look[] = [];
  /** Periods that a look takes. */
  private each = 0.5;
  /** A column of colours for each look, how many of them are as they will stay, and the scale that they are of. */
  private readonly image = document.createElement("canvas");
  private painted = 0;
  private scale: Colour[] = [];
  /** How many waves are jammed, and since when so many. */
  private jammed = { waves: 0, since: 0 };

  see(frame: Frame, tube: Welcome): void {
    if (tube.waves < FEWEST_WAVES) return;
    let last = this.looks.at(-1);
    if (last && last.clock > frame.clock) {
      this.keep(({ clock }) => clock <= frame.clock);
      last = this.looks.at(-1);
    }
    if (!last || frame.clock >= last.clock + this.each) {
      last = { clock: frame.clock, flows: new Float32Array(tube.waves), grains: new Float32Array(tube.waves) };
      this.looks.push(last);
      if (this.looks.length > MOST) {
        this.keep((_, k) => k % 2 === 0);
        this.each *= 2;
      }
    }
    const isInside = insideOf(frame, tube);
    for (let i = 0; i < frame.grains; i++) {
      if (!isInside(i)) continue;
      const z = frame.position[3 * i + 2];
      const along = Math.floor((tube.heading * z) / tube.wavelength - frame.period);
      const wave = ((along % tube.waves) + tube.waves) % tube.waves;
      last.flows[wave] += (tube.heading * frame.velocity[3 * i + 2]) / (frame.wave_speed || NaN);
      last.grains[wave] += 1;
    }
  }

  draw(chart: Chart, tube: Welcome, lightness: boolean, colours: Ink): void {
    const scale = stops(FIELDS.axial, lightness);
    const end = Math.max(this.looks.at(-1)?.clock ?? 0, 2);
    chart.begin([0, end], [-0.5, tube.waves - 0.5], [timeAxis(tube), "wave"], colours, {
      legend: [
        { text: "against the wave", colour: css(colourAt(scale, 0.1)), mark: "area" },
        { text: "no flow", colour: css(colourAt(scale, 0.5)), mark: "area" },
        { text: "jammed: along it at c", colour: css(colourAt(scale, 0.97)), mark: "area" },
      ],
    });
    this.paint(tube.waves, scale);
    const { context, x, box } = chart;
    context.imageSmoothingEnabled = false;
    this.looks.forEach(({ clock }, k) => {
      const left = x.at(clock);
      const right = x.at(this.looks.at(k + 1)?.clock ?? clock);
      context.drawImage(this.image, k, 0, 1, tube.waves, left, box.top, Math.max(1, right - left + 0.5), box.height);
    });
  }

  private keep(which: (look: Look, number: number) => boolean): void {
    this.looks = this.looks.filter(which);
    this.painted = 0;
  }

  /** Gives each look its column, as far as it has not got it. */
  private paint(waves: number, scale: Colour[]): void {
    const { image, looks } = this;
    const context = image.getContext("2d");
    if (!context) return;
    if (image.height !== waves || scale !== this.scale) {
      [image.width, image.height] = [MOST + 1, waves];
      this.scale = scale;
      this.painted = 0;
    }
    for (let k = this.painted; k < looks.length; k++) {
      const column = context.createImageData(1, waves);
      for (let wave = 0; wave < waves; wave++) {
        const colour = colourAt(scale, 0.5 + 0.5 * (looks[k].flows[wave] / looks[k].grains[wave]));
        column.data.set([...colour, 255], 4 * (waves - 1 - wave));
      }
      context.putImageData(column, k, 0);
    }
    // More may come to the last.
    this.painted = Math.max(0, looks.length - 1);
  }

  /** What it shows, in words. */
  words(): string {
    const last = this.looks.at(-1);
    if (!last) return "";
    const ratios = Array.from(last.flows, (sum, wave) => sum / last.grains[wave]);
    const waves = ratios.filter((ratio) => ratio > 0.5).length;
    if (waves !== this.jammed.waves || last.clock < this.jammed.since) this.jammed = { waves, since: last.clock };
    return `${waves} of ${ratios.length} waves jammed${waves > 0 ? `, since ${written(this.jammed.since)} T` : ""}`;
  }
}

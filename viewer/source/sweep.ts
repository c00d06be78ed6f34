import type { Connection } from "./connection";
import type { Film } from "./film";
import { isPublished } from "./ghosts";
import { element } from "./page";
import type { Steered, Welcome } from "./protocol";

/** Seconds that the way there and back takes. */
const MINUTE = 60;
/** Part of the samples that a run can have which it takes at most, or of those that are left. */
const SHARE = 0.25;
const REST = 0.9;
/** Part of them that is to be enough. */
const SLACK = 0.9;
/** Steps there and back, and milliseconds from one look at the place to the next. */
const STEPS = 150;
const EACH = 40;
/** From where to where, of what drives the tube: in tubes of the published runs what is known to jam and what is known to let go lie between. */
const WAYS: Record<Welcome["control"], [Steered, number, number]> = {
  strain: ["width", 3, 2.4],
  stress: ["force_amplitude", 0.0015, 0.0065],
};
/** Part of its range that the way through another tube leaves out, where it is driven hardest. */
const LEFT_OUT = 0.25;

/** What is led, from where and to where, in a tube. */
function wayOf(tube: Welcome): [Steered, number, number] {
  const { control, ranges } = tube;
  const [parameter, from, to] = WAYS[control];
  const range = ranges[parameter];
  if (isPublished(tube) || !range) return [parameter, from, to];
  const [least, most] = range;
  const room = LEFT_OUT * (most - least);
  return control === "strain" ? [parameter, most, least + room] : [parameter, least, most - room];
}

/** The way there and back again, that the loop is seen on. */
export class Sweep {
  private timer = 0;

  /** `film` is that of the run; `ended` is called when it comes back, and when it is stopped. */
  constructor(private readonly connection: Connection, private readonly film: () => Film, private readonly ended: () => void) {}

  get isGoing(): boolean {
    return this.timer !== 0;
  }

  begin(tube: Welcome): void {
    const [parameter, from, to] = wayOf(tube);
    const range = tube.ranges[parameter];
    if (!range) return;
    const [begin, first] = [performance.now(), this.samples()];
    this.film().since = first;
    const now = this.film().rows.at(-1)?.amplitude ?? tube.driven[parameter] ?? from;
    // A tube that jumps to where the sweep begins shows nothing on the way: it walks there too.
    const [before, across] = [Math.abs(from - now), Math.abs(to - from)];
    const whole = before + 2 * across;
    const placeAt = (way: number) =>
      way < before ? now + Math.sign(from - now) * way : from + (to - from) * (1 - Math.abs(1 - (way - before) / across));
    const seconds = (MINUTE * whole) / (2 * across);
    const most = Math.min(SHARE * tube.most_samples, REST * (tube.most_samples - first));
    let last = -1;
    // As fast as the machine computes, until it is known how fast the samples would be used up.
    this.connection.send({ type: "speed", periods_per_second: null });
    let isPaced = false;
    this.connection.send({ type: "play", playing: true });
    const step = () => {
      const apart = this.apart();
      if (!isPaced && apart > 0) {
        isPaced = true;
        const pace = (SLACK * most * apart) / seconds;
        this.connection.send({ type: "speed", periods_per_second: Number(pace.toPrecision(2)) });
      }
      // A small tube is so quick that a minute has more samples than are kept.
      const part = Math.min(1, Math.max((performance.now() - begin) / 1000 / seconds, (this.samples() - first) / most));
      if (part < 1 && part * whole < last + (2 * across) / STEPS) return;
      last = part * whole;
      this.connection.send({ type: "steer", parameter, value: Math.min(range[1], Math.max(range[0], placeAt(last))) });
      if (part === 1) this.end();
    };
    step();
    this.timer = window.setInterval(step, EACH);
    this.show();
  }

  end(): void {
    if (!this.isGoing) return;
    clearInterval(this.timer);
    this.timer = 0;
    this.show();
    this.ended();
  }

  /** How many the run has taken. */
  private samples(): number {
    return this.film().rows.at(-1)?.number ?? 0;
  }

  /** Periods from one sample to the next; no number where that is not known yet. */
  private apart(): number {
    const { rows } = this.film();
    const [first, last] = [rows.at(0), rows.at(-1)];
    return first && last ? (last.clock - first.clock) / (last.number - first.number) : NaN;
  }

  private show(): void {
    const button = element("sweep");
    button.textContent = this.isGoing ? "stop the sweep" : "sweep there and back";
    button.setAttribute("aria-pressed", String(this.isGoing));
  }
}

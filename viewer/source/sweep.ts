import type { Connection } from "./connection";
import { element } from "./page";
import type { Steered, Welcome } from "./protocol";

/** Seconds that the way there and back takes. */
const MINUTE = 60;
/** Milliseconds from one step of the way to the next. */
const EACH = 400;
/** From where to where, of what drives the tube; what is known to jam and what is known to let go lie between. */
const WAYS: Record<Welcome["control"], [Steered, number, number]> = {
  strain: ["width", 3, 2.4],
  stress: ["force_amplitude", 0.0015, 0.0065],
};

/** The way there and back again, that the loop is seen on. */
export class Sweep {
  private timer = 0;

  /** `ended` is called when it comes back, and when it is stopped. */
  constructor(private readonly connection: Connection, private readonly ended: () => void) {}

  get isGoing(): boolean {
    return this.timer !== 0;
  }

  begin(tube: Welcome): void {
    const [parameter, from, to] = WAYS[tube.control];
    const range = tube.ranges[parameter];
    if (!range) return;
    const begin = performance.now();
    // As fast as the machine computes, so that the flow has the time that a minute gives.
    this.connection.send({ type: "speed", periods_per_second: null });
    this.connection.send({ type: "play", playing: true });
    const step = () => {
      const part = (performance.now() - begin) / 1000 / MINUTE;
      if (part >= 1) return this.end();
      const place = from + (to - from) * (1 - Math.abs(1 - 2 * part));
      this.connection.send({ type: "steer", parameter, value: Math.min(range[1], Math.max(range[0], place)) });
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

  private show(): void {
    const button = element("sweep");
    button.textContent = this.isGoing ? "stop the sweep" : "sweep there and back";
    button.setAttribute("aria-pressed", String(this.isGoing));
  }
}

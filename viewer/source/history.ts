import type { Frame, Row } from "./protocol";

/** Bytes of frames that are kept. */
const ROOM = 256e6;

/** The frames kept for going back, and every row of the time series. */
export class History {
  frames: Frame[] = [];
  rows: Row[] = [];
  private bytes = 0;
  private epoch = 0;

  /** Takes a frame; what came after it on a course that was left is forgotten. */
  add(frame: Frame): void {
    if (frame.epoch !== this.epoch) {
      this.epoch = frame.epoch;
      this.frames = this.frames.filter((known) => known.clock < frame.clock);
      this.bytes = this.frames.reduce((sum, known) => sum + known.bytes, 0);
      this.rows = this.rows.filter((row) => row.clock <= frame.clock);
    }
    this.addRows(frame.rows);
    const last = this.frames.at(-1);
    if (last && last.step === frame.step) {
      this.frames[this.frames.length - 1] = frame;
      return;
    }
    this.frames.push(frame);
    this.bytes += frame.bytes;
    if (this.bytes > ROOM) this.thin();
  }

  addRows(rows: Row[]): void {
    const newest = this.rows.at(-1)?.number ?? -1;
    this.rows.push(...rows.filter((row) => row.number > newest));
  }

  /** Number of the frame nearest to a time. */
  at(clock: number): number {
    let low = 0;
    let high = this.frames.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.frames[middle].clock < clock) low = middle + 1;
      else high = middle;
    }
    if (low > 0 && clock - this.frames[low - 1].clock < this.frames[low].clock - clock) low -= 1;
    return low;
  }

  /** J/Jmax averaged over the last period before each row. */
  averages(): number[] {
    const averages: number[] = [];
    let first = 0;
    let sum = 0;
    this.rows.forEach((row, last) => {
      sum += row.flow_rate_ratio ?? 0;
      while (this.rows[first].clock < row.clock - 0.999) sum -= this.rows[first++].flow_rate_ratio ?? 0;
      averages.push(sum / (last - first + 1));
    });
    return averages;
  }

  /** Lets every second frame of the older half go. */
  private thin(): void {
    const half = this.frames.length >> 1;
    this.frames = this.frames.filter((_, index) => index >= half || index % 2 === 0);
    this.bytes = this.frames.reduce((sum, frame) => sum + frame.bytes, 0);
  }
}

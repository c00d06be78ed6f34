import type { Frame, Row } from "./protocol";

/** Frames in the order of time, and the time series beside them. */
export abstract class Film {
  rows: Row[] = [];

  /** Number of frames. */
  abstract get count(): number;

  /** A frame, where it is at hand. */
  abstract frame(index: number): Frame | undefined;

  /** Time of a frame in periods. */
  abstract clock(index: number): number;

  /** Number of the frame nearest to a time. */
  at(clock: number): number {
    const after = Math.min(this.count - 1, this.until(clock) + 1);
    const before = Math.max(0, after - 1);
    return clock - this.clock(before) < this.clock(after) - clock ? before : after;
  }

  /** Number of the last frame that is not after a time; -1 where all are. */
  until(clock: number): number {
    let low = 0;
    let high = this.count;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.clock(middle) <= clock) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  /** The frames at hand among so many that end with this one. */
  recent(index: number, most: number): Frame[] {
    const frames: Frame[] = [];
    for (let k = Math.max(0, index - most + 1); k <= index; k++) {
      const frame = this.frame(k);
      if (frame) frames.push(frame);
    }
    return frames;
  }

  addRows(rows: Row[]): void {
    const newest = this.rows.at(-1)?.number ?? -1;
    this.rows.push(...rows.filter((row) => row.number > newest));
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
}

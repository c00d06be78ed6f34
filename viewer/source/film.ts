import type { Frame, Row } from "./protocol";

/** Rows that are kept, at most. */
const ROWS = 8000;

/** A row as the page keeps it. */
export interface FilmRow extends Row {
  /** NaN where there is no flow rate. */
  average: number;
  /** Friction at this time, as far as the page knows it. */
  friction: number | null;
}

/** Frames in the order of time, and the time series beside them. */
export abstract class Film {
  rows: FilmRow[] = [];
  /** Of the rows before the last period those are kept whose number is a multiple of this. */
  private each = 1;

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

  /** Takes rows that are new, each with the mean over the period before it. */
  addRows(rows: Row[], friction: number | null = null): void {
    const newest = this.rows.at(-1)?.number ?? -1;
    for (const row of rows) {
      if (row.number <= newest) continue;
      this.rows.push({ ...row, average: row.average ?? NaN, friction });
      if (typeof row.average !== "number") this.average(this.rows.length - 1);
    }
    if (this.rows.length > ROWS) this.thinRows();
  }

  /** Lets rows go evenly, so that those from long ago are as near to each other as those from a while ago. */
  private thinRows(): void {
    // The means to come are taken of all rows of the last period.
    const begin = this.rows[this.rows.length - 1].clock - 1;
    const recent = this.rows.filter(({ clock }) => clock > begin);
    const thin = (rows: FilmRow[]) => rows.filter(({ number }) => number % this.each === 0);
    let before = thin(this.rows.slice(0, this.rows.length - recent.length));
    while (before.length > ROWS / 2) {
      this.each *= 2;
      before = thin(before);
    }
    this.rows = [...before, ...recent];
  }

  private average(last: number): void {
    let [sum, number] = [0, 0];
    const begin = this.rows[last].clock - 0.999;
    for (let k = last; k >= 0 && this.rows[k].clock > begin; k--) {
      const ratio = this.rows[k].flow_rate_ratio;
      if (ratio === null) continue;
      sum += ratio;
      number += 1;
    }
    // Where there is no flow rate its mean is NaN.
    this.rows[last].average = sum / number;
  }

  /** The last row that is not after a time, or -1. */
  rowAt(clock: number): number {
    let [low, high] = [0, this.rows.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.rows[middle].clock <= clock + 1e-9) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }
}

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
  /** Number of the row from which on thresholds are looked for: a sweep forgets what was before it. */
  since = 0;
  /** Of the rows before the last thinning those are kept whose number is a multiple of this. */
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

  /** Takes rows that are new. */
  addRows(rows: Row[], friction: number | null = null): void {
    const newest = this.rows.at(-1)?.number ?? -1;
    for (const row of rows)
      if (row.number > newest) this.rows.push({ ...row, average: row.average ?? NaN, friction });
    if (this.rows.length > ROWS) this.thinRows();
  }

  /** Lets rows go evenly: those from long ago stay as near to each other as later ones, and the newest stays. */
  private thinRows(): void {
    const newest = this.rows[this.rows.length - 1];
    const thin = () => (this.rows = this.rows.filter((row) => row.number % this.each === 0 || row === newest));
    for (thin(); this.rows.length > ROWS / 2; thin()) this.each *= 2;
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

import { Film } from "./film";
import type { Frame } from "./protocol";

/** Bytes of frames that are kept. */
const ROOM = 256e6;

/** The frames of a run that goes on: those kept for going back. */
export class History extends Film {
  private frames: Frame[] = [];
  private bytes = 0;
  private epoch: number | null = null;

  get count(): number {
    return this.frames.length;
  }

  frame(index: number): Frame | undefined {
    return this.frames[index];
  }

  clock(index: number): number {
    return this.frames[index].clock;
  }

  get newest(): Frame | undefined {
    return this.frames.at(-1);
  }

  /** Takes a frame; what came after it on a course that was left is forgotten. */
  add(frame: Frame): void {
    if (frame.past) {
      this.frames.push(frame);
      this.bytes += frame.bytes;
      return;
    }
    this.epoch ??= frame.epoch;
    if (frame.epoch !== this.epoch) {
      this.epoch = frame.epoch;
      this.frames = this.frames.filter((known) => known.clock < frame.clock);
      this.bytes = this.frames.reduce((sum, known) => sum + known.bytes, 0);
      this.rows = this.rows.filter((row) => row.clock <= frame.clock);
      if (this.since > (this.rows.at(-1)?.number ?? 0)) this.since = 0;
    }
    this.addRows(frame.rows, frame.driven.friction);
    const last = this.frames.at(-1);
    if (last && last.step === frame.step) {
      this.frames[this.frames.length - 1] = frame;
      return;
    }
    this.frames.push(frame);
    this.bytes += frame.bytes;
    if (this.bytes > ROOM) this.thin();
  }

  /** Lets frames go evenly in time, half of them or more; the newest stays. */
  private thin(): void {
    const last = this.frames.length - 1;
    const apart = (2 * (this.frames[last].clock - this.frames[0].clock)) / last;
    let kept = -Infinity;
    this.frames = this.frames.filter(({ clock }, index) => {
      if (clock - kept < apart && index < last) return false;
      kept = clock;
      return true;
    });
    this.bytes = this.frames.reduce((sum, frame) => sum + frame.bytes, 0);
  }
}

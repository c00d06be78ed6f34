import { Film } from "./film";
import type { Frame } from "./protocol";

/** Bytes of frames that are kept. */
const ROOM = 256e6;
/** Frames asked for that have not come, at most. */
const ASKED = 4;
/** Frames that are fetched before and after the one that is shown. */
const AHEAD = 16;

/** The frames of a trajectory: fetched when they are about to be shown, and kept while there is room. */
export class Recording extends Film {
  private readonly kept = new Map<number, Frame>();
  private readonly asked = new Set<number>();
  private readonly lost = new Set<number>();
  private bytes = 0;
  private wanted = 0;

  constructor(private readonly clocks: number[], private readonly ask: (number: number) => void) {
    super();
  }

  get count(): number {
    return this.clocks.length;
  }

  frame(index: number): Frame | undefined {
    return this.kept.get(index);
  }

  clock(index: number): number {
    return this.clocks[index];
  }

  /** Whether there is no use in waiting for a frame. */
  isLost(index: number): boolean {
    return this.lost.has(index);
  }

  /** Asks for a frame, for those that follow so far apart, and then for those before it. */
  want(index: number, apart: number): void {
    this.wanted = index;
    for (let k = 0; k <= AHEAD; k++) this.fetch(index + k * apart);
    for (let k = 1; k < AHEAD; k++) this.fetch(index - k);
  }

  private fetch(index: number): void {
    const known = this.kept.has(index) || this.asked.has(index) || this.lost.has(index);
    if (known || this.asked.size >= ASKED || index < 0 || index >= this.count) return;
    this.asked.add(index);
    this.ask(index);
  }

  add(frame: Frame): void {
    if (frame.number === null) return;
    this.asked.delete(frame.number);
    this.kept.set(frame.number, frame);
    this.bytes += frame.bytes;
    while (this.bytes > ROOM && this.kept.size > 1) this.drop();
  }

  /** Takes note that a frame cannot be had. */
  miss(number: number): void {
    this.asked.delete(number);
    this.lost.add(number);
  }

  /** Lets the frame go that is furthest from the one that is shown. */
  private drop(): void {
    let furthest = this.wanted;
    for (const number of this.kept.keys())
      if (Math.abs(number - this.wanted) > Math.abs(furthest - this.wanted)) furthest = number;
    this.bytes -= this.kept.get(furthest)?.bytes ?? 0;
    this.kept.delete(furthest);
  }
}

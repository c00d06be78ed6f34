import type { Film } from "./film";
import { History } from "./history";
import type { Frame } from "./protocol";
import { Recording } from "./recording";

/** Which frame of a film is shown: the newest, or one that was gone back to, from where kept frames are played on. */
export class Playback {
  film: Film = new History();
  /** Number of the frame that is shown; the newest where it is null, which no recording has. */
  cursor: number | null = null;
  /** Whether kept frames are played from the cursor on. */
  isOn = false;
  /** Periods a second at which a recording is played; every frame for one picture where it is null. */
  speed: number | null = 1;
  /** Time in periods to which a recording was played. */
  private played = 0;
  /** Frames from one picture to the next. */
  private apart = 1;

  /** Another film; a recording from a time on, or from the frame that was shown. */
  open(film: Film, jump?: number): void {
    this.film = film;
    if (film instanceof Recording) this.recordedFrom(jump ? film.until(jump) : (this.cursor ?? 0));
  }

  get shown(): number {
    return this.cursor ?? this.film.count - 1;
  }

  /** The last frame that was computed; none of a recording. */
  get newest(): Frame | undefined {
    return this.film instanceof History ? this.film.newest : undefined;
  }

  /** To the newest frame, or the last of a recording. */
  goLive(): void {
    this.scrub(this.film.count - 1);
  }

  /** To a frame, which stands. */
  scrub(index: number): void {
    this.isOn = false;
    if (this.film instanceof Recording) this.recordedFrom(index);
    else this.cursor = index >= this.film.count - 1 ? null : Math.max(0, index);
  }

  /** Plays kept frames on, or halts; a recording that has come to its end from the start. */
  toggle(): void {
    if (this.film instanceof Recording && this.shown >= this.film.count - 1) this.scrub(0);
    this.isOn = !this.isOn;
  }

  /** Goes on to the next picture. */
  advance(seconds: number): void {
    if (this.film instanceof Recording) this.playOn(this.film, seconds);
    else if (this.isOn && this.cursor !== null) {
      this.cursor += 1;
      if (this.cursor >= this.film.count - 1) this.goLive();
    }
  }

  private recordedFrom(index: number): void {
    this.cursor = Math.min(this.film.count - 1, Math.max(0, index));
    this.played = this.film.clock(this.cursor);
    this.apart = 1;
  }

  /** Plays a recording on; time waits for a frame that has not come yet. */
  private playOn(film: Recording, seconds: number): void {
    if (this.isOn && this.cursor !== null) {
      const last = film.count - 1;
      const until = this.played + (this.speed ?? 0) * seconds;
      const aim = this.speed === null ? Math.min(last, this.cursor + 1) : Math.max(this.cursor, film.until(until));
      if (aim > this.cursor) this.apart = aim - this.cursor;
      if (aim !== this.cursor && !film.frame(aim) && !film.isLost(aim)) return film.want(aim, this.apart);
      this.played = this.speed === null ? film.clock(aim) : until;
      this.cursor = aim;
      if (aim === last) this.isOn = false;
    }
    film.want(this.shown, this.isOn ? this.apart : 1);
  }
}

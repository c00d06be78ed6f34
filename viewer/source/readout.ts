import { Chart, ink, written } from "./charts";
import { FIELDS, partsOf } from "./fields";
import type { Film } from "./film";
import { drawFlat } from "./flat";
import { acrossOf, drawLoop, wordsOf } from "./loop";
import { isByLightness } from "./looks";
import { element, fill } from "./page";
import { drawFlow, drawInsteadOfLoop, drawMap, drawProfile } from "./plots";
import { type Frame, unitOfTime, type Welcome } from "./protocol";
import { factsOfDrive, factsOfGrain, factsOfSample, inWords, summaryOf } from "./readings";
import type { Scene } from "./scene";
import type { Sliders } from "./sliders";
import { FEWEST_WAVES, SpaceTime } from "./space-time";
import { type Chapter, tell } from "./story";

/** Milliseconds between two summaries for who does not see the page. */
const SUMMARIES = 5000;

/** What the page shows at an instant. */
export interface Shown {
  frame: Frame;
  /** Number of the frame. */
  index: number;
  /** The last frame that was computed; none of a recording. */
  newest: Frame | undefined;
  film: Film;
  tube: Welcome;
  scene: Scene | null;
  field: string;
  playing: boolean;
  /** Whether the newest frame is shown. */
  live: boolean;
  /** Periods a second that were asked for. */
  speed: number | null;
  chapter: Chapter | null;
}

/** The charts and numbers beside the tube. */
export class Readout {
  readonly charts = {
    flow: new Chart(element<HTMLCanvasElement>("flow")),
    loop: new Chart(element<HTMLCanvasElement>("loop")),
    profile: new Chart(element<HTMLCanvasElement>("profile")),
    spaceTime: new Chart(element<HTMLCanvasElement>("space-time")),
  };
  spaceTime = new SpaceTime();
  /** When the summary was told, and when and from which time the pace was measured. */
  private summarised = -SUMMARIES;
  private summarising = 0;
  /** Whether it played then. */
  private played = false;
  private measuredFrom: [number, number] = [0, 0];

  constructor(private readonly sliders: Sliders) {}

  show(shown: Shown, now: number): void {
    const { frame, film, tube, scene, index } = shown;
    const colours = ink();
    const { charts } = this;
    drawFlow(charts.flow, film, tube, frame.clock, colours);
    if (!isSteady(film, tube)) this.showLoop(shown);
    else element("loop-figure").hidden = !drawInsteadOfLoop(charts.loop, film, tube, frame.clock, colours);
    element("profile-of").textContent = drawProfile(charts.profile, film, index, tube, colours);
    const isLong = tube.waves >= FEWEST_WAVES && !tube.recorded;
    element("space-time-figure").hidden = !isLong;
    const lightness = isByLightness();
    if (isLong) this.spaceTime.draw(charts.spaceTime, tube, lightness, colours);
    const view = scene ? { middle: scene.middle, half: scene.halfShown() / 1.1 } : { middle: 0, half: tube.length };
    const tones = scene?.values ?? partsOf(FIELDS[shown.field], frame, tube);
    drawMap(element<HTMLCanvasElement>("map"), frame, tones, FIELDS[shown.field], tube, lightness, view);
    if (!scene) drawFlat(element<HTMLCanvasElement>("stage"), frame, tones, FIELDS[shown.field], tube, lightness, colours);
    this.showNumbers(shown, now);
  }

  private showLoop({ film, tube, frame, chapter }: Shown): void {
    const found = wordsOf(drawLoop(this.charts.loop, film, tube, frame, ink()), acrossOf(tube, frame));
    element("found").textContent = found;
    if (chapter === "jams" || chapter === "remembers") tell(found);
  }

  private showNumbers({ frame, index, newest, film, tube, scene, playing, live, speed, chapter }: Shown, now: number): void {
    // Before the first sample there is none.
    const ratio = film.rows[film.rowAt(frame.clock)]?.average ?? NaN;
    element("ratio").textContent = Number.isNaN(ratio) ? "–" : ratio.toFixed(3).replace(/^-(?=.*[1-9])/, "−").replace("-", "");
    if (chapter === "friction" && frame.clock > 1) tell(ratio < -0.01 ? "The grains flow against the wave." : `J/Jmax = ${written(ratio, 2)}`);
    if (chapter === "begins") tell(this.spaceTime.words());
    element("clock").textContent = `${frame.clock.toFixed(2)} ${unitOfTime(tube)}`;
    const slider = element<HTMLInputElement>("time");
    slider.value = String(index);
    slider.setAttribute("aria-valuetext", `${frame.clock.toFixed(2)} ${inWords(tube)}`);
    element("live").dataset.live = String(live);
    element("play").setAttribute("aria-pressed", String(playing));
    element("onward").hidden = live || tube.recorded !== null;
    const select = element<HTMLSelectElement>("speed");
    const chosen = speed === null ? "" : String(speed);
    // A sweep has a speed of its own.
    if (![...select.options].some(({ value }) => value === chosen)) select.add(new Option(`${chosen} T/s`, chosen), select.length - 1);
    if (select !== document.activeElement) select.value = chosen;
    this.showPace(newest, tube, speed, now);
    // While one looks back, what drove the run then.
    this.sliders.show(frame.driven, live ? (newest ?? frame).aims : frame.driven);
    const facts = factsOfSample(frame, tube);
    fill(element("numbers"), tube.recorded ? [...factsOfDrive(frame.driven), ...facts] : facts);
    fill(element("warnings"), frame.warnings.map(({ key, message }) => [key, message]));
    showGrain(frame, tube, scene?.picked ?? -1);
    // At once where it starts or stops playing; else a while after the last, for nothing may be drawn after this.
    const wait = frame.playing !== this.played ? 0 : Math.max(0, SUMMARIES - (now - this.summarised));
    const summary = summaryOf(frame, tube, ratio);
    this.played = frame.playing;
    clearTimeout(this.summarising);
    this.summarising = window.setTimeout(() => {
      this.summarised = performance.now();
      element("summary").textContent = summary;
    }, wait);
  }

  /** How fast it really goes, where that is not what was asked for. */
  private showPace(newest: Frame | undefined, tube: Welcome, asked: number | null, now: number): void {
    const [since, clock] = this.measuredFrom;
    if (now - since < 1000) return;
    const reached = newest?.clock ?? 0;
    const pace = ((reached - clock) / (now - since)) * 1000;
    this.measuredFrom = [now, reached];
    const tells = newest?.playing && since > 0 && pace > 0 && (asked === null || pace < 0.8 * asked);
    element("pace").textContent = tells ? `now ${written(pace, 2)} ${unitOfTime(tube)}/s` : "";
  }
}

/** Whether there is no loop: the wave stands, which has no largest flow, or nothing was driven in a recording. */
export function isSteady({ rows }: Film, tube: Welcome): boolean {
  const [first] = rows;
  return tube.unit_period === null || (tube.recorded !== null && rows.every((row) => row.amplitude === first.amplitude));
}

/** The numbers of the grain that was picked. */
export function showGrain(frame: Frame, tube: Welcome, grain: number): void {
  const box = element("grain");
  box.hidden = grain < 0 || grain >= frame.grains;
  if (!box.hidden) fill(element("grain-numbers"), factsOfGrain(frame, tube, grain));
}

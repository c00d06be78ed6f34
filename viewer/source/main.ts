import { Chart, ink, written } from "./charts";
import { type Connection, Engine, type Listener, Server } from "./connection";
import { FIELDS } from "./fields";
import { showField } from "./field-legend";
import type { Film } from "./film";
import { History } from "./history";
import { element, fill, listenToLook } from "./page";
import { drawBottleneck, drawFlow, drawLoop, drawMap, drawProfile } from "./plots";
import type { Driven, Frame, Told, Welcome } from "./protocol";
import { digest, extent, factsOfDrive, factsOfGrain, factsOfSample } from "./readings";
import { Recording } from "./recording";
import { showSaved } from "./saved";
import { Scene, WALLS, type WallLook } from "./scene";
import { Sliders } from "./sliders";
import { choice, wanted } from "./tubes";

/** Milliseconds between two drawings of the charts. */
const CHARTS = 120;

/** The page. */
class Page {
  private tube: Welcome | null = null;
  private scene: Scene | null = null;
  /** What is shown: a run that goes on, or a recording. */
  private film: Film = new History();
  private readonly connection: Connection;
  private readonly charts = {
    flow: new Chart(element<HTMLCanvasElement>("flow")),
    loop: new Chart(element<HTMLCanvasElement>("loop")),
    profile: new Chart(element<HTMLCanvasElement>("profile")),
  };
  /** Number of the frame that is shown; the newest where it is null, which no recording has. */
  private cursor: number | null = null;
  /** Whether kept frames are played from the cursor on. */
  private replaying = false;
  /** Periods a second at which a recording is played; every frame for one picture where it is null. */
  private speed: number | null = 1;
  /** Time in periods to which a recording was played. */
  private played = 0;
  /** Frames from one picture to the next. */
  private apart = 1;
  private ticked = 0;
  private shownFrame: Frame | null = null;
  private riding = false;
  /** Whether the picked grain stays in the middle. */
  private following = false;
  /** Wavelengths that the wave had run in the frame that was shown last. */
  private rode = 0;
  private field = "axial";
  private chartsDrawn = 0;
  private chartsStale = true;
  private readonly sliders = new Sliders((parameter, value) => {
    this.goLive();
    this.connection.send({ type: "steer", parameter, value });
  });

  constructor() {
    const listener: Listener = {
      told: (message) => this.told(message),
      frame: (frame) => this.receive(frame),
      lost: () => this.status("connection lost: is the program still running?", true),
    };
    // The page that is put on any server computes its tube itself.
    const alone = document.body.dataset.engine === "page";
    this.connection = alone ? new Engine(listener, wanted()) : new Server(listener);
    if (alone) element("tubes").replaceChildren(choice());
    this.listen();
    requestAnimationFrame((now) => this.tick(now));
  }

  private told(message: Told): void {
    if (message.type === "welcome") this.welcome(message);
    else if (message.type === "saved") showSaved(message);
    else if (message.type === "missing") this.missing(message.number, message.message);
    else {
      this.status(message.message, true);
      if (!this.tube) element("facts").textContent = message.message;
    }
  }

  private welcome(tube: Welcome): void {
    this.status("", false);
    this.tube = tube;
    this.open(tube);
    this.scene ??= new Scene(element<HTMLCanvasElement>("stage"), tube);
    document.title = `${tube.title} – peristalsis`;
    element("title").textContent = tube.title;
    element("facts").textContent =
      `${tube.grains.toLocaleString("en")} grains · ${tube.waves} ${tube.waves === 1 ? "wave" : "waves"} · ${tube.control} control${extent(tube)}`;
    this.sliders.make(tube);
    this.showWithin(tube);
    document.body.dataset.ready = "true";
  }

  /** The film of a run or of a recording, from its begin. */
  private open({ recorded, rows }: Welcome): void {
    if (recorded) {
      this.film = new Recording(recorded.clocks, (number) => this.connection.send({ type: "frame", number }));
      this.cursor = Math.min(this.cursor ?? 0, recorded.clocks.length - 1);
      this.played = recorded.clocks[this.cursor];
      element<HTMLInputElement>("time").max = String(Math.max(1, recorded.clocks.length - 1));
    } else {
      this.film = new History();
    }
    this.film.addRows(rows);
    this.shownFrame = null;
    this.chartsStale = true;
    document.body.dataset.recorded = String(recorded !== null);
    element("loop-name").textContent = this.isSteady() ? "The bottleneck" : "The loop, as it was driven";
    if (!recorded) element("loop-name").textContent = "The loop: drive it there and back";
  }

  /** The way back to the study that the run is of, and to the other runs of its point. */
  private showWithin({ within }: Welcome): void {
    element("within").hidden = within === null;
    if (!within) return;
    const link = element<HTMLAnchorElement>("to-study");
    link.textContent = `← ${within.study}`;
    link.href = `../../../../${sessionStorage.getItem("study") ?? ""}`;
    const siblings = element<HTMLSelectElement>("siblings");
    const all = within.siblings.map(({ number, replicate }) => new Option(`${replicate + 1} of ${within.siblings.length}`, String(number)));
    siblings.replaceChildren(...all);
    siblings.value = String(within.number);
    siblings.onchange = () => location.assign(`../${siblings.value}/`);
  }

  /** Whether a recording has no loop, for nothing was driven. */
  private isSteady(): boolean {
    const [first] = this.film.rows;
    return this.film instanceof Recording && this.film.rows.every((row) => row.amplitude === first.amplitude);
  }

  private missing(number: number, message: string): void {
    if (this.film instanceof Recording) this.film.miss(number);
    this.status(`frame ${number + 1} cannot be shown: ${message}`, true);
  }

  private receive(frame: Frame): void {
    this.chartsStale = true;
    if (this.film instanceof Recording) {
      this.film.add(frame);
      return;
    }
    if (!(this.film instanceof History)) return;
    const epoch = this.film.newest?.epoch;
    this.film.add(frame);
    if (epoch !== undefined && epoch !== frame.epoch) this.cursor = null;
    if (this.cursor === null) this.shownFrame = null;
    element<HTMLInputElement>("time").max = String(Math.max(1, this.film.count - 1));
    element("play").setAttribute("aria-pressed", String(this.playing()));
  }

  private playing(): boolean {
    return this.cursor === null ? this.newest()?.playing === true : this.replaying;
  }

  /** The last frame that was computed; none of a recording. */
  private newest(): Frame | undefined {
    return this.film instanceof History ? this.film.newest : undefined;
  }

  private shown(): number {
    return this.cursor ?? this.film.count - 1;
  }

  /** To the end: the newest frame, or the last of a recording. */
  private goLive(): void {
    if (this.film instanceof Recording) {
      this.scrub(this.film.count - 1);
      return;
    }
    this.cursor = null;
    this.replaying = false;
    this.shownFrame = null;
    this.chartsStale = true;
  }

  private play(): void {
    if (this.cursor === null) {
      this.connection.send({ type: "play", playing: !this.playing() });
    } else {
      if (this.film instanceof Recording && this.cursor >= this.film.count - 1) this.scrub(0);
      this.replaying = !this.replaying;
    }
    this.chartsStale = true;
  }

  private scrub(index: number): void {
    if (this.newest()?.playing) this.connection.send({ type: "play", playing: false });
    const last = this.film.count - 1;
    this.replaying = false;
    if (this.film instanceof Recording) {
      this.cursor = Math.min(last, Math.max(0, index));
      this.played = this.film.clock(this.cursor);
      this.apart = 1;
    } else {
      this.cursor = index >= last ? null : Math.max(0, index);
      this.shownFrame = null;
    }
    this.chartsStale = true;
  }

  private step(direction: number): void {
    if (direction > 0 && this.cursor === null) this.connection.send({ type: "step" });
    else this.scrub(this.shown() + direction);
  }

  /** Plays a recording on; time waits for a frame that has not come yet. */
  private playOn(film: Recording, seconds: number): void {
    if (this.replaying && this.cursor !== null) {
      const last = film.count - 1;
      const until = this.played + (this.speed ?? 0) * seconds;
      const aim = this.speed === null ? Math.min(last, this.cursor + 1) : Math.max(this.cursor, film.until(until));
      if (aim > this.cursor) this.apart = aim - this.cursor;
      if (aim === this.cursor || film.frame(aim) || film.isLost(aim)) {
        this.played = this.speed === null ? film.clock(aim) : until;
        if (aim !== this.cursor) this.chartsStale = true;
        this.cursor = aim;
        if (aim === last) this.replaying = false;
      } else {
        film.want(aim, this.apart);
        return;
      }
    }
    film.want(this.shown(), this.replaying ? this.apart : 1);
  }

  /** Plays the kept frames of a run on, one for one picture. */
  private replay(): void {
    if (!this.replaying || this.cursor === null) return;
    this.cursor += 1;
    this.shownFrame = null;
    this.chartsStale = true;
    if (this.cursor >= this.film.count - 1) this.goLive();
  }

  private tick(now: number): void {
    requestAnimationFrame((next) => this.tick(next));
    const { scene, tube, film } = this;
    const seconds = Math.min(0.25, (now - this.ticked) / 1000);
    this.ticked = now;
    if (!scene || !tube || film.count === 0) return;
    if (film instanceof Recording) this.playOn(film, seconds);
    else this.replay();
    // A recorded frame that has not come leaves the one before in the picture.
    const frame = film.frame(this.shown()) ?? this.shownFrame;
    if (!frame) return;
    if (frame !== this.shownFrame) {
      if (this.following && scene.picked >= 0) scene.middle = frame.position[3 * scene.picked + 2];
      else if (this.riding) scene.slide(this.ridden(frame, tube));
      this.rode = frame.period;
      scene.show(frame, FIELDS[this.field]);
      this.shownFrame = frame;
    }
    const colours = ink();
    scene.draw(colours);
    if (this.chartsStale && now - this.chartsDrawn > CHARTS) {
      this.chartsStale = false;
      this.chartsDrawn = now;
      this.drawCharts(frame, tube, scene);
    }
  }

  /** How far the wave ran since the frame that was shown before. */
  private ridden(frame: Frame, tube: Welcome): number {
    const run = frame.period - this.rode;
    return Math.abs(run) < 2 ? run * tube.wavelength : 0;
  }

  private drawCharts(frame: Frame, tube: Welcome, scene: Scene): void {
    const colours = ink();
    const { film } = this;
    const averages = film.averages();
    drawFlow(this.charts.flow, film, averages, tube, frame.clock, colours);
    if (!this.isSteady()) drawLoop(this.charts.loop, film, averages, tube, frame.clock, colours);
    else element("loop-figure").hidden = !drawBottleneck(this.charts.loop, film, frame.clock, colours);
    drawProfile(this.charts.profile, film, this.shown(), tube, colours);
    const view = { middle: scene.middle, half: scene.halfShown() / 1.1 };
    drawMap(element<HTMLCanvasElement>("map"), frame, FIELDS[this.field], tube, scene.lightness, view, colours);
    this.showNumbers(frame, averages, tube, scene);
  }

  private showNumbers(frame: Frame, averages: number[], tube: Welcome, scene: Scene): void {
    const at = this.film.rows.findLastIndex((row) => row.clock <= frame.clock + 1e-9);
    element("ratio").textContent = at >= 0 ? averages[at].toFixed(3).replace(/^-(?=.*[1-9])/, "−").replace("-", "") : "–";
    element("clock").textContent = `${frame.clock.toFixed(2)} T`;
    const slider = element<HTMLInputElement>("time");
    slider.value = String(this.shown());
    slider.setAttribute("aria-valuetext", `${frame.clock.toFixed(2)} periods`);
    element("live").dataset.live = String(this.cursor === null);
    element("play").setAttribute("aria-pressed", String(this.playing()));
    element("onward").hidden = this.cursor === null || this.film instanceof Recording;
    const speed = element<HTMLSelectElement>("speed");
    const asked = this.film instanceof Recording ? this.speed : (this.newest() ?? frame).speed;
    if (speed !== document.activeElement) speed.value = asked === null ? "" : String(asked);
    element("pace").textContent = frame.pace ? `at most ${written(frame.pace, 2)} T/s` : "";
    this.sliders.show((this.newest() ?? frame).driven);
    const facts = factsOfSample(frame);
    fill(element("numbers"), this.film instanceof Recording ? [...factsOfDrive(frame.driven), ...facts] : facts);
    fill(element("warnings"), frame.warnings.map(({ key, message }) => [key, message]));
    this.showGrain(frame, tube, scene.picked);
  }

  private showGrain(frame: Frame, tube: Welcome, grain: number): void {
    const box = element("grain");
    box.hidden = grain < 0 || grain >= frame.grains;
    if (!box.hidden) fill(element("grain-numbers"), factsOfGrain(frame, tube, grain));
  }

  private status(text: string, trouble: boolean): void {
    const box = element("status");
    box.textContent = text;
    box.hidden = text === "";
    box.dataset.trouble = String(trouble);
    if (text && trouble) setTimeout(() => box.textContent === text && (box.hidden = true), 8000);
  }

  private showLegend(): void {
    showField(FIELDS[this.field], this.scene?.lightness ?? false, this.scene?.marks ?? false);
  }

  private redraw(): void {
    this.shownFrame = null;
    this.chartsStale = true;
    this.showLegend();
  }

  private listen(): void {
    const fields = element<HTMLSelectElement>("field");
    for (const [key, field] of Object.entries(FIELDS)) fields.add(new Option(field.name, key));
    fields.onchange = () => {
      this.field = fields.value;
      this.redraw();
    };
    const walls = element<HTMLSelectElement>("wall");
    for (const look of WALLS) walls.add(new Option(look, look));
    walls.onchange = () => {
      if (this.scene) this.scene.wall = walls.value as WallLook;
      this.redraw();
    };
    const tick = (id: string, change: (scene: Scene, on: boolean) => void) => {
      const box = element<HTMLInputElement>(id);
      box.onchange = () => {
        if (this.scene) change(this.scene, box.checked);
        this.redraw();
      };
    };
    tick("marks", (scene, on) => (scene.marks = on));
    tick("lightness", (scene, on) => (scene.lightness = on));
    tick("follow", (_, on) => (this.following = on));
    tick("ride", (_, on) => (this.riding = on));
    element("play").onclick = () => this.play();
    element("back").onclick = () => this.step(-1);
    element("forth").onclick = () => this.step(1);
    element("live").onclick = () => this.goLive();
    element("home").onclick = () => this.scene?.home();
    element("save").onclick = () => this.tube?.recorded === null && this.connection.send({ type: "save" });
    element("help").onclick = () => element<HTMLDialogElement>("keys").showModal();
    element("onward").onclick = () => {
      this.connection.send({ type: "seek", period: this.film.clock(this.shown()) });
    };
    element("again").onclick = () => this.connection.send({ type: "seek", period: 0 });
    element("grain-close").onclick = () => this.pick(-1);
    for (const dialog of document.querySelectorAll("dialog"))
      dialog.onclick = (event) => event.target === dialog && dialog.close();
    const time = element<HTMLInputElement>("time");
    time.oninput = () => this.scrub(time.valueAsNumber);
    const speed = element<HTMLSelectElement>("speed");
    speed.onchange = () => {
      const periods_per_second = speed.value === "" ? null : Number(speed.value);
      if (this.film instanceof Recording) this.speed = periods_per_second;
      else this.connection.send({ type: "speed", periods_per_second });
    };
    listenToLook(() => this.redraw());
    new ResizeObserver(() => {
      this.scene?.resize();
      // At once: a canvas of another size is empty.
      this.scene?.draw(ink());
      this.chartsStale = true;
    }).observe(element("stage"));
    const sizes = new ResizeObserver(() => (this.chartsStale = true));
    for (const id of ["flow", "loop", "profile", "map"]) sizes.observe(element(id));
    this.listenToPointers();
    document.addEventListener("keydown", (event) => this.key(event));
    this.showLegend();
  }

  private pick(grain: number): void {
    if (!this.scene) return;
    this.scene.picked = grain;
    const frame = this.shownFrame;
    if (this.tube && frame) this.showGrain(frame, this.tube, grain);
    this.scene.touch();
    this.chartsStale = true;
  }

  private listenToPointers(): void {
    const stage = element("stage");
    let down: [number, number] | null = null;
    stage.addEventListener("pointerdown", (event) => {
      // A second finger means to come nearer, and picks nothing.
      down = event.isPrimary ? [event.clientX, event.clientY] : null;
    });
    stage.addEventListener("pointerup", (event) => {
      const room = event.pointerType === "touch" ? 10 : 4;
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > room || !this.scene) return;
      const box = stage.getBoundingClientRect();
      const x = (2 * (event.clientX - box.left)) / box.width - 1;
      const y = 1 - (2 * (event.clientY - box.top)) / box.height;
      this.pick(this.scene.pick(x, y));
    });
    stage.addEventListener("pointermove", () => (this.chartsStale = true));
    const dragged = (id: string, move: (part: number) => void) => {
      const canvas = element(id);
      const follow = (event: PointerEvent) => {
        const box = canvas.getBoundingClientRect();
        move((event.clientX - box.left) / box.width);
      };
      canvas.addEventListener("pointerdown", (event) => {
        canvas.setPointerCapture(event.pointerId);
        follow(event);
      });
      canvas.addEventListener("pointermove", (event) => event.buttons > 0 && follow(event));
    };
    dragged("map", (part) => {
      if (!this.scene || !this.tube) return;
      const { heading, length } = this.tube;
      this.scene.middle = (heading > 0 ? part : 1 - part) * length;
      this.scene.touch();
      this.chartsStale = true;
    });
    dragged("flow", (part) => {
      const { flow } = this.charts;
      this.scrub(this.film.at(flow.x.value(part * flow.canvas.clientWidth)));
    });
  }

  private key(event: KeyboardEvent): void {
    const { target } = event;
    const typing = target instanceof HTMLSelectElement ||
      (target instanceof HTMLInputElement && (target.type === "number" || target.type === "range"));
    if (typing || event.ctrlKey || event.metaKey || event.altKey) return;
    const click = (id: string) => () => element(id).click();
    const actions: Record<string, () => void> = {
      " ": () => this.play(),
      ArrowLeft: () => (event.shiftKey ? this.scene?.slide(-1) : this.step(-1)),
      ArrowRight: () => (event.shiftKey ? this.scene?.slide(1) : this.step(1)),
      ArrowUp: () => this.scene?.move(0, -0.08, 1),
      ArrowDown: () => this.scene?.move(0, 0.08, 1),
      a: () => this.scene?.move(-0.08, 0, 1),
      d: () => this.scene?.move(0.08, 0, 1),
      "+": () => this.scene?.move(0, 0, 0.9),
      "-": () => this.scene?.move(0, 0, 1 / 0.9),
      "0": () => this.scene?.home(),
      l: () => this.goLive(),
      m: click("marks"),
      r: click("ride"),
      s: click("save"),
      "?": click("help"),
      Escape: () => this.pick(-1),
    };
    const action = actions[event.key];
    if (!action || (event.key === " " && target instanceof HTMLButtonElement)) return;
    event.preventDefault();
    action();
    this.chartsStale = true;
  }

  /** What drives the newest frame. */
  get driven(): Driven | undefined {
    return this.newest()?.driven;
  }

  /** What tests look at. */
  get measured() {
    const frame = this.newest() ?? this.shownFrame;
    return {
      frames: this.film.count,
      pictures: this.scene?.pictures ?? 0,
      drawing: this.scene?.frameTime ?? 0,
      clock: frame?.clock ?? 0,
      number: frame?.number ?? null,
      ratio: frame?.sample?.flow_rate_ratio ?? null,
      eye: this.scene?.eye ?? [],
      step: frame?.step ?? 0,
      digest: frame ? digest(frame) : 0,
    };
  }
}

declare global {
  interface Window {
    viewer: Page;
  }
}
window.viewer = new Page();

import { ink } from "./charts";
import { type Connection, Engine, type Listener, Server, type Wanted } from "./connection";
import { FIELDS, lacks } from "./fields";
import { showField } from "./field-legend";
import type { Film } from "./film";
import { isPublished } from "./ghosts";
import { History } from "./history";
import { Host, isHosted } from "./host";
import { showHeading } from "./heading";
import { listenToKeys } from "./keys";
import { element, isStillAsked, keepSaid, listenToDialogs, listenToLook, listenToSizes, say } from "./page";
import { isByLightness, listenToLooks, offer } from "./looks";
import { giveLoop } from "./loop";
import { listenToPointers } from "./pointers";
import { type Driven, type Frame, type Told, unitOfTime, type Welcome } from "./protocol";
import { measuredOf } from "./readings";
import { isSteady, Readout, showGrain } from "./readout";
import { Playback } from "./playback";
import { insteadOfLoop } from "./plots";
import { Recording } from "./recording";
import { showSaved } from "./saved";
import { Scene, WALLS } from "./scene";
import { Address, keepTube, listenToShare, readLink } from "./share";
import { Sliders } from "./sliders";
import { SpaceTime } from "./space-time";
import { type Chapter, givesUp, listenToChapters } from "./story";
import { Sweep } from "./sweep";
import { choice, named, wanted } from "./tubes";
import { showWithin } from "./within";
import { Work } from "./work";

/** Milliseconds between two drawings of the charts. */
const CHARTS = 120;

class Page {
  private tube: Welcome | null = null;
  private scene: Scene | null = null;
  private readonly playback = new Playback();
  private readonly connection: Connection;
  /** The engine in the page, where it computes the tube itself. */
  private readonly engine: Engine | null = null;
  private readonly sweep: Sweep;
  /** What the address asked for when the page was opened; done once. */
  private asked = readLink();
  private readonly address: Address;
  private chapter: Chapter | null = null;
  /** Whether the tube that comes is to be swept there and back. */
  private sweeps = false;
  private readonly work = new Work();
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
    this.sweep.end();
    this.goLive();
    this.connection.send({ type: "steer", parameter, value });
  });
  private readonly readout = new Readout(this.sliders);

  constructor() {
    const listener: Listener = {
      told: (message) => this.told(message),
      frame: (frame) => this.work.add(() => this.receive(frame)),
      lost: (reason) => this.lost(reason),
    };
    // The page that is put on any server computes its tube itself.
    const alone = document.body.dataset.engine === "page";
    if (alone) this.engine = new Engine(listener, wanted());
    this.connection = this.engine ?? (isHosted() ? new Host(listener) : new Server(listener));
    this.address = new Address(this.connection, alone, () => ({
      eye: this.scene?.eye ?? [], middle: this.scene?.middle ?? 0, field: this.field, wall: this.scene?.wall ?? WALLS[0],
      clock: this.shownFrame?.clock ?? 0, playing: this.shownFrame?.playing ?? false,
    }));
    this.sweep = new Sweep(this.connection, () => this.film, () => this.connection.send({ type: "play", playing: false }));
    if (new URLSearchParams(location.hash.slice(1)).has("embed")) document.body.dataset.embed = "true";
    if (alone) element("tubes").replaceChildren(choice(wanted(), (tube) => this.openTube(tube)));
    listenToChapters((chapter) => this.begin(chapter));
    this.listen();
    requestAnimationFrame((now) => this.tick(now));
  }

  private told(message: Told): void {
    if (message.type === "welcome") this.welcome(message);
    else if (message.type === "saved") showSaved(message);
    else if (message.type === "missing") this.missing(message.number, message.message);
    else if (message.type === "course") this.address.take(message);
    else {
      // What is refused to a sweep is refused at each of its steps.
      this.sweep.end();
      say(message.message, true, this.newest()?.ended);
      if (!this.tube) element("facts").textContent = message.message;
    }
  }

  /** Another tube, computed by the page. */
  private openTube(tube: Wanted): void {
    this.sweeps = false;
    this.sweep.end();
    keepTube(tube.preset, tube.settings);
    this.asked = {};
    this.engine?.open(tube);
    element("tubes").replaceChildren(choice(tube, (other) => this.openTube(other)));
  }

  private lost(reason: string): void {
    document.body.dataset.lost = "true";
    this.sweep.end();
    if (this.film instanceof Recording) this.playback.isOn = false;
    element("play").setAttribute("aria-pressed", String(this.playing()));
    this.chartsStale = true;
    if (!this.tube) element("facts").textContent = "not connected";
    say(reason, true, true);
  }

  private welcome(tube: Welcome): void {
    say(this.asked.damaged ? "This link is damaged: how its tube was steered cannot be read." : "", this.asked.damaged === true);
    delete this.asked.damaged;
    delete document.body.dataset.lost;
    this.tube = tube;
    this.open(tube);
    this.stage(tube);
    showHeading(tube);
    this.sliders.make(tube);
    showWithin(tube);
    this.contactsWanted();
    if (this.asked.step && this.engine) {
      this.connection.send({ type: "follow", turns: this.asked.turns ?? [], step: this.asked.step });
    } else if (this.asked.jump && !tube.recorded && tube.rows.length === 0) {
      this.connection.send({ type: "seek", period: this.asked.jump });
    } else if (!tube.recorded && tube.rows.length === 0 && !isStillAsked() && !isHosted()) {
      // The first picture moves, but for who asks for stillness, and where the run is another's.
      this.connection.send({ type: "play", playing: true });
    }
    if (this.sweeps) this.sweep.begin(tube);
    document.body.dataset.ready = "true";
  }

  /** The stage; without the means to draw in space the tube is drawn flat, with the charts. */
  private stage(tube: Welcome): void {
    if (this.scene) return this.scene.open(tube);
    if (document.body.dataset.flat) return;
    try {
      this.scene = new Scene(element<HTMLCanvasElement>("stage"), tube);
    } catch {
      document.body.dataset.flat = "true";
      element("flat").hidden = false;
      element("stage").setAttribute("aria-label", "The tube and its grains from the side");
      return;
    }
    this.scene.lookAs(this.asked);
    element<HTMLSelectElement>("wall").value = this.scene.wall;
  }

  /** The film of a run or of a recording, from its begin. */
  private open(tube: Welcome): void {
    const { recorded, rows } = tube;
    const film = recorded ? new Recording(recorded.clocks, (number) => this.connection.send({ type: "frame", number })) : new History();
    this.playback.open(film, this.asked.jump ?? (recorded ? (this.asked.clock ?? undefined) : undefined));
    if (recorded) delete this.asked.clock;
    if (recorded) element<HTMLInputElement>("time").max = String(Math.max(1, film.count - 1));
    this.film.addRows(rows);
    this.readout.spaceTime = new SpaceTime();
    this.shownFrame = null;
    this.chartsStale = true;
    document.body.dataset.recorded = String(recorded !== null);
    element("sweep-published").hidden = !isPublished(tube);
    if (recorded && FIELDS[this.field].ofContacts) this.field = "axial";
    offer(this.field, recorded !== null);
    element("loop-name").textContent = isSteady(this.film, tube) ? insteadOfLoop(tube).name : recorded ? "The loop, as it was driven" : "The loop";
  }

  private missing(number: number, message: string): void {
    if (this.film instanceof Recording) this.film.miss(number);
    say(`frame ${number + 1} cannot be shown: ${message}`, true);
  }

  private receive(frame: Frame): void {
    this.chartsStale = true;
    if (this.film instanceof Recording) {
      this.film.add(frame);
      return;
    }
    if (!(this.film instanceof History) || !this.tube) return;
    const { epoch, playing, ended } = this.film.newest ?? {};
    this.film.add(frame);
    this.readout.spaceTime.see(frame, this.tube);
    if (frame.past) return;
    if (epoch !== undefined && epoch !== frame.epoch) this.playback.cursor = null;
    // Also where the run has stopped by itself; what the server said of it stays until the run goes on.
    if (playing && !frame.playing) this.sweep.end();
    if (frame.ended !== (ended ?? false)) keepSaid(frame.ended);
    if (typeof this.asked.clock === "number") {
      const index = this.film.at(this.asked.clock);
      if (index < this.film.count - 1) this.playback.cursor = index;
      delete this.asked.clock;
    }
    element<HTMLInputElement>("time").max = String(Math.max(1, this.film.count - 1));
    element("play").setAttribute("aria-pressed", String(this.playing()));
  }

  /** What is shown: a run that goes on, or a recording. */
  private get film(): Film {
    return this.playback.film;
  }

  /** The last frame that was computed; none of a recording. */
  private newest(): Frame | undefined {
    return this.playback.newest;
  }

  private playing(): boolean {
    if (this.playback.cursor !== null) return this.playback.isOn;
    return !document.body.dataset.lost && this.newest()?.playing === true;
  }

  private goLive(): void {
    this.playback.goLive();
    this.chartsStale = true;
  }

  private play(): void {
    if (this.playback.cursor === null) this.connection.send({ type: "play", playing: !this.playing() });
    else this.playback.toggle();
    this.chartsStale = true;
  }

  private scrub(index: number): void {
    if (this.newest()?.playing) this.connection.send({ type: "play", playing: false });
    this.playback.scrub(index);
    this.chartsStale = true;
  }

  private step(direction: number): void {
    if (direction > 0 && this.playback.cursor === null) this.connection.send({ type: "step" });
    else this.scrub(this.playback.shown + direction);
  }

  private tick(now: number): void {
    requestAnimationFrame((next) => this.tick(next));
    const took = now - this.ticked;
    this.ticked = now;
    const { pictures } = this.scene ?? {};
    this.work.add(() => this.picture(now, took));
    if (pictures !== this.scene?.pictures) this.work.end();
  }

  /** Draws what is new. */
  private picture(now: number, took: number): void {
    const { scene, tube, film, playback } = this;
    if (!tube || film.count === 0) return;
    playback.advance(Math.min(0.25, took / 1000));
    // A recorded frame that has not come leaves the one before in the picture.
    const frame = film.frame(playback.shown) ?? this.shownFrame;
    if (!frame) return;
    if (frame !== this.shownFrame) {
      if (scene) {
        const place = this.following && scene.picked >= 0 ? frame.position[3 * scene.picked + 2] : NaN;
        if (!Number.isNaN(place)) scene.middle = place;
        else if (this.riding) scene.slide(tube.wavelength * ridden(frame.period - this.rode));
        scene.show(frame, FIELDS[this.field]);
      }
      this.rode = frame.period;
      this.shownFrame = frame;
      this.chartsStale = true;
    }
    scene?.draw(ink(), took);
    if (this.chartsStale && now - this.chartsDrawn > CHARTS) {
      this.chartsStale = false;
      this.chartsDrawn = now;
      this.showReadout(frame, tube);
    }
  }

  private showReadout(frame: Frame, tube: Welcome): void {
    const { film, playback, scene, field, chapter } = this;
    const newest = this.newest();
    const speed = tube.recorded ? playback.speed : (newest ?? frame).speed;
    const [index, playing, live] = [playback.shown, this.playing(), playback.cursor === null];
    this.readout.show({ frame, index, newest, film, tube, scene, field, playing, live, speed, chapter }, this.ticked);
    this.showLegend();
  }

  private showLegend(): void {
    const force = this.scene?.contacts ? this.scene.forces.largest : null;
    const field = FIELDS[this.field];
    const isLacking = this.shownFrame !== null && lacks(field, this.shownFrame);
    showField(field, isLacking, isByLightness(), this.scene?.marks ?? false, force);
  }

  /** Contacts are sent where something is made of them. */
  private contactsWanted(): void {
    const shown = (this.scene?.contacts ?? false) || FIELDS[this.field].ofContacts === true;
    if (this.film instanceof History) this.connection.send({ type: "contacts", shown });
  }

  /** Something about the looks has changed, which the address keeps. */
  private looked(): void {
    this.chartsStale = true;
    this.address.keep();
  }

  /** What the chapters of the front page do. */
  private begin(chapter: Chapter): void {
    this.chapter = chapter;
    this.sweep.end();
    const isWide = this.tube?.control === "strain" && this.tube.waves <= 4;
    const tube = { jams: isWide ? "" : "wide", remembers: isWide ? "" : "wide", friction: "friction, flowing back", begins: "long" }[chapter];
    if (tube) this.openTube(named(tube));
    this.goLive();
    if (chapter === "jams") {
      this.connection.send({ type: "speed", periods_per_second: 10 });
      this.connection.send({ type: "steer", parameter: "width", value: 2.5 });
    }
    this.sweeps = chapter === "remembers";
    if (this.sweeps && isWide && this.tube) this.sweep.begin(this.tube);
    else this.connection.send({ type: "play", playing: true });
    document.querySelector("header")?.scrollIntoView({ block: "start" });
  }

  private redraw(): void {
    this.looked();
    this.shownFrame = null;
    this.chartsStale = true;
    this.showLegend();
  }

  private listen(): void {
    if (this.asked.field && Object.hasOwn(FIELDS, this.asked.field)) this.field = this.asked.field;
    listenToLooks(this.field, {
      field: (name) => {
        this.field = name;
        this.contactsWanted();
        this.redraw();
      },
      scene: (change) => {
        if (this.scene) change(this.scene);
        this.contactsWanted();
        this.redraw();
      },
      ride: (on) => (this.riding = on),
      follow: (on) => (this.following = on),
    });
    element("play").onclick = () => this.play();
    element("back").onclick = () => this.step(-1);
    element("forth").onclick = () => this.step(1);
    element("live").onclick = () => this.goLive();
    element("home").onclick = () => {
      this.scene?.home();
      this.looked();
    };
    element("save").onclick = () => this.tube?.recorded === null && this.connection.send({ type: "save" });
    element("help").onclick = () => element<HTMLDialogElement>("keys").showModal();
    element("onward").onclick = () => void this.goOn(this.film.clock(this.playback.shown), "Go on from here?", "go on from here");
    element("again").onclick = () => void this.goOn(this.tube?.begin ?? 0, "Begin anew?", "from the start");
    element("sweep").onclick = () => (this.sweep.isGoing ? this.sweep.end() : this.tube && !this.newest()?.ended && this.sweep.begin(this.tube));
    listenToShare(this.address, () => this.tube?.title ?? "tube", () => this.scene?.touch());
    for (const kind of ["png", "svg", "csv"] as const) element(`loop-${kind}`).onclick = () => this.tube && this.shownFrame && giveLoop(kind, this.readout.charts.loop, this.film, this.tube, this.shownFrame);
    element("grain-close").onclick = () => this.pick(-1);
    listenToDialogs();
    const time = element<HTMLInputElement>("time");
    time.oninput = () => this.scrub(time.valueAsNumber);
    const speed = element<HTMLSelectElement>("speed");
    speed.onchange = () => {
      const periods_per_second = speed.value === "" ? null : Number(speed.value);
      if (this.film instanceof Recording) this.playback.speed = periods_per_second;
      else this.connection.send({ type: "speed", periods_per_second });
    };
    listenToLook(() => this.redraw());
    listenToSizes(() => {
      this.scene?.resize();
      // At once: a canvas of another size is empty.
      this.scene?.draw(ink(), 0);
      this.chartsStale = true;
    });
    this.listenToPointers();
    listenToKeys({
      step: (direction) => this.step(direction),
      slide: (distance) => this.scene?.slide(distance),
      move: (around, up, nearer) => this.scene?.move(around, up, nearer),
      release: () => this.pick(-1),
      next: () => this.scene && this.pick(this.scene.next()),
      done: () => this.looked(),
    });
    this.showLegend();
  }

  /** Computes on from another time, after a question: what came later is given up. */
  private async goOn(period: number, question: string, answer: string): Promise<void> {
    if (!(await givesUp(period, this.newest()?.clock ?? 0, this.tube ? unitOfTime(this.tube) : "T", question, answer))) return;
    this.sweep.end();
    this.connection.send({ type: "seek", period });
  }

  private pick(grain: number): void {
    if (!this.scene) return;
    this.scene.picked = grain;
    const frame = this.shownFrame;
    if (this.tube && frame) showGrain(frame, this.tube, grain);
    this.scene.touch();
    this.chartsStale = true;
  }

  private listenToPointers(): void {
    listenToPointers({
      pick: (x, y) => this.scene && this.pick(this.scene.pick(x, y)),
      moved: () => this.looked(),
      map: (part) => {
        if (!this.scene || !this.tube) return;
        const { heading, length } = this.tube;
        this.scene.middle = (heading > 0 ? part : 1 - part) * length;
        this.scene.touch();
        this.looked();
      },
      flow: (part) => {
        const { flow } = this.readout.charts;
        this.scrub(this.film.at(flow.x.value(part * flow.canvas.clientWidth)));
      },
    });
  }

  /** What drives the newest frame. */
  get driven(): Driven | undefined {
    return this.newest()?.driven;
  }

  /** What tests look at. */
  get measured() {
    const frame = this.newest() ?? this.shownFrame;
    return {
      frames: this.film.count, rows: this.film.rows.length, playing: this.playing(), work: this.work.median,
      pictures: this.scene?.pictures ?? 0, fineness: this.scene?.part ?? 1, eye: this.scene?.eye ?? [],
      ...measuredOf(frame),
    };
  }
}

/** Wavelengths that the wave ran since the frame before; a jump in time is none. */
const ridden = (run: number) => (Math.abs(run) < 2 ? run : 0);

declare global {
  interface Window {
    viewer: Page;
  }
}
window.viewer = new Page();

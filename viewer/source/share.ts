import type { Connection } from "./connection";
import { element } from "./page";
import type { Course, Turn } from "./protocol";
import { NAMES } from "./sliders";

/** What the address keeps of the page. */
export interface Link {
  eye: number[];
  middle: number;
  field: string;
  wall: string;
  /** How the tube was steered, and up to where, where the page computes it. */
  turns: Turn[];
  step: number;
  /** Time in periods, of a run that is computed elsewhere. */
  clock: number | null;
  /** Time in periods that is to be shown first, of a run that begins anew. */
  jump: number;
  /** Whether it was steered in a way that cannot be read. */
  damaged: boolean;
}

/** Seconds of a film. */
const SECONDS = 10;

/** What the address says, as far as it does. */
export function readLink(): Partial<Link> {
  const parts = new URLSearchParams(location.hash.slice(1));
  const numbers = (name: string) => (parts.get(name) ?? "").split(",").filter(Boolean).map(Number);
  const link: Partial<Link> = {};
  const eye = numbers("eye");
  if (eye.length === 3 && eye.every(Number.isFinite) && Math.hypot(...eye) > 1) link.eye = eye;
  const [middle] = numbers("at");
  if (Number.isFinite(middle)) link.middle = middle;
  const [step] = numbers("step");
  if (Number.isSafeInteger(step) && step >= 0) link.step = step;
  const [clock] = numbers("t");
  if (Number.isFinite(clock)) link.clock = clock;
  const [jump] = numbers("jump");
  if (Number.isFinite(jump)) link.jump = jump;
  for (const name of ["field", "wall"] as const) {
    const text = parts.get(name);
    if (text !== null) link[name] = text;
  }
  const turns = (parts.get("turns") ?? "").split(",").filter(Boolean).map((turn) => turn.split(":"));
  link.turns = turns.map(([at, parameter, value]) => [Number(at), parameter, Number(value)] as Turn);
  const isWhole = ([at, parameter, value]: Turn) => Number.isFinite(at) && Object.hasOwn(NAMES, parameter) && Number.isFinite(value);
  if (!link.turns.every(isWhole)) {
    [link.turns, link.step, link.damaged] = [[], undefined, true];
  }
  return link;
}

/** The address of this state. */
export function linkOf(link: Omit<Link, "jump" | "damaged">, embedded = false): string {
  const before = new URLSearchParams(location.hash.slice(1));
  const parts = new URLSearchParams();
  for (const name of ["preset", "set"]) for (const text of before.getAll(name)) parts.append(name, text);
  parts.set("field", link.field);
  parts.set("wall", link.wall);
  parts.set("eye", link.eye.map((it) => it.toFixed(2)).join(","));
  parts.set("at", link.middle.toFixed(2));
  if (link.clock !== null) parts.set("t", link.clock.toFixed(4));
  else if (link.step > 0) parts.set("step", String(link.step));
  if (link.turns.length > 0) parts.set("turns", link.turns.map((turn) => turn.join(":")).join(","));
  if (embedded) parts.set("embed", "1");
  const address = new URL(location.href);
  address.hash = String(parts).replaceAll("%2C", ",").replaceAll("%3A", ":");
  return String(address);
}

/** Keeps another tube in the address. */
export function keepTube(preset: string, settings: string[]): void {
  history.replaceState(null, "", `#${new URLSearchParams([["preset", preset], ...settings.map((it) => ["set", it])])}`);
}

/** Gives a file to whoever looks at the page. */
export function download(name: string, file: Blob): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(file);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 60000);
}

/** The stage as a picture. */
export function takePicture(canvas: HTMLCanvasElement, name: string): void {
  canvas.toBlob((file) => file && download(`${name}.png`, file));
}

/** The stage as a film of the next ten seconds; what stands still is drawn again now and then, for only drawing gives frames. */
export function takeFilm(canvas: HTMLCanvasElement, name: string, button: HTMLButtonElement, redraw: () => void): void {
  const recorder = new MediaRecorder(canvas.captureStream(30), { videoBitsPerSecond: 8e6 });
  const parts: Blob[] = [];
  const label = button.textContent;
  button.disabled = true;
  recorder.ondataavailable = ({ data }) => parts.push(data);
  const drawing = setInterval(redraw, 250);
  recorder.onstop = () => {
    clearInterval(drawing);
    download(`${name}.webm`, new Blob(parts, { type: recorder.mimeType }));
    button.disabled = false;
    button.textContent = label;
  };
  recorder.start(1000);
  let left = SECONDS;
  const count = () => {
    button.textContent = `recording: ${left} s`;
    if (left-- > 0) setTimeout(count, 1000);
    else recorder.stop();
  };
  count();
}

/** Copies what is in a field; where the browser does not let a page do that, it is chosen for the keys to copy. */
async function copy(field: HTMLInputElement, button: HTMLElement): Promise<void> {
  const label = button.textContent;
  field.select();
  try {
    await navigator.clipboard.writeText(field.value);
    button.textContent = "copied";
  } catch {
    button.textContent = "press Ctrl+C";
  }
  setTimeout(() => (button.textContent = label), 2000);
}

/** What the address is made of, besides the course of the run. */
type View = Omit<Link, "jump" | "damaged" | "turns" | "step" | "clock"> & { clock: number; playing: boolean };

/** Milliseconds that the address waits for more changes. */
const KEEPING = 500;

/** The address, which keeps parameters, view, colours and time. */
export class Address {
  private timer = 0;
  /** Whether the dialog is to be opened when the course is known. */
  private sharing = false;

  /** `own`: the page computes its tube itself, and an address holds how it was steered. */
  constructor(private readonly connection: Connection, private readonly own: boolean, private readonly view: () => View) {}

  keep(): void {
    // A page inside of another has no address of its own.
    if (location.protocol === "about:") return;
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.ask(), KEEPING);
  }

  share(): void {
    this.sharing = true;
    this.ask();
  }

  private ask(): void {
    if (this.own) this.connection.send({ type: "course" });
    else this.take({ type: "course", turns: [], step: 0 });
  }

  take({ turns, step }: Course): void {
    const { playing, clock, ...view } = this.view();
    const link = { ...view, turns, step: playing ? 0 : step, clock: this.own ? null : clock };
    history.replaceState(null, "", linkOf(playing ? { ...link, turns: [] } : link));
    if (!this.sharing) return;
    this.sharing = false;
    element<HTMLInputElement>("link").value = linkOf({ ...link, turns, step });
    const small = linkOf({ ...link, step: 0, turns: [] }, true);
    element<HTMLInputElement>("embed").value =
      `<iframe src="${small}" width="720" height="420" title="Grains in a peristaltic tube" loading="lazy"></iframe>`;
    element("embed-label").hidden = !this.own;
    element("link-note").hidden = this.own;
    element<HTMLDialogElement>("share-dialog").showModal();
  }
}

/** The button that shares, and those of its dialog. */
export function listenToShare(address: Address, title: () => string, redraw: () => void): void {
  const stage = element<HTMLCanvasElement>("stage");
  element("share").onclick = () => address.share();
  element("picture").onclick = () => takePicture(stage, title());
  const film = element<HTMLButtonElement>("film-button");
  film.onclick = () => takeFilm(stage, title(), film, redraw);
  for (const id of ["link", "embed"]) element(`copy-${id}`).onclick = () => void copy(element<HTMLInputElement>(id), element(`copy-${id}`));
  addEventListener("hashchange", () => location.reload());
}

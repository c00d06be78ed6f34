import { element } from "./page";

/** What the keys do besides clicking on buttons. */
export interface Actions {
  step(direction: number): void;
  slide(distance: number): void;
  move(around: number, up: number, nearer: number): void;
  release(): void;
  /** Picks the grain in the middle, or the one after the picked one. */
  next(): void;
  done(): void;
}

/** Listens to the keys, except in fields and while a dialog is open. */
export function listenToKeys(acts: Actions): void {
  const click = (id: string) => () => element(id).click();
  const actions: Record<string, (event: KeyboardEvent) => void> = {
    " ": click("play"),
    ArrowLeft: ({ shiftKey }) => (shiftKey ? acts.slide(-1) : acts.step(-1)),
    ArrowRight: ({ shiftKey }) => (shiftKey ? acts.slide(1) : acts.step(1)),
    ArrowUp: () => acts.move(0, -0.08, 1),
    ArrowDown: () => acts.move(0, 0.08, 1),
    a: () => acts.move(-0.08, 0, 1),
    d: () => acts.move(0.08, 0, 1),
    "+": () => acts.move(0, 0, 0.9),
    "-": () => acts.move(0, 0, 1 / 0.9),
    "0": click("home"),
    c: click("contacts"),
    g: () => acts.next(),
    l: click("live"),
    m: click("marks"),
    r: click("ride"),
    s: click("save"),
    "?": click("help"),
    Escape: () => acts.release(),
  };
  document.addEventListener("keydown", (event) => {
    const { target } = event;
    const typing = target instanceof HTMLSelectElement ||
      (target instanceof HTMLInputElement && target.type !== "checkbox");
    if (typing || event.ctrlKey || event.metaKey || event.altKey || document.querySelector("dialog[open]")) return;
    const action = actions[event.key];
    const isIn = (places: string) => target instanceof Element && target.closest(places) !== null;
    // What a key does by itself there: space presses, arrows scroll.
    const own = event.key === " " ? "button, input, a, summary" : event.key.startsWith("Arrow") ? ".panel, .chapters" : "";
    if (!action || (own && isIn(own))) return;
    event.preventDefault();
    action(event);
    acts.done();
  });
}

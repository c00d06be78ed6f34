import { element } from "./page";

/** What pointers do with the stage and with the charts that one drags on. */
export interface Pointed {
  /** A tap at a place of the stage, from -1 to 1. */
  pick(x: number, y: number): void;
  /** Drags on the map and on the chart of time, at a part of their width. */
  map(part: number): void;
  flow(part: number): void;
  moved(): void;
}

export function listenToPointers(pointed: Pointed): void {
  const stage = element("stage");
  let down: [number, number] | null = null;
  stage.addEventListener("pointerdown", (event) => {
    // A second finger means to come nearer, and picks nothing.
    down = event.isPrimary ? [event.clientX, event.clientY] : null;
  });
  stage.addEventListener("pointerup", (event) => {
    const room = event.pointerType === "touch" ? 10 : 4;
    if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > room) return;
    const box = stage.getBoundingClientRect();
    pointed.pick((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
  });
  stage.addEventListener("pointermove", () => pointed.moved());
  for (const id of ["map", "flow"] as const) {
    const canvas = element(id);
    const follow = (event: PointerEvent) => {
      const box = canvas.getBoundingClientRect();
      pointed[id]((event.clientX - box.left) / box.width);
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      follow(event);
    });
    canvas.addEventListener("pointermove", (event) => event.buttons > 0 && follow(event));
  }
}

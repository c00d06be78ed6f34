import { FIELDS } from "./fields";
import { element, options } from "./page";
import { type Scene, WALLS, type WallLook } from "./scene";

/** What is done when the looks are changed. */
export interface Looks {
  field(name: string): void;
  scene(change: (scene: Scene) => void): void;
  ride(on: boolean): void;
  follow(on: boolean): void;
}

/** The choices of colours, wall and marks. */
export function listenToLooks(field: string, looks: Looks): void {
  const fields = element<HTMLSelectElement>("field");
  offer(field, false);
  fields.onchange = () => looks.field(fields.value);
  const walls = element<HTMLSelectElement>("wall");
  for (const look of WALLS) walls.add(new Option(look, look));
  walls.onchange = () => looks.scene((scene) => (scene.wall = walls.value as WallLook));
  const tick = (id: string, change: (on: boolean) => void) => {
    const box = element<HTMLInputElement>(id);
    box.onchange = () => change(box.checked);
  };
  closeBeside(document.querySelector<HTMLDetailsElement>("details.more"));
  tick("contacts", (on) => looks.scene((scene) => (scene.contacts = on)));
  tick("marks", (on) => looks.scene((scene) => (scene.marks = on)));
  tick("lightness", (on) => looks.scene((scene) => (scene.lightness = on)));
  tick("ride", looks.ride);
  tick("follow", looks.follow);
}

/** Whether colours go from dark to light; without a scene, too. */
export const isByLightness = (): boolean => element<HTMLInputElement>("lightness").checked;

/** Offers the colours that there are: a recording has no contacts. */
export function offer(field: string, recorded: boolean): void {
  const offered = Object.entries(FIELDS).filter(([, { ofContacts }]) => !(recorded && ofContacts));
  options("field", offered.map(([name, { name: label }]) => ({ name, label })), field);
}

/** Closes the menu by a press elsewhere, and by escape before that key does anything else. */
function closeBeside(menu: HTMLDetailsElement | null): void {
  if (!menu) return;
  document.addEventListener("pointerdown", ({ target }) => {
    if (!menu.contains(target as Node)) menu.open = false;
  });
  document.addEventListener("keydown", (event) => {
    if (event.key !== "Escape" || !menu.open) return;
    event.stopPropagation();
    menu.open = false;
    menu.querySelector("summary")?.focus();
  }, true);
}

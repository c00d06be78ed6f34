/** What the pages have in common. */
import { forgetInk } from "./charts";

export function element<T extends HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no ${id}`);
  return found as T;
}

/** Names and values, each in its column. */
export function fill(list: HTMLElement, facts: [string, string][]): void {
  list.replaceChildren(
    ...facts.flatMap(([name, value]) => {
      const [term, definition] = [document.createElement("dt"), document.createElement("dd")];
      term.textContent = name;
      definition.textContent = value;
      return [term, definition];
    }),
  );
}

/** Follows the choice of light or dark, of the page and of the system. */
export function listenToLook(redraw: () => void): void {
  const look = element<HTMLSelectElement>("look");
  const change = () => {
    document.documentElement.dataset.look = look.value;
    forgetInk();
    redraw();
  };
  look.onchange = change;
  matchMedia("(prefers-color-scheme: dark)").onchange = change;
}

export function isDark(): boolean {
  const { look } = document.documentElement.dataset;
  return look === "dark" || (look !== "light" && matchMedia("(prefers-color-scheme: dark)").matches);
}

/** The options of a choice, made anew only where they are others. */
export function options(id: string, all: { name: string; label: string }[], chosen: string): void {
  const select = element<HTMLSelectElement>(id);
  const same = select.options.length === all.length && all.every(({ name }, k) => select.options[k].value === name);
  if (!same) select.replaceChildren(...all.map(({ name, label }) => new Option(label, name)));
  select.value = chosen;
}

/** Whether whoever looks wants no motion. */
export const isStillAsked = (): boolean => matchMedia("(prefers-reduced-motion: reduce)").matches;

/** Says something over the stage; what is no lasting trouble goes by itself. */
export function say(text: string, trouble = false, lasting = false): void {
  const box = element("status");
  box.textContent = text;
  box.hidden = text === "";
  box.dataset.trouble = String(trouble);
  clearTimeout(going);
  if (text && trouble && !lasting) going = window.setTimeout(() => (box.hidden = true), 8000);
}

/** The timer by which what is said goes. */
let going = 0;

/** Keeps what is said, or lets it go. */
export function keepSaid(keeps: boolean): void {
  clearTimeout(going);
  if (!keeps) element("status").hidden = true;
}

/** Follows the sizes of the stage and the charts. */
export function listenToSizes(changed: () => void): void {
  const sizes = new ResizeObserver(changed);
  for (const id of ["stage", "flow", "loop", "profile", "map", "space-time"]) sizes.observe(element(id));
}

/** Closes dialogs by their buttons and by a click beside them; the page's policy lets no form do it. */
export function listenToDialogs(): void {
  for (const dialog of document.querySelectorAll("dialog")) {
    // An answer of false would keep links in it from being followed.
    dialog.onclick = (event) => {
      if (event.target === dialog) dialog.close();
    };
    for (const button of dialog.querySelectorAll<HTMLButtonElement>("form button"))
      button.onclick = (event) => {
        event.preventDefault();
        dialog.close(button.value);
      };
  }
}

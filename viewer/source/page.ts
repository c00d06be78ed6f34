/** What the pages have in common. */

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
  look.onchange = () => {
    document.documentElement.dataset.look = look.value;
    redraw();
  };
  matchMedia("(prefers-color-scheme: dark)").onchange = redraw;
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

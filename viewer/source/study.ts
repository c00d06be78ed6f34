import { type Choice, keep, read, untouched } from "./choice";
import { momentOf } from "./first";
import { Chart, ink, textOf } from "./charts";
import { type Curve, curvesOf, drawCurves, extent } from "./curves";
import { showFigures } from "./figures";
import { across, drawHeat, type Scale } from "./heat";
import { showMarks, showScale } from "./legend";
import type { List, Study } from "./messages";
import { element, isDark, listenToLook, options, say } from "./page";
import { beside, type Panel, placeOf, pointAt, put } from "./panel";
import { factsOf, showPoint, showTip } from "./point";
import { type Point, Results, type Value } from "./results";
import { fixable, numeric, settle } from "./settle";

/** Milliseconds from one look for new rows to the next, while runs are to come and when none is known to be. */
const EACH = { growing: 4000, done: 15000 };

class StudyPage {
  private list: List = { studies: [], figures: [] };
  private results: Results | null = null;
  private choice = read();
  /** What was chosen of the studies that were left. */
  private readonly left = new Map<number, Choice>();
  private panels: Panel[] = [];
  private points: Point[] = [];
  private chosen: Point | null = null;
  /** Which panel the chosen point is in. */
  private within: Panel | null = null;
  private drawn = 0;

  constructor() {
    this.listen();
    void this.begin();
  }

  private async begin(): Promise<void> {
    this.list = (await (await fetch("list")).json()) as List;
    const studies = element<HTMLSelectElement>("study");
    this.list.studies.forEach((study, k) => studies.add(new Option(`${study.name} (${study.rows})`, String(k))));
    element("study-label").hidden = this.list.studies.length < 2;
    element("view-figures").hidden = this.list.figures.length === 0;
    if (this.list.studies.length === 0) this.choice.view = "figures";
    if (this.choice.study >= this.list.studies.length) this.choice.study = 0;
    showFigures(element("figures"), this.list, (study) => {
      this.choice.view = "curves";
      void this.open(study);
    });
    await this.open(this.choice.study);
    void this.follow();
  }

  /** Looks for new rows again and again, while anybody sees them. */
  private async follow(): Promise<void> {
    for (;;) {
      await new Promise((done) => setTimeout(done, this.results?.study.growing ? EACH.growing : EACH.done));
      if (this.results && document.visibilityState === "visible") await this.refresh();
    }
  }

  /** Another study, as it was left or with its own first choice: what is right for one is wrong for the next. */
  private async open(study: number): Promise<void> {
    const { view } = this.choice;
    if (study !== this.choice.study) {
      this.left.set(this.choice.study, this.choice);
      this.choice = this.left.get(study) ?? { ...untouched(), study };
      this.choice.view = view;
    }
    this.results = null;
    this.chosen = null;
    if (this.list.studies.length > 0) await this.refresh();
    this.show();
  }

  private async refresh(): Promise<void> {
    const { study } = this.choice;
    const known = this.results?.study.version;
    try {
      const headers: HeadersInit = known === undefined ? {} : { "If-None-Match": `"${known}"` };
      const answer = await fetch(`study/${study}`, { headers, cache: "no-store" });
      if (answer.status === 304) return say("");
      if (!answer.ok) throw new Error(await answer.text());
      if (study !== this.choice.study) return;
      this.take(new Results((await answer.json()) as Study));
      say("");
    } catch (error) {
      say(`no answer: is the program still running? (${error instanceof Error ? error.message : error})`);
    }
  }

  private take(results: Results): void {
    this.results = results;
    this.show();
  }

  /** Everything anew. */
  private show(): void {
    if (this.results) settle(this.choice, this.results);
    this.showChoices();
    this.showFacts();
    this.regroup();
    this.layOut();
    this.draw();
    keep(this.choice);
  }

  private showFacts(): void {
    const { results, list, choice } = this;
    element("plots").hidden = choice.view === "figures";
    element("figures").hidden = choice.view !== "figures";
    element("side").hidden = choice.view === "figures";
    const entry = list.studies.at(choice.study);
    const title = choice.view === "figures" ? "Figures" : entry?.title || entry?.name || "No studies";
    document.title = `${title} – peristalsis`;
    element("title").textContent = title;
    if (choice.view === "figures") {
      element("facts").textContent = `${list.figures.length} ${list.figures.length === 1 ? "figure" : "figures"} of the claims, with the studies behind them`;
      return;
    }
    if (!results) return;
    const { counts, name, growing, store } = results.study;
    const rest = Object.entries(counts).filter(([state]) => state !== "done");
    const states: Record<string, string> = { leased: "being computed", pending: "waiting", checkpointed: "interrupted" };
    const parts = rest.map(([state, count]) => `${count} ${states[state] ?? state}`);
    element("facts").textContent = [name, `${results.rows.toLocaleString("en")} ${results.rows === 1 ? "run" : "runs"} done`, ...parts].join(" · ");
    element("refresh").hidden = !growing;
    const none = this.choice.x ? "No finished run has such a value." : "Nothing can go across: the finished runs differ in no number. study export writes them as a table.";
    element("empty").textContent = results.rows > 0
      ? none
      : "No run of this study has ended yet." + (store ? ` This computes them: peristalsis study run ${store}/study.toml --store ${store}` : "");
  }

  private showChoices(): void {
    const { results, choice } = this;
    for (const view of ["curves", "heat", "figures"] as const)
      element(`view-${view}`).setAttribute("aria-pressed", String(choice.view === view));
    element("choices").hidden = choice.view === "figures";
    element<HTMLSelectElement>("study").value = String(choice.study);
    if (!results) return;
    options("value", results.quantities, choice.value);
    options("x", numeric(results), choice.x);
    const others = results.parameters.filter(({ name }) => name !== choice.x);
    const none = choice.view === "curves" || others.length === 0 ? [{ name: "none", label: "none" }] : [];
    options("other", [...others, ...none], choice.other);
    // A box may be too narrow for what is chosen.
    for (const id of ["value", "x", "other"]) element(id).title = element<HTMLSelectElement>(id).selectedOptions[0]?.text ?? "";
    element("other-name").textContent = choice.view === "heat" ? "up" : "family";
    element("start-label").hidden = results.starts.length < 2;
    const starts = ["both", ...results.starts].map((name) => ({ name, label: name === "both" ? "both" : `from ${name}` }));
    options("start", starts, choice.start);
    element<HTMLInputElement>("logarithmic").checked = choice.logarithmic;
    const box = element("fixed");
    box.replaceChildren();
    let rows = results.all();
    for (const parameter of fixable(results, choice)) {
      const value = choice.fixed.get(parameter.name);
      if (value === undefined) continue;
      const values = results.valuesOf(parameter.name, rows);
      const label = document.createElement("label");
      const select = document.createElement("select");
      values.forEach((it, k) => select.add(new Option(textOf(it, 4), String(k))));
      select.value = String(values.indexOf(value));
      select.onchange = () => {
        choice.fixed.set(parameter.name, values[Number(select.value)]);
        this.show();
      };
      label.append(`${parameter.label} `, select);
      box.append(label);
      rows = results.where(rows, new Map([[parameter.name, value]]));
    }
    const quantity = results.quantities.find(({ name }) => name === choice.value);
    element("description").textContent = quantity ? quantity.description : "";
  }

  /** The points of the choice; the one that was chosen stays chosen. */
  private regroup(): void {
    const { results, choice, chosen } = this;
    this.points = [];
    element("left-out").textContent = "";
    if (!results || choice.view === "figures" || !choice.x) return;
    const rows = results.where(results.all(), choice.fixed);
    const kept = rows.filter((row) => choice.start === "both" || results.value("initial_state", row) === choice.start);
    const other = choice.other === "none" ? null : choice.other;
    const points = results.points(kept, choice.value, choice.x, other);
    this.points = choice.logarithmic ? points.filter(({ value }) => value > 0) : points;
    const left = points.length - this.points.length;
    if (left > 0) element("left-out").textContent = `Not shown, for they are 0 or below: ${left} of ${points.length} points.`;
    const is = (point: Point) => point.x === chosen?.x && point.other === chosen.other && point.start === chosen.start;
    this.chosen = this.points.find(is) ?? null;
  }

  private shownStarts(): string[] {
    const starts = new Set(this.points.map(({ start }) => start));
    return (this.results?.starts ?? []).filter((start) => starts.has(start));
  }

  private members(): (Value | null)[] {
    const own = new Set(this.points.map(({ other }) => other));
    const values = this.results?.parameter(this.choice.other)?.values ?? [];
    return this.choice.other === "none" ? [null] : values.filter((value) => own.has(value));
  }

  /** One canvas for curves; for a map one for each start. */
  private layOut(): void {
    const starts = this.choice.view === "heat" ? this.shownStarts() : [null];
    const same = starts.length === this.panels.length && starts.every((start, k) => this.panels[k].start === start);
    if (same) return;
    const box = element("charts");
    box.replaceChildren();
    this.panels = starts.map((start) => {
      const figure = document.createElement("figure");
      const canvas = document.createElement("canvas");
      canvas.tabIndex = 0;
      canvas.setAttribute("role", "application");
      if (start !== null && starts.length > 1) {
        const caption = document.createElement("figcaption");
        caption.textContent = `from ${start}`;
        figure.append(caption);
      }
      figure.append(canvas);
      box.append(figure);
      const panel: Panel = { chart: new Chart(canvas), start, places: new Map(), cells: [], lines: [] };
      this.listenTo(canvas, panel);
      sizes.observe(canvas);
      return panel;
    });
  }

  draw(): void {
    const { choice, results } = this;
    if (!results || choice.view === "figures") return;
    const colours = ink();
    const x = results.parameter(choice.x);
    const empty = this.points.length === 0;
    element("empty").hidden = !empty;
    element("charts").hidden = empty;
    this.showLegend();
    if (empty || !x) return;
    const value = this.quantity;
    const other = results.parameter(choice.other)?.label ?? "";
    for (const panel of this.panels) {
      const { chart } = panel;
      const name = choice.view === "heat" ? `Map of ${value}` : `Curves of ${value}`;
      chart.canvas.setAttribute("aria-label", `${name} against ${x.label}; arrow keys go from point to point, Enter opens the run`);
      if (choice.view === "heat") {
        const own = this.points.filter(({ start }) => start === panel.start);
        const rows = this.members();
        const longest = Math.max(...rows.map((row) => textOf(row).length));
        const left = Math.min(150, Math.max(42, 7 * longest + 14));
        chart.begin(across(this.points), [0, 1], [x.label, other], colours, { left, scaled: false });
        panel.cells = drawHeat(chart, own, rows, this.scale(), this.chosen, colours);
        panel.lines = rows.map((row) => own.filter((point) => point.other === row));
      } else {
        const curves = this.curves();
        const room = 0.03 * (across(this.points)[1] - across(this.points)[0]);
        const places = this.points.map((point) => point.x);
        const ends: [number, number] = [Math.min(...places) - room, Math.max(...places) + room];
        chart.begin(ends, extent(this.points, choice.logarithmic), [x.label, value], colours, { logarithmic: choice.logarithmic });
        panel.places = drawCurves(chart, curves, this.chosen, colours);
        panel.lines = curves.map(({ points }) => points);
      }
    }
    this.showTip();
    this.showPoint();
    this.drawn += 1;
  }

  private readonly curves = (): Curve[] => curvesOf(this.points, this.members(), this.results?.starts ?? [], isDark());

  private scale(): Scale {
    const values = this.points.map(({ value }) => value);
    return { from: Math.min(...values), to: Math.max(...values), logarithmic: this.choice.logarithmic };
  }

  /** What is drawn, with its unit. */
  private get quantity(): string {
    return this.results?.quantities.find(({ name }) => name === this.choice.value)?.label ?? "";
  }

  private showLegend(): void {
    const { results, choice } = this;
    const box = element("legend");
    if (!results || this.points.length === 0) return box.replaceChildren();
    const value = this.quantity;
    const limits = this.points.some(({ atLeast }) => atLeast);
    if (choice.view === "heat") return showScale(box, value, this.scale(), limits);
    const family = results.parameter(choice.other);
    showMarks(box, family?.label ?? value, this.curves(), limits);
  }

  private showTip(): void {
    const { chosen, within, results, choice } = this;
    const place = chosen && within && placeOf(within, chosen);
    element("tip").hidden = !place;
    if (!place || !results) return;
    const isKnown = results.typical(chosen, choice.value) !== null;
    showTip(this.quantity, chosen, factsOf(chosen, results, choice), isKnown ? (this.touched ? "tap again to watch its run" : "click to watch its run") : null);
    put(element("tip"), element("charts"), within, place);
  }

  private showPoint(): void {
    const { chosen, results, choice } = this;
    element("point").hidden = chosen === null;
    element("hint").hidden = chosen !== null;
    if (chosen && results) showPoint(this.quantity, chosen, results, choice, (row) => this.address(results, row));
  }

  private address(results: Results, row: number): string {
    return `study/${this.choice.study}/run/${results.study.runs[row]}/${momentOf(results, row)}`;
  }

  private watch(point: Point): void {
    const { results } = this;
    const row = results?.typical(point, this.choice.value) ?? null;
    if (results && row !== null) location.assign(this.address(results, row));
  }

  private choose(point: Point | null, panel: Panel | null): void {
    if (point === this.chosen && panel === this.within) return;
    this.chosen = point;
    this.within = panel;
    this.draw();
  }

  private touched = false;

  private listenTo(canvas: HTMLCanvasElement, panel: Panel): void {
    canvas.addEventListener("pointermove", (event) => {
      if (event.pointerType === "touch") return;
      this.touched = false;
      const point = pointAt(panel, event, 16);
      canvas.style.cursor = point && this.results?.typical(point, this.choice.value) !== null ? "pointer" : "default";
      if (point) this.choose(point, panel);
    });
    canvas.addEventListener("pointerleave", () => (element("tip").hidden = true));
    canvas.addEventListener("click", (event) => {
      const touch = event instanceof PointerEvent && event.pointerType === "touch";
      const point = pointAt(panel, event, touch ? 28 : 16);
      // A finger does not hover: the first tap tells, the second opens.
      const known = !touch || (point === this.chosen && this.touched);
      this.touched = touch;
      if (point && known) this.watch(point);
      else this.choose(point, point && panel);
    });
    canvas.addEventListener("keydown", (event) => this.key(event, panel));
    canvas.addEventListener("blur", () => (element("tip").hidden = true));
  }

  private key(event: KeyboardEvent, panel: Panel): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { chosen } = this;
    const steps: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (event.key === "Enter" && chosen) this.watch(chosen);
    else if (event.key === "Escape") this.choose(null, null);
    else if (event.key in steps) this.choose(beside(panel, chosen, steps[event.key]), panel);
    else return;
    event.preventDefault();
  }

  private listen(): void {
    const select = (id: string, change: (value: string) => void) => {
      const box = element<HTMLSelectElement>(id);
      box.onchange = () => {
        change(box.value);
        this.show();
      };
    };
    select("value", (value) => (this.choice.value = value));
    select("x", (value) => {
      if (this.choice.other === value) this.choice.other = this.choice.x;
      this.choice.x = value;
    });
    select("other", (value) => (this.choice.other = value));
    select("start", (value) => (this.choice.start = value));
    element<HTMLSelectElement>("study").onchange = ({ target }) => void this.open(Number((target as HTMLSelectElement).value));
    const logarithmic = element<HTMLInputElement>("logarithmic");
    logarithmic.onchange = () => {
      this.choice.logarithmic = logarithmic.checked;
      this.show();
    };
    for (const view of ["curves", "heat", "figures"] as const)
      element(`view-${view}`).onclick = () => {
        this.choice.view = view;
        if (view === "heat" && this.choice.other === "none") this.choice.other = "";
        this.show();
      };
    element("refresh").onclick = () => void this.refresh();
    listenToLook(() => this.show());
    window.addEventListener("hashchange", () => {
      const before = this.choice.study;
      this.choice = read();
      if (this.choice.study === before) this.show();
      else void this.open(this.choice.study);
    });
  }

  /** What tests look at. */
  get measured() {
    const places = this.panels.map(({ chart, cells, places }) => {
      const { left, top } = chart.canvas.getBoundingClientRect();
      const middles = cells.map((cell): [number, number] => [cell.left + 0.5 * cell.width, cell.top + 0.5 * cell.height]);
      return [...middles, ...places.values()].map(([x, y]) => [left + x, top + y]);
    });
    return {
      drawn: this.drawn,
      points: this.points.length,
      curves: this.results ? this.curves().length : 0,
      places: places.flat(),
      chosen: this.chosen && { x: this.chosen.x, value: this.chosen.value, number: this.chosen.number },
    };
  }
}

declare global {
  interface Window {
    study: StudyPage;
  }
}
const sizes = new ResizeObserver(() => window.study?.draw());
window.study = new StudyPage();

import { Chart, type Entry, type Ink, ink, written } from "./charts";
import type { Film, FilmRow } from "./film";
import { type Ghost, ghostsOf, ghostsOfFriction } from "./ghosts";
import type { Frame, Welcome } from "./protocol";
import { download } from "./share";
import { SvgContext } from "./svg";

/** Half of the largest flow: where a flow counts as jammed, and as let go. */
const HALF = 0.5;
/** How far the flow has to go to both sides of it. */
const ROOM = 0.1;

/** Values of the driven parameter at which the flow came to be jammed, and let go, last. */
export interface Thresholds {
  jams: number | null;
  letsGo: number | null;
}

/** What the loop is drawn against. */
export interface Across {
  name: string;
  unit: string;
  of: (row: FilmRow) => number;
  /** The words for up and down. */
  ways: [string, string];
  ghosts: Ghost[];
}

/** The width or the force; friction, where the tube is one whose flow by friction is published. */
export function acrossOf(tube: Welcome, frame: Frame): Across {
  const friction = ghostsOfFriction(tube, frame.driven);
  if (friction.length > 0)
    return { name: "friction μ", unit: "", of: (row) => row.friction ?? NaN, ways: ["more friction", "less"], ghosts: friction };
  const ghosts = ghostsOf(tube, frame.driven);
  const of = (row: FilmRow) => row.amplitude ?? NaN;
  if (tube.control === "strain") return { name: "width w / d", unit: " d", of, ways: ["widened", "narrowed"], ghosts };
  return { name: "force amplitude f / (m d/t²)", unit: "", of, ways: ["more force", "less"], ghosts };
}

/** Where the flow crossed half of the largest while the parameter was driven. */
export function thresholds(rows: FilmRow[], { of }: Across): Thresholds {
  const found: Thresholds = { jams: null, letsGo: null };
  let [side, crossed, low, high] = [0, NaN, Infinity, -Infinity];
  for (const row of rows) {
    const value = of(row);
    if (value < low) low = value;
    if (value > high) high = value;
    const now = row.average > HALF + ROOM ? 1 : row.average < HALF - ROOM ? -1 : 0;
    if (now === side) crossed = NaN;
    else if (Number.isNaN(crossed) && (row.average - HALF) * side < 0) crossed = value;
    if (now === 0 || now === side) continue;
    // What a tube does by itself says nothing of its width.
    const isDriven = Math.max(value - low, high - value) > 0.004 * Math.abs(value);
    if (side !== 0 && isDriven) found[now > 0 ? "jams" : "letsGo"] = Number.isNaN(crossed) ? value : crossed;
    [side, crossed, low, high] = [now, NaN, Infinity, -Infinity];
  }
  return found;
}

/** In words. */
export function wordsOf({ jams, letsGo }: Thresholds, { name, unit }: Across): string {
  const symbol = name.split(" ").find((word) => /^[wfμ]$/.test(word)) ?? name;
  const at = (value: number) => `${symbol} = ${written(value)}${unit}`;
  if (jams !== null && letsGo !== null) return `It jams at ${at(jams)} and lets go at ${at(letsGo)}.`;
  if (jams !== null) return `It jams at ${at(jams)}. Now go back: where does it let go?`;
  return letsGo !== null ? `It lets go at ${at(letsGo)}. Now go back: where does it jam?` : "";
}

/** J/Jmax against the driven parameter, beside the published branches and a Newtonian fluid. */
export function drawLoop(chart: Chart, film: Film, tube: Welcome, frame: Frame, colours: Ink): void {
  const across = acrossOf(tube, frame);
  const rows = film.rows.filter((row) => Number.isFinite(across.of(row)));
  const { ghosts } = across;
  const byFriction = across.name.startsWith("friction");
  const range = (byFriction ? tube.ranges.friction : (tube.ranges.width ?? tube.ranges.force_amplitude)) ?? [0, 1];
  const newtonian = byFriction ? [] : tube.newtonian;
  let [least, most] = [-0.1, 1.05];
  for (const { average } of rows) if (Number.isFinite(average)) [least, most] = [Math.min(least, average), Math.max(most, average)];
  let [from, to] = [Infinity, -Infinity];
  const see = (value: number) => ([from, to] = [Math.min(from, value), Math.max(to, value)]);
  rows.forEach((row) => see(across.of(row)));
  ghosts.forEach(({ points }) => points.forEach(([x]) => see(x)));
  const room = ghosts.length > 0 ? 0.04 * (to - from) : Math.max(0.12 * (range[1] - range[0]), 0.15 * (to - from));
  [from, to] = from <= to ? [Math.max(0, from - room), to + room] : range;
  const legend: Entry[] = [
    { text: across.ways[0], colour: colours.along },
    { text: across.ways[1], colour: colours.against, dash: [5, 3] },
  ];
  for (const { start } of ghosts) legend.push({ text: `published, from ${start}`, colour: colours.wall, mark: start === "rest" ? "full" : "open" });
  if (newtonian.length > 0) legend.push({ text: "Newtonian fluid", colour: colours.faint, dash: [1, 3] });
  chart.begin([from, to], [least, most], [across.name, "J / Jmax"], colours, { legend });
  chart.curve([[from, 0], [to, 0]], colours.faint, 1);
  chart.curve(newtonian, colours.faint, 1.5, [1, 3]);
  for (const { start, points } of ghosts) {
    chart.curve(points.map(([x, y]): [number, number] => [x, y]), colours.wall, 1.2);
    for (const [x, y] of points) chart.dot(x, y, 2.6, start === "rest" ? colours.wall : colours.back, colours.wall);
  }
  drawCourse(chart, rows, across, colours);
  const found = thresholds(rows, across);
  for (const [key, colour] of [["jams", colours.against], ["letsGo", colours.along]] as const) {
    const value = found[key];
    if (value === null) continue;
    chart.upright(value, colour);
    chart.label(value, key === "jams" ? "jams" : "lets go", key === "jams" ? "right" : "left", colour);
  }
  const at = rows.findLastIndex((row) => row.clock <= frame.clock + 1e-9);
  if (at >= 0) chart.dot(across.of(rows[at]), rows[at].average, 5, colours.accent, colours.back);
}

/** Time between two rows above which some are missing. */
export const farApart = (rows: FilmRow[]): number => 1 + 0.003 * (rows.at(-1)?.clock ?? 0);

/** Which way the parameter went last decides how a piece is drawn: full upwards, dashed downwards. */
function drawCourse(chart: Chart, rows: FilmRow[], { of }: Across, colours: Ink): void {
  const each = Math.ceil(rows.length / 3000);
  let [before, direction] = [0, 0];
  let piece: [number, number][] = [];
  const finish = () => {
    const colour = direction > 0 ? colours.along : direction < 0 ? colours.against : colours.faint;
    chart.curve(piece, colour, 2.2, direction < 0 ? [5, 3] : []);
  };
  const far = farApart(rows);
  for (let k = 0; k < rows.length; k += each) {
    // Rows that a slow page has missed: nothing is known of the way between.
    if (each === 1 && k > 0 && rows[k].clock - rows[k - 1].clock > far) {
      finish();
      piece = [];
    }
    const step = of(rows[k]) - of(rows[before]);
    const now = Math.abs(step) < 1e-9 ? direction : Math.sign(step);
    if (now !== direction) {
      finish();
      piece = piece.slice(-1);
      direction = now;
    }
    piece.push([of(rows[k]), rows[k].average]);
    before = k;
  }
  finish();
}

/** Gives the loop as a file. */
export function giveLoop(kind: "png" | "svg" | "csv", { canvas }: Chart, film: Film, tube: Welcome, frame: Frame): void {
  if (kind === "png") return canvas.toBlob((file) => file && download("loop.png", file));
  if (kind === "csv") return download("loop.csv", new Blob([asTable(film.rows, tube)], { type: "text/csv" }));
  const svg = new SvgContext(canvas.clientWidth, canvas.clientHeight, ink().back);
  drawLoop(new Chart(canvas, svg as unknown as CanvasRenderingContext2D), film, tube, frame, ink());
  download("loop.svg", new Blob([String(svg)], { type: "image/svg+xml" }));
}

/** The course as a table. */
function asTable(rows: FilmRow[], tube: Welcome): string {
  const amplitude = tube.control === "strain" ? "width" : "force_amplitude";
  const lines = rows.map((row) => [row.clock, row.amplitude, row.strain_rate, row.flow_rate_ratio, Number.isFinite(row.average) ? row.average : null].join(","));
  return [`period,${amplitude},strain_rate,flow_rate_ratio,flow_rate_ratio_mean_of_a_period`, ...lines, ""].join("\n");
}

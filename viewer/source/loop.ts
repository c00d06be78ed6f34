import { Chart, type Entry, type Ink, ink, written } from "./charts";
import type { Film, FilmRow } from "./film";
import { type Ghost, ghostsOf, ghostsOfFriction } from "./ghosts";
import type { Frame, Welcome } from "./protocol";
import { download } from "./share";
import { SvgContext } from "./svg";
import { type Driving, type Span, type Thresholds, thresholds } from "./thresholds";

/** Small steps that a threshold which is marked in the loop may lie between. */
const MARKED = 5;

/** The size of the loop as a file, and how many pixels of a picture are one of it. */
const SIZE = { width: 900, height: 560 };
const FINE = 2;

/** What the loop is drawn against. */
export interface Across extends Driving {
  name: string;
  unit: string;
  /** The words for up and down. */
  ways: [string, string];
  ghosts: Ghost[];
}

/** The width or the force; friction, where the tube is one whose flow by friction is published. */
export function acrossOf(tube: Welcome, frame: Frame): Across {
  const { width, force_amplitude, friction } = tube.ranges;
  const byFriction = ghostsOfFriction(tube, frame.driven);
  if (byFriction.length > 0)
    return {
      name: "kinetic friction μₖ", unit: "", of: (row) => row.friction ?? NaN, small: 0.02, opens: 1, range: friction ?? [0, 1],
      ways: ["more friction", "less"], ghosts: byFriction,
    };
  const ghosts = ghostsOf(tube, frame.driven);
  const of = (row: FilmRow) => row.amplitude ?? NaN;
  if (tube.control === "strain")
    return { name: "width w / d", unit: " d", of, small: 0.012, opens: 1, range: width ?? [0, 1], ways: ["widened", "narrowed"], ghosts };
  return {
    name: "force amplitude fᴾ / (m d/t²)", unit: " m d/t²", of, small: 1e-4, opens: -1, range: force_amplitude ?? [0, 1],
    ways: ["more force", "less"], ghosts,
  };
}

/** In words. */
export function wordsOf({ jams, letsGo, not }: Thresholds, { name, unit, opens }: Across): string {
  const symbol = name.split(" ").find((word) => /^(w|fᴾ|μₖ)$/.test(word)) ?? name;
  const at = (value: number) => `${symbol} = ${written(value)}${unit}`;
  const over = ([from, to]: Span) => (from === to ? `at ${at(from)}` : `between ${at(from)} and ${written(to)}${unit}`);
  const said: string[] = [];
  if (jams) said.push(`jams ${over(jams)}`);
  if (letsGo) said.push(`lets go ${over(letsGo)}`);
  if (not && !(jams && letsGo)) {
    const [verb, way] = not.deed === "jams" ? ["jammed", -opens] : ["let go", opens];
    said.push(`has not ${verb} ${way > 0 ? "up" : "down"} to ${at(not.to)}`);
  }
  if (said.length === 0) return "";
  const next = said.length > 1 || not ? "" : ` Now go back: where does it ${jams ? "let go" : "jam"}?`;
  return `It ${said.join(" and ")}.${next}`;
}

/** J/Jmax against the driven parameter, beside the published branches and a Newtonian fluid; answers where it jams and lets go. */
export function drawLoop(chart: Chart, film: Film, tube: Welcome, frame: Frame, colours: Ink): Thresholds {
  const across = acrossOf(tube, frame);
  const rows = film.rows.filter((row) => Number.isFinite(across.of(row)));
  const { ghosts, range } = across;
  const newtonian = across.name.includes("friction") ? [] : tube.newtonian;
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
  if (newtonian.length > 0) legend.push({ text: "Newtonian fluid without load", colour: colours.faint, dash: [1, 3] });
  chart.begin([from, to], [least, most], [across.name, "J / Jmax"], colours, { legend });
  chart.curve([[from, 0], [to, 0]], colours.faint, 1);
  chart.curve(newtonian, colours.faint, 1.5, [1, 3]);
  for (const { start, points } of ghosts) {
    chart.curve(points.map(([x, y]): [number, number] => [x, y]), colours.wall, 1.2);
    for (const [x, y] of points) chart.dot(x, y, 2.6, start === "rest" ? colours.wall : colours.back, colours.wall);
  }
  drawCourse(chart, rows, across, colours);
  const found = thresholds(rows.filter(({ number }) => number >= film.since), across);
  for (const [key, colour] of [["jams", colours.against], ["letsGo", colours.along]] as const) {
    const [from, to] = found[key] ?? [-Infinity, Infinity];
    // Between the ends of a jump there is no place to mark.
    if (to - from > MARKED * across.small) continue;
    const middle = 0.5 * (from + to);
    chart.upright(middle, colour);
    chart.label(middle, key === "jams" ? "jams" : "lets go", key === "jams" ? "right" : "left", colour, colours.back);
  }
  const at = rows.findLastIndex((row) => row.clock <= frame.clock + 1e-9);
  if (at >= 0) chart.dot(across.of(rows[at]), rows[at].average, 5, colours.accent, colours.back);
  return found;
}

/** Time between two rows above which some are missing, of rows that end at a time. */
export const farApart = (end: number): number => 1 + 0.003 * end;

/** Which way the parameter went last decides how a piece is drawn: full upwards, dashed downwards. */
function drawCourse(chart: Chart, rows: FilmRow[], { of }: Across, colours: Ink): void {
  const each = Math.ceil(rows.length / 3000);
  let [before, direction] = [0, 0];
  let piece: [number, number][] = [];
  const finish = () => {
    const colour = direction > 0 ? colours.along : direction < 0 ? colours.against : colours.faint;
    chart.curve(piece, colour, 2.2, direction < 0 ? [5, 3] : []);
  };
  const far = farApart(rows.at(-1)?.clock ?? 0);
  for (let k = 0; k < rows.length; k++) {
    // Rows that a slow page has missed: nothing is known of the way between.
    if (k > 0 && rows[k].clock - rows[k - 1].clock > far) {
      finish();
      piece = [];
    } else if (k % each > 0) continue;
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
  if (kind === "csv") return download("loop.csv", new Blob([asTable(film.rows, tube)], { type: "text/csv" }));
  const draw = (context: CanvasRenderingContext2D) => drawLoop(new Chart(canvas, { context, ...SIZE }), film, tube, frame, ink());
  if (kind === "png") return drawPicture(draw);
  const svg = new SvgContext(SIZE.width, SIZE.height, ink().back);
  draw(svg as unknown as CanvasRenderingContext2D);
  download("loop.svg", new Blob([String(svg)], { type: "image/svg+xml" }));
}

function drawPicture(draw: (context: CanvasRenderingContext2D) => void): void {
  const picture = document.createElement("canvas");
  [picture.width, picture.height] = [FINE * SIZE.width, FINE * SIZE.height];
  const context = picture.getContext("2d");
  if (!context) return;
  context.scale(FINE, FINE);
  context.fillStyle = ink().back;
  context.fillRect(0, 0, SIZE.width, SIZE.height);
  draw(context);
  picture.toBlob((file) => file && download("loop.png", file));
}

/** The course as a table. */
function asTable(rows: FilmRow[], tube: Welcome): string {
  const amplitude = tube.control === "strain" ? "width" : "force_amplitude";
  const driven: [string, keyof FilmRow][] = [[amplitude, "amplitude"], ["strain_rate", "strain_rate"]];
  if (rows.some(({ friction }) => friction !== null)) driven.push(["friction", "friction"]);
  const lines = rows.map((row) =>
    [row.clock, ...driven.map(([, key]) => row[key]), row.flow_rate_ratio, Number.isFinite(row.average) ? row.average : null].join(","));
  return [["period", ...driven.map(([name]) => name), "flow_rate_ratio", "flow_rate_ratio_mean_of_a_period"].join(","), ...lines, ""].join("\n");
}

import { ink, textOf, written } from "./charts";
import { type Curve, mark, type Style } from "./curves";
import { colourAt, css } from "./fields";
import type { Scale } from "./heat";
import { SEQUENTIAL } from "./messages";

function head(box: HTMLElement, text: string): void {
  const title = document.createElement("h2");
  title.textContent = text;
  box.replaceChildren(title);
}

/** The colours of a map. */
export function showScale(box: HTMLElement, value: string, { from, to, logarithmic }: Scale, limits: boolean): void {
  head(box, value);
  const bar = document.createElement("div");
  bar.className = "bar";
  bar.style.background = `linear-gradient(90deg, ${Array.from({ length: 12 }, (_, k) => css(colourAt(SEQUENTIAL, k / 11))).join(",")})`;
  const ends = document.createElement("div");
  ends.className = "ends";
  const middle = logarithmic ? Math.sqrt(from * to) : 0.5 * (from + to);
  ends.append(...[from, middle, to].map((end) => Object.assign(document.createElement("span"), { textContent: written(end) })));
  box.append(bar, ends);
  if (limits) note(box, "hatched: at least this, for runs ended before their transition");
}

function note(box: HTMLElement, text: string): void {
  box.append(Object.assign(document.createElement("div"), { className: "item note", textContent: text }));
}

/** The marks of a family, and the lines of both starts where there are both. */
export function showMarks(box: HTMLElement, family: string, curves: Curve[], limits: boolean): void {
  head(box, family);
  const starts = [...new Set(curves.map(({ start }) => start))];
  const both = starts.length > 1;
  const item = (text: string, style: Style) => {
    const line = document.createElement("div");
    line.className = "item";
    const canvas = document.createElement("canvas");
    line.append(canvas, text);
    box.append(line);
    sample(canvas, style);
  };
  const members = new Set(curves.map(({ member }) => member).filter((member) => member !== null));
  for (const member of members) {
    const style = curves.find((curve) => curve.member === member)?.style;
    if (style) item(textOf(member), { ...style, open: !both && style.open });
  }
  if (both) for (const start of starts) item(`from ${start}`, { colour: ink().text, mark: 0, open: start === "jammed" });
  if (limits) note(box, "↑ at least: runs ended before their transition");
}

/** A mark on a piece of its line. */
function sample(canvas: HTMLCanvasElement, style: Style): void {
  const density = Math.min(3, devicePixelRatio);
  [canvas.width, canvas.height] = [40 * density, 16 * density];
  const context = canvas.getContext("2d");
  if (!context) return;
  context.scale(density, density);
  context.strokeStyle = style.colour;
  context.lineWidth = 1.6;
  context.setLineDash(style.open ? [5, 4] : []);
  context.beginPath();
  context.moveTo(1, 8);
  context.lineTo(39, 8);
  context.stroke();
  mark(context, 20, 8, 4, style, ink().back);
}

import type { Chart, Ink } from "./charts";
import { colourAt, css } from "./fields";
import { SEQUENTIAL } from "./messages";
import type { Point, Value } from "./results";

/** A curve: the points of one start and one member of the family. */
export interface Curve {
  start: string;
  member: Value | null;
  points: Point[];
  style: Style;
}

/** How it is drawn: each member of a family has its colour and its mark, and each start its line. */
export interface Style {
  colour: string;
  mark: number;
  open: boolean;
}

/** Marks that are told apart without colour. */
const MARKS: ((context: CanvasRenderingContext2D, x: number, y: number, r: number) => void)[] = [
  (context, x, y, r) => context.arc(x, y, r, 0, 2 * Math.PI),
  (context, x, y, r) => context.rect(x - 0.88 * r, y - 0.88 * r, 1.76 * r, 1.76 * r),
  (context, x, y, r) => polygon(context, x, y, 1.25 * r, 3, -Math.PI / 2),
  (context, x, y, r) => polygon(context, x, y, 1.2 * r, 4, 0),
  (context, x, y, r) => polygon(context, x, y, 1.25 * r, 3, Math.PI / 2),
  (context, x, y, r) => polygon(context, x, y, 1.1 * r, 6, 0),
];

function polygon(context: CanvasRenderingContext2D, x: number, y: number, r: number, corners: number, from: number): void {
  for (let k = 0; k < corners; k++) {
    const angle = from + (2 * Math.PI * k) / corners;
    context[k === 0 ? "moveTo" : "lineTo"](x + r * Math.cos(angle), y + r * Math.sin(angle));
  }
  context.closePath();
}

/** The points as curves, in the order of the family. */
export function curvesOf(points: Point[], members: (Value | null)[], starts: string[], dark: boolean): Curve[] {
  const curves: Curve[] = [];
  members.forEach((member, place) => {
    // Not to the ends of the scale, which are hard to see on one of the pages.
    const part = members.length > 1 ? place / (members.length - 1) : 0.25;
    const colour = css(colourAt(SEQUENTIAL, dark ? 0.42 + 0.58 * part : 0.78 * part));
    for (const start of starts) {
      const own = points.filter((point) => point.other === member && point.start === start);
      if (own.length === 0) continue;
      const style = { colour, mark: place % MARKS.length, open: start === "jammed" };
      curves.push({ start, member, points: own, style });
    }
  });
  return curves;
}

/** Draws a mark alone, as legends do. */
export function mark(context: CanvasRenderingContext2D, x: number, y: number, r: number, style: Style, back: string): void {
  context.save();
  context.setLineDash([]);
  context.beginPath();
  MARKS[style.mark](context, x, y, r);
  context.fillStyle = style.open ? back : style.colour;
  context.strokeStyle = style.colour;
  context.lineWidth = 1.8;
  context.fill();
  context.stroke();
  context.restore();
}

/** Ends of the value axis. */
export function extent(points: Point[], logarithmic: boolean): [number, number] {
  const spread = (point: Point) => (Number.isFinite(point.error) && !point.atLeast ? point.error : 0);
  let [least, most] = [Infinity, -Infinity];
  for (const point of points) {
    if (logarithmic && point.value <= 0) continue;
    const below = point.value - spread(point);
    least = Math.min(least, logarithmic && below <= 0 ? point.value : below);
    most = Math.max(most, point.value + spread(point));
  }
  if (!Number.isFinite(least)) return logarithmic ? [0.1, 1] : [0, 1];
  if (logarithmic) return [least / 1.25, most * 1.25];
  const room = 0.06 * (most - least) || 0.1 * Math.abs(most) || 1;
  // A quantity that cannot be negative begins at nothing, where it comes near to it.
  const from = least >= 0 && least < 0.35 * most ? Math.min(0, least) : least - room;
  return [from, most + room];
}

/** Draws curves with errors and lower limits; answers where each point came to lie. */
export function drawCurves(chart: Chart, curves: Curve[], chosen: Point | null, colours: Ink): Map<Point, [number, number]> {
  const places = new Map<Point, [number, number]>();
  const { context } = chart;
  for (const { points, style } of curves) {
    // A lower limit is no place that the curve goes through, and another tube is another curve.
    const path = points.flatMap(({ x, value, atLeast, tube }, k): [number, number][] => {
      const place: [number, number] = [x, atLeast ? NaN : value];
      return k > 0 && points[k - 1].tube !== tube ? [[x, NaN], place] : [place];
    });
    chart.curve(path, style.colour, 1.6, style.open ? [5, 4] : []);
  }
  for (const { points, style } of curves) {
    for (const point of points) {
      const [x, y] = [chart.x.at(point.x), chart.y.at(point.value)];
      if (!Number.isFinite(x + y)) continue;
      places.set(point, [x, y]);
      context.strokeStyle = style.colour;
      context.lineWidth = 1.4;
      if (point.atLeast) {
        // An arrow: it is at least so much.
        chart.line(x, y, x, y - 17);
        chart.line(x - 3.5, y - 12, x, y - 17);
        chart.line(x + 3.5, y - 12, x, y - 17);
      } else if (point.error > 0) {
        const [low, high] = [chart.y.at(point.value - point.error), chart.y.at(point.value + point.error)];
        const foot = Number.isFinite(low) ? low : chart.box.top + chart.box.height;
        chart.line(x, foot, x, high);
        chart.line(x - 3, high, x + 3, high);
        chart.line(x - 3, foot, x + 3, foot);
      }
      mark(context, x, y, 4, style, colours.back);
    }
  }
  const at = chosen && places.get(chosen);
  if (at) {
    context.beginPath();
    context.arc(at[0], at[1], 9.5, 0, 2 * Math.PI);
    context.strokeStyle = colours.text;
    context.lineWidth = 2;
    context.stroke();
  }
  return places;
}

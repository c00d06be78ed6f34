import { type Chart, type Ink, textOf, written } from "./charts";
import { colourAt, css } from "./fields";
import { type Colour, SEQUENTIAL } from "./messages";
import type { Point, Value } from "./results";

/** A cell of the map. */
export interface Cell {
  point: Point;
  left: number;
  top: number;
  width: number;
  height: number;
}

/** From what to what the colours go. */
export interface Scale {
  from: number;
  to: number;
  logarithmic: boolean;
}

/** Place of a value in a scale, from 0 to 1. */
export function placeIn({ from, to, logarithmic }: Scale, value: number): number {
  if (logarithmic) return Math.log(value / from) / Math.log(to / from || 1);
  return (value - from) / (to - from || 1);
}

/** Ends of cells about places: half way to the next. */
function edges(places: number[]): number[] {
  if (places.length === 1) return [places[0] - 0.5, places[0] + 0.5];
  const middle = (k: number) => 0.5 * (places[k] + places[k + 1]);
  const last = places.length - 1;
  const inner = Array.from({ length: last }, (_, k) => middle(k));
  return [2 * places[0] - inner[0], ...inner, 2 * places[last] - inner[last - 1]];
}

/** All places of the points along the horizontal axis. */
const placesOf = (points: Point[]) => [...new Set(points.map(({ x }) => x))].sort((one, other) => one - other);

/** Ends of the horizontal axis about all points. */
export function across(points: Point[]): [number, number] {
  const ends = edges(placesOf(points));
  return [ends[0], ends[ends.length - 1]];
}

/** Draws a map of the points, a row of cells for each value of the vertical axis, one if there is no such axis; answers the cells. */
export function drawHeat(chart: Chart, points: Point[], rows: (Value | null)[], scale: Scale, chosen: Point | null, colours: Ink): Cell[] {
  const { context, box } = chart;
  const cells: Cell[] = [];
  const height = box.height / rows.length;
  const places = placesOf(points);
  const shared = edges(places);
  rows.forEach((value, place) => {
    const own = points.filter((point) => point.other === value);
    // A lone point is as wide as it would be among those of all rows.
    const lone = places.indexOf(own[0]?.x);
    const ends = own.length === 1 ? shared.slice(lone, lone + 2) : edges(own.map(({ x }) => x));
    const top = box.top + box.height - (place + 1) * height;
    own.forEach((point, k) => {
      const left = Math.max(box.left, chart.x.at(ends[k]));
      const right = Math.min(box.left + box.width, chart.x.at(ends[k + 1]));
      cells.push({ point, left, top, width: right - left, height });
    });
  });
  for (const { point, left, top, width, height: high } of cells) {
    const colour = colourAt(SEQUENTIAL, placeIn(scale, point.value));
    context.fillStyle = css(colour);
    const within: Box = [left + 0.5, top + 0.5, Math.max(1, width - 1), Math.max(1, high - 1)];
    context.fillRect(...within);
    if (point.atLeast) hatch(context, within, light(colour) > 0.19 ? "#10141c66" : "#ffffff66");
    const text = (point.atLeast ? "≥ " : "") + short(point.value);
    context.font = "11px system-ui, sans-serif";
    // All numbers or none: short ones alone would look like the only ones.
    if (Math.max(context.measureText(text).width, 24) > width - 5 || high < 15) continue;
    context.fillStyle = light(colour) > 0.19 ? "#10141c" : "#ffffff";
    context.textAlign = "center";
    context.textBaseline = "middle";
    context.fillText(text, left + 0.5 * width, top + 0.5 * high);
  }
  context.fillStyle = colours.faint;
  context.textAlign = "right";
  context.textBaseline = "middle";
  rows.forEach((value, place) => {
    const text = textOf(value);
    context.fillText(text, box.left - 7, box.top + box.height - (place + 0.5) * height, box.left - 9);
  });
  const cell = cells.find(({ point }) => point === chosen);
  if (cell) {
    context.lineWidth = 4;
    context.strokeStyle = colours.back;
    context.strokeRect(cell.left + 1, cell.top + 1, cell.width - 2, cell.height - 2);
    context.lineWidth = 2;
    context.strokeStyle = colours.text;
    context.strokeRect(cell.left + 1, cell.top + 1, cell.width - 2, cell.height - 2);
  }
  return cells;
}

/** Left, top, width and height. */
type Box = [number, number, number, number];

/** Lines across a cell whose value is a lower limit. */
function hatch(context: Chart["context"], within: Box, colour: string): void {
  const [left, top, width, height] = within;
  context.save();
  context.beginPath();
  context.rect(...within);
  context.clip();
  context.beginPath();
  for (let from = left - height; from < left + width; from += 7) {
    context.moveTo(from, top + height);
    context.lineTo(from + height, top);
  }
  context.lineWidth = 1;
  context.strokeStyle = colour;
  context.stroke();
  context.restore();
}

const short = (value: number) => {
  const size = Math.abs(value);
  if (size >= 1000) return `${written(value / 1000, 2)}k`;
  return size >= 0.01 || size === 0 ? written(value, 2) : written(value, 1);
};

/** Luminance from 0 to 1. */
const light = ([red, green, blue]: Colour) => (0.2126 * red ** 2.2 + 0.7152 * green ** 2.2 + 0.0722 * blue ** 2.2) / 255 ** 2.2;

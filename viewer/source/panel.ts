import type { Chart } from "./charts";
import type { Cell } from "./heat";
import type { Point } from "./results";

/** A canvas with what can be pointed at in it. */
export interface Panel {
  chart: Chart;
  start: string | null;
  places: Map<Point, [number, number]>;
  cells: Cell[];
  lines: Point[][];
}

/** Where a point stands in the canvas of a panel. */
export function placeOf({ cells, places }: Panel, point: Point): [number, number] | undefined {
  const cell = cells.find((it) => it.point === point);
  return cell ? [cell.left + 0.5 * cell.width, cell.top + 0.3 * cell.height] : places.get(point);
}

/** Puts a tip beside a place in a panel: to its right, or to its left where there is no room, and never over it. */
export function put(tip: HTMLElement, charts: HTMLElement, panel: Panel, place: [number, number]): void {
  const box = charts.getBoundingClientRect();
  const canvas = panel.chart.canvas.getBoundingClientRect();
  const [x, y] = [canvas.left - box.left + place[0], canvas.top - box.top + place[1]];
  const [right, left] = [x + 18, x - tip.offsetWidth - 18];
  const beside = right + tip.offsetWidth < box.width || left > 0;
  const middle = Math.min(box.width - tip.offsetWidth - 4, Math.max(4, x - 0.5 * tip.offsetWidth));
  tip.style.left = `${beside ? (right + tip.offsetWidth < box.width ? right : left) : middle}px`;
  // On a narrow page it is above or below.
  const top = beside ? y - 0.5 * tip.offsetHeight : y - tip.offsetHeight - 18 > 0 ? y - tip.offsetHeight - 18 : y + 18;
  tip.style.top = `${Math.max(0, charts.offsetTop + top)}px`;
}

/** The point of a panel under the pointer, or the nearest within reach of it. */
export function pointAt(panel: Panel, event: MouseEvent, reach: number): Point | null {
  const box = panel.chart.canvas.getBoundingClientRect();
  const [x, y] = [event.clientX - box.left, event.clientY - box.top];
  const cell = panel.cells.find(({ left, top, width, height }) => x >= left && x < left + width && y >= top && y < top + height);
  if (cell) return cell.point;
  let [nearest, found]: [number, Point | null] = [reach, null];
  for (const [point, place] of panel.places) {
    const away = Math.hypot(place[0] - x, place[1] - y);
    if (away < nearest) [nearest, found] = [away, point];
  }
  return found;
}

/** The next point along its curve or row, or the nearest of the next one. */
export function beside(panel: Panel, chosen: Point | null, [along, up]: [number, number]): Point | null {
  const lines = panel.lines.filter((line) => line.length > 0);
  const line = lines.findIndex((it) => chosen !== null && it.includes(chosen));
  if (line < 0 || !chosen) return lines.at(0)?.at(0) ?? null;
  if (up !== 0) {
    const next = lines[Math.min(lines.length - 1, Math.max(0, line + up))];
    return next.toSorted((one, other) => Math.abs(one.x - chosen.x) - Math.abs(other.x - chosen.x))[0];
  }
  const place = lines[line].indexOf(chosen) + along;
  return lines[line][Math.min(lines[line].length - 1, Math.max(0, place))];
}

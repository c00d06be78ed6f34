import type { FilmRow } from "./film";

/** Half of the largest flow: where a flow counts as jammed, and as let go. */
const HALF = 0.5;
/** How far the flow has to go to both sides of it. */
const ROOM = 0.1;

/** Periods that a jump takes. */
const JUMP = 0.5;

/** What a flow does as a parameter is driven. */
export type Deed = "jams" | "letsGo";

/** Values between which it did so: one value where the parameter walked across, the ends of the jump where it jumped. */
export type Span = [number, number];

export interface Thresholds {
  jams: Span | null;
  letsGo: Span | null;
  /** What it has not done yet, and the value up or down to which the parameter has walked without. */
  not: { deed: Deed; to: number } | null;
}

/** How the driven parameter is read. */
export interface Driving {
  of: (row: FilmRow) => number;
  /** Steps from row to row below which it walks, and the way that it has to walk at least. */
  small: number;
  /** Which way a jam lets go: 1 upwards, -1 downwards. */
  opens: 1 | -1;
  /** Its least and largest value, at which no threshold can be told. */
  range: [number, number];
}

/** Where the flow crossed half of the largest as the parameter was driven. */
export function thresholds(rows: FilmRow[], { of, small, opens, range }: Driving): Thresholds {
  const found: Thresholds = { jams: null, letsGo: null, not: null };
  // The side of the flow, and since which row; the crossing to the other, until the flow has gone far enough.
  let [side, since, crossing]: [number, number, Span | null] = [0, 0, null];
  // The value before the last jump, and when that began; over which values it has walked since then or the last crossing.
  let [held, jumped, low, high] = [NaN, -Infinity, NaN, NaN];
  const beginAt = (value: number) => ([low, high] = [value, value]);
  const spanAt = (value: number): Span => (Math.max(value - low, high - value) > small ? [value, value] : [held, value]);
  rows.forEach((row, k) => {
    const value = of(row);
    const last = k > 0 ? of(rows[k - 1]) : value;
    if (k === 0) beginAt(value);
    if (Math.abs(value - last) > small) {
      if (row.clock - jumped > JUMP) [held, jumped] = [last, row.clock];
      beginAt(value);
    }
    [low, high] = [Math.min(low, value), Math.max(high, value)];
    const now = row.average > HALF + ROOM ? 1 : row.average < HALF - ROOM ? -1 : 0;
    if (now === side) crossing = null;
    else if ((row.average - HALF) * side < 0) crossing ??= spanAt(value);
    if (now === 0 || now === side) return;
    const [from, at] = crossing ?? spanAt(value);
    if (side !== 0) {
      const deed: Deed = now > 0 ? "jams" : "letsGo";
      const isEnd = Math.min(at - range[0], range[1] - at) < small;
      found.not = null;
      // What a tube does by itself says nothing of the parameter.
      if (from === at) [found[deed], found.not] = isEnd ? [null, { deed, to: at }] : [[at, at], null];
      else if (Math.abs(at - from) > small) found[deed] = [Math.min(at, from), Math.max(at, from)];
    }
    [side, since, crossing, held] = [now, k, null, NaN];
    beginAt(at);
  });
  // A mean tells of the period before it.
  const gone = rows.slice(since).filter(({ clock }) => clock < rows[rows.length - 1].clock - 1).map(of);
  const way = side * opens;
  const to = way > 0 ? Math.max(...gone) : Math.min(...gone);
  if (gone.length > 0 && way * (to - gone[0]) > small) {
    const deed: Deed = side > 0 ? "letsGo" : "jams";
    found.not = { deed, to };
    // It has not done so now where it did so before.
    if (found[deed]?.every((it) => way * (to - it) > 0)) found[deed] = null;
  }
  return found;
}

import { type Chart, type Entry, type Ink, written } from "./charts";
import { colourAt, type Field, inWave, speedOf, stops } from "./fields";
import type { Film } from "./film";
import { insideOf } from "./inside";
import { farApart } from "./loop";
import { type Frame, type Row, timeAxis, unitOfTime, type Welcome } from "./protocol";

/** Frames and periods that a profile is averaged over at most, and looks at grains after which fewer frames do. */
const AVERAGED = 16;
const PERIODS = 1;
const LOOKS = 12000;
/** Bins of a profile: as many, where there are enough grains for that. */
const BINS = { least: 4, most: 24 };
/** Looks at grains that a mean velocity is taken of, at least. */
const FEWEST = 8;

/** J/Jmax against time, with the time that is shown. */
export function drawFlow(chart: Chart, film: Film, tube: Welcome, clock: number, colours: Ink): void {
  const { rows } = film;
  const { record, newtonian } = tube;
  const recorded = tube.recorded?.clocks;
  // Of a record from before, what lies not too far ahead.
  const ahead = Math.min(record.at(-1)?.[0] ?? 0, Math.max(20, 4 * (rows.at(-1)?.clock ?? 0)));
  const end = Math.max(rows.at(-1)?.clock ?? 0, ahead, recorded?.at(-1) ?? 0);
  const last = recorded ? end : Math.max(end, 2);
  let [least, most] = [-0.1, 1.05];
  const shown = [...rows.map(({ average }) => average), ...record.filter(([time]) => time <= last).map(([, ratio]) => ratio ?? NaN)];
  for (const ratio of shown) if (Number.isFinite(ratio)) [least, most] = [Math.min(least, ratio), Math.max(most, ratio)];
  const legend: Entry[] = [
    { text: "each sample", colour: colours.line },
    { text: "mean over the period before", colour: colours.accent },
  ];
  if (newtonian.length > 0) legend.push({ text: "Newtonian fluid without load", colour: colours.faint, dash: [1, 3] });
  if (record.length > 0) legend.push({ text: "computed before", colour: colours.wall, dash: [4, 3] });
  chart.begin([0, last], [least, most], [timeAxis(tube), "J / Jmax"], colours, { legend });
  chart.curve([[0, 0], [last, 0]], colours.faint, 1);
  // Where there are frames, unless everywhere.
  if (recorded && recorded[recorded.length - 1] - recorded[0] < 0.98 * last) chart.curve([[recorded[0], least], [recorded[recorded.length - 1], least]], colours.accent, 5);
  chart.curve(record.map(([x, y]) => [x, y ?? NaN]), colours.wall, 1.5, [4, 3]);
  chart.curve(sparse(rows.map((row) => [row.clock, row.flow_rate_ratio ?? NaN])), colours.line, 1);
  const fluid = newtonian.length > 0 ? rows.map((row): [number, number] => [row.clock, between(newtonian, row.amplitude ?? NaN)]) : [];
  chart.curve(sparse(fluid), colours.faint, 1.5, [1, 3]);
  chart.curve(sparse(rows.map((row) => [row.clock, row.average])), colours.accent, 2);
  chart.upright(clock, colours.text);
  const at = film.rowAt(clock);
  if (at >= 0) chart.dot(rows[at].clock, rows[at].average, 4, colours.accent, colours.back);
}

/** A curve's value at a place. */
function between(points: [number, number][], x: number): number {
  const after = points.findIndex(([place]) => place >= x);
  if (after <= 0) return points[Math.max(after, 0)]?.[1] ?? NaN;
  const [[x0, y0], [x1, y1]] = [points[after - 1], points[after]];
  return y0 + ((x - x0) / (x1 - x0)) * (y1 - y0);
}

/** At most some thousand points; none between two that are so far apart that rows between them were missed. */
function sparse(points: [number, number][]): [number, number][] {
  const each = Math.ceil(points.length / 3000);
  const far = farApart(points.at(-1)?.[0] ?? 0);
  return points.flatMap((point, k): [number, number][] => {
    const kept: [number, number][] = k % each === 0 ? [point] : [];
    return k > 0 && point[0] - points[k - 1][0] > far ? [[point[0], NaN], point] : kept;
  });
}

/** What is drawn where there is no loop: its name, the label of its axis, and where a row has it. */
export const insteadOfLoop = ({ open }: Welcome): { name: string; label: string; key: keyof Row } =>
  open
    ? { name: "The discharge", label: "discharge rate / (m/t)", key: "discharge_rate" }
    : { name: "The bottleneck", label: "bottleneck w / d", key: "bottleneck" };

/** This against time, with the time that is shown; false where it is not known. */
export function drawInsteadOfLoop(chart: Chart, film: Film, tube: Welcome, clock: number, colours: Ink): boolean {
  const { label, key } = insteadOfLoop(tube);
  const points = film.rows.map((row): [number, number] => [row.clock, row[key] ?? NaN]);
  const known = points.map(([, value]) => value).filter(Number.isFinite);
  if (known.length === 0) return false;
  const [least, most] = [known.reduce((a, b) => Math.min(a, b)), known.reduce((a, b) => Math.max(a, b))];
  const room = Math.max(0.15 * (most - least), 0.02 * Math.abs(most)) || 1;
  const last = Math.max(points[points.length - 1][0], clock) || 1;
  chart.begin([0, last], [least - room, most + room], [timeAxis(tube), label], colours);
  // The rows of a standing wave are as far apart in t as one likes.
  chart.curve(tube.unit_period === null ? points : sparse(points), colours.accent, 2);
  chart.upright(clock, colours.text);
  const at = points.findLastIndex(([time]) => time <= clock + 1e-9);
  if (at >= 0) chart.dot(...points[at], 4, colours.accent, colours.back);
  return true;
}

/** The frames that a profile is averaged over: they end with this one, and are of one period where the wave runs. */
function framesOfProfile(film: Film, shown: number, tube: Welcome): Frame[] {
  const grains = film.frame(shown)?.grains ?? tube.grains;
  const frames = film.recent(shown, Math.min(AVERAGED, Math.ceil(LOOKS / grains)));
  const run = frames.at(-1)?.period ?? 0;
  return frames.filter(({ period }) => run - period < PERIODS);
}

/** Volume fraction and axial velocity in the wave frame, under the outline of the tube; answers what they are means of. */
export function drawProfile(chart: Chart, film: Film, shown: number, tube: Welcome, colours: Ink): string {
  const frames = framesOfProfile(film, shown, tube);
  const last = frames.at(-1);
  const standing = last?.wave_speed === 0 ? speedOf(last) : null;
  const looks = frames.reduce((sum, frame) => sum + frame.grains, 0);
  const bins = Math.min(BINS.most, Math.max(BINS.least, Math.floor(looks / (2 * FEWEST))));
  const number = new Float64Array(bins);
  const volume = new Float64Array(bins);
  const velocity = new Float64Array(bins);
  for (const frame of frames) {
    const isInside = insideOf(frame, tube);
    for (let i = 0; i < frame.grains; i++) {
      if (!isInside(i)) continue;
      const bin = Math.min(bins - 1, Math.floor(bins * inWave(frame, tube, frame.position[3 * i + 2])));
      number[bin] += 1;
      volume[bin] += (Math.PI / 6) * frame.diameter[i] ** 3;
      velocity[bin] += (tube.heading * frame.velocity[3 * i + 2]) / (standing ?? (frame.wave_speed || NaN));
    }
  }
  // A mean over a handful of looks at grains is none.
  const means = Array.from(velocity, (sum, bin) => (number[bin] >= FEWEST ? sum / number[bin] : NaN));
  const middle = (bin: number) => (bin + 0.5) / bins;
  const radius = outline(film.frame(shown) ?? frames.at(-1), tube);
  // Of the clear tube, inside the spheres of the wall.
  const clear = (bin: number) => radius[Math.round(middle(bin) * (radius.length - 1))] - 0.5 * tube.wall_sphere_diameter;
  const each = (tube.wavelength / bins) * tube.waves * frames.length * Math.PI;
  // Where the throat is all but closed the part of its volume says nothing.
  const fractions = Array.from(volume, (sum, bin) => (clear(bin) > 0.25 ? sum / (each * clear(bin) ** 2) : NaN));
  const drawn = [...means, ...fractions].filter(Number.isFinite);
  const [least, most] = [Math.min(-0.25, ...drawn), Math.max(1.3, ...drawn)];
  const area = `color-mix(in srgb, ${colours.wall} 20%, transparent)`;
  const legend: Entry[] = [
    { text: `mean axial velocity/${standing === null ? "c" : `(${written(standing)} d/t)`}`, colour: colours.accent },
    { text: "volume fraction φ", colour: colours.text, dash: [2, 3] },
    { text: "tube", colour: area, mark: "area" },
  ];
  const position = tube.unit_period === null ? "position z/λ" : "position (z − ct)/λ";
  chart.begin([0, 1], [least, most], [position, ""], colours, { legend });
  // The tube's outline above and below the middle of the chart.
  const centre = 0.5 * (least + most);
  const scale = (0.46 * (most - least)) / Math.max(...radius, 1);
  const { context } = chart;
  context.save();
  chart.clip();
  context.beginPath();
  radius.forEach((r, k) => context.lineTo(chart.x.at(k / (radius.length - 1)), chart.y.at(centre + scale * r)));
  for (let k = radius.length - 1; k >= 0; k--)
    context.lineTo(chart.x.at(k / (radius.length - 1)), chart.y.at(centre - scale * radius[k]));
  context.closePath();
  context.fillStyle = area;
  context.fill();
  context.restore();
  chart.curve(fractions.map((fraction, bin) => [middle(bin), fraction]), colours.text, 1.5, [2, 3]);
  chart.curve([[0, 0], [1, 0]], colours.faint, 1);
  chart.curve(means.map((mean, bin) => [middle(bin), mean]), colours.accent, 2);
  if (!last || frames.length < 2) return "of the frame shown";
  return `mean of ${frames.length} frames, over ${written(last.clock - frames[0].clock, 2)} ${unitOfTime(tube)}`;
}

/** Radius of the tube at 49 places of the wave. */
export function outline(frame: Frame | undefined, tube: Welcome): number[] {
  const places = 48;
  if (!frame) return [];
  const sums = Array.from({ length: places }, () => [0, 0]);
  const add = (z: number, radius: number) => {
    const bin = Math.min(places - 1, Math.floor(places * inWave(frame, tube, z)));
    sums[bin][0] += radius;
    sums[bin][1] += 1;
  };
  if (frame.wall_spheres > 0) {
    for (let i = 0; i < frame.wall_spheres; i++)
      add(frame.wall[3 * i + 2], Math.hypot(frame.wall[3 * i], frame.wall[3 * i + 1]));
  } else {
    const rings = frame.rings;
    // Between rings straight lines.
    for (let k = 0; k < 8 * rings; k++) {
      const [ring, part] = [Math.floor(k / 8), (k % 8) / 8];
      const radius = frame.ringRadius[ring] * (1 - part) + frame.ringRadius[(ring + 1) % rings] * part;
      add(((k / 8) * tube.wavelength) / rings, radius);
    }
  }
  const means = sums.map(([sum, count]) => sum / count);
  const known = means.findIndex(Number.isFinite);
  for (let k = 0; k < places; k++) {
    const at = (known + k) % places;
    if (!Number.isFinite(means[at])) means[at] = means[(at + places - 1) % places];
  }
  return [...means, means[0]];
}

/** The pixels of the map, which are used again. */
let mapped: ImageData | null = null;

/** The whole tube from end to end, with what is in the picture; `tones` are the grains' places on the scale of the field. */
export function drawMap(
  canvas: HTMLCanvasElement, frame: Frame, tones: Float32Array, values: Field, tube: Welcome, lightness: boolean,
  view: { middle: number; half: number },
): void {
  const context = canvas.getContext("2d");
  // A small version of the page has none.
  if (!context || canvas.clientWidth === 0) return;
  const density = Math.min(2, devicePixelRatio);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const [columns, lines] = [Math.round(width * density), Math.round(height * density)];
  if (canvas.width !== columns || canvas.height !== lines) [canvas.width, canvas.height] = [columns, lines];
  context.setTransform(density, 0, 0, density, 0, 0);
  const scale = stops(values, lightness);
  const place = (z: number) => (tube.heading > 0 ? z : tube.length - z) / tube.length;
  const reach = 1.15 * tube.reach;
  const thick = Math.max(1, (width / tube.length) * 0.8);
  // Ten thousand rectangles take a canvas longer than their pixels take to be set one by one.
  if (mapped?.width !== canvas.width || mapped.height !== canvas.height) mapped = context.createImageData(canvas.width, canvas.height);
  const image = mapped;
  image.data.fill(0);
  const pixels = new Uint32Array(image.data.buffer);
  const inks = Uint32Array.from({ length: 256 }, (_, k) => pixel(colourAt(scale, k / 255)));
  const unknown = pixel(colourAt(scale, NaN));
  const across = Math.max(1, Math.round(density * thick));
  const down = Math.max(2, Math.round(density * 2.5));
  for (let i = 0; i < frame.grains; i++) {
    const tone = tones[i];
    const colour = Number.isNaN(tone) ? unknown : inks[Math.round(255 * Math.min(1, Math.max(0, tone)))];
    const left = Math.round(place(frame.position[3 * i + 2]) * columns - 0.5 * across);
    const top = Math.round(0.5 * lines * (1 - frame.position[3 * i] / reach) - 0.5 * down);
    const [low, high] = [Math.max(0, left), Math.min(columns, left + across)];
    for (let y = Math.max(0, top); y < Math.min(lines, top + down); y++)
      for (let at = y * columns + low; at < y * columns + high; at++) pixels[at] = colour;
  }
  context.putImageData(image, 0, 0);
  const half = Math.min(0.5, view.half / tube.length);
  const centre = place(view.middle);
  // On the dark of the map, whatever the page is.
  context.strokeStyle = "#e9eef6";
  context.lineWidth = 1.5;
  if (half < 0.49) {
    for (const turn of tube.open ? [0] : [-1, 0, 1])
      context.strokeRect((centre - half + turn) * width, 0.75, 2 * half * width, height - 1.5);
  }
}

/** A colour as a canvas keeps it: red first in memory. */
function pixel([red, green, blue]: [number, number, number]): number {
  return ((255 << 24) | (blue << 16) | (green << 8) | red) >>> 0;
}

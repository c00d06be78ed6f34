/** Small charts on canvases, in the colours of the page. */

export interface Box {
  left: number;
  top: number;
  width: number;
  height: number;
}

export interface Ink {
  text: string;
  faint: string;
  line: string;
  accent: string;
  along: string;
  against: string;
  wall: string;
  back: string;
  stageMiddle: string;
  stageEdge: string;
}

let known: Ink | null = null;

/** Reads the colours of the page anew at the next look. */
export function forgetInk(): void {
  known = null;
}

export function ink(): Ink {
  if (known) return known;
  const style = getComputedStyle(document.documentElement);
  const read = (name: string) => style.getPropertyValue(`--${name}`).trim();
  known = {
    text: read("text"),
    faint: read("faint"),
    line: read("hairline"),
    accent: read("accent"),
    along: read("along"),
    against: read("against"),
    wall: read("wall"),
    back: read("panel"),
    stageMiddle: read("stage-middle"),
    stageEdge: read("stage-edge"),
  };
  return known;
}

/** A linear or logarithmic axis. */
export class Axis {
  constructor(
    readonly from: number, readonly to: number, readonly start: number, readonly end: number,
    readonly logarithmic = false,
  ) {}

  at(value: number): number {
    const part = this.logarithmic
      ? Math.log(value / this.from) / Math.log(this.to / this.from)
      : (value - this.from) / (this.to - this.from || 1);
    return this.start + part * (this.end - this.start);
  }

  value(place: number): number {
    const part = (place - this.start) / (this.end - this.start || 1);
    return this.logarithmic ? this.from * (this.to / this.from) ** part : this.from + part * (this.to - this.from);
  }

  ticks(most: number): number[] {
    return this.logarithmic ? this.powers(most) : this.steps(most);
  }

  /** 1, 2 and 5 times powers of ten, or fewer of them. */
  private powers(most: number): number[] {
    const decades = Math.log10(this.to / this.from);
    const leading = 3 * decades <= most ? [1, 2, 5] : [1];
    const ticks: number[] = [];
    for (let power = Math.floor(Math.log10(this.from)); power <= Math.log10(this.to); power++)
      for (const digit of leading) ticks.push(digit * 10 ** power);
    const inside = ticks.filter((tick) => tick >= this.from * (1 - 1e-9) && tick <= this.to * (1 + 1e-9));
    return inside.length > 1 ? inside : this.steps(most);
  }

  private steps(most: number): number[] {
    const span = this.to - this.from;
    const rough = span / Math.max(1, most);
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = power * ([1, 2, 5, 10].find((it) => it * power >= rough) ?? 10);
    const ticks: number[] = [];
    for (let k = Math.ceil(this.from / step - 1e-9); k * step <= this.to + 1e-9 * span; k++) ticks.push(k * step);
    return ticks;
  }
}

const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** 10 to a whole power. */
export const powerOfTen = (power: number): string =>
  `10${power < 0 ? "⁻" : ""}${[...String(Math.abs(power))].map((digit) => RAISED[Number(digit)]).join("")}`;

export const written = (value: number, digits = 3): string => {
  if (!Number.isFinite(value)) return "–";
  if (Math.abs(value) < 1e4 && (value === 0 || Math.abs(value) >= 1e-3)) return String(Number(value.toPrecision(digits))).replace("-", "−");
  const [factor, power] = value.toExponential(digits - 1).split("e");
  const plain = String(Number(factor)).replace("-", "−");
  return `${plain === "1" ? "" : plain === "−1" ? "−" : `${plain}·`}${powerOfTen(Number(power))}`;
};

/** A number or a word of a column as a reader sees it; nothing where there is none. */
export const textOf = (value: number | string | null, digits?: number): string => (typeof value === "number" ? written(value, digits) : (value ?? ""));

/** Ticks with their names, with as many digits as tell each from the next. */
function named(ticks: number[]): [number, string][] {
  const step = Math.min(...ticks.slice(1).map((tick, k) => tick - ticks[k]));
  const digits = Math.floor(Math.log10(Math.max(...ticks.map(Math.abs))) + 1e-9) - Math.floor(Math.log10(step) + 1e-9) + 1;
  return ticks.map((tick) => [tick, written(tick, Math.min(12, Math.max(3, digits || 3)))]);
}

/** How a chart is laid out, where it is not a small one beside the tube. */
export interface Layout {
  left?: number;
  logarithmic?: boolean;
  /** Whether the vertical axis has a scale. */
  scaled?: boolean;
  /** What the curves are, above them. */
  legend?: Entry[];
}

/** A curve of a legend. */
export interface Entry {
  text: string;
  colour: string;
  dash?: number[];
  /** A mark in place of a line: a dot, filled or not, or the colour of an area. */
  mark?: "full" | "open" | "area";
}

/** A canvas with two axes. */
export class Chart {
  readonly context: CanvasRenderingContext2D;
  box: Box = { left: 0, top: 0, width: 0, height: 0 };
  x = new Axis(0, 1, 0, 1);
  y = new Axis(0, 1, 0, 1);

  /** `file` takes the place of the canvas's own context and size, to draw into a file. */
  constructor(readonly canvas: HTMLCanvasElement, private readonly file?: { context: CanvasRenderingContext2D; width: number; height: number }) {
    const context = file?.context ?? canvas.getContext("2d");
    if (!context) throw new Error("this browser draws no canvas");
    this.context = context;
  }

  /** Clears, and lays the axes out. */
  begin(x: [number, number], y: [number, number], labels: [string, string], colours: Ink, layout: Layout = {}): void {
    const { canvas, context } = this;
    const density = Math.min(3, devicePixelRatio);
    const { width, height } = this.file ?? { width: canvas.clientWidth, height: canvas.clientHeight };
    if (!this.file) {
      if (canvas.width !== Math.round(width * density)) canvas.width = Math.round(width * density);
      if (canvas.height !== Math.round(height * density)) canvas.height = Math.round(height * density);
      context.setTransform(density, 0, 0, density, 0, 0);
      context.clearRect(0, 0, width, height);
    }
    context.font = "11px system-ui, sans-serif";
    const top = this.legend(layout.legend ?? [], labels[1], width, colours);
    const high = height - top - 30;
    this.y = new Axis(...y, top + high, top, layout.logarithmic);
    const up = layout.scaled === false ? [] : named(this.y.ticks(high / 34));
    const wide = (text: string) => context.measureText(text).width;
    const left = layout.left ?? Math.max(38, ...up.map(([, text]) => wide(text) + 10));
    const across = width - left - 12;
    this.box = { left, top, width: across, height: high };
    this.x = new Axis(...x, left, left + across);
    context.lineWidth = 1;
    context.fillStyle = colours.faint;
    context.textAlign = "center";
    context.textBaseline = "top";
    // Numbers that are long have fewer ticks.
    const apart = Math.max(60, ...named(this.x.ticks(across / 60)).map(([, text]) => wide(text) + 24));
    for (const [tick, text] of named(this.x.ticks(across / apart))) {
      context.strokeStyle = colours.line;
      this.line(this.x.at(tick), top, this.x.at(tick), top + high);
      // The last one stays within the picture.
      context.fillText(text, Math.min(this.x.at(tick), width - wide(text) / 2 - 1), top + high + 5);
    }
    context.textAlign = "right";
    context.textBaseline = "middle";
    for (const [tick, text] of up) {
      context.strokeStyle = colours.line;
      this.line(left, this.y.at(tick), left + across, this.y.at(tick));
      context.fillText(text, left - 6, this.y.at(tick));
    }
    context.fillStyle = colours.text;
    context.textAlign = "left";
    context.fillText(labels[1], 2, 8);
    context.textAlign = "right";
    context.fillText(labels[0], left + across, top + high + 24);
  }

  /** Writes what the curves are beside the name of the vertical axis, in as many lines as it takes; answers where they end. */
  private legend(entries: Entry[], name: string, width: number, colours: Ink): number {
    const { context } = this;
    context.textAlign = "left";
    context.textBaseline = "middle";
    let [x, y] = [context.measureText(name).width + 18, 8];
    for (const { text, colour, dash, mark } of entries) {
      const room = 24 + context.measureText(text).width;
      if (x + room > width && x > 2) [x, y] = [2, y + 15];
      context.strokeStyle = context.fillStyle = colour;
      context.lineWidth = 2;
      if (mark === "area") {
        context.beginPath();
        context.rect(x, y - 5, 18, 10);
        context.fill();
        context.strokeStyle = colours.faint;
        context.lineWidth = 1;
        context.stroke();
      } else if (mark) {
        context.beginPath();
        context.arc(x + 9, y, 3.2, 0, 2 * Math.PI);
        if (mark === "full") context.fill();
        context.lineWidth = 1.2;
        context.stroke();
      } else {
        context.setLineDash(dash ?? []);
        this.line(x, y, x + 18, y);
        context.setLineDash([]);
      }
      context.fillStyle = colours.text;
      context.fillText(text, x + 22, y);
      x += room + 12;
    }
    context.lineWidth = 1;
    return y + 12;
  }

  line(x0: number, y0: number, x1: number, y1: number): void {
    this.context.beginPath();
    this.context.moveTo(x0, y0);
    this.context.lineTo(x1, y1);
    this.context.stroke();
  }

  /** A curve through points; values that are no numbers break it. */
  curve(points: Iterable<[number, number]>, colour: string, width = 1.5, dash: number[] = []): void {
    const { context } = this;
    context.save();
    this.clip();
    context.beginPath();
    let pen = false;
    for (const [x, y] of points) {
      if (!Number.isFinite(y)) pen = false;
      else if (pen) context.lineTo(this.x.at(x), this.y.at(y));
      else {
        context.moveTo(this.x.at(x), this.y.at(y));
        pen = true;
      }
    }
    context.strokeStyle = colour;
    context.lineWidth = width;
    context.lineJoin = "round";
    context.setLineDash(dash);
    context.stroke();
    context.restore();
  }

  dot(x: number, y: number, radius: number, colour: string, rim: string): void {
    if (!Number.isFinite(y)) return;
    const { context } = this;
    context.beginPath();
    context.arc(this.x.at(x), this.y.at(y), radius, 0, 2 * Math.PI);
    context.fillStyle = colour;
    context.fill();
    context.strokeStyle = rim;
    context.lineWidth = 1.5;
    context.stroke();
  }

  /** Words beside an upright line, below the top, over curves; on its other side where there is no room. */
  label(x: number, text: string, side: "left" | "right", colour: string, back: string): void {
    const { context } = this;
    const [place, room] = [this.x.at(x), context.measureText(text).width + 4];
    const isRightOf = side === "left" ? place + room <= this.box.left + this.box.width : place - room < this.box.left;
    context.textAlign = isRightOf ? "left" : "right";
    context.textBaseline = "middle";
    const height = this.box.top + 0.35 * this.box.height;
    // Curves behind the words would make them hard to read.
    context.beginPath();
    context.rect(isRightOf ? place + 2 : place - room, height - 7, room - 2, 14);
    context.fillStyle = back;
    context.fill();
    context.fillStyle = colour;
    context.fillText(text, place + (isRightOf ? 4 : -4), height);
  }

  upright(x: number, colour: string): void {
    this.context.strokeStyle = colour;
    this.context.lineWidth = 1;
    this.line(this.x.at(x), this.box.top, this.x.at(x), this.box.top + this.box.height);
  }

  clip(): void {
    const { left, top, width, height } = this.box;
    this.context.beginPath();
    this.context.rect(left - 1, top - 1, width + 2, height + 2);
    this.context.clip();
  }
}

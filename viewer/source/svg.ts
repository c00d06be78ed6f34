/** A canvas's context that writes SVG in place of pixels: as much of it as charts use. */
export class SvgContext {
  fillStyle = "#000";
  strokeStyle = "#000";
  lineWidth = 1;
  lineJoin = "miter";
  globalAlpha = 1;
  font = "11px sans-serif";
  textAlign = "left";
  textBaseline = "alphabetic";
  private dash: number[] = [];
  private path = "";
  private clips = 0;
  private clipped = "";
  private readonly kept: [string, number, string, number, number[], string][] = [];
  private readonly parts: string[] = [];
  private readonly ruler = document.createElement("canvas").getContext("2d");

  constructor(private readonly width: number, private readonly height: number, private readonly back: string) {}

  save(): void {
    this.kept.push([this.strokeStyle, this.lineWidth, this.fillStyle, this.globalAlpha, this.dash, this.clipped]);
  }

  restore(): void {
    const kept = this.kept.pop();
    if (kept) [this.strokeStyle, this.lineWidth, this.fillStyle, this.globalAlpha, this.dash, this.clipped] = kept;
  }

  beginPath(): void {
    this.path = "";
  }

  moveTo(x: number, y: number): void {
    this.path += `M${short(x)} ${short(y)}`;
  }

  lineTo(x: number, y: number): void {
    this.path += `${this.path ? "L" : "M"}${short(x)} ${short(y)}`;
  }

  closePath(): void {
    this.path += "Z";
  }

  /** Whole circles only. */
  arc(x: number, y: number, r: number): void {
    this.path += `M${short(x - r)} ${short(y)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0Z`;
  }

  rect(x: number, y: number, width: number, height: number): void {
    this.path += `M${short(x)} ${short(y)}h${short(width)}v${short(height)}h${short(-width)}Z`;
  }

  setLineDash(dash: number[]): void {
    this.dash = dash;
  }

  clip(): void {
    this.clips += 1;
    this.clipped = `clip${this.clips}`;
    this.parts.push(`<clipPath id="${this.clipped}"><path d="${this.path}"/></clipPath>`);
  }

  stroke(): void {
    const dash = this.dash.length > 0 ? ` stroke-dasharray="${this.dash.join(" ")}"` : "";
    this.put(`fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}"${dash}`);
  }

  fill(): void {
    this.put(`fill="${this.fillStyle}" fill-opacity="${this.globalAlpha}"`);
  }

  private put(look: string): void {
    const clip = this.clipped ? ` clip-path="url(#${this.clipped})"` : "";
    if (this.path) this.parts.push(`<path d="${this.path}" ${look}${clip}/>`);
  }

  measureText(text: string): { width: number } {
    if (this.ruler) this.ruler.font = this.font;
    return { width: this.ruler?.measureText(text).width ?? 6 * text.length };
  }

  fillText(text: string, x: number, y: number): void {
    const anchor = { left: "start", center: "middle", right: "end" }[this.textAlign];
    const base = { middle: "central", top: "hanging" }[this.textBaseline] ?? "auto";
    const plain = text.replaceAll("&", "&amp;").replaceAll("<", "&lt;");
    this.parts.push(
      `<text x="${short(x)}" y="${short(y)}" fill="${this.fillStyle}" text-anchor="${anchor}" dominant-baseline="${base}">${plain}</text>`,
    );
  }

  /** The file. */
  toString(): string {
    const { width, height } = this;
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" ` +
      `font-family="system-ui, sans-serif" font-size="11"><rect width="100%" height="100%" fill="${this.back}"/>` +
      `${this.parts.join("")}</svg>`
    );
  }
}

const short = (number: number) => String(Math.round(100 * number) / 100);

/** Pictures that are remembered. */
const PICTURES = 60;

/** The page's own work for each of the last pictures, in milliseconds: from what has come to the calls that draw it. */
export class Work {
  private readonly times: number[] = [];
  private now = 0;

  /** Does a part of the work for the picture that comes. */
  add(part: () => void): void {
    const begin = performance.now();
    part();
    this.now += performance.now() - begin;
  }

  /** The picture is drawn. */
  end(): void {
    this.times.push(this.now);
    if (this.times.length > PICTURES) this.times.shift();
    this.now = 0;
  }

  get median(): number {
    return this.times.toSorted((a, b) => a - b)[this.times.length >> 1];
  }
}

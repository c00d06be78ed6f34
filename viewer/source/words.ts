import type { Point } from "./results";
import { powerOfTen, written } from "./charts";

/** A value with its error, both to the error's first digit, or to its second if the first is a 1. */
export function withError(value: number, error: number): string {
  if (!Number.isFinite(error) || error <= 1e-12 * Math.abs(value)) return written(value, 4);
  const first = Math.floor(Math.log10(error));
  // The power of ten of its last digit; 1.95 is rounded to 2.
  const last = error < 1.95 * 10 ** first ? first - 1 : first;
  const size = Math.max(Math.abs(value), error);
  const power = size >= 1e6 || size < 1e-3 ? Math.floor(Math.log10(size)) : 0;
  const place = last - power;
  // Digits before the point are rounded too; a zero has no sign.
  const unit = 10 ** Math.max(0, place);
  const digits = (number: number) => {
    const units = (number / 10 ** power / unit).toFixed(Math.max(0, -place));
    return (place > 0 ? String(unit * Number(units)) : units).replace(/^-(0\.?0*)$/, "$1");
  };
  const pair = `${digits(value)}\u00a0±\u00a0${digits(error)}`;
  return (power ? `(${pair})·${powerOfTen(power)}` : pair).replaceAll("-", "−");
}

/** The value of a point, which is a lower limit where runs ended without a transition. */
export function valueOf({ value, error, atLeast }: Point): string {
  return (atLeast ? "at least " : "") + withError(value, atLeast ? NaN : error);
}

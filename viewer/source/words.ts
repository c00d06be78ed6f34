import type { Point } from "./results";
import { powerOfTen, written } from "./charts";

/** A value with its error, both to the error's first digit, or to its second if the first is a 1. */
export function withError(value: number, error: number): string {
  if (!(error > 0)) return written(value, 4);
  const first = Math.floor(Math.log10(error));
  // The power of ten of its last digit; 1.95 is rounded to 2.
  const last = error < 1.95 * 10 ** first ? first - 1 : first;
  const size = Math.max(Math.abs(value), error);
  if (size >= 1e6 || size < 1e-3) {
    const power = Math.floor(Math.log10(size));
    const scale = 10 ** power;
    const decimals = Math.min(8, Math.max(0, power - last));
    return `(${(value / scale).toFixed(decimals)}\u00a0±\u00a0${(error / scale).toFixed(decimals)})·${powerOfTen(power)}`.replace("-", "−");
  }
  const decimals = Math.min(10, Math.max(0, -last));
  return `${value.toFixed(decimals)}\u00a0±\u00a0${error.toFixed(decimals)}`.replace("-", "−");
}

/** The value of a point, which is a lower limit where runs ended without a transition. */
export function valueOf({ value, error, atLeast }: Point): string {
  return (atLeast ? "at least " : "") + withError(value, atLeast ? NaN : error);
}

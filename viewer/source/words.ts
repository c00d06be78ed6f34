import type { Point } from "./results";
import { powerOfTen, written } from "./charts";

/** A value with its error, both to the error's second digit. */
export function withError(value: number, error: number): string {
  if (!(error > 0)) return written(value, 4);
  const digits = Math.floor(Math.log10(error));
  const size = Math.max(Math.abs(value), error);
  if (size >= 1e5 || size < 1e-4) {
    const power = Math.floor(Math.log10(size));
    const scale = 10 ** power;
    const decimals = Math.min(8, Math.max(0, power - digits + 1));
    return `(${(value / scale).toFixed(decimals)}\u00a0±\u00a0${(error / scale).toFixed(decimals)})·${powerOfTen(power)}`.replace("-", "−");
  }
  const decimals = Math.min(10, Math.max(0, 1 - digits));
  return `${value.toFixed(decimals)}\u00a0±\u00a0${error.toFixed(decimals)}`.replace("-", "−");
}

/** The value of a point, which is a lower limit where runs ended without a transition. */
export function valueOf({ value, error, atLeast }: Point): string {
  return (atLeast ? "at least " : "") + withError(value, atLeast ? NaN : error);
}

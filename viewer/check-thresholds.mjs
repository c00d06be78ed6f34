// Functions of the page by themselves: where it says that a flow jams and lets go, from courses made by hand, and how it writes
// numbers; called by check.mjs.
import assert from "node:assert/strict";
import { build } from "esbuild";

/** A module of the page. */
async function part(name) {
  const { outputFiles } = await build({ entryPoints: [`source/${name}.ts`], bundle: true, format: "esm", write: false });
  return import(`data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`);
}

/** Of a tube whose width is driven; its page's own function. */
async function load() {
  const { thresholds } = await part("thresholds");
  return (rows) => thresholds(rows, { of: (row) => row.width, small: 0.012, opens: 1, range: [1.6, 3] });
}

/** Rows of which each piece leads the width to a value within so many periods, by the flow that goes with it. */
function course(...pieces) {
  const rows = [];
  let [clock, width] = [0, pieces[0].to];
  for (const { to, periods, flow } of pieces) {
    const from = width;
    for (let k = 1; k <= 20 * periods; k++) {
      width = from + ((to - from) * k) / (20 * periods);
      rows.push({ clock: (clock += 0.05), width, average: flow(width) });
    }
  }
  return rows;
}

const flowing = () => 0;
const jammed = () => 1;
const jamsAt = (threshold) => (width) => (width < threshold ? 1 : 0);

export const thresholdChecks = {
  // The rows of the tests of `number.rs`: one rule for page and program.
  async numbersWithErrors() {
    const { withError } = await part("words");
    const written = [
      [1234, 56, "1230 ± 60"],
      [1234, 156, "1230 ± 160"],
      [-0.01, 0.3, "0.0 ± 0.3"],
      [0.9, 0.012, "0.900 ± 0.012"],
      [-2.5, 0.04, "−2.50 ± 0.04"],
      [3.2e-6, 4e-7, "(3.2 ± 0.4)·10⁻⁶"],
      [1, Infinity, "1"],
      [-0.012, 1.7e-18, "−0.012"],
    ];
    for (const [value, error, text] of written) assert.equal(withError(value, error).replaceAll("\u00a0", " "), text);
  },

  async thresholds() {
    const found = await load();
    // What is typed jumps: nobody knows where between, until it has been walked over.
    const typed = [
      { to: 2.9, periods: 5, flow: flowing },
      { to: 2.5, periods: 0.25, flow: flowing },
      { to: 2.5, periods: 20, flow: jammed },
      { to: 3, periods: 0.25, flow: jammed },
      { to: 3, periods: 20, flow: flowing },
    ];
    const { jams, letsGo } = found(course(...typed));
    assert.deepEqual([jams, letsGo], [[2.5, 2.9], [2.5, 3]]);
    const there = [{ to: 3, periods: 5, flow: flowing }, { to: 2.4, periods: 60, flow: jamsAt(2.8) }];
    const swept = found(course(...there, { to: 3, periods: 60, flow: jamsAt(2.9) }));
    for (const [deed, at] of [["jams", 2.8], ["letsGo", 2.9]]) {
      const [from, to] = swept[deed];
      assert(from === to && Math.abs(at - to) < 0.01, `${deed} at ${from} to ${to}`);
    }
    assert.equal(swept.not, null);
    // What has not let go by the end, or does so only there, has not been seen to.
    for (const last of [jammed, jamsAt(2.995)]) {
      const kept = found(course(...there, { to: 3, periods: 60, flow: last }, { to: 3, periods: 3, flow: last }));
      assert.equal(kept.letsGo, null);
      assert(kept.not.deed === "letsGo" && kept.not.to > 2.98, JSON.stringify(kept));
    }
    // Nobody has driven what changes by itself.
    const alone = found(course({ to: 2.8, periods: 5, flow: flowing }, { to: 2.8, periods: 5, flow: jammed }));
    assert.deepEqual(alone, { jams: null, letsGo: null, not: null });
    // Rows that a slow page has missed leave the ends of the gap.
    const missed = found(course(...there).filter((_, k) => k % 40 === 0));
    assert(missed.jams[0] < 2.8 && missed.jams[1] > 2.8 && missed.jams[1] - missed.jams[0] < 0.03, JSON.stringify(missed));
  },
};

// What axe-core finds in a page as it is.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";

const AXE = readFileSync(new URL("node_modules/axe-core/axe.min.js", import.meta.url), "utf8");

/** Nothing is to be found in this state of a page. */
export async function audit(page, state) {
  await page.evaluate(AXE);
  const found = await page.evaluate(async () => (await window.axe.run()).violations.map(({ id, nodes }) => `${id}: ${nodes.map((it) => it.html).join(" ").slice(0, 300)}`));
  assert.deepEqual(found, [], `axe-core finds in ${state}`);
}

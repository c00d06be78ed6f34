// What axe-core finds in a page as it is, and in all its looks.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";

const AXE = readFileSync(new URL("node_modules/axe-core/axe.min.js", import.meta.url), "utf8");

/** Nothing is to be found in this state of a page. */
export async function audit(page, state) {
  await page.evaluate(AXE);
  const found = await page.evaluate(async () => (await window.axe.run()).violations.map(({ id, nodes }) => `${id}: ${nodes.map((it) => it.html).join(" ").slice(0, 300)}`));
  assert.deepEqual(found, [], `axe-core finds in ${state}`);
}

const SIZES = { phone: { width: 390, height: 844 }, laptop: { width: 1366, height: 768 }, wide: { width: 1920, height: 1080 } };

/** Nothing is to be found in this state of a page at three sizes and in both themes, and nothing beside the window. */
export async function everyLook(page, state, folder) {
  const before = page.viewportSize();
  for (const [size, viewport] of Object.entries(SIZES)) {
    await page.setViewportSize(viewport);
    for (const colorScheme of ["light", "dark"]) {
      await page.emulateMedia({ colorScheme });
      // The charts are drawn anew some time after the stage.
      await page.waitForTimeout(folder ? 700 : 150);
      await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
      const look = `${state}, ${size}, ${colorScheme}`;
      assert(!(await page.evaluate(() => document.documentElement.scrollWidth > innerWidth)), `wider than the window: ${look}`);
      await audit(page, look);
      if (folder) await page.screenshot({ path: join(folder, `${look.replaceAll(/[ ,]+/g, "-")}.png`), fullPage: size === "phone" });
    }
  }
  await page.emulateMedia({ colorScheme: "light" });
  await page.setViewportSize(before);
}

// The page that computes by itself, and many grains; called by check.mjs.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";

/** Where `just web` puts the page that computes by itself. */
export const WEB = new URL("../target/web/", import.meta.url);
const KINDS = { html: "text/html", js: "text/javascript", css: "text/css", svg: "image/svg+xml", png: "image/png", jpg: "image/jpeg", gif: "image/gif", wasm: "application/wasm" };

/** Its files on any static server. */
export async function serveFiles() {
  const server = createServer((request, response) => {
    const name = request.url === "/" ? "index.html" : request.url.slice(1);
    const file = new URL(name, WEB);
    if (!/^[A-Za-z.-]+$/.test(name) || !existsSync(file)) return response.writeHead(404).end();
    response.writeHead(200, { "content-type": KINDS[name.split(".").at(-1)] });
    response.end(readFileSync(file));
  });
  await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
  return { address: `http://127.0.0.1:${server.address().port}/`, end: () => server.close() };
}

export function webChecks({ serve, record, open, measured, until, shoot, pixels, isTooWide, desk, phone, program, runs }) {
  /** From the start on by so many samples, one after the other; what the state is then, in a number. */
  async function stepOn(page, samples) {
    for (let { rows } = await measured(page), k = 0; k < samples; k++) {
      await page.evaluate(() => document.getElementById("forth").click());
      // A sample may take some frames: its row comes with the last of them.
      await until(page, (rows) => window.viewer.measured.rows >= rows, (rows += 1));
    }
    const { step, digest } = await measured(page);
    return { step, digest };
  }

  async function checkWeb(browser) {
    if (!existsSync(new URL("engine.wasm", WEB))) {
      console.log("skipped: the page that computes by itself ('just web' makes it)");
      return;
    }
    const { address, end } = await serveFiles();
    for (const [preset, ...settings] of [
      ["frictionless", "tube.waves=2", "drive.width=2.6", "run.periods=3"],
      ["frictional", "tube.waves=2", "run.periods=1"],
    ]) {
      const hash = new URLSearchParams([["preset", preset], ...settings.map((it) => ["set", it])]);
      // Without its pictures, which take the processor longer than the tube.
      const { page, close } = await open(browser, `${address}#${hash}`, { ...desk, undrawn: true });
      // The same bits as the program's own, step for step.
      const own = await serve(preset, ...settings.flatMap((it) => ["--set", it]));
      const { page: native, close: closeNative } = await open(browser, own.address, { ...desk, undrawn: true });
      assert.deepEqual(await stepOn(page, 12), await stepOn(native, 12), `${preset} is another in the browser`);
      await closeNative();
      own.end();

      // It goes on by itself, and is driven.
      await page.selectOption("#speed", "");
      await page.click("#play");
      const { clock } = await measured(page);
      await until(page, (clock) => window.viewer.measured.clock > clock + 0.5, clock);
      await until(page, () => document.getElementById("pace").textContent !== "");
      const pace = await page.textContent("#pace");
      const key = preset === "frictional" ? "force_amplitude" : "width";
      const before = await page.inputValue(`#number-${key}`);
      await page.fill(`#number-${key}`, String(0.9 * Number(before)));
      await page.press(`#number-${key}`, "Enter");
      await until(page, ({ key, before }) => Math.abs(window.viewer.driven[key] / before - 0.9) < 1e-3, { key, before: Number(before) });
      await page.click("#play");
      console.log(`${preset} in the browser itself: ${pace}`);

      // What it saves, the program goes on with.
      await page.click("#save");
      await until(page, () => document.getElementById("saved").open);
      const folder = join(runs, `from-web-${preset}`);
      mkdirSync(folder);
      for (const link of ["#saved-toml", "#saved-state"]) {
        const [name, text] = await page.evaluate(async (link) => {
          const { download, href } = document.querySelector(link);
          const reader = new FileReader();
          reader.readAsDataURL(window.offered.get(href));
          await new Promise((read) => (reader.onload = read));
          return [download, reader.result];
        }, link);
        writeFileSync(join(folder, name), Buffer.from(text.split(",")[1], "base64"));
      }
      const resumed = spawnSync(program, ["run", "--quiet", "--resume", folder]);
      assert.equal(resumed.status, 0, String(resumed.stderr));
      await close();
    }
    const { page: small, close } = await open(browser, address, phone);
    assert(!(await isTooWide(small)), "the page that computes by itself is wider than a phone");
    const { height } = await small.locator("#title").boundingBox();
    assert(height < 40, `the title takes ${height} pixels of a phone`);
    const still = await pixels(small);
    assert(still.edges > 0.005 && still.edges < 0.5, `edges cover ${still.edges} of the stage`);
    await small.locator("#play").click();
    const { pictures: drawn } = await measured(small);
    await until(small, (drawn) => window.viewer.measured.clock > 0.3 && window.viewer.measured.pictures > drawn + 2, drawn);
    assert.notEqual((await pixels(small)).sum, still.sum);
    await shoot(small, "web-phone");
    await close();
    end();
  }

  /** Milliseconds of its own work for a picture that a page may have with 10,000 grains. */
  const MOST_WORK = 8;

  /**
   * The page's own work for a picture of 10,000 grains, of a run that is computed meanwhile and of a recording: everything from
   * frames that come to the calls that draw them, charts and numbers too. The drawing itself is a graphics card's.
   */
  async function measureMany(browser) {
    // 494 waves of the preset, 20.25 grains each.
    const waves = "tube.waves=494";
    const folder = record("many", "frictionless", "0.02", waves, "run.periods=1");
    for (const view of [["frictionless", "--set", waves], [folder]]) {
      const { address, end } = await serve(...view);
      const { page, close } = await open(browser, address, { ...desk, undrawn: true });
      const isRecorded = view[0] === folder;
      if (isRecorded) await page.selectOption("#speed", "");
      else await page.click("#play");
      // At best of three: others may use the machine as well.
      let work = Infinity;
      for (let k = 0; k < 3 && work >= MOST_WORK; k++) {
        if (isRecorded) await page.fill("#time", "0");
        if (isRecorded) await page.click("#play");
        const { pictures: before } = await measured(page);
        await until(page, (before) => window.viewer.measured.pictures > before + 40, before);
        work = Math.min(work, (await measured(page)).work);
      }
      const facts = await page.textContent("#facts");
      console.log(`${facts}: ${work.toFixed(1)} ms of the page's own work for a picture (median, without the drawing)`);
      assert(work < MOST_WORK, `${work} ms`);
      await close();
      end();
    }
  }

  return { web: checkWeb, many: measureMany };
}

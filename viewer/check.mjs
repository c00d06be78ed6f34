// The viewer in a browser without a display: node check.mjs PROGRAM [--pictures DIR] [--only CHECKS]
//
// Checks that the page loads, draws, plays, is driven, goes back, picks, saves, plays recordings, follows fingers, shows
// studies and opens their runs, computes by itself the same bits (where `just web` was called), asks nobody else for
// anything, and has little work of its own with 10,000 grains. CHROMIUM names another browser than
// Debian's.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { parseArgs } from "node:util";
import { launched } from "./chromium.mjs";
import { everyLook } from "./audit.mjs";
import { moreChecks } from "./check-more.mjs";
import { thresholdChecks } from "./check-thresholds.mjs";
import { webChecks } from "./check-web.mjs";

const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: { pictures: { type: "string" }, only: { type: "string" } },
});
const [program] = positionals;
const { pictures, only } = values;
const saves = mkdtempSync(join(tmpdir(), "peristalsis-viewer-"));
const runs = mkdtempSync(join(tmpdir(), "peristalsis-runs-"));
const desk = { viewport: { width: 1440, height: 900 } };
const phone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };

/** Programs that were started: none outlives the checks. */
const started = new Set();
process.on("exit", () => started.forEach((it) => it.kill()));
for (const signal of ["SIGINT", "SIGTERM"]) process.on(signal, () => process.exit(1));

/** A viewer of the program. */
async function serve(...view) {
  const served = spawn(program, ["view", ...view, "--saves", saves]);
  started.add(served);
  const address = await new Promise((found, lost) => {
    served.stdout.once("data", (text) => found(String(text).trim()));
    served.once("exit", (code) => lost(new Error(`the program ended with ${code}`)));
  });
  return { address, pid: served.pid, end: () => served.kill("SIGINT") };
}

/** A run with its trajectory. */
function record(name, preset, every, ...settings) {
  const folder = join(runs, name);
  const set = settings.flatMap((it) => ["--set", it]);
  const done = spawnSync(program, [
    "run", "--preset", preset, ...set, "--trajectory", "gsd", "--trajectory-every", every, "--out", folder,
  ]);
  assert.equal(done.status, 0, String(done.stderr));
  return folder;
}

/** A page of it; whatever it complains of is a failure. */
async function open(browser, address, { undrawn, ...options }, ready = () => window.viewer?.measured.pictures > 0) {
  const context = await browser.newContext({ reducedMotion: "reduce", ...options });
  const page = await context.newPage();
  // Without a graphics card a picture may take seconds where others use the machine as well.
  page.setDefaultTimeout(120000);
  const complaints = [];
  // What a graphics card would do is not done by the processor in its place.
  if (undrawn)
    await page.addInitScript(() => {
      for (const name of ["drawArrays", "drawElements", "drawArraysInstanced", "drawElementsInstanced"])
        WebGL2RenderingContext.prototype[name] = () => {};
    });
  // Files that are offered for download: this browser has nowhere to put them.
  await page.addInitScript(() => {
    window.offered = new Map();
    // When the tube was drawn first, in milliseconds from the begin of the load.
    const look = () => (window.viewer?.measured.pictures > 0 ? (window.drawn = performance.now()) : requestAnimationFrame(look));
    requestAnimationFrame(look);
    const create = URL.createObjectURL;
    URL.createObjectURL = (file) => {
      const address = create(file);
      window.offered.set(address, file);
      return address;
    };
  });
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("request", (request) => {
    const { hostname, protocol } = new URL(request.url());
    if (!["blob:", "data:"].includes(protocol) && hostname !== "127.0.0.1") complaints.push(`asks ${request.url()}`);
  });
  await page.goto(address);
  await page.waitForFunction(ready);
  const close = async () => {
    // What the graphics driver says of itself is not the page's.
    const own = complaints.filter((text) => !/GL Driver Message|GPU stall/.test(text));
    assert.deepEqual(own, []);
    await context.close();
  };
  return { page, context, close };
}

const measured = (page) => page.evaluate(() => window.viewer.measured);
const until = (page, condition, argument) => page.waitForFunction(condition, argument);
const shoot = async (page, name) => pictures && page.screenshot({ path: join(pictures, `${name}.png`), fullPage: true });

/** Which parts of the stage, between parts of its width, are edges, and strongly coloured; and a number that changes with the picture. */
const pixels = (page, from = 0, to = 1) =>
  page.evaluate(([from, to]) => {
    const stage = document.getElementById("stage");
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [stage.width, stage.height];
    const context = copy.getContext("2d", { willReadFrequently: true });
    context.drawImage(stage, 0, 0);
    const [left, right] = [from, to].map((part) => Math.floor(part * copy.width));
    const { data } = context.getImageData(left, 0, right - left, copy.height);
    let [edges, coloured, sum] = [0, 0, 0];
    for (let at = 4; at < data.length; at += 4) {
      if (Math.abs(data[at + 1] - data[at - 3]) > 20) edges += 1;
      if (Math.abs(data[at] - data[at + 2]) > 60) coloured += 1;
      sum = (31 * sum + data[at] + 7 * data[at + 2]) % 1000003;
    }
    return { edges: (4 * edges) / data.length, coloured: (4 * coloured) / data.length, sum };
  }, [from, to]);

/** What a page is without scripts. */
async function withoutScript(browser, address, look) {
  const context = await browser.newContext({ ...desk, javaScriptEnabled: false });
  const page = await context.newPage();
  await page.goto(address);
  await look(page);
  await context.close();
}

async function checkDriving(browser) {
  const { address, end } = await serve("frictionless", "--set", "tube.waves=4");
  const { page, close } = await open(browser, address, desk);
  const still = await pixels(page);
  assert(still.edges > 0.005 && still.edges < 0.5, `edges cover ${still.edges} of the stage`);
  await shoot(page, "start");

  await page.selectOption("#speed", "");
  await page.click("#play");
  const { pictures: drawn } = await measured(page);
  await until(page, (drawn) => window.viewer.measured.clock > 3 && window.viewer.measured.pictures > drawn + 2, drawn);
  const moved = await pixels(page);
  assert.notEqual(moved.sum, still.sum);

  // A wide tube does not jam, a narrow one does.
  await page.fill("#number-width", "2.4");
  await page.press("#number-width", "Enter");
  await until(page, () => window.viewer.measured.ratio > 0.8);
  const jammed = await pixels(page);
  assert(jammed.coloured > 0.005, `grains along the wave cover ${jammed.coloured}`);
  await shoot(page, "jammed");
  await page.fill("#number-width", "3");
  await page.press("#number-width", "Enter");
  await until(page, () => window.viewer.measured.ratio < 0.3);
  await page.click("#play");
  await shoot(page, "loop");

  // Back among the frames that were kept, and on from there.
  const newest = await measured(page);
  await page.focus("#time");
  await page.keyboard.press("Home");
  await until(page, () => document.getElementById("live").dataset.live === "false");
  await page.click("#onward");
  await page.click("#confirm-yes");
  await until(page, (clock) => window.viewer.measured.clock < clock, newest.clock / 2);

  // The grain in the middle, by hand.
  await pick(page, (x, y) => page.mouse.click(x, y));
  await looks(page);
  await page.check("#marks");
  await shoot(page, "picked");
  await page.keyboard.press("Escape");
  await page.click("#save");
  await until(page, () => document.getElementById("saved").open);
  const command = await page.textContent("#saved-command");
  const folder = command.replace("peristalsis run --resume ", "");
  assert.match(readFileSync(join(folder, "config.toml"), "utf8"), /\[tube\]/);
  await shoot(page, "saved");
  const [file] = await Promise.all([page.waitForEvent("download"), page.click("#saved-toml")]);
  assert.match(file.suggestedFilename(), /\.toml$/);
  await close();
  end();
}

/** Opens the menu of looks. */
const looks = (page) => page.evaluate(() => (document.querySelector("details.more").open = true));
const isTooWide = (page) => page.evaluate(() => document.documentElement.scrollWidth > innerWidth);

async function checkPlaying(browser) {
  const folder = record("played", "frictional", "0.05", "tube.waves=2", "run.periods=6");
  const { address, end } = await serve(folder);
  const { page, close } = await open(browser, address, desk);
  await until(page, () => window.viewer.measured.number === 0);
  const still = await pixels(page);
  assert(still.edges > 0.005 && still.edges < 0.5, `edges cover ${still.edges} of the stage`);
  for (const driving of ["#save", "#again", "#live", "#onward", "#slider-friction"])
    assert(!(await page.isVisible(driving)), `${driving} is shown beside a recording`);
  // Colours of contacts are for frames that have them.
  const offered = await page.$$eval("#field option", (all) => all.map(({ value }) => value));
  assert(offered.includes("axial") && !offered.includes("pressure") && !offered.includes("coordination"), String(offered));

  // Played at its speed, and halted.
  await page.click("#play");
  const begin = Date.now();
  await until(page, () => window.viewer.measured.number >= 40);
  const seconds = (Date.now() - begin) / 1000;
  assert(seconds > 1.5, `two periods at one a second took ${seconds} s`);
  await page.click("#play");
  const { number } = await measured(page);
  assert.notEqual((await pixels(page)).sum, still.sum);
  await page.waitForTimeout(300);
  assert.equal((await measured(page)).number, number);

  // Anywhere in time, by the slider, the keys and the chart.
  await page.fill("#time", "100");
  await until(page, () => window.viewer.measured.number === 100);
  await until(page, () => document.getElementById("clock").textContent === "5.00 T");
  await page.evaluate(() => document.activeElement.blur());
  await page.keyboard.press("ArrowLeft");
  await until(page, () => window.viewer.measured.number === 99);
  const flow = await page.locator("#flow").boundingBox();
  await page.mouse.click(flow.x + 38 + (flow.width - 50) / 2, flow.y + 60);
  await until(page, () => Math.abs(window.viewer.measured.number - 60) <= 1);
  const ratio = Number((await page.textContent("#ratio")).replace("−", "-"));
  assert(Number.isFinite(ratio), "no flow rate beside the frame");
  assert.match(await page.textContent("#numbers"), /bottleneck w[0-9.]+ d/);
  await pick(page, (x, y) => page.mouse.click(x, y));
  await everyLook(page, "a recording", pictures);

  // To the end, where it stops, and from the begin again.
  await page.keyboard.press("Escape");
  await page.selectOption("#speed", "");
  await page.fill("#time", "112");
  await page.click("#play");
  await until(page, () => window.viewer.measured.number === 120);
  await until(page, () => document.getElementById("play").ariaPressed === "false");
  await page.click("#play");
  await until(page, () => window.viewer.measured.number < 100);
  await close();

  await checkTouch(browser, address);
  end();
}

/** Tries places on the stage until a grain is picked. */
async function pick(page, tap) {
  await page.locator("#stage").scrollIntoViewIfNeeded();
  const box = await page.locator("#stage").boundingBox();
  for (let k = 0; k < 90 && !(await page.isVisible("#grain")); k++)
    await tap(box.x + box.width * (0.2 + 0.02 * (k % 30)), box.y + box.height * (0.46 + 0.03 * Math.floor(k / 30)));
  assert(await page.isVisible("#grain"), "no grain can be picked");
}

async function checkTouch(browser, address) {
  const { page, context, close } = await open(browser, address, phone);
  await until(page, () => window.viewer.measured.number === 0);
  assert(!(await isTooWide(page)), "a recording is wider than a phone");
  const fingers = await context.newCDPSession(page);
  const box = await page.locator("#stage").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  /** Moves fingers from places to places, relative to the middle of the stage. */
  const move = async (from, to) => {
    const at = (part) => from.map(([dx, dy], id) => ({
      id, x: x + dx + part * (to[id][0] - dx), y: y + dy + part * (to[id][1] - dy),
    }));
    await fingers.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: at(0) });
    for (let k = 1; k <= 10; k++) {
      await fingers.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: at(k / 10) });
      await page.waitForTimeout(20);
    }
    await fingers.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
    await page.waitForTimeout(800);
    return (await measured(page)).eye;
  };
  const before = (await measured(page)).eye;
  const turned = await move([[-60, 0]], [[60, 20]]);
  const angle = Math.acos(before.reduce((sum, it, k) => sum + it * turned[k], 0) / (Math.hypot(...before) * Math.hypot(...turned)));
  assert(angle > 0.2, `one finger turned the tube by ${angle}`);
  assert(Math.abs(Math.hypot(...turned) / Math.hypot(...before) - 1) < 0.02, "one finger came nearer");
  const nearer = await move([[-30, 0], [30, 0]], [[-110, 0], [110, 0]]);
  assert(Math.hypot(...nearer) < 0.8 * Math.hypot(...turned), `two fingers came from ${Math.hypot(...turned)} to ${Math.hypot(...nearer)}`);
  assert(!(await page.isVisible("#grain")), "turning picked a grain");
  assert.equal(await page.evaluate(() => window.visualViewport.scale), 1, "the page came nearer, not the tube");
  const further = await move([[-110, 0], [110, 0]], [[-30, 0], [30, 0]]);
  assert(Math.hypot(...further) > 1.2 * Math.hypot(...nearer));
  await page.touchscreen.tap(...(await middle(page, "#home")));
  await pick(page, (left, top) => page.touchscreen.tap(left, top));
  await page.touchscreen.tap(...(await middle(page, "#play")));
  await until(page, () => window.viewer.measured.number >= 20);
  await page.touchscreen.tap(...(await middle(page, "#play")));
  assert(!(await isTooWide(page)), "a recording is wider than a phone");
  await page.waitForTimeout(1200);
  await shoot(page, "recording-phone");
  await close();
}

/** The middle of an element, scrolled to. */
async function middle(page, selector) {
  await page.locator(selector).scrollIntoViewIfNeeded();
  const { x, y, width, height } = await page.locator(selector).boundingBox();
  return [x + width / 2, y + height / 2];
}

async function checkLooks(browser) {
  const { address, end } = await serve("frictional", "--set", "tube.waves=2");
  for (const [name, options] of [["phone", phone], ["dark", { ...desk, colorScheme: "dark" }]]) {
    const { page, close } = await open(browser, address, options);
    assert(!(await isTooWide(page)), `${name}: the page is wider than the window`);
    assert((await pixels(page)).edges > 0.005);
    await page.locator("#play").click();
    await page.waitForTimeout(3000);
    // What is driven has its column.
    await page.click("#loop-csv");
    await until(page, () => window.offered.size === 1);
    const lines = (await page.evaluate(() => [...window.offered.values()][0].text())).trim().split("\n");
    const [head, row] = [lines[0], lines.at(-1)].map((line) => line.split(","));
    assert.deepEqual(head.slice(0, 4), ["period", "force_amplitude", "strain_rate", "friction"]);
    assert(row.length === head.length && Number(row[3]) > 0, String(row));
    await looks(page);
    for (const look of ["glass", "closed", "hidden", "cut open"]) {
      await page.selectOption("#wall", look);
      await page.waitForTimeout(300);
      await shoot(page, `${name}-${look.replace(" ", "-")}`);
    }
    await close();
  }
  end();
}

/** A study of both starts at two strain rates, two replicates each, as far as it is computed. */
const STUDY = `
name = "checked"
title = "Width and strain rate, from both starts"
preset = "frictionless"
states = ["rest", "jammed"]
replicates = 2
[base]
tube.waves = 2
run.periods = 15
[[axes]]
key = "drive.strain_rate"
values = [0.05, 0.1]
[[axes]]
key = "drive.width"
values = [2.5, 2.7, 2.9]
`;

/** Part of a canvas of charts that is strongly coloured, and how many tones it has. */
const inked = (page) =>
  page.evaluate(() => {
    const parts = [...document.querySelectorAll("#charts canvas")].map((canvas) => {
      const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
      const tones = new Set();
      let coloured = 0;
      for (let at = 0; at < data.length; at += 4) {
        const [red, green, blue, cover] = data.subarray(at, at + 4);
        if (cover < 255 || Math.max(red, green, blue) - Math.min(red, green, blue) < 40) continue;
        coloured += 1;
        tones.add((red >> 4) * 256 + (green >> 4) * 16 + (blue >> 4));
      }
      return { coloured: (4 * coloured) / data.length, tones: tones.size };
    });
    return { canvases: parts.length, coloured: Math.min(...parts.map((it) => it.coloured)), tones: Math.max(...parts.map((it) => it.tones)) };
  });

const studied = (page) => page.evaluate(() => window.study.measured);
const hasPoints = () => window.study?.measured.places.length > 0;

async function checkStudy(browser) {
  const file = join(runs, "study.toml");
  const store = join(runs, "store");
  writeFileSync(file, STUDY);
  const compute = (...options) => spawnSync(program, ["study", "run", file, "--store", store, "--quiet", ...options]);
  const done = compute();
  assert.equal(done.status, 0, String(done.stderr));
  const { address, end } = await serve(store);
  const { page, close } = await open(browser, address, desk, hasPoints);
  assert.match(await page.textContent("#facts"), /24 runs done/);
  const curves = await studied(page);
  assert.deepEqual([curves.points, curves.curves], [12, 4]);
  const drawn = await inked(page);
  assert(drawn.coloured > 0.002 && drawn.tones > 4, `curves cover ${drawn.coloured} in ${drawn.tones} tones`);
  // A pointer, and the keys, tell a point's number with its error.
  await page.mouse.move(...curves.places[4]);
  await until(page, () => !document.getElementById("tip").hidden);
  assert.match(await page.textContent("#tip"), /J\s?\/\s?J.*: .*±.*replicates2/s);
  assert.match(await page.textContent("#point-value"), /J\s?\/\s?J.*: .*±/);
  assert.equal(await page.locator("#runs a").count(), 2);
  await shoot(page, "study-curves");
  await page.focus("#charts canvas");
  const { chosen } = await studied(page);
  await page.keyboard.press("ArrowRight");
  const next = (await studied(page)).chosen;
  assert(next.x !== chosen.x || next.value !== chosen.value, "the arrow key stays where it was");

  // Any number against any axes.
  await page.selectOption("#value", "transition_time");
  assert.match(await page.textContent("#legend"), /at least/);
  // Where the transition is known, a point leads to shortly before it.
  const links = await page.evaluate(() =>
    window.study.points.map((point) => {
      const { results } = window.study;
      const row = point.rows.at(-1);
      const moment = results.number("transition_time", row) / results.periodOf(row) - 5;
      return [moment, window.study.address(results, row)];
    }));
  assert(links.some(([moment]) => Number.isFinite(moment)), String(links));
  for (const [moment, link] of links)
    assert.equal(link.split("#jump=")[1], Number.isFinite(moment) ? Math.max(0, moment).toFixed(2) : undefined, link);
  await page.check("#logarithmic");
  await shoot(page, "study-times");
  await page.uncheck("#logarithmic");
  await page.selectOption("#value", "granular_temperature");
  await page.selectOption("#x", "drive.strain_rate");
  assert.equal(await page.inputValue("#other"), "drive.width");
  assert.equal((await studied(page)).curves, 6);
  await page.selectOption("#start", "jammed");
  assert.equal((await studied(page)).points, 6);
  await page.selectOption("#start", "both");
  await page.selectOption("#x", "drive.width");
  await page.selectOption("#value", "flow_rate_ratio");

  // The map, a click on which opens a run of its point, and the way back to the same map.
  await page.click("#view-heat");
  await until(page, () => document.querySelectorAll("#charts canvas").length === 2);
  const heat = await inked(page);
  assert(heat.coloured > 0.4 && heat.tones > 2, `the map covers ${heat.coloured} in ${heat.tones} tones`);
  const cells = await studied(page);
  assert.equal(cells.places.length, 12);
  await page.mouse.move(...cells.places[0]);
  await everyLook(page, "a map of a study", pictures);
  await page.mouse.move(...cells.places[0]);
  await page.mouse.click(...cells.places[0]);
  await until(page, () => window.viewer?.measured.pictures > 0);
  assert.match(await page.textContent("#title"), /strain rate 0\.05, width 2\.5, from rest/);
  assert.equal(await page.locator("#siblings option").count(), 2);
  await page.click("#play");
  await until(page, () => window.viewer.measured.clock > 0.5);
  await page.click("#play");
  await shoot(page, "study-run");
  await page.selectOption("#siblings", { index: 1 });
  await until(page, () => window.viewer?.measured.pictures > 0 && document.getElementById("siblings").selectedIndex === 1);
  await page.click("#to-study");
  await until(page, () => window.study?.measured.places.length === 12);
  assert.equal(await page.getAttribute("#view-heat", "aria-pressed"), "true");
  await close();

  // A finger tells first, and opens then.
  const { page: small, close: closeSmall } = await open(browser, address, phone, hasPoints);
  assert(!(await isTooWide(small)), "a study is wider than a phone");
  const [x, y] = (await studied(small)).places[0];
  await small.touchscreen.tap(x, y);
  await until(small, () => !document.getElementById("tip").hidden);
  await shoot(small, "study-phone");
  const [again, down] = (await studied(small)).places[0];
  await small.touchscreen.tap(again, down);
  await until(small, () => window.viewer?.measured.pictures > 0);
  assert(!(await isTooWide(small)), "a run of a study is wider than a phone");
  await closeSmall();

  // Runs that end meanwhile are seen.
  const { page: growing, close: closeGrowing } = await open(browser, address, desk, hasPoints);
  assert(!(await growing.isVisible("#refresh")));
  writeFileSync(file, STUDY.replace("replicates = 2", "replicates = 9"));
  compute("--for", "0.1s");
  await growing.reload();
  await until(growing, hasPoints);
  await until(growing, () => document.getElementById("facts").textContent.includes("waiting"));
  assert.equal(compute().status, 0);
  await until(growing, () => document.getElementById("facts").textContent === "checked · 108 runs done");
  await closeGrowing();
  end();
}

const tools = { serve, record, open, measured, until, shoot, pictures, pixels, withoutScript, isTooWide, desk, phone, program, runs };
const checks = { driving: checkDriving, playing: checkPlaying, looks: checkLooks, study: checkStudy, ...thresholdChecks, ...webChecks(tools), ...moreChecks(tools) };
assert(program, `usage: node check.mjs PROGRAM [--pictures DIR] [--only ${Object.keys(checks)}]`);
const browser = await launched();
try {
  for (const [name, check] of Object.entries(checks)) {
    if (only !== undefined && !only.split(",").includes(name)) continue;
    const begin = Date.now();
    await check(browser);
    console.log(`${name}: ${((Date.now() - begin) / 1000).toFixed(0)} s`);
  }
  console.log("the viewer works");
} finally {
  await browser.close();
  for (const folder of [saves, runs]) rmSync(folder, { recursive: true });
}

// The viewer in a browser without a display: node check.mjs PROGRAM [--pictures DIR]
//
// Checks that the page loads, draws, plays, is driven, goes back, picks, saves, and asks nobody else for anything; tells the
// time of a picture of 10,000 grains. CHROMIUM names another browser than Debian's.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

const [program, option, pictures] = process.argv.slice(2);
assert(program && (option === undefined || option === "--pictures"), "usage: node check.mjs PROGRAM [--pictures DIR]");
const saves = mkdtempSync(join(tmpdir(), "peristalsis-viewer-"));
const desk = { viewport: { width: 1440, height: 900 } };
const phone = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };

/** A viewer of the program. */
async function serve(...view) {
  const served = spawn(program, ["view", ...view, "--saves", saves]);
  const address = await new Promise((found, lost) => {
    served.stdout.once("data", (text) => found(String(text).trim()));
    served.once("exit", (code) => lost(new Error(`the program ended with ${code}`)));
  });
  return { address, end: () => served.kill("SIGINT") };
}

/** A page of it; whatever it complains of is a failure. */
async function open(browser, address, options) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.message));
  page.on("request", (request) => {
    const { hostname, protocol } = new URL(request.url());
    if (!["blob:", "data:"].includes(protocol) && hostname !== "127.0.0.1") complaints.push(`asks ${request.url()}`);
  });
  await page.goto(address);
  await page.waitForFunction(() => window.viewer.measured.pictures > 0);
  const close = async () => {
    // What the graphics driver says of itself is not the page's.
    const own = complaints.filter((text) => !/GL Driver Message|GPU stall/.test(text));
    assert.deepEqual(own, []);
    await context.close();
  };
  return { page, close };
}

const measured = (page) => page.evaluate(() => window.viewer.measured);
const until = (page, condition, argument) => page.waitForFunction(condition, argument, { timeout: 60000 });
const shoot = async (page, name) => pictures && page.screenshot({ path: join(pictures, `${name}.png`), fullPage: true });

/** Which parts of the stage are edges, and strongly coloured; and a number that changes with the picture. */
const pixels = (page) =>
  page.evaluate(() => {
    const stage = document.getElementById("stage");
    const copy = document.createElement("canvas");
    [copy.width, copy.height] = [stage.width, stage.height];
    const context = copy.getContext("2d");
    context.drawImage(stage, 0, 0);
    const { data } = context.getImageData(0, 0, copy.width, copy.height);
    let [edges, coloured, sum] = [0, 0, 0];
    for (let at = 4; at < data.length; at += 4) {
      if (Math.abs(data[at + 1] - data[at - 3]) > 20) edges += 1;
      if (Math.abs(data[at] - data[at + 2]) > 60) coloured += 1;
      sum = (31 * sum + data[at] + 7 * data[at + 2]) % 1000003;
    }
    return { edges: (4 * edges) / data.length, coloured: (4 * coloured) / data.length, sum };
  });

async function checkDriving(browser) {
  const { address, end } = await serve("frictionless", "--set", "tube.waves=4");
  const { page, close } = await open(browser, address, desk);
  const still = await pixels(page);
  assert(still.edges > 0.005 && still.edges < 0.5, `edges cover ${still.edges} of the stage`);
  await shoot(page, "start");

  await page.selectOption("#speed", "");
  await page.click("#play");
  await until(page, () => window.viewer.measured.clock > 3);
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
  await until(page, (clock) => window.viewer.measured.clock < clock, newest.clock / 2);

  // The grain in the middle, by hand.
  const box = await page.locator("#stage").boundingBox();
  for (let k = 0; k < 90 && !(await page.isVisible("#grain")); k++)
    await page.mouse.click(box.x + box.width * (0.2 + 0.02 * (k % 30)), box.y + box.height * (0.46 + 0.03 * Math.floor(k / 30)));
  assert(await page.isVisible("#grain"), "no grain can be picked");
  await page.check("#marks");
  await shoot(page, "picked");
  await page.keyboard.press("Escape");
  await page.click("#save");
  await until(page, () => document.getElementById("saved").open);
  const command = await page.textContent("#saved-command");
  const folder = command.replace("peristalsis run --resume ", "");
  assert.match(readFileSync(join(folder, "config.toml"), "utf8"), /\[tube\]/);
  await shoot(page, "saved");
  await close();
  end();
}

async function checkLooks(browser) {
  const { address, end } = await serve("frictional", "--set", "tube.waves=2");
  for (const [name, options] of [["phone", phone], ["dark", { ...desk, colorScheme: "dark" }]]) {
    const { page, close } = await open(browser, address, options);
    const wider = await page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
    assert(!wider, `${name}: the page is wider than the window`);
    assert((await pixels(page)).edges > 0.005);
    await page.locator("#play").click();
    await page.waitForTimeout(3000);
    for (const look of ["glass", "closed", "hidden", "cut open"]) {
      await page.selectOption("#wall", look);
      await page.waitForTimeout(300);
      await shoot(page, `${name}-${look.replace(" ", "-")}`);
    }
    await close();
  }
  end();
}

async function measureMany(browser) {
  // 493 waves of the preset, 20.25 grains each.
  const { address, end } = await serve("frictionless", "--set", "tube.waves=494");
  const { page, close } = await open(browser, address, desk);
  await page.click("#play");
  const before = await measured(page);
  const seconds = 10;
  await page.waitForTimeout(1000 * seconds);
  const after = await measured(page);
  const grains = await page.textContent("#facts");
  const each = (1000 * seconds) / (after.pictures - before.pictures);
  console.log(`${grains}: ${each.toFixed(0)} ms from picture to picture, ${after.drawing.toFixed(1)} ms of them the page's own work`);
  assert(after.pictures > before.pictures, "no picture is drawn");
  await shoot(page, "many");
  await close();
  end();
}

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
  args: ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  await checkDriving(browser);
  await checkLooks(browser);
  await measureMany(browser);
  console.log("the viewer works");
} finally {
  await browser.close();
  rmSync(saves, { recursive: true });
}

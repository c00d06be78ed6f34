// What new users met, each as a check, and what the page is to do besides; called by check.mjs.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { gzipSync } from "node:zlib";
import { audit, everyLook } from "./audit.mjs";
import { serveFiles, WEB } from "./check-web.mjs";
import { widgetChecks } from "./check-widget.mjs";

export function moreChecks({ serve, open, measured, until, shoot, pictures, pixels, withoutScript, desk, phone, program, runs }) {
  const fastest = async (page) => {
    await page.selectOption("#speed", "");
    await page.click("#play");
  };

  async function checkMore(browser) {
    const { address, pid, end } = await serve("frictionless", "--set", "tube.waves=2");
    const { page, close } = await open(browser, address, desk);
    // A slider that is moved while the tube rests stays where it was put.
    await page.fill("#number-width", "2.4");
    await page.press("#number-width", "Enter");
    await page.evaluate(() => document.activeElement.blur());
    await page.waitForTimeout(4500);
    await page.mouse.move(400, 300);
    await page.waitForTimeout(400);
    assert.equal(await page.inputValue("#number-width"), "2.400");
    // A comma is a point; what is out of range, or no number, is told.
    for (const [typed, taken, told] of [["2,5", "2.500", null], ["25", "3.000", /Width w \/ d: 25 is outside 1\.6 to 3, and 3 is taken/], ["wide", "3.000", /“wide” is no number/], ["2.4", "2.400", null]]) {
      await page.click("#number-width");
      await page.fill("#number-width", "");
      await page.keyboard.type(typed);
      await page.keyboard.press("Enter");
      assert.equal(await page.inputValue("#number-width"), taken);
      if (told) assert.match(await page.textContent("#status"), told);
    }
    // Dialogs: escape closes, and no key works behind them.
    await page.click("#help");
    await page.keyboard.press("m");
    await page.keyboard.press(" ");
    assert.equal(await page.isChecked("#marks"), false);
    await page.keyboard.press("Escape");
    assert.equal(await page.evaluate(() => document.querySelector("dialog[open]")), null);
    // The menu of looks closes by escape, and by a press elsewhere.
    const isOpen = () => page.evaluate(() => document.querySelector("details.more").open);
    await page.click("details.more summary");
    assert(await isOpen());
    await page.check("#lightness");
    await page.uncheck("#lightness");
    assert(await isOpen());
    await page.keyboard.press("Escape");
    assert(!(await isOpen()));
    // A key that does something where it is pressed does nothing else.
    await page.focus("details.more summary");
    await page.keyboard.press(" ");
    assert((await isOpen()) && !(await measured(page)).playing);
    await page.mouse.click(200, 500);
    assert(!(await isOpen()));
    const taken = await page.evaluate(() => [".panel", "#stage"].map((place) => {
      const event = new KeyboardEvent("keydown", { key: "ArrowDown", bubbles: true, cancelable: true });
      return !document.querySelector(place).dispatchEvent(event);
    }));
    assert.deepEqual(taken, [false, true], "arrows scroll the panel, and turn the tube elsewhere");
    // Marks are for colours with a sign.
    const look = () => page.evaluate(() => (document.querySelector("details.more").open = true));
    await look();
    await page.selectOption("#field", "place");
    await page.waitForTimeout(1500);
    const plain = await pixels(page);
    await page.check("#marks");
    await page.waitForTimeout(1500);
    assert.equal((await pixels(page)).sum, plain.sum, "marks where colour has no sign");
    await page.selectOption("#field", "axial");
    for (const box of await page.locator("#sliders input").all())
      assert(!/\d{9}/.test(await box.getAttribute("min")), "a slider with the noise of a float");
    // Pixels that were saved come back.
    const [worst, best] = await page.evaluate(() => {
      const { scene } = window.viewer;
      const draw = (took, number) => {
        for (let k = 0; k < number; k++) scene.keepUp((scene.drawnAt ?? 0) + 30, took);
        return window.viewer.measured.fineness;
      };
      return [draw(200, 60), draw(10, 3000)];
    });
    assert(worst < 0.7 && best === 1, `fineness ${worst}, then ${best}`);

    // Memory is bounded at any speed.
    await fastest(page);
    await until(page, () => window.viewer.measured.clock > 1200);
    const resident = Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${pid}/status`, "utf8"))[1]) / 1024;
    assert(resident < 600, `${resident} MB after 1200 periods`);
    assert((await measured(page)).rows <= 8001);
    // A long history is thinned evenly, and the newest row stays.
    const thinned = await page.evaluate(() => {
      const film = new window.viewer.film.constructor();
      const rows = Array.from({ length: 262144 }, (_, number) => ({ number, clock: number / 20, flow_rate_ratio: number % 20 }));
      for (let k = 0; k < rows.length; k += 256) film.addRows(rows.slice(k, k + 256));
      const gaps = film.rows.slice(1).map((row, k) => row.number - film.rows[k].number);
      return { first: film.rows[0].number, rows: film.rows.length, each: film.each, widest: Math.max(...gaps),
        last: film.rows.at(-1).number };
    });
    assert(thinned.first === 0 && thinned.rows > 2000 && thinned.rows <= 8000 && thinned.last === 262143, JSON.stringify(thinned));
    assert(thinned.widest <= thinned.each && thinned.each <= 128, JSON.stringify(thinned));
    // Grains that have left the tube are no part of what flows in it.
    const emptied = await page.evaluate(() => {
      const { readout, tube, film } = window.viewer;
      const spaceTime = new readout.spaceTime.constructor();
      const see = (frame) => spaceTime.see(frame, { ...tube, waves: 6 });
      see({ ...film.newest, velocity: film.newest.velocity.map(() => tube.heading * film.newest.wave_speed) });
      const full = spaceTime.words();
      see({ ...film.newest, clock: film.newest.clock + 1, position: film.newest.position.map((it, k) => (k % 3 === 0 ? 100 : it)) });
      return [full, spaceTime.words(), [...spaceTime.looks[1].grains]];
    });
    assert.match(emptied[0], /^[1-6] of 6 waves jammed/);
    assert.match(emptied[1], /^0 of 6 waves jammed/);
    assert(emptied[2].every((grains) => grains === 0), `${emptied[2]}`);
    // Forces are drawn, and colours are made of them.
    const before = await pixels(page);
    await page.check("#contacts");
    await until(page, () => window.viewer.measured.contacts > 0);
    await page.waitForTimeout(1500);
    assert.notEqual((await pixels(page)).sum, before.sum);
    await shoot(page, "forces");
    await page.selectOption("#field", "pressure");
    await page.waitForTimeout(1500);
    assert.match(await page.textContent("#bar-to"), /m\/\(d t²\)/);
    await page.selectOption("#field", "axial");
    await page.click("#play");
    await until(page, () => !window.viewer.measured.playing);

    // To begin anew is asked for, and can be refused.
    const { clock, frames } = await measured(page);
    await page.click("#again");
    await page.keyboard.press("Escape");
    assert.equal((await measured(page)).clock, clock);
    // A page that is loaded again can go back.
    await page.reload();
    await until(page, () => window.viewer?.measured.pictures > 0);
    await until(page, (frames) => window.viewer.measured.frames > Math.min(5, frames / 20), frames);
    // Going on from another time goes on from there, steered as it was.
    await page.focus("#time");
    await page.keyboard.press("Home");
    for (let k = 0; k < 3; k++) await page.keyboard.press("ArrowRight");
    await until(page, () => document.getElementById("live").dataset.live === "false");
    await until(page, () => window.viewer.shownFrame === window.viewer.film.frame(3));
    const shown = await page.evaluate(() => window.viewer.shownFrame.clock);
    // The sliders are where they were then, and the profile is of no more than a period.
    const driven = await page.evaluate(() => window.viewer.shownFrame.driven.width.toFixed(3));
    await until(page, (driven) => document.getElementById("number-width").value === driven, driven);
    assert.match(await page.textContent("#profile-of"), /^(of the frame shown|mean of \d+ frames, over (0|0\.\d+|1) T)$/);
    // What is not known of this time has no colour.
    for (const field of ["pressure", "coordination"]) {
      await page.selectOption("#field", field);
      await until(page, () => /not kept/.test(document.getElementById("bar-name").textContent));
      assert(await page.evaluate(() => window.viewer.scene.values.every(Number.isNaN)), `${field} of a frame without contacts`);
    }
    await shoot(page, "no-contacts");
    await page.selectOption("#field", "axial");
    await page.click("#onward");
    assert.match(await page.textContent("#confirm-text"), /came after \d+\.\d\d T, up to \d+\.\d\d T/);
    await page.click("#confirm-yes");
    await until(page, (shown) => Math.abs(window.viewer.measured.clock - shown) < 1e-6, shown);
    // A sweep ends before the samples that a run can have, there and back; it ends too where the run is halted.
    await page.evaluate(() => (window.viewer.tube.most_samples = window.viewer.film.rows.at(-1).number + 100000));
    await page.click("#sweep");
    await until(page, () => document.getElementById("sweep").ariaPressed === "true" && window.viewer.measured.playing);
    // As fast as the samples last for the time that it takes.
    await until(page, () => window.viewer.newest().speed > 1);
    await page.waitForFunction(() => document.getElementById("sweep").ariaPressed === "false", null, { timeout: 200000 });
    await until(page, () => window.viewer.newest().aims.width === 3);
    const swept = await page.evaluate(() => {
      const { film, tube } = window.viewer;
      return { least: Math.min(...film.rows.map(({ amplitude }) => amplitude)), left: tube.most_samples - film.rows.at(-1).number };
    });
    assert(swept.least < 2.45 && swept.left > 0, JSON.stringify(swept));
    // What has been found leaves the loop its room.
    await until(page, () => document.getElementById("found").textContent !== "");
    const { height: room } = await page.locator("#loop").boundingBox();
    assert(room >= 200, `the loop is ${room} pixels high`);
    await page.evaluate(() => (window.viewer.tube.most_samples = 262144));
    await page.click("#sweep");
    await until(page, () => window.viewer.measured.playing);
    await page.click("#play");
    await until(page, () => document.getElementById("sweep").ariaPressed === "false");
    // The loop as files.
    for (const kind of ["png", "svg", "csv"]) await page.click(`#loop-${kind}`);
    await until(page, () => [...window.offered.values()].length >= 3);
    const files = await page.evaluate(async () => Promise.all([...window.offered.values()].map((file) => file.slice(0, 90).text())));
    assert(files.some((text) => /^<svg.*viewBox="0 0 900 560"/.test(text)), String(files));
    assert(files.some((text) => text.startsWith("<svg")) && files.some((text) => text.startsWith("period,width,")), String(files));
    // The address keeps the looks.
    await page.selectOption("#field", "total");
    await until(page, () => location.hash.includes("field=total"));
    await everyLook(page, "a run", pictures);
    for (const [button, dialog] of [["#help", "keys"], ["#share", "share-dialog"], ["#save", "saved"], ["#again", "confirm"]]) {
      await page.click(button);
      await until(page, (dialog) => document.getElementById(dialog).open, dialog);
      await everyLook(page, dialog, pictures);
      await page.keyboard.press("Escape");
    }
    await close();
    const { page: dark, close: closeDark } = await open(browser, address, desk);
    // A ninth page is told why it gets none.
    await dark.evaluate(() => {
      window.others = Array.from({ length: 7 }, () => new WebSocket(new URL("live", location.href).href.replace("http", "ws")));
      return Promise.all(window.others.map((it) => new Promise((done) => (it.onopen = done))));
    });
    const ninth = await dark.context().newPage();
    await ninth.goto(address);
    await until(ninth, () => /8 pages are open/.test(document.getElementById("status").textContent));
    await ninth.close();
    // A program that has ended is missed.
    end();
    await until(dark, () => document.body.dataset.lost === "true" && /has ended/.test(document.getElementById("status").textContent));
    assert.equal(await dark.getAttribute("#play", "aria-pressed"), "false");
    await shoot(dark, "lost");
    await dark.context().close();
    void closeDark;
  }

  /** What a viewer's user met: links that hung or broke the page, and a sweep that spoke of published runs of another tube. */
  async function checkLinks(browser) {
    const { address, end } = await serve("frictionless", "--set", "tube.waves=2");
    const damaged = /This link is damaged: how its tube was steered cannot be read/;
    for (const [link, told] of [["at=1e300", null], ["at=-1e9", null], ["field=constructor&wall=toString", null], ["eye=1e300,0,0", null],
      ["turns=0:width:wide&step=100", damaged], ["turns=0:constructor:2&step=100", damaged]]) {
      const { page, close } = await open(browser, `${address}#${link}`, desk);
      if (told) assert.match(await page.textContent("#status"), told, link);
      const { pictures } = await measured(page);
      await page.click("#play");
      await until(page, (pictures) => window.viewer.measured.pictures > pictures + 3, pictures);
      await page.click("#play");
      assert(await page.isVisible("#sweep-published"));
      await close();
    }
    end();
    const other = await serve("frictionless", "--set", "tube.waves=2", "--set", "tube.radius=4", "--set", "drive.width=3.4");
    const { page, close } = await open(browser, other.address, desk);
    assert(!(await page.isVisible("#sweep-published")));
    // It begins at the wide end, where such a tube is not clogged.
    await page.click("#sweep");
    await until(page, () => window.viewer.shownFrame?.aims.width > 3.4);
    await close();
    other.end();
    const led = await serve("frictionless", "--set", 'drive.schedule={form="ramp",parameter="width",from=3.0,to=2.5,end=100}');
    const { page: scheduled, close: closeScheduled } = await open(browser, led.address, desk);
    await scheduled.click("#sweep");
    await until(scheduled, () => /drive\.width still follows its schedule/.test(document.getElementById("status").textContent));
    assert.equal(await scheduled.getAttribute("#sweep", "aria-pressed"), "false");
    await closeScheduled();
    led.end();
  }

  /** An open tube whose wave stands: no flow rate over the largest, no periods, no images. */
  async function checkOpen(browser) {
    const { address, end } = await serve("silo", "--set", "grains.number=700", "--set", "inlet.waiting=200");
    const { page, close } = await open(browser, address, desk);
    assert.match(await page.textContent("#facts"), /1 standing wave, open ends/);
    assert.equal(await page.textContent("#direction"), "outlet ");
    for (const id of ["ratio", "flow", "sweep"]) assert(!(await page.isVisible(`#${id}`)), `${id} of a standing wave`);
    await fastest(page);
    await until(page, () => window.viewer.measured.clock > 40 && /discharge rate[0-9.−·⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+ m\/t/.test(document.getElementById("numbers").textContent));
    await page.click("#play");
    await until(page, () => !window.viewer.measured.playing && / t$/.test(document.getElementById("clock").textContent));
    assert.match(await page.textContent("#bar-to"), /^[0-9.]+ d\/t$/);
    // Each grain inside is drawn once, and those that wait are not.
    const seen = await page.evaluate(() => {
      const { scene, shownFrame } = window.viewer;
      const inside = Array.from({ length: shownFrame.grains }, (_, i) => i).filter((i) => !Number.isNaN(shownFrame.position[3 * i]));
      const sides = Array.from(scene.values.filter((it) => Math.abs(it - 0.5) > 0.05));
      return { drawn: scene.grains.geometry.instanceCount, inside: inside.length, coloured: sides.length };
    });
    assert(seen.drawn > 0 && seen.drawn <= seen.inside && seen.coloured > 20, JSON.stringify(seen));
    await page.focus("#stage");
    await page.keyboard.press("g");
    assert.match(await page.textContent("#grain-numbers"), /speed[0-9.−·⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+ d\/t/);
    await everyLook(page, "an open tube", pictures);
    await close();
    end();
  }

  /** A program that is started again at the same port has another address, which the page of the old one says. */
  async function checkLost(browser) {
    const { address, end } = await serve("frictionless", "--set", "tube.waves=2");
    const { page, context } = await open(browser, address, desk);
    await page.click("#play");
    await until(page, () => window.viewer.measured.playing);
    end();
    await until(page, () => document.body.dataset.lost === "true");
    const again = await serve("frictionless", "--set", "tube.waves=2", "--port", new URL(address).port);
    await until(page, () => /no longer valid/.test(document.getElementById("status").textContent));
    assert.equal(await page.getAttribute("#play", "aria-pressed"), "false");
    // What is said of it is not grey as the rest is.
    const greyed = await page.evaluate(() => {
      for (let it = document.getElementById("status"); it; it = it.parentElement) {
        const { filter, opacity } = getComputedStyle(it);
        if (filter !== "none" || opacity !== "1") return it.outerHTML.slice(0, 60);
      }
      return null;
    });
    assert.equal(greyed, null);
    await shoot(page, "lost-for-ever");
    await context.close();
    again.end();
  }

  /** Files of the stage, and a start at another time. */
  async function checkNumbers(browser) {
    const { address, end } = await serve("frictionless", "--set", "tube.waves=2");
    const { page, close } = await open(browser, `${address}#jump=2`, desk);
    // A link may lead to another time.
    await until(page, () => Math.abs(window.viewer.measured.clock - 2) < 0.1 && !window.viewer.measured.playing);
    // The first view is full of tube from side to side, however few its waves are.
    const sides = [(await pixels(page, 0, 0.03)).edges, (await pixels(page, 0.97, 1)).edges];
    assert(sides.every((part) => part > 0.005), `edges cover ${sides} of the sides of the stage`);
    // Numbers have names and units; the flow is a mean, which is said.
    assert.match(await page.textContent(".flow"), /mean over the last period/);
    const numbers = await page.textContent("#numbers");
    for (const unit of [/w[0-9.]+ d/, /temperature, escaped too[0-9.·⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+ m d²\/t²/, /wall[−0-9.·⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+ m d²\/t³/]) assert.match(numbers, unit);
    assert.match(await page.textContent("#sliders"), /Width w \/ d.*Strain rate ε̇ \/ t⁻¹/s);
    await page.click("#loop-svg");
    const svg = await page.evaluate(() => [...window.offered.values()].at(-1).text());
    for (const words of ["width w / d", "J / Jmax", "Newtonian fluid", "narrowed", "widened"]) assert(svg.includes(words), `the loop lacks ${words}`);
    // Words beside an upright line stay inside of the chart.
    const ends = await page.evaluate(() => {
      const { loop } = window.viewer.readout.charts;
      const places = [];
      const own = loop.context.fillText;
      loop.context.fillText = (text, x) => {
        const { width } = loop.context.measureText(text);
        places.push(loop.context.textAlign === "left" ? [x, x + width] : [x - width, x]);
      };
      loop.label(loop.x.to, "lets go", "left", "#000", "#fff");
      loop.label(loop.x.from, "jams", "right", "#000", "#fff");
      loop.context.fillText = own;
      return { places, box: loop.box };
    });
    for (const [from, to] of ends.places)
      assert(from >= ends.box.left && to <= ends.box.left + ends.box.width, `words from ${from} to ${to} in ${JSON.stringify(ends.box)}`);
    // Nearly all of the pressures lie within the colours from the begin.
    await page.selectOption("#field", "pressure");
    await until(page, () => window.viewer.measured.contacts > 0 && !/not kept/.test(document.getElementById("bar-name").textContent));
    const pressures = await page.evaluate(() => [...window.viewer.scene.values]);
    const above = pressures.filter((it) => it > 1).length / pressures.length;
    assert(above < 0.1 && pressures.some((it) => it > 0.3), `${above} of the pressures are above the colours`);
    await page.selectOption("#field", "axial");
    // The profile shows velocities above that of the wave.
    const most = await page.evaluate(async () => {
      const { film, tube, readout } = window.viewer;
      const { newest } = film;
      const kept = newest.velocity;
      newest.velocity = kept.map((_, k) => (k % 3 === 2 ? 2 * tube.heading * newest.wave_speed : 0));
      film.recent = () => [newest];
      window.viewer.redraw();
      await new Promise((done) => setTimeout(done, 1500));
      newest.velocity = kept;
      delete film.recent;
      return readout.charts.profile.y.to;
    });
    assert(most >= 2, `the profile goes to ${most}`);
    // Grains are picked by a key, one after the other.
    const told = () => page.textContent("#grain-numbers");
    await page.focus("#stage");
    await page.keyboard.press("g");
    const first = await told();
    await page.keyboard.press("g");
    assert.match(first, /^grain\d/);
    assert.notEqual(await told(), first);
    await page.keyboard.press("Escape");
    assert(!(await page.isVisible("#grain")));
    // The pace that is told is the one that is reached.
    await fastest(page);
    await until(page, () => /now [0-9.]+ T\/s/.test(document.getElementById("pace").textContent));
    await page.evaluate(() => {
      window.summaries = 0;
      new MutationObserver(() => (window.summaries += 1)).observe(document.getElementById("summary"), { childList: true });
    });
    const [from, begin] = await page.evaluate(() => [window.viewer.measured.clock, performance.now()]);
    await page.waitForTimeout(4000);
    const [to, now, words] = await page.evaluate(() => [window.viewer.measured.clock, performance.now(), document.getElementById("pace").textContent]);
    const reached = (1000 * (to - from)) / (now - begin);
    const pace = Number(/now ([0-9.]+)/.exec(words)[1]);
    assert(pace > reached / 3 && pace < 3 * reached, `${words}, and ${reached} are reached`);
    // Who does not see the page is told at most once a second.
    const summaries = await page.evaluate(() => window.summaries);
    assert(summaries <= (now - begin) / 1000 + 1, `${summaries} summaries`);
    await page.click("#play");
    // A picture and a film of the stage.
    await page.click("#share");
    await until(page, () => document.getElementById("share-dialog").open);
    await page.context().grantPermissions(["clipboard-read", "clipboard-write"]);
    await page.click("#copy-link");
    await until(page, () => document.getElementById("copy-link").textContent === "copied");
    assert.equal(await page.evaluate(() => navigator.clipboard.readText()), await page.inputValue("#link"));
    await page.evaluate(() => window.offered.clear());
    await page.click("#picture");
    await until(page, () => window.offered.size === 1);
    await page.click("#film-button");
    await until(page, () => /recording: \d+ s/.test(document.getElementById("film-button").textContent));
    await until(page, () => window.offered.size === 2);
    const files = await page.evaluate(async () =>
      Promise.all([...window.offered.values()].map(async (file) => [file.size, ...new Uint8Array(await file.slice(0, 4).arrayBuffer())])));
    assert.deepEqual(files.map((file) => file.slice(1)), [[0x89, 0x50, 0x4e, 0x47], [0x1a, 0x45, 0xdf, 0xa3]]);
    assert(files.every(([size]) => size > 2000), `${files}`);
    await close();
    end();
  }

  async function checkBare(browser) {
    const { address, end } = await serve("frictionless", "--set", "tube.waves=2");
    // Without WebGL the charts go on.
    const context = await browser.newContext(desk);
    const page = await context.newPage();
    await page.addInitScript(() => {
      const own = HTMLCanvasElement.prototype.getContext;
      HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
        return kind.startsWith("webgl") ? null : own.call(this, kind, ...rest);
      };
    });
    await page.goto(address);
    // It plays by itself, for who has not asked for stillness, and the tube is drawn flat.
    await until(page, () => window.viewer?.measured.clock > 4);
    assert(await page.isVisible("#flat"));
    const first = await pixels(page);
    assert(first.edges > 0.005 && first.coloured > 0.01, `of the flat stage ${first.edges} are edges, ${first.coloured} coloured`);
    await until(page, () => window.viewer?.measured.clock > 5);
    assert.notEqual((await pixels(page)).sum, first.sum);
    await shoot(page, "no-webgl");
    await audit(page, "a run without WebGL");
    await context.close();
    await withoutScript(browser, address, async (text) => assert.match(await text.innerText("noscript"), /does not run/));
    end();
  }

  async function checkStudies(browser) {
    const results = new URL("../validation/results", import.meta.url).pathname;
    const { address, end } = await serve(results);
    const { page, close } = await open(browser, address, desk, () => window.study?.measured.places.length > 0);
    const names = await page.locator("#study option").allTextContents();
    const choose = async (begin) => {
      const at = names.findIndex((name) => name.startsWith(`${begin} (`));
      await page.selectOption("#study", String(at));
      const isShown = (name) => document.getElementById("facts").textContent.startsWith(`${name} ·`) && window.study.measured.places.length > 0;
      await until(page, isShown, begin);
      return page.evaluate(() => ({ ...window.study.measured, other: document.getElementById("other").value, value: document.getElementById("value").value }));
    };
    // Charts change with the theme as if the page had begun in it.
    await page.emulateMedia({ colorScheme: "dark" });
    await page.reload();
    await until(page, () => window.study?.measured.places.length > 0);
    const dark = await page.evaluate(() => document.querySelector("#charts canvas").toDataURL());
    for (const colorScheme of ["light", "dark"]) {
      await page.emulateMedia({ colorScheme });
      await until(page, ([dark, is]) => (document.querySelector("#charts canvas").toDataURL() === dark) === is, [dark, colorScheme === "dark"]);
    }
    await page.emulateMedia({ colorScheme: "light" });
    // What is right for one study is not taken to the next.
    await choose("elastic-yielding");
    const radius = await choose("radius");
    assert.notEqual(radius.other, "none");
    assert(radius.curves > 2, `${radius.curves} curves of four radii`);
    // Axes that say the same make no families of one point.
    for (const tied of ["back-flow", "sweep-up"]) {
      const study = await choose(tied);
      assert(study.points / study.curves > 1.5, `${tied}: ${study.points} points in ${study.curves} curves`);
    }
    assert.equal((await choose("divergence-coarse")).value, "transition_time");
    for (const silo of ["silo-feed", "silo-arches"]) assert.equal((await choose(silo)).value, "discharge_rate", silo);
    // What stands at the axes is written for a reader, and all that is chosen stands in a line.
    const labels = await page.locator("#value option, #x option, #other option").allTextContents();
    assert.deepEqual(labels.filter((label) => /[\^_]/.test(label)), []);
    for (const wide of ["wavelength", "branches-12x16"]) {
      await choose(wide);
      const tops = await page.$$eval("#choices label:not([hidden])", (all) => all.map((it) => Math.round(it.getBoundingClientRect().top)));
      assert.equal(new Set(tops).size, 1, `${wide}: ${tops}`);
    }
    const { places } = await choose("branches-coarse");
    for (const place of [places[0], places[Math.floor(places.length / 2)]]) {
      await page.mouse.move(...place);
      await until(page, () => !document.getElementById("tip").hidden);
      const { x, y, width, height } = await page.locator("#tip").boundingBox();
      assert(place[0] < x || place[0] > x + width || place[1] < y || place[1] > y + height, "the tip covers its point");
    }
    await everyLook(page, "a study", pictures);
    // No curve joins tubes unlike each other.
    await choose("wall-stiffness");
    assert(await page.evaluate(() => new Set(window.study.points.map(({ tube }) => tube)).size > 1));
    for (const name of names) {
      await choose(name.split(" (")[0]);
      // Each tick is told from the next, and none is cut.
      const ticks = await page.evaluate(() => {
        const [{ chart }] = window.study.panels;
        const { context } = chart;
        const found = [];
        context.fillText = (text, x, y) => {
          if (context.textAlign === "right" && x < chart.box.left) found.push([text, x - context.measureText(text).width]);
          CanvasRenderingContext2D.prototype.fillText.call(context, text, x, y);
        };
        window.study.draw();
        delete context.fillText;
        return found;
      });
      assert(ticks.length > 1 && ticks.every(([, left]) => left >= 0), `${name}: ${ticks.join(" ")}`);
      assert.equal(new Set(ticks.map(([text]) => text)).size, ticks.length, `${name}: ${ticks.join(" ")}`);
      await shoot(page, `studies-${name.split(" (")[0]}`);
    }
    await close();
    end();
    await checkFigures(browser);
  }

  /** The figures of a reproduction. */
  async function checkFigures(browser) {
    const folder = join(runs, "reproduction");
    const made = spawnSync(program, ["reproduce", "--quick", "--only", "Q3", "--for", "2s", "--out", folder, "--quiet"]);
    assert(existsSync(join(folder, "claims.json")), String(made.stderr));
    const { address, end } = await serve(folder);
    const { page, close } = await open(browser, address, desk, () => window.study !== undefined);
    await until(page, () => !document.getElementById("view-figures").hidden);
    await page.click("#view-figures");
    await until(page, () => document.getElementById("view-figures").ariaPressed === "true");
    await everyLook(page, "figures", pictures);
    await close();
    end();
  }

  /** Milliseconds from the begin of a load to the first picture, at best of three. */
  async function firstLoad(browser, address) {
    const times = [];
    for (let k = 0; k < 3; k++) {
      const { page, close } = await open(browser, address, { ...desk, undrawn: true });
      await until(page, () => window.drawn > 0);
      times.push(await page.evaluate(() => window.drawn));
      await close();
    }
    return Math.min(...times);
  }

  async function checkFront(browser) {
    if (!existsSync(new URL("engine.wasm", WEB))) {
      console.log("skipped: the front page ('just web' makes it)");
      return;
    }
    const files = ["index.html", "viewer.css", "viewer.js", "worker.js", "engine.wasm"];
    const size = files.reduce((sum, name) => sum + gzipSync(readFileSync(new URL(name, WEB)), { level: 9 }).length, 0);
    console.log(`the front page: ${(size / 1000).toFixed(0)} kB compressed by gzip`);
    assert(size < 900e3, `${size} bytes`);
    const { address, end } = await serveFiles();
    // It is there within a second, and moves by itself, but for who asks for stillness.
    const drawn = await firstLoad(browser, address);
    console.log(`the front page: the tube is drawn after ${drawn.toFixed(0)} ms`);
    assert(drawn < 1000, `the front page takes ${drawn} ms`);
    const { page, close } = await open(browser, address, { ...desk, reducedMotion: "no-preference" });
    await until(page, () => window.viewer.measured.playing && window.viewer.measured.clock > 0.2);
    await everyLook(page, "the front page", pictures);
    const links = await page.evaluate(() => [...document.querySelectorAll("footer nav a")].map((link) => [link.textContent, link.getAttribute("href")]));
    for (const [, href] of links) assert(/^https:/.test(href) || existsSync(new URL(href, WEB)), `${href} is not there`);
    for (const name of ["Source", "Cite it", "The paper", "From Python"]) assert(links.some(([text]) => text === name), `no link: ${name}`);
    assert.equal(await page.locator(".chapter").count(), 4);
    await page.click("[data-chapter=jams]");
    await until(page, () => window.viewer.driven?.width < 2.51);
    await until(page, () => /jams between w = 2\.\d+ d and 2\.9 d/.test(document.querySelector(".chapter.now .said").textContent));
    await everyLook(page, "it jams", pictures);
    await page.click("[data-chapter=remembers]");
    await until(page, () => document.getElementById("sweep").ariaPressed === "true");
    await page.click("#sweep");
    await until(page, () => !window.viewer.measured.playing);
    // A link takes another visitor to the same bits.
    await page.click("#share");
    await until(page, () => document.getElementById("share-dialog").open);
    const link = await page.inputValue("#link");
    const { step, digest } = await measured(page);
    const embed = /src="([^"]+)"/.exec(await page.inputValue("#embed"))[1];
    await page.keyboard.press("Escape");
    const { page: other, close: closeOther } = await open(browser, link, desk);
    await until(other, (step) => window.viewer.measured.step === step, step);
    assert.equal((await measured(other)).digest, digest);
    await closeOther();
    await page.click("[data-chapter=friction]");
    await until(page, () => document.getElementById("title").textContent === "frictional" && window.viewer.measured.playing);
    await until(page, () => document.getElementById("speed").value === "0.3");
    await page.click("[data-chapter=begins]");
    await until(page, () => !document.getElementById("space-time-figure").hidden && window.viewer.measured.clock > 5);
    await until(page, () => document.querySelector("#published img").naturalWidth > 0);
    const { height: own } = await page.locator("#space-time").boundingBox();
    assert(own > 150, `the waves are drawn ${own} pixels high`);
    await everyLook(page, "where a jam begins", pictures);
    await close();
    const { page: embedded, close: closeEmbedded } = await open(browser, embed, { viewport: { width: 720, height: 420 } });
    assert(await embedded.isVisible("#slider-width") && !(await embedded.isVisible("#flow")));
    const drive = await embedded.locator(".drive").boundingBox();
    assert(Math.abs(drive.y + drive.height - 420) < 2, `the small version ends at ${drive.y + drive.height}`);
    await shoot(embedded, "embedded");
    await closeEmbedded();
    const { page: small, close: closeSmall } = await open(browser, address, phone);
    const [stage, slider] = [await small.locator("#stage").boundingBox(), await small.locator("#slider-width").boundingBox()];
    assert(slider.y - stage.y - stage.height < 200, "the slider is far below the tube");
    await closeSmall();
    await withoutScript(browser, address, async (text) => {
      assert.match(await text.innerText("body"), /A wave runs along a tube/);
      assert(await text.isVisible("footer noscript img"));
      await shoot(text, "front-no-script");
    });
    end();
  }

  return { more: checkMore, links: checkLinks, open: checkOpen, lost: checkLost, bare: checkBare, numbers: checkNumbers, studies: checkStudies, front: checkFront,
    ...widgetChecks({ serve, until, shoot, desk }) };
}

// The page as a widget of a notebook (source/widget.ts), beside a model that stands for anywidget's: what the other half in
// Python would compute comes from the program. Called by check.mjs.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { audit } from "./audit.mjs";

const asset = (name) => readFileSync(new URL(`../crates/viewer/assets/${name}`, import.meta.url), "utf8");

/** In the page: a model, the module's half of the widget in it, and what the module said. */
async function show({ parts, module }) {
  const traits = new Map([["_page", parts], ["height", 600]]);
  const hearers = new Set();
  window.said = [];
  window.hear = (text, bytes) => {
    for (const hear of hearers) hear(text === null ? {} : { text }, bytes ? [new DataView(Uint8Array.from(bytes).buffer)] : []);
  };
  const model = {
    get: (name) => traits.get(name),
    set: (name, value) => traits.set(name, value),
    save_changes: () => window.said.push(Object.fromEntries(["width", "playing", "speed"].map((name) => [name, traits.get(name)]))),
    send: (content) => window.said.push(content),
    on: (_, hear) => hearers.add(hear),
    off: (_, hear) => hearers.delete(hear),
  };
  const { default: widget } = await import(URL.createObjectURL(new Blob([module], { type: "text/javascript" })));
  window.end = widget.render({ model, el: document.body });
  window.hearers = hearers;
}

export function widgetChecks({ serve, until, shoot, desk }) {
  async function checkWidget(browser) {
    const { address, end } = await serve("frictionless", "--set", "tube.waves=2", "--set", "drive.width=2.6");
    const context = await browser.newContext(desk);
    const page = await context.newPage();
    const complaints = [];
    page.on("pageerror", (error) => complaints.push(error.message));
    page.on("console", (message) => message.type() === "error" && complaints.push(message.text()));
    page.on("request", (request) => /^(https?|wss?):/.test(request.url()) && complaints.push(`asks ${request.url()}`));
    await page.setContent("<!doctype html><html lang=en><title>A notebook</title><main></main>");
    await page.evaluate(show, { parts: ["tube.html", "viewer.css", "viewer.js"].map(asset), module: asset("widget.js") });
    await until(page, () => window.said.includes("ready"));
    // What the kernel would send.
    const kernel = await context.newPage();
    let told = Promise.resolve();
    await kernel.exposeFunction("tell", (text, bytes) => {
      told = told.then(() => page.evaluate(([text, bytes]) => window.hear(text, bytes), [text, bytes])).catch(() => {});
    });
    await kernel.goto(`${address}icon.svg`);
    await kernel.evaluate(() => {
      window.socket = new WebSocket(new URL("live", location.href).href.replace("http", "ws"));
      window.socket.binaryType = "arraybuffer";
      window.socket.onmessage = ({ data }) => void (typeof data === "string" ? window.tell(data, null) : window.tell(null, [...new Uint8Array(data)]));
      return new Promise((open) => (window.socket.onopen = open));
    });
    await page.bringToFront();
    const command = (what) => kernel.evaluate((text) => window.socket.send(text), JSON.stringify(what));
    const inside = page.frames()[1];
    await inside.waitForFunction(() => window.viewer?.measured.pictures > 0);
    // The run is the notebook's: it does not begin by itself, and what a simulation of Python cannot do is not offered.
    await until(page, () => window.said.includes("next"));
    assert(!(await page.evaluate(() => window.said.some((it) => it.playing))), "it plays without being asked to");
    for (const button of ["#save", "#again", "#share"]) assert(!(await inside.isVisible(button)), `${button} is shown`);
    // What the simulation does is seen.
    await command({ type: "step" });
    await inside.waitForFunction(() => window.viewer.measured.step > 0 && window.viewer.measured.rows > 0);
    await command({ type: "steer", parameter: "width", value: 2.5 });
    await inside.waitForFunction(() => document.getElementById("slider-width").value === "2.5");
    // What the page does, the model gets.
    await inside.fill("#number-width", "2.4");
    await inside.press("#number-width", "Enter");
    await until(page, () => window.said.some((it) => it.width === 2.4));
    await inside.click("#play");
    await until(page, () => window.said.some((it) => it.playing === true));
    await inside.selectOption("#speed", "");
    await until(page, () => window.said.some((it) => it.speed === null));
    await inside.check("#contacts");
    await until(page, () => window.said.some((it) => it.type === "contacts" && it.shown));
    await inside.click("#forth");
    await until(page, () => window.said.some((it) => it.type === "step"));
    await shoot(page, "widget");
    await audit(inside, "a widget");
    await page.evaluate(() => window.end());
    assert.equal(await page.evaluate(() => window.hearers.size), 0);
    assert.deepEqual(complaints.filter((text) => !/GL Driver Message|GPU stall/.test(text)), []);
    await context.close();
    end();
  }

  return { widget: checkWidget };
}

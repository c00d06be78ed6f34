// The widget in a JupyterLab: node check-notebook.mjs PYTHON, an interpreter with jupyterlab and peristalsis[widget].
//
// A notebook is opened and run; its page is steered by hand and by cells, and either follows the other.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { launched } from "./chromium.mjs";

const [python, picture] = process.argv.slice(2);
assert(python, "usage: node check-notebook.mjs PYTHON [PICTURE]");
const folder = mkdtempSync(join(tmpdir(), "peristalsis-notebook-"));
const KERNEL = { name: "python3", display_name: "Python 3", language: "python" };
const cell = (source) => ({ cell_type: "code", execution_count: null, metadata: {}, outputs: [], source });
const CELLS = [
  "import peristalsis\nsim = peristalsis.Simulation.preset('frictionless', waves=2, width=2.6, seed=1)\nview = sim.view()\nview",
  "print('width', sim.width)",
  "sim.run(periods=2)\nprint('steps', sim.steps)",
  "view.width = 2.7",
];
writeFileSync(join(folder, "tube.ipynb"), JSON.stringify({ cells: CELLS.map(cell), metadata: { kernelspec: KERNEL }, nbformat: 4, nbformat_minor: 4 }));
const server = spawn(python, ["-m", "jupyterlab", "--no-browser", "--allow-root", "--expose-app-in-browser", "--port=0", "--ip=127.0.0.1", `--notebook-dir=${folder}`],
  { env: { ...process.env, HOME: folder } });
const address = await new Promise((found, lost) => {
  let text = "";
  server.stderr.on("data", (part) => {
    text += part;
    const known = /http:\/\/127\.0\.0\.1:\d+\/lab\?token=\w+/.exec(text);
    if (known) found(known[0]);
  });
  server.once("exit", () => lost(new Error(text)));
});
const browser = await launched();
try {
  const page = await browser.newPage({ viewport: { width: 1440, height: 1100 } });
  page.setDefaultTimeout(60000);
  await page.goto(address.replace("/lab?", "/lab/tree/tube.ipynb?"));
  await page.waitForFunction(() => window.jupyterapp?.shell.currentWidget?.context?.sessionContext?.isReady);
  /** Runs a cell; what it prints. */
  const run = (number) =>
    page.evaluate(async (number) => {
      const { shell, commands } = window.jupyterapp;
      const { context, content } = shell.currentWidget;
      await context.sessionContext.ready;
      content.activeCellIndex = number;
      await commands.execute("notebook:run-cell");
      return content.widgets[number].model.outputs.toJSON().map(({ text }) => [text].flat().join("")).join("");
    }, number);
  await run(0);
  const tube = await (await page.waitForSelector("iframe[title='The tube of this simulation']")).contentFrame();
  await tube.waitForFunction(() => window.viewer?.measured.pictures > 0);
  // What is done on the page, the simulation does.
  await tube.evaluate(() => {
    const slider = document.getElementById("slider-width");
    slider.value = "2.5";
    slider.dispatchEvent(new Event("input"));
  });
  await page.waitForTimeout(500);
  assert.match(await run(1), /width 2\.5\b/);
  // What the simulation does, the page shows.
  const printed = await run(2);
  assert.match(printed, /steps \d+/);
  const steps = Number(/steps (\d+)/.exec(printed)[1]);
  await tube.waitForFunction((steps) => window.viewer.measured.step === steps, steps);
  await run(3);
  await tube.waitForFunction(() => document.getElementById("slider-width").value === "2.7");
  // It plays while no cell runs.
  await tube.evaluate(() => document.getElementById("play").click());
  await tube.waitForFunction((steps) => window.viewer.measured.step > steps, steps);
  if (picture) await page.screenshot({ path: picture });
  console.log("the widget works in JupyterLab");
} finally {
  await browser.close();
  server.kill("SIGTERM");
  await new Promise((ended) => server.once("exit", ended));
  rmSync(folder, { recursive: true, force: true });
}

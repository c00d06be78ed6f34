// Screenshots of every state, to look at: node shoot.mjs PROGRAM FOLDER [preset] [--set ...]
import { spawn } from "node:child_process";
import { chromium } from "playwright-core";
const [program, folder, ...view] = process.argv.slice(2);
const served = spawn(program, ["view", ...view, "--saves", `${folder}/saves`]);
const address = await new Promise((found) => served.stdout.on("data", (text) => found(String(text).trim())));
const browser = await chromium.launch({ executablePath: "/usr/bin/chromium", args: ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
async function shoot(name, options, act) {
  const page = await (await browser.newContext(options)).newPage();
  page.on("console", (m) => console.log(name, m.type(), m.text()));
  page.on("pageerror", (e) => console.log(name, "pageerror", e.message));
  await page.goto(address);
  await page.waitForFunction(() => window.viewer.measured.pictures > 0, null, { timeout: 20000 });
  await act(page);
  await page.screenshot({ path: `${folder}/${name}.png`, fullPage: options.fullPage ?? false });
  console.log(name, JSON.stringify(await page.evaluate(() => window.viewer.measured)));
  await page.close();
}
const wide = { viewport: { width: 1440, height: 900 } };
const wait = (ms) => new Promise((done) => setTimeout(done, ms));
try {
  await shoot("start", wide, () => wait(700));
  await shoot("playing", wide, async (page) => {
    await page.selectOption("#speed", "3");
    await page.click("#play");
    await wait(7000);
  });
  await shoot("dark", { ...wide, colorScheme: "dark" }, async (page) => {
    const slider = await page.$("#number-width, #number-force_amplitude");
    await slider.fill(view[0] === "frictional" ? "0.006" : "2.6");
    await slider.press("Enter");
    await wait(9000);
    const box = await (await page.$("#stage")).boundingBox();
    for (let k = 0; k < 12; k++) {
      await page.mouse.click(box.x + box.width * (0.3 + 0.03 * k), box.y + box.height * 0.5);
      if (await page.isVisible("#grain")) break;
    }
    await page.check("#marks");
    await wait(500);
  });
  await shoot("phone", { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true, fullPage: true }, async (page) => {
    await wait(1500);
  });
  await shoot("saved", wide, async (page) => {
    await page.check("#lightness");
    await page.click("#save");
    await wait(1200);
  });
  await shoot("glass", wide, async (page) => {
    await page.selectOption("#wall", "glass");
    await page.click("#stage");
    for (let k = 0; k < 6; k++) await page.keyboard.press("a");
    for (let k = 0; k < 5; k++) await page.keyboard.press("+");
    await wait(500);
  });
} finally {
  await browser.close();
  served.kill("SIGINT");
}

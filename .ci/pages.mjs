// node pages.mjs CHROMIUM FOLDER [SHOTS]: looks at every FOLDER/*/index.html; SHOTS gets pictures of them.
import { readdirSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";
const require = createRequire(import.meta.url);
const puppeteer = require("puppeteer-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

const [executablePath, folder, shots] = process.argv.slice(2);
const profile = mkdtempSync(join(tmpdir(), "profile-"));
const browser = await puppeteer.launch({
  executablePath,
  userDataDir: profile,
  // A machine that does other work, too, may take its time.
  protocolTimeout: 600_000,
  args: ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
    "--disable-component-update", "--disable-sync", "--disable-dev-shm-usage"],
});
const faults = [];
const WIDTHS = [400, 900, 1600];

// Runs in the page: what is cut off, invisible or wider than the page.
const layout = () => {
  const wrong = [];
  const width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > width) wrong.push(`the page is ${document.documentElement.scrollWidth} px wide`);
  const figures = [...document.querySelectorAll("figure")];
  if (!figures.length) wrong.push("there is no figure");
  for (const figure of figures) {
    const drawing = figure.querySelector("svg.axes") ?? figure.querySelector(":scope > div > svg");
    const name = drawing?.getAttribute("aria-label") ?? figure.textContent.slice(0, 40);
    const box = drawing?.getBoundingClientRect();
    if (!box || box.width < 200 || box.height < 60) wrong.push(`«${name}» is ${box?.width} × ${box?.height} px`);
    else if (box.left < -0.5 || box.right > width + 0.5) wrong.push(`«${name}» reaches from ${box.left} to ${box.right} px`);
    else if (!drawing.checkVisibility({ visibilityProperty: true, opacityProperty: true })) wrong.push(`«${name}» is invisible`);
  }
  for (const chart of document.querySelectorAll("svg.axes")) {
    for (const text of chart.querySelectorAll("text")) {
      const box = text.getBoundingClientRect();
      if (box.left < -0.5 || box.right > width + 0.5) wrong.push(`«${text.textContent}» of «${chart.getAttribute("aria-label")}» is cut off`);
    }
  }
  return wrong;
};

const axeRun = async page => {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() => axe.run(document, { resultTypes: ["violations"] }));
  return violations.filter(v => ["serious", "critical"].includes(v.impact)).map(v => `${v.id}: ${v.help}: ${v.nodes.slice(0, 3).map(n => n.target.join(" ") + " " + (n.any[0]?.message ?? "")).join("; ")}`);
};

const move = async (page, selector, where) => {
  await page.$eval(selector, element => element.scrollIntoView({ block: "center" }));
  const box = await (await page.$(selector)).boundingBox();
  for (const [x, y] of where) {
    await page.mouse.move(box.x + box.width * x, box.y + box.height * y);
    const tip = await page.$eval(".tip", tip => tip.hidden ? "" : tip.textContent);
    if (/\d/.test(tip)) return tip;
  }
  return "";
};

// What a reader does: point, press keys, sort, hide, zoom.
const use = async (page, told) => {
  const grid = [...Array(24)].flatMap((_, i) => [...Array(16)].map((_, j) => [(i + 0.5) / 24, (j + 0.5) / 16]));
  if (await page.$("svg.axes")) {
    const tip = await move(page, "svg.axes", grid);
    if (!tip) told("no value under the pointer");
    await page.$eval("svg.axes", svg => svg.focus());
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    const output = await page.$eval("figure.chart output", output => output.textContent);
    if (!/\d/.test(output)) told("no value under the keys");
    await page.click("figure.chart .keys button");
    const hidden = await page.$eval("svg.plot g[data-layer]", layer => getComputedStyle(layer).visibility);
    if (hidden !== "hidden") told("a curve is not hidden");
    await page.click("figure.chart .keys button");
  }
  if (await page.$(".sheet svg .hint")) {
    await page.$eval(".sheet svg[tabindex]", svg => svg.focus());
    await page.keyboard.press("ArrowRight");
    const tip = await page.$eval(".tip", tip => tip.hidden ? "" : tip.textContent);
    if (!/\d/.test(tip)) told("no value of a figure that is a file");
    const place = await page.$eval(".sheet svg .hint", hint => { hint.scrollIntoView({ block: "center" }); const box = hint.getBoundingClientRect(); return [box.x + box.width / 2, box.y + box.height / 2]; });
    await page.mouse.move(0, 0);
    await page.mouse.move(...place);
    if (!/\d/.test(await page.$eval(".tip", tip => tip.hidden ? "" : tip.textContent))) told("no value of a figure under the pointer");
  }
  if (await page.$("figure[data-zoom]")) {
    const labels = () => page.$eval("figure[data-zoom] .xt", ticks => ticks.textContent);
    const before = await labels();
    await page.click("figure[data-zoom] .tools button");
    if ((await labels()) === before) told("it does not zoom");
    await page.$eval("figure[data-zoom] .tools button[aria-label='the whole record']", button => button.click());
  }
  const head = await page.$("table.sortable thead button");
  if (head) {
    const column = () => page.$eval("table.sortable:has(thead button)", table => [...table.tBodies[0].rows].map(row => row.cells[0].textContent));
    await head.click();
    const up = await column();
    await head.click();
    const down = await column();
    if (new Set(up).size > 1 && up.join() === down.join()) told("a table does not sort");
  }
};

for (const name of readdirSync(folder).filter(name => existsSync(join(folder, name, "index.html"))).sort()) {
  const file = resolve(folder, name, "index.html");
  const begun = Date.now();
  const size = statSync(file).size;
  if (size > 5e6) faults.push(`${name}: ${size} bytes`);
  for (const scheme of ["light", "dark"]) {
    const page = await browser.newPage();
    page.setDefaultTimeout(300_000);
    const told = fault => faults.push(`${name}, ${scheme}: ${fault}`);
    page.on("console", message => { if (["error", "warn"].includes(message.type())) told(`console: ${message.text()}`); });
    page.on("pageerror", error => told(`script: ${error.message}`));
    page.on("request", request => { if (!/^(file|data|blob):/.test(request.url())) told(`fetches ${request.url()}`); });
    await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
    for (const width of WIDTHS) {
      await page.setViewport({ width, height: 900 });
      if (width === WIDTHS[0]) await page.goto(pathToFileURL(file).href);
      (await page.evaluate(layout)).forEach(fault => told(`${width} px: ${fault}`));
      if (shots) {
        mkdirSync(shots, { recursive: true });
        await page.screenshot({ path: join(shots, `${name}-${scheme}-${width}.png`), fullPage: true });
      }
    }
    (await axeRun(page)).forEach(told);
    await use(page, told);
    if (scheme === "light") {
      const drawn = await page.$$eval("figure", figures => figures.length);
      const pdf = await page.pdf({ format: "A4", printBackground: true });
      await page.emulateMediaType("print");
      await page.setViewport({ width: 794, height: 1123 });
      (await page.evaluate(layout)).forEach(fault => told(`printed: ${fault}`));
      const sheets = (Buffer.from(pdf).toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length;
      if (sheets < drawn / 8 || pdf.length < 10_000) told(`printed: ${sheets} sheets, ${pdf.length} bytes for ${drawn} figures`);
      const blank = await page.evaluate(() => [...document.querySelectorAll("section")].filter(s => s.getBoundingClientRect().height < 20).map(s => s.id));
      if (blank.length) told(`printed: nothing in ${blank}`);
      if (shots) writeFileSync(join(shots, `${name}.pdf`), pdf);
    }
    await page.close();
  }
  console.log(`${name}: ${(size / 1e3).toFixed(0)} kB, looked at in ${((Date.now() - begun) / 1e3).toFixed(0)} s`);
}
await browser.close();
rmSync(profile, { recursive: true, force: true });
if (faults.length) {
  console.error(`${faults.length} faults:\n` + faults.join("\n"));
  process.exit(1);
}

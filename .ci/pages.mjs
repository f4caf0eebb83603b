// node pages.mjs CHROMIUM FOLDER [SHOTS]: looks at every FOLDER/*/index.html; SHOTS gets pictures of them.
import { spawnSync } from "node:child_process";
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
const layout = screen => {
  const wrong = [];
  const width = document.documentElement.clientWidth;
  if (document.documentElement.scrollWidth > width) wrong.push(`the page is ${document.documentElement.scrollWidth} px wide`);
  const figures = [...document.querySelectorAll("figure")];
  if (!figures.length) wrong.push("there is no figure");
  for (const figure of figures) {
    const drawing = figure.querySelector(":scope > div > svg");
    const name = drawing?.getAttribute("aria-label") ?? figure.textContent.slice(0, 40);
    const box = drawing?.getBoundingClientRect();
    // A drawing that is wider than a narrow screen scrolls in its frame.
    const frame = drawing?.parentElement.getBoundingClientRect();
    if (!box || box.width < 200 || box.height < 60) wrong.push(`«${name}» is ${box?.width} × ${box?.height} px`);
    else if (frame.left < -0.5 || frame.right > width + 0.5) wrong.push(`«${name}» reaches from ${box.left} to ${box.right} px`);
    else if (!drawing.checkVisibility({ visibilityProperty: true, opacityProperty: true })) wrong.push(`«${name}» is invisible`);
  }
  for (const drawing of document.querySelectorAll(".sheet svg")) {
    const page = drawing.getBoundingClientRect();
    const title = drawing.getAttribute("aria-label");
    for (const text of drawing.querySelectorAll("text")) {
      const box = text.getBoundingClientRect();
      if (box.left < page.left - 1 || box.right > page.right + 1) wrong.push(`«${text.textContent.trim()}» of «${title}» is cut off`);
    }
    const size = 16 * page.width / Number(drawing.getAttribute("width"));
    if (screen && size < 9) wrong.push(`letters of «${title}» are ${size.toFixed(1)} px high`);
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

// A reader points, presses keys, hides, zooms and sorts.
const use = async (page, reported) => {
  const grid = [...Array(24)].flatMap((_, i) => [...Array(16)].map((_, j) => [(i + 0.5) / 24, (j + 0.5) / 16]));
  const note = () => page.$eval(".tip", tip => tip.hidden ? "" : tip.textContent);
  for (const [kind, part] of [["frame", "[data-frame]"], ["mark", ".hint"]]) {
    const chosen = `.sheet svg:has(${part})`;
    if (!(await page.$(chosen))) continue;
    if (!(await move(page, `${chosen} ${part}`, kind === "frame" ? grid : [[0.5, 0.5]]))) reported(`no value of a ${kind} under the pointer`);
    await page.mouse.move(0, 0);
    await page.$eval(chosen, svg => svg.focus());
    await page.keyboard.press("ArrowRight");
    await page.keyboard.press("ArrowRight");
    if (!/\d/.test(await note())) reported(`no value of a ${kind} under the keys`);
    if (!/\d/.test(await page.$eval(`.sheet:has(${part}) output`, output => output.textContent))) reported(`no value of a ${kind} is read out`);
  }
  const entries = await page.$$(".sheet svg [data-hides]");
  for (const entry of entries) {
    const hidden = () => entry.evaluate(entry => {
      const groups = [...entry.closest("svg").querySelectorAll("[data-series]")].filter(group => group.dataset.series === entry.dataset.hides);
      return groups.length > 0 && groups.every(group => getComputedStyle(group).visibility === "hidden");
    });
    const name = await entry.evaluate(entry => entry.dataset.hides);
    const expect = async (wanted, how) => { if ((await hidden()) !== wanted) reported(`«${name}» is ${wanted ? "not hidden" : "hidden still"} by ${how}`); };
    await entry.evaluate(entry => entry.scrollIntoView({ block: "center", inline: "center" }));
    await entry.click();
    await expect(true, "the pointer");
    await entry.evaluate(entry => entry.focus());
    await page.keyboard.press("Enter");
    await expect(false, "the keys");
    await page.keyboard.press("Space");
    await expect(true, "the keys");
    await page.keyboard.press("Space");
  }
  if (await page.$(".tools")) {
    const labels = () => page.$eval(".sheet:has(.tools) [data-ticks]", ticks => ticks.textContent);
    const whole = await labels();
    await page.click(".tools button");
    if ((await labels()) === whole) reported("it does not zoom by a button");
    await page.$eval(".tools button[aria-label='the whole record']", button => button.click());
    await page.$eval(".sheet:has(.tools) [data-zooms]", frame => frame.scrollIntoView({ block: "center" }));
    const box = await (await page.$(".sheet:has(.tools) [data-zooms]")).boundingBox();
    const before = await labels();
    await page.mouse.move(box.x + 0.4 * box.width, box.y + 0.5 * box.height);
    await page.mouse.down();
    await page.mouse.move(box.x + 0.6 * box.width, box.y + 0.5 * box.height, { steps: 3 });
    await page.mouse.up();
    if ((await labels()) === before) reported("it does not zoom by dragging");
    await page.$eval(".tools button[aria-label='the whole record']", button => button.click());
  }
  const head = await page.$("table.sortable thead button");
  if (head) {
    const column = () => page.$eval("table.sortable:has(thead button)", table => [...table.tBodies[0].rows].map(row => row.cells[0].textContent));
    await head.click();
    const up = await column();
    await head.click();
    const down = await column();
    if (new Set(up).size > 1 && up.join() === down.join()) reported("a table does not sort");
  }
};

// Drawings that once ran a script where a page took them in, and elements that do so in every way that a browser knows.
const HOSTILE = [
  `<svg a=">" onload="document.title='PWNED'" width="9" height="9"></svg>`,
  `<svg/onload="document.title='PWNED'" width="9" height="9"></svg>`,
  "<svg a=\"'\" onload=document.title=`PWNED` b=\"'\" width=\"9\" height=\"9\"></svg>",
  `<svg xmlns="http://www.w3.org/2000/svg"><script>document.title='PWNED'</script></svg>`,
  `<svg xmlns="http://www.w3.org/2000/svg"><a href="javascript:document.title='PWNED'"><text y="9">x</text></a></svg>`,
  `<svg xmlns="http://www.w3.org/2000/svg"><animate onbegin="document.title='PWNED'" attributeName="x" dur="1s"/></svg>`,
  `<svg xmlns="http://www.w3.org/2000/svg"><foreignObject><iframe srcdoc="<script>parent.document.title='PWNED'</script>"></iframe></foreignObject></svg>`,
  `<svg xmlns="http://www.w3.org/2000/svg"><image href="x" onerror="document.title='PWNED'"/></svg>`,
  `<script>document.title='PWNED'</script><img src="x" onerror="document.title='PWNED'">`,
];

// Whether a script that is not a page's own runs where this page is opened, and its links are followed.
const runs = async (file, rules) => {
  const page = await browser.newPage();
  await page.setBypassCSP(!rules);
  let asked = false;
  page.on("dialog", dialog => { asked = true; dialog.dismiss(); });
  await page.goto(pathToFileURL(file).href);
  for (const link of await page.$$("a[href^='javascript'], svg a")) await link.evaluate(link => link.dispatchEvent(new MouseEvent("click", { bubbles: true })));
  await new Promise(resolve => setTimeout(resolve, 100));
  const title = await page.title();
  await page.close();
  return asked || title === "PWNED";
};

// Nothing runs on a page but its own script: what is put into it later does not, by the page's own rules.
const foreign = async file => {
  const attacked = join(profile, "attacked.html");
  let found = false;
  for (const hostile of HOSTILE) {
    writeFileSync(attacked, readFileSync(file, "utf8").replace("<main", `${hostile}<main`));
    found ||= await runs(attacked, true);
  }
  return found;
};

// A browser that ran none of them without such rules would show nothing.
const bare = join(profile, "bare.html");
let harmful = 0;
for (const hostile of HOSTILE) {
  writeFileSync(bare, `<!doctype html><title>bare</title><main>${hostile}</main>`);
  harmful += Number(await runs(bare, false));
}
console.log(`${harmful} of ${HOSTILE.length} hostile drawings run a script on a page without rules`);
if (harmful < 6) faults.push(`only ${harmful} hostile drawings run anything: they prove nothing`);

// A report whose drawings were changed: no page, or one on which nothing of them runs.
const [program, report] = process.argv.slice(5);
if (program) {
  const figures = readdirSync(report).filter(name => name.endsWith(".svg")).map(name => join(report, name));
  for (const hostile of HOSTILE) {
    figures.forEach(figure => writeFileSync(figure, hostile));
    rmSync(join(report, "index.html"), { force: true });
    rmSync(join(report, ".switchback.sha256"), { force: true });
    const { status } = spawnSync(program, ["report", report, "--quiet", "--force"], { stdio: "ignore" });
    const made = existsSync(join(report, "index.html"));
    if (status !== 0 && status !== 2) faults.push(`report ends with ${status} where a drawing is ${hostile}`);
    if (made && await runs(join(report, "index.html"), true)) faults.push(`a page that took in ${hostile} runs it`);
    if (made && await runs(join(report, "index.html"), false)) faults.push(`a page that took in ${hostile} runs it where its rules are switched off`);
  }
}

for (const name of readdirSync(folder).filter(name => existsSync(join(folder, name, "index.html"))).sort()) {
  const file = resolve(folder, name, "index.html");
  const begun = Date.now();
  const size = statSync(file).size;
  if (size > 5e6) faults.push(`${name}: ${size} bytes`);
  if (await foreign(file)) faults.push(`${name}: a script that is not the page's own runs`);
  for (const scheme of ["light", "dark"]) {
    const page = await browser.newPage();
    page.setDefaultTimeout(300_000);
    const reported = fault => faults.push(`${name}, ${scheme}: ${fault}`);
    page.on("console", message => { if (["error", "warn"].includes(message.type())) reported(`console: ${message.text()}`); });
    page.on("pageerror", error => reported(`script: ${error.message}`));
    page.on("request", request => { if (!/^(file|data|blob):/.test(request.url())) reported(`fetches ${request.url()}`); });
    await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
    for (const width of WIDTHS) {
      await page.setViewport({ width, height: 900 });
      if (width === WIDTHS[0]) await page.goto(pathToFileURL(file).href);
      (await page.evaluate(layout, true)).forEach(fault => reported(`${width} px: ${fault}`));
      if (shots) {
        mkdirSync(shots, { recursive: true });
        await page.screenshot({ path: join(shots, `${name}-${scheme}-${width}.png`), fullPage: true });
      }
    }
    (await axeRun(page)).forEach(reported);
    await use(page, reported);
    if (scheme === "light") {
      const drawn = await page.$$eval("figure", figures => figures.length);
      const pdf = await page.pdf({ format: "A4", printBackground: true });
      await page.emulateMediaType("print");
      await page.setViewport({ width: 794, height: 1123 });
      (await page.evaluate(layout, false)).forEach(fault => reported(`printed: ${fault}`));
      const sheets = (Buffer.from(pdf).toString("latin1").match(/\/Type\s*\/Page\b/g) ?? []).length;
      if (sheets < drawn / 8 || pdf.length < 10_000) reported(`printed: ${sheets} sheets, ${pdf.length} bytes for ${drawn} figures`);
      const blank = await page.evaluate(() => [...document.querySelectorAll("section")].filter(s => s.getBoundingClientRect().height < 20).map(s => s.id));
      if (blank.length) reported(`printed: nothing in ${blank}`);
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

// Opens pages in a headless Chromium and uses them as a reader does. Called by .ci/browser.
"use strict";
const assert = require("node:assert/strict");
const path = require("node:path");
const { pathToFileURL } = require("node:url");
const { chromium } = require("playwright-core");

const [work, ...pages] = process.argv.slice(2);
const DESK = { width: 1280, height: 800 };
const PHONE = { width: 390, height: 844 };
// A4 between margins of 1 cm, at 96 dots an inch.
const PAPER = { width: 718, height: 1046 };

// Opens a page; whatever goes wrong on it, and any request but for itself, is collected.
async function open(browser, file, options) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const wrong = [];
  page.on("console", m => ["error", "warning"].includes(m.type()) && wrong.push(m.text()));
  page.on("pageerror", e => wrong.push(String(e)));
  page.on("request", r => r.url() === pathToFileURL(file).href || wrong.push("request: " + r.url()));
  await page.goto(pathToFileURL(file).href);
  return { page, wrong, close: () => context.close() };
}

const fits = page => page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth);

// What is wider than its frame, so that a reader does not see all of it: tables, figures, answers, text.
const cut = page => page.evaluate(() => [...document.querySelectorAll(".scroll,.table,figure,.plot,.u-legend,.answers,nav,pre")]
  .filter(e => e.clientWidth > 0 && e.scrollWidth > e.clientWidth + 1)
  .map(e => `${e.tagName}.${e.className} ${e.scrollWidth} > ${e.clientWidth}: ${e.innerText.slice(0, 60)}`));
const unfold = page => page.evaluate(() => document.querySelectorAll("details").forEach(d => { d.open = true; }));

// A legend names its curves, and shows values only under the pointer.
const idle = figure => figure.locator(".u-legend").evaluate(legend => [...legend.querySelectorAll(".u-value")]
  .filter(value => getComputedStyle(value).visibility !== "hidden").map(value => value.textContent));
const range = (figure, key) => figure.evaluate((f, k) => [f.plot.scales[k].min, f.plot.scales[k].max], key);

// Brings a figure into view and waits for its canvas.
async function drawn(figure) {
  await figure.scrollIntoViewIfNeeded();
  await figure.locator("canvas").waitFor();
}

async function drag(page, figure, from, to) {
  const over = figure.locator(".u-over");
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  const y = box.y + box.height / 2;
  await page.mouse.move(box.x + from * box.width, y);
  await page.mouse.down();
  await page.mouse.move(box.x + to * box.width, y, { steps: 8 });
  await page.mouse.up();
}

// Of one interactive figure: the pointer's values, a zoom and back, a series hidden.
async function use(page, figure) {
  await drawn(figure);
  await page.mouse.move(0, 0);
  assert.deepEqual(await idle(figure), [], "no values where nothing points");
  const over = figure.locator(".u-over");
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  await page.mouse.move(box.x + 0.4 * box.width, box.y + box.height / 2);
  await page.waitForTimeout(60);
  const shown = await figure.locator(".u-value").allTextContents();
  assert.ok(shown.length >= 2 && shown.every(v => v !== "" && v !== "--"), `${await figure.locator(".title").first().textContent()}: a hover shows values: ${shown}`);

  const before = await range(figure, "x");
  await drag(page, figure, 0.3, 0.5);
  const zoomed = await range(figure, "x");
  const share = (zoomed[1] - zoomed[0]) / (before[1] - before[0]);
  const log = await figure.evaluate(f => f.plot.scales.x.distr === 3);
  assert.ok(log ? share < 1 : Math.abs(share - 0.2) < 0.02, `a drag over a fifth shows a fifth, not ${share}`);
  await page.mouse.dblclick(box.x + 0.5 * box.width, box.y + box.height / 2);
  await page.waitForTimeout(60);
  assert.deepEqual(await range(figure, "x"), before, "a double click shows all again");

  const name = figure.locator(".u-series th").nth(1);
  const visible = () => figure.evaluate(f => f.plot.series[1].show);
  await name.click();
  assert.equal(await visible(), false, "a click on its name hides a series");
  await name.press("Enter");
  assert.equal(await visible(), true, "the keyboard shows it again");
  return shown;
}

// On the page of a motion: the pointer on the peak of the tracking error says what the table says, which
// another program has written.
async function peak(page) {
  const figure = page.locator("figure", { hasText: /^Figure \d+ Tracking error/ }).first();
  const cell = page.locator("tr:has(th[scope=row])", { hasText: "tracking error" }).locator("td").first();
  if (!(await page.title()).startsWith("Motion of") || (await cell.count()) === 0) return;
  await drawn(figure);
  await figure.evaluate(f => {
    const u = f.plot;
    const at = u.data[1].reduce((best, v, k, all) => (Math.abs(v) > Math.abs(all[best]) ? k : best), 0);
    u.setCursor({ left: u.valToPos(u.data[0][at], "x"), top: 10 });
  });
  await page.waitForTimeout(60);
  const shown = await figure.locator(".u-value").nth(1).textContent();
  const plain = text => text.replace("\u00a0", " ").replace("\u2212", "");
  assert.equal(plain(shown), plain(await cell.textContent()), "the pointer's value is the table's");
}

// Figures that share their axis zoom together.
async function linked(page, figures) {
  const groups = new Map();
  for (const figure of figures) {
    const link = JSON.parse(await figure.locator("script").textContent()).link;
    if (link !== "") groups.set(link, [...(groups.get(link) ?? []), figure]);
  }
  const pair = [...groups.values()].find(group => group.length > 1);
  if (!pair) return "none linked";
  await drawn(pair[1]);
  await drawn(pair[0]);
  const before = await range(pair[1], "x");
  await drag(page, pair[0], 0.2, 0.4);
  await page.waitForTimeout(60);
  const [a, b] = [await range(pair[0], "x"), await range(pair[1], "x")];
  assert.notDeepEqual(b, before, "a zoom of one is a zoom of the other");
  await pair[0].locator(".u-over").dblclick();
  await page.mouse.move(0, 0);
  assert.deepEqual(await range(pair[1], "x"), before, "a double click shows all of both again");
  a.forEach((end, k) => assert.ok(Math.abs(end - b[k]) <= 1e-9 * Math.abs(a[1]), `${a} and ${b} are one range`));
  return "linked";
}

async function check(browser, file) {
  const name = path.basename(path.dirname(file)) + "-" + path.basename(file, ".html");
  const picture = what => path.join(work, `${name}-${what}.png`);

  const desk = await open(browser, file, { viewport: DESK, colorScheme: "light" });
  await desk.page.screenshot({ path: picture("first") });
  const all = desk.page.locator("figure:has(> script)");
  const figures = await all.all();
  const values = [];
  for (const figure of figures) {
    const folded = await figure.evaluate(f => f.closest("details:not([open])") !== null);
    if (!folded) values.push(await use(desk.page, figure));
  }
  await peak(desk.page);
  const links = await linked(desk.page, figures);
  await desk.page.evaluate(() => window.scrollTo(0, 0));
  await desk.page.screenshot({ path: picture("light"), fullPage: true });
  assert.ok(await fits(desk.page), "light: no scrolling sideways");
  await desk.page.emulateMedia({ media: "print" });
  assert.equal(await desk.page.locator(".plot:visible").count(), 0, "print shows the pictures");
  if (figures.length > 0) assert.ok(await desk.page.locator(".drawing svg:visible").count() > 0);
  await desk.page.pdf({ path: path.join(work, `${name}.pdf`) });
  assert.deepEqual(desk.wrong, []);
  await desk.close();

  for (const [what, options] of [
    ["desk", { viewport: DESK, colorScheme: "light" }],
    ["dark", { viewport: DESK, colorScheme: "dark" }],
    ["phone-dark", { viewport: PHONE, deviceScaleFactor: 2, hasTouch: true, isMobile: true, colorScheme: "dark" }],
    ["phone", { viewport: PHONE, deviceScaleFactor: 2, hasTouch: true, isMobile: true }],
    ["plain", { viewport: DESK, javaScriptEnabled: false }],
  ]) {
    const opened = await open(browser, file, options);
    if (what !== "plain") {
      for (const figure of await opened.page.locator("figure:has(> script):visible").all()) await drawn(figure);
      assert.ok(await fits(opened.page), `${what}: no scrolling sideways`);
      await unfold(opened.page);
      assert.deepEqual(await cut(opened.page), [], `${what}: nothing is cut off`);
    } else if (figures.length > 0) {
      assert.ok(await opened.page.locator(".drawing svg:visible").count() > 0, "without scripts the pictures show");
    }
    await opened.page.screenshot({ path: picture(what), fullPage: true });
    assert.deepEqual(opened.wrong, [], what);
    await opened.close();
  }
  // On paper: pictures in place of plots, every table whole.
  const paper = await open(browser, file, { viewport: PAPER });
  await paper.page.emulateMedia({ media: "print" });
  await unfold(paper.page);
  assert.deepEqual(await cut(paper.page), [], "print: nothing is cut off");
  await paper.page.screenshot({ path: picture("print"), fullPage: true });
  assert.deepEqual(paper.wrong, [], "print");
  await paper.close();
  console.log(`browser: ${name}: ${figures.length} figures, ${links}; under the pointer: ${(values[0] ?? []).join(" | ")}`);
}

(async () => {
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM,
    args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
      "--disable-component-update", "--disable-sync"],
  });
  try {
    for (const file of pages) await check(browser, file);
  } finally {
    await browser.close();
  }
})().catch(error => {
  console.error(`browser: ${error.stack ?? error}`);
  process.exit(1);
});

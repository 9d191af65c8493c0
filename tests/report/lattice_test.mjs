// The report of a real run through a lattice: what the program writes is what the page reads.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { kPhone, open, startBrowser } from "./browser.mjs";
import { kTop, scree, temporaryFolder } from "./folders.mjs";

let browser, place, report;

// cases/examples/averages_and_touch.toml with half the grains and a shorter drain: 3000 steps.
const kShortened = ["region.inside.max=[2.2e-3, 2.2e-3, 10e-3]", "stage.fill.count=1200", "stage.settle.time=4e-3", "stage.drain.max_time=20e-3",
  "time.step=8e-6", "output.average.filling.times=[2e-3]", "output.energy_ledger=true"];

before(async () => {
  place = temporaryFolder();
  const out = join(place.folder, "lattice");
  scree("run", join(kTop, "cases/examples/averages_and_touch.toml"), "--out", out, ...kShortened.flatMap((set) => ["--set", set]));
  report = join(out, "report.html");
  browser = await startBrowser();
});
after(async () => {
  await browser?.close();
  place?.remove();
});

const numbersIn = (texts) => texts.map((text) => Number(text.replace(" %", "").replace("−", "-"))).filter(Number.isFinite);

test("all its sections are there, without a complaint, wide and on a phone, which nothing makes scroll sideways", async () => {
  for (const viewport of [undefined, kPhone]) {
    const { page, troubles, close } = await open(browser, report, viewport ? { viewport } : {});
    const ids = await page.locator("main section").evaluateAll((all) => all.map((s) => s.id));
    for (const id of ["result", "case", "flow", "averages", "touch", "residence", "checks", "performance", "files"]) assert.ok(ids.includes(id), `${id} is missing`);
    assert.equal(await page.getByText("This section could not be made").count(), 0);
    assert.doesNotMatch(await page.locator("main").innerText(), /\bundefined\b|\bNaN\b|\[object/);
    assert.equal(await page.locator(".facts dd:empty").count(), 0, "a fact without a value");
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= (viewport ?? { width: 1280 }).width);
    assert.deepEqual(troubles, []);
    await close();
  }
});

test("both averages have their numbers and slices, the touch table its shares and counts", async () => {
  const { page, close } = await open(browser, report);
  assert.deepEqual(await page.locator("#averages h3").allTextContents(), ["Filling", "Lattice"]);
  const [filling] = numbersIn(await page.locator("#averages table").first().locator("tbody tr").first().locator("td").allTextContents());
  assert.ok(filling > 0.01 && filling < 0.7, `solid fraction ${filling}`);
  assert.ok((await page.locator("#averages img").count()) >= 4);
  const heads = await page.locator("#touch thead th").allTextContents();
  for (const head of ["Touched, share of time", "Never touched, share of area", "Out of reach, share of area", "Contacts at a time"]) assert.ok(heads.includes(head), head);
  const [touched, dead, out, contacts] = numbersIn(await page.locator("#touch tbody tr").first().locator("td").allTextContents());
  assert.ok(touched > 0 && touched < 100 && dead > 0 && dead <= 100 && out >= 0 && out <= dead && contacts > 0, `${touched}, ${dead}, ${out}, ${contacts}`);
  assert.ok((await page.locator("#touch img").count()) >= 4);
  await close();
});

test("no particle is lost and the energy ledger closes", async () => {
  const { page, close } = await open(browser, report);
  assert.equal(await page.locator("#checks .fails").count(), 0, await page.locator("#checks").innerText());
  assert.equal(await page.locator("#checks .holds", { hasText: "Energy" }).count(), 1);
  await close();
});

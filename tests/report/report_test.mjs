// The report in a browser: it opens offline without a complaint, its chart answers with the right numbers, it fits a phone.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";

import { kPhone, open, startBrowser } from "./browser.mjs";
import { addPicturesAndFields, discharged, kEnd, kOpen, kRate, makeKnownSweep, runSmallSweep, scree, temporaryFolder, writeRun } from "./folders.mjs";

let browser, place, full, swept, known;

before(async () => {
  browser = await startBrowser();
  place = temporaryFolder();
  full = writeRun(join(place.folder, "full"));
  addPicturesAndFields(full);
  scree("report", full);
  swept = runSmallSweep(place.folder);
  known = makeKnownSweep(place.folder);
});
after(async () => {
  await browser?.close();
  place?.remove();
});

const reportOf = (folder) => join(folder, "report.html");
const number = (text) => Number(/-?[\d.]+/.exec(text.replace("−", "-"))[0]);

// The read-out of the chart with this y label while the pointer is at `share` of its width.
const readOut = async (page, section, index, share) => {
  const over = page.locator(`#${section} .u-over`).nth(index);
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox();
  await page.mouse.move(box.x + share * box.width, box.y + box.height / 2);
  const chart = page.locator(`#${section} .chart`).nth(index);
  await page.evaluate(() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn))));
  return chart.locator(".u-value").allTextContents();
};

test("it opens without a message, an error or a request, in light and dark, wide and on a phone", async () => {
  for (const colorScheme of ["light", "dark"]) {
    for (const viewport of [undefined, kPhone]) {
      const { page, troubles, close } = await open(browser, reportOf(full), { colorScheme, ...(viewport && { viewport }) });
      await page.mouse.wheel(0, 20000);
      await page.waitForTimeout(200);
      assert.deepEqual(troubles, []);
      await close();
    }
  }
});

test("the steady mass flow, its error and its window stand first, in the largest letters", async () => {
  const { page, close } = await open(browser, reportOf(full));
  assert.equal(await page.locator("main section").first().locator(".big").textContent(), "8.00 ± 0.23 g/s");
  assert.match(await page.locator("#result").textContent(), /from 0\.200 s to 0\.400 s/);
  const largest = await page.evaluate(() => Math.max(...[...document.querySelectorAll("main *, header *")].filter((e) => !e.closest(".big")).map((e) => parseFloat(getComputedStyle(e).fontSize))));
  assert.ok(await page.evaluate(() => parseFloat(getComputedStyle(document.querySelector(".big")).fontSize)) > largest);
  await close();
});

test("a hover reads the curve's values at that time", async () => {
  const { page, close } = await open(browser, reportOf(full));
  for (const share of [0.1, 0.45, 0.8]) {
    const [time, rate] = await readOut(page, "flow", 0, share);
    const t = number(time);
    assert.ok(Math.abs(t - share * 0.5) < 0.01, `${time} at ${share} of the axis`);
    assert.ok(Math.abs(number(rate) - (t > kOpen ? kRate * 1e3 : 0)) < 0.02, `${rate} at ${time}`);
    const [again, mass] = await readOut(page, "flow", 1, share);
    assert.ok(Math.abs(number(mass) - discharged(number(again)) * 1e3) < 2e-3 * Math.max(1, discharged(t) * 1e3), `${mass} at ${again}`);
  }
  await close();
});

test("a drag zooms both charts, the button goes back", async () => {
  const { page, close } = await open(browser, reportOf(full));
  const over = page.locator("#flow .u-over").first();
  await over.scrollIntoViewIfNeeded();
  const box = await over.boundingBox(), y = box.y + box.height / 2;
  await page.mouse.move(box.x + 0.4 * box.width, y);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.6 * box.width, y, { steps: 5 });
  await page.mouse.up();
  for (const index of [0, 1]) {
    const [left] = await readOut(page, "flow", index, 0.02);
    assert.ok(Math.abs(number(left) - 0.2) < 0.02, `${left} at the left end of chart ${index}`);
  }
  await page.locator("#flow button.reset").first().click();
  const [left] = await readOut(page, "flow", 1, 0.02);
  assert.ok(number(left) < 0.03, `${left} at the left end after the button`);
  await close();
});

test("the choice of the averaging window changes the curve", async () => {
  const { page, close } = await open(browser, reportOf(full));
  const near = async () => number((await readOut(page, "flow", 0, 0.206))[1]);  // 3 ms after the opening
  const options = page.locator("#window option");
  await page.locator("#window").selectOption({ index: 0 });
  const sharp = await near();
  await page.locator("#window").selectOption({ index: (await options.count()) - 1 });
  assert.ok(sharp > 7.9 && (await near()) < 6, "the jump is sharp from row to row and smooth over a long window");
  await close();
});

test("no page scrolls sideways on a phone", async () => {
  const compared = join(place.folder, "compared.html");
  scree("report", full, join(swept, "rolling_cdt__seed_1"), join(swept, "rolling_epsd2__seed_2"), "--out", compared);
  for (const file of [reportOf(full), compared, reportOf(swept), reportOf(known), reportOf(join(swept, "rolling_cdt__seed_1"))]) {
    const { page, troubles, close } = await open(browser, file, { viewport: kPhone });
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= kPhone.width, file);
    assert.deepEqual(troubles, [], file);
    await close();
  }
});

test("sections stand for the files that are there, and only for those", async () => {
  const bare = writeRun(join(place.folder, "bare"));
  scree("report", bare);
  const ids = async (folder) => {
    const { page, close } = await open(browser, reportOf(folder));
    const found = await page.locator("main section").evaluateAll((all) => all.map((s) => s.id));
    await close();
    return found;
  };
  assert.deepEqual(await ids(full), ["result", "case", "flow", "meters", "pictures", "averages", "touch", "residence", "checks", "performance", "files"]);
  assert.deepEqual(await ids(bare), ["result", "case", "flow", "checks", "performance", "files"]);
});

test("pictures are in the page itself, with captions, and open large", async () => {
  const { page, close } = await open(browser, reportOf(full));
  const picture = page.locator("#pictures img");
  assert.match(await picture.getAttribute("src"), /^data:image\/png;base64,/);
  assert.ok(await picture.evaluate((img) => img.decode().then(() => img.naturalWidth === 1)));
  assert.equal(await page.locator("#pictures figcaption").textContent(), "Front speed, t = 0.35 s");
  await page.locator("#pictures button").click();
  assert.ok(await page.locator("dialog img").isVisible());
  await close();
});

test("touch maps, residence and retention are told as numbers", async () => {
  const { page, close } = await open(browser, reportOf(full));
  assert.deepEqual(await page.locator("#touch tbody tr").allTextContents(), ["Fibres62 %25 %5 %3001.5025.0", "Fibres, upper half90 %2 %––––", "Channel50 %10 %––––"]);
  assert.match(await page.locator("#residence").textContent(), /500 mg of 1\.00 g that entered/);
  const [time, share] = await readOut(page, "residence", 0, 0.5);
  assert.ok(Math.abs(number(time) - 0.2) < 0.11 && [2, 6].some((s) => Math.abs(number(share) - s) < 1e-6), `${share} at ${time}`);
  assert.deepEqual(await page.locator("#residence .table-box tbody tr").allTextContents(), ["5, 0, 103.0030", "0, 0, 101.0010"]);
  assert.equal(await page.locator("#residence figcaption").textContent(), "Times");
  await close();
});

test("averages tell what is at the junctions, where the fastest lanes run, and numbers that the page has no words for", async () => {
  const { page, troubles, close } = await open(browser, reportOf(full));
  assert.deepEqual(await page.locator("#averages .table-box tbody tr").allTextContents(), ["The whole box, outside fibres0.40030.0–", "Within one diameter above a junction (mean of 6)0.5000.3000.0100", "Within one diameter below a junction (mean of 6)0no grains–"]);
  const facts = await page.locator("#averages .facts > div").allTextContents();
  assert.deepEqual(facts.slice(0, 3), ["Granular temperature, m²/s²0.001", "Something new, kg0.25", "More of itlow 1 m, high 2 m"]);
  assert.match(facts[3], /2\.00 \(1\.50 to 2\.50 from layer to layer\) times the mean/);
  const [height, lane] = await readOut(page, "averages", 0, 0.5);
  assert.deepEqual([height, lane], ["1.00 mm", "3.00 mm, 2.00 × mean"]);
  assert.deepEqual(troubles, []);
  await close();
});

test("of many pictures an even choice is shown, and the page says how many there are besides", async () => {
  const many = writeRun(join(place.folder, "many"));
  addPicturesAndFields(many);
  rmSync(join(many, "pictures"), { recursive: true });
  mkdirSync(join(many, "pictures"));
  const png = Buffer.from("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg==", "base64");
  for (let k = 0; k < 100; ++k) writeFileSync(join(many, "pictures", `side_${String(k).padStart(4, "0")}.png`), png);
  scree("report", many);
  const { page, close } = await open(browser, reportOf(many));
  const captions = await page.locator("#pictures figcaption").allTextContents();
  assert.equal(captions.length, 24);
  assert.deepEqual([captions[0], captions[23]], ["Side 0000", "Side 0099"]);
  assert.match(await page.locator("#pictures .note").textContent(), /76 more in pictures\//);
  await close();
});

test("a run that was interrupted, failed or has not ended says so", async () => {
  for (const [name, changes, text] of [["stopped", { status: "interrupted" }, /was interrupted/], ["broken", { status: "failed", message: "a particle left the domain" }, /failed: a particle left the domain/], ["going", null, /has not ended/]]) {
    const folder = writeRun(join(place.folder, name), { changes });
    scree("report", folder);
    const { page, troubles, close } = await open(browser, reportOf(folder));
    assert.match(await page.locator(".warning").textContent(), text);
    assert.deepEqual(troubles, []);
    await close();
  }
});

test("a curve that falls short of the outlets' mass is an error, but where the run stopped between two samples", async () => {
  const mass_discharged_kg = discharged(kEnd) * 1.001;
  for (const [name, changes, fails, text] of [["short", { mass_discharged_kg }, 1, /Does not hold\. The curve ends at 3\.20000 g, the mass/], ["cut", { mass_discharged_kg, status: "interrupted" }, 0, /The curve ends at 3\.20000 g, its last sample/]]) {
    const folder = writeRun(join(place.folder, name), { changes });
    scree("report", folder);
    const { page, close } = await open(browser, reportOf(folder));
    assert.match(await page.locator("#checks").textContent(), text);
    assert.equal(await page.locator("#checks .fails").count(), fails);
    await close();
  }
});

test("a title of HTML is shown as text", async () => {
  const title = "</script><img src=x onerror=alert(1)><!--";
  const folder = writeRun(join(place.folder, "hostile"), { title });
  scree("report", folder);
  const { page, troubles, close } = await open(browser, reportOf(folder));
  assert.equal(await page.locator("h1").textContent(), title);
  assert.deepEqual(troubles, []);
  await close();
});

test("lost particles are told as a check that does not hold", async () => {
  const folder = writeRun(join(place.folder, "lost"), { changes: { lost_particles: 2 } });
  scree("report", folder);
  const { page, close } = await open(browser, reportOf(folder));
  assert.match(await page.locator("#checks .fails").textContent(), /2 lost/);
  await close();
});

test("the energy ledger is told as a check that holds or does not", async () => {
  const ledger = { kinetic_J: 1e-6, gravity_work_J: 2e-3, dissipated_by_friction_J: 1.5e-3, energy_residual_share: 1.5e-4, momentum_residual_share: 2.4e-6, tolerance: 1e-3, time_stepping_share: 0.1, time_stepping_tolerance: 0.2, closes: true };
  const closing = writeRun(join(place.folder, "closing"), { changes: { energy: ledger } });
  const open_ended = writeRun(join(place.folder, "open_ended"), { changes: { energy: { ...ledger, energy_residual_share: 0.02, closes: false } } });
  for (const [folder, state, text] of [
    [closing, "holds", "Holds. Energy: 0.015 % of the energy turned over is in no term of the ledger, 0.00024 % of the momentum; rounding explains up to 0.10 %. Finite time steps make 10 % of it, mostly work of dissipating forces booked half a step early (up to 20 % are held to be sound)."],
    [open_ended, "fails", "Does not hold. Energy: 2.0 % of the energy turned over is in no term of the ledger, 0.00024 % of the momentum; rounding explains up to 0.10 %. Finite time steps make 10 % of it, mostly work of dissipating forces booked half a step early (up to 20 % are held to be sound)."]]) {
    scree("report", folder);
    const { page, troubles, close } = await open(browser, reportOf(folder));
    assert.equal(await page.locator(`#checks .${state}`, { hasText: "Energy" }).textContent(), text);
    assert.deepEqual(await page.locator("#checks tbody td:first-child").allTextContents(), ["Gravity work", "Dissipated by friction", "Kinetic"]);
    assert.deepEqual(troubles, []);
    await close();
  }
  const both = join(place.folder, "ledgers.html");
  scree("report", full, closing, open_ended, "--out", both);
  const { page, close } = await open(browser, both);
  assert.deepEqual(await page.locator("#checks tbody td:last-child").allTextContents(), ["no ledger", "holds", "does not hold"]);
  await close();
});

test("several runs lie over one another from the moment the drain began, and what differs is listed", async () => {
  const other = writeRun(join(place.folder, "other"), { friction: 0.7, changes: { steady_mass_flow_kg_per_s: 6e-3 } });
  const page_file = join(place.folder, "two.html");
  scree("report", full, other, "--out", page_file);
  const { page, troubles, close } = await open(browser, page_file);
  const [time, one, two] = await readOut(page, "flow", 1, 0.6);
  assert.ok(Math.abs(number(one) - number(time) * kRate * 1e3) < 0.02, `${one} at ${time} after the opening`);
  assert.equal(one, two);
  const differences = await page.locator("#differences table").textContent();
  assert.match(differences, /pair\.glass\+glass\.sliding_friction/);
  assert.match(differences, /0\.7/);
  assert.match(await page.locator("#result table").textContent(), /8\.00 ± 0\.23.*6\.00 ± 0\.23/);
  assert.deepEqual(troubles, []);
  await close();
});

test("what many runs have to say one by one is folded away, opens with a click and fits a phone", async () => {
  const folders = ["first", "second", "third"].map((name) => writeRun(join(place.folder, name)));
  folders.forEach(addPicturesAndFields);
  const page_file = join(place.folder, "three.html");
  scree("report", ...folders, "--out", page_file);
  const { page, troubles, close } = await open(browser, page_file, { viewport: kPhone });
  assert.deepEqual(await page.locator("#pictures .gallery.small figcaption").allTextContents(), folders.map((_, k) => ` ${["first", "second", "third"][k]}: front speed, t = 0.35 s`));
  for (const id of ["pictures", "averages", "touch", "residence"]) {
    const folds = page.locator(`#${id} details`);
    assert.deepEqual(await folds.locator("summary").allTextContents(), [" first", " second", " third"], id);
    assert.ok(!(await folds.first().locator("img").first().isVisible()), id);
    for (let k = 0; k < 3; ++k) await folds.nth(k).locator("summary").click();
    assert.ok(await folds.last().locator("img").first().isVisible(), id);
  }
  assert.deepEqual(await readOut(page, "averages", 2, 0.5), ["1.00 mm", "3.00 mm, 2.00 × mean"]);
  assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= kPhone.width);
  assert.deepEqual(troubles, []);
  await close();
});

test("a sweep has a row for each combination, a chart for each parameter, and links to its runs", async () => {
  const { page, troubles, close } = await open(browser, reportOf(swept));
  assert.equal(await page.locator("#sweep tbody tr").count(), 2);
  assert.deepEqual(await page.locator("#sweep tbody a").evaluateAll((all) => all.map((a) => a.getAttribute("href"))), [
    "rolling_cdt__seed_1/report.html", "rolling_cdt__seed_2/report.html", "rolling_epsd2__seed_1/report.html", "rolling_epsd2__seed_2/report.html"]);
  assert.equal(await page.locator("#trends .chart").count(), 1);
  assert.deepEqual(troubles, []);
  await close();
});

test("a sweep's curves are means over its seeds with a band of one standard error, beside the reference", async () => {
  const { page, troubles, close } = await open(browser, reportOf(known));
  assert.deepEqual(await page.locator("#flow .chart").first().locator(".u-series .u-label").allTextContents(), ["time", "cdt", "epsd2", "measured"]);
  const [time, cdt, epsd2, measured] = await readOut(page, "flow", 0, 0.6);
  assert.deepEqual([cdt, epsd2, measured], ["7.0 ± 1.0 g/s", "5.000 g/s", "6.500 g/s"], `at ${time}`);
  const [again, mass] = await readOut(page, "flow", 1, 0.6);
  assert.ok(Math.abs(number(mass) - 7 * number(again)) < 0.05, `${mass} at ${again}`);
  assert.match(mass, /±/);
  // Coloured between the seeds' 6 and 8 g/s, bare above and below.
  const colours = await page.evaluate(() => {
    const canvas = document.querySelector("#flow canvas"), over = document.querySelector("#flow .u-over").getBoundingClientRect(), at = canvas.getBoundingClientRect();
    const ratio = canvas.width / at.width, top = 1.06 * 8;
    const x = Math.round((over.left - at.left + 0.7 * over.width) * ratio);
    const column = canvas.getContext("2d").getImageData(x, 0, 1, canvas.height).data;
    return [8.3, 7.7, 6.2, 5.5].map((rate) => Math.round((over.top - at.top + (1 - rate / top) * over.height) * ratio)).map((y) => column.slice(4 * y, 4 * y + 4).join());
  });
  assert.equal(colours[1], colours[2]);
  assert.notEqual(colours[0], colours[1]);
  assert.equal(colours[0], colours[3]);
  assert.deepEqual(troubles, []);
  await close();
});

test("a sweep tells flow, drain time and mass left against each parameter, with captions and the reference where it belongs", async () => {
  const { page, troubles, close } = await open(browser, reportOf(known));
  assert.deepEqual(await page.locator("#trends h3").allTextContents(), ["Steady mass flow against rolling", "Drain time to 95 % discharged against rolling", "Mass left in the end against rolling"]);
  assert.deepEqual(await page.locator(".caption").allTextContents(), ["As somebody's mass flow against rolling.", "As somebody's curves."]);
  const [, flow, measured] = await readOut(page, "trends", 0, 0.25);
  assert.deepEqual([flow, measured], ["7.0 ± 1.0 g/s", "6.500 g/s"]);
  // 95 % of 3.3 g at 8 g/s and of 2.5 g at 6 g/s: 0.3919 s and 0.3958 s.
  assert.equal((await readOut(page, "trends", 1, 0.25))[1], "393.9 ± 2.0 ms");
  assert.equal((await readOut(page, "trends", 2, 0.25)).length, 2, "no rate among masses");
  assert.match((await page.locator("#sweep tbody tr").allTextContents())[0], /^cdt7\.0 ± 1\.0393\.9 ± 2\.0100\.0seed 1, seed 2$/);
  assert.deepEqual(troubles, []);
  await close();
});

test("a run that jams has no drain time and does not shorten that of the others", async () => {
  const { page, close } = await open(browser, reportOf(makeKnownSweep(place.folder, { rolling_epsd2__seed_2: 0.2 })));
  assert.equal(await page.locator("#trends h3").nth(1).textContent(), "Drain time to 95 % discharged against rolling");
  assert.match(await page.locator("#trends").textContent(), /Drain time to 95 % discharged: 1 of the runs has none, as it did not flow long enough/);
  await close();
});

test("runs that end at a share of the mass are not said to show what stays", async () => {
  const short = join(place.folder, "short.toml"), out = join(place.folder, "short");
  writeFileSync(short, readFileSync(join(place.folder, "small.toml"), "utf8").replace("discharged_fraction = 1", "discharged_fraction = 0.01"));
  scree("sweep", short, "--out", out);
  const { page, close } = await open(browser, reportOf(out));
  assert.match(await page.locator("#trends").textContent(), /ends a run when 1 % of the mass has left/);
  assert.ok(!(await page.locator("#trends h3").allTextContents()).some((text) => text.startsWith("Mass left")));
  await close();
});

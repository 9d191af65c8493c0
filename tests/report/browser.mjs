// A headless browser that has no network, and pages whose every message, error and request is kept.
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const { chromium } = createRequire(`${process.env.SCREE_MODULES}/`)("playwright-core");

const kFlags = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];

export const kWide = { width: 1280, height: 900 };
export const kPhone = { width: 360, height: 740 };
const kPatience = 120e3;  // ms: beside other work a page of a second may take half a minute

export const startBrowser = () => chromium.launch({ executablePath: process.env.SCREE_BROWSER, args: kFlags });

// Opens a file. `troubles` grows with everything that a page must not do.
export const open = async (browser, file, { viewport = kWide, colorScheme = "light" } = {}) => {
  const context = await browser.newContext({ viewport, colorScheme });
  await context.setOffline(true);
  const page = await context.newPage();
  page.setDefaultTimeout(kPatience);
  const troubles = [], url = pathToFileURL(file).href;
  page.on("console", (message) => troubles.push(`console ${message.type()}: ${message.text()}`));
  page.on("pageerror", (error) => troubles.push(`error: ${error.message}`));
  page.on("request", (request) => { if (request.url() !== url && !request.url().startsWith("data:")) troubles.push(`request: ${request.url()}`); });
  await page.goto(url);
  await page.waitForSelector("footer:not(:empty)", { state: "attached" });
  return { page, troubles, close: () => context.close() };
};

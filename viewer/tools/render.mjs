// SPDX-License-Identifier: MIT
// Pictures of a run's viewer.html; called by scripts/render, which says how.

import { existsSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const kUsage = "usage: scripts/render [--size WxH] [--dark] [--view FRAGMENT] RUN_DIR OUT_PREFIX [FRAME...]\n";

function readArguments(words) {
  const options = { width: 1280, height: 800, scheme: "light", view: "ui=0" };
  const rest = [];
  for (let i = 0; i < words.length; ++i) {
    if (words[i] === "--dark") {
      options.scheme = "dark";
    } else if (words[i] === "--view" && i + 1 < words.length) {
      options.view = words[++i];
    } else if (words[i] === "--size" && /^[1-9]\d{1,3}x[1-9]\d{1,3}$/.test(words[i + 1] ?? "")) {
      [options.width, options.height] = words[++i].split("x").map(Number);
    } else if (words[i].startsWith("-")) {
      return null;
    } else {
      rest.push(words[i]);
    }
  }
  const [run, prefix, ...frames] = rest;
  if (!prefix || !frames.every((frame) => /^\d+$/.test(frame))) return null;
  return { ...options, run, prefix, frames: frames.length > 0 ? frames.map(Number) : [0] };
}

async function render({ run, prefix, frames, view, ...size }) {
  const file = resolve(run, "viewer.html");
  if (!existsSync(file)) throw new Error(`${file} is not there. Make it with: arris export ${run} --formats viewer`);
  const address = pathToFileURL(file).href;
  const browser = new Browser();
  try {
    const page = await browser.open(`${address}#frame=${frames[0]}&play=0&${view}`, size);
    const kShown = "document.documentElement.dataset.frame || document.documentElement.dataset.problem";
    await page.until(kShown);
    const last = await page.evaluate("Number(document.getElementById('scrub').max)");
    const problem = await page.evaluate("document.documentElement.dataset.problem ?? ''");
    if (problem) throw new Error(`${file}: ${problem}`);
    for (const frame of frames) {
      await page.evaluate(`location.hash = ${JSON.stringify(`frame=${frame}&play=0&${view}`)}`);
      await page.until(`document.documentElement.dataset.wanted === "${frame}"`, 2).catch(() => {
        throw new Error(`${file} does not hold frame ${frame} (it has ${last + 1})`);
      });
      await page.until(`document.documentElement.dataset.frame === "${frame}"`);
      await page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
      const picture = `${prefix}${String(frame).padStart(5, "0")}.png`;
      writeFileSync(picture, await page.screenshot());
      console.log(picture);
    }
  } finally {
    await browser.close();
  }
}

const options = readArguments(process.argv.slice(2));
if (!options) {
  process.stderr.write(kUsage);
  process.exit(2);
}
try {
  await render(options);
} catch (error) {
  process.stderr.write(`scripts/render: ${error.message}\n`);
  process.exit(1);
}

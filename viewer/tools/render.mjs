// SPDX-License-Identifier: MIT
// Makes pictures of a run's viewer.html; called by scripts/render, which documents the usage.

import { existsSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const kUsage = "usage: scripts/render [--size WxH] [--dark] [--view FRAGMENT] RUN_DIR OUT_PREFIX [FRAME...]\n";

// Parameters of a view, as listed in viewer/README.md, except the frame, which is an argument of its own.
const isNumber = (text) => text.trim() !== "" && Number.isFinite(Number(text));
const kNumber = { holds: isNumber, allowed: "a number" };
const kPositive = { holds: (text) => isNumber(text) && Number(text) > 0, allowed: "a number above 0" };
const oneOf = (...values) => ({ holds: (text) => values.includes(text), allowed: values.join(", ") });
const kView = {
  colour: oneOf("none", "strain", "contact"), top: kPositive, edges: oneOf("0", "1"), ui: oneOf("0", "1"),
  azimuth: kNumber, elevation: kNumber, zoom: kPositive, fit: oneOf("frame"), play: oneOf("0", "1"),
};

/** The error in a view's parameters, which the page would ignore silently; null if there is none. */
function findFault(view) {
  for (const [name, value] of new URLSearchParams(view)) {
    if (name === "frame") return "--view frame: frames stand behind OUT_PREFIX";
    if (!Object.hasOwn(kView, name)) return `--view ${name}: unknown; allowed: ${Object.keys(kView).join(", ")}`;
    if (!kView[name].holds(value)) return `--view ${name}=${value}: allowed: ${kView[name].allowed}`;
  }
  return null;
}

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

function write(picture, bytes) {
  try {
    writeFileSync(picture, bytes);
  } catch (error) {
    throw new Error(`${picture}: cannot be written (${error.code}); OUT_PREFIX begins with a folder that is there`);
  }
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
      write(picture, await page.screenshot());
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
const fault = findFault(options.view);
if (fault) {
  process.stderr.write(`scripts/render: ${fault}\n`);
  process.exit(2);
}
try {
  await render(options);
} catch (error) {
  process.stderr.write(`scripts/render: ${error.message}\n`);
  process.exit(1);
}

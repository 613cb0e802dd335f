// SPDX-License-Identifier: MIT
// Makes pictures of a run's viewer.html; called by scripts/render, which documents the usage.

import { spawn } from "node:child_process";
import { existsSync, writeFileSync } from "node:fs";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { Browser } from "./browser.mjs";

const kOptions = "[--size WxH] [--dark] [--view FRAGMENT]";
const kUsage = `usage: scripts/render ${kOptions} RUN_DIR OUT_PREFIX [FRAME...]\n` +
               `       scripts/render ${kOptions} [--fps N] [--quality N] --film FILE.mp4|.webm RUN_DIR [FRAME...]\n`;

// Parameters of a view, as listed in viewer/README.md, except the frame, which is an argument of its own.
const isNumber = (text) => text.trim() !== "" && Number.isFinite(Number(text));
const kNumber = { holds: isNumber, allowed: "a number" };
const kPositive = { holds: (text) => isNumber(text) && Number(text) > 0, allowed: "a number above 0" };
const kBox = {
  holds: (text) => text.split(",").length === 6 && text.split(",").every(isNumber), allowed: "x,y,z,x,y,z of two corners, m",
};
const oneOf = (...values) => ({ holds: (text) => values.includes(text), allowed: values.join(", ") });
const kView = {
  colour: oneOf("none", "checker", "strain", "speed", "contact"), top: kPositive, edges: oneOf("0", "1"), ui: oneOf("0", "1"),
  azimuth: kNumber, elevation: kNumber, zoom: kPositive, box: kBox, fit: oneOf("frame"), play: oneOf("0", "1"),
  eol: oneOf("0", "1"), obstacles: oneOf("0", "1"), view: oneOf("front", "side", "top", "first"),
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
    } else if (words[i] === "--film" && /\.(mp4|webm)$/.test(words[i + 1] ?? "")) {
      options.film = words[++i];
    } else if (words[i] === "--fps" && Number(words[i + 1]) > 0 && Number(words[i + 1]) <= 1000) {
      options.fps = Number(words[++i]);
    } else if (words[i] === "--quality" && /^\d{1,2}$/.test(words[i + 1] ?? "") && Number(words[i + 1]) <= 63) {
      options.quality = Number(words[++i]);
    } else if (words[i].startsWith("-")) {
      return null;
    } else {
      rest.push(words[i]);
    }
  }
  const run = rest.shift();
  const prefix = options.film ? options.film : rest.shift();
  if (!run || !prefix || !rest.every((frame) => /^\d+$/.test(frame))) return null;
  if (!options.film && (options.fps !== undefined || options.quality !== undefined)) return null;
  return { ...options, run, prefix, frames: rest.map(Number) };
}

function write(picture, bytes) {
  try {
    writeFileSync(picture, bytes);
  } catch (error) {
    throw new Error(`${picture}: cannot be written (${error.code}); OUT_PREFIX begins with a folder that is there`);
  }
}

/** Opens the run's page and returns it with the frames to show: the ones asked for, or `isAll`, or the first. */
async function openRun(browser, { run, frames, view, ...size }, isAll) {
  const file = resolve(run, "viewer.html");
  const page = await browser.open(`${pathToFileURL(file).href}#frame=${frames[0] ?? 0}&play=0&${view}`, size);
  await page.until("document.documentElement.dataset.frame || document.documentElement.dataset.problem");
  const problem = await page.evaluate("document.documentElement.dataset.problem ?? ''");
  if (problem) throw new Error(`${file}: ${problem}`);
  const meta = await page.evaluate(`(() => {
    const { frames, frames_per_second } = JSON.parse(document.getElementById("arris-meta").textContent);
    return { indices: frames.map(({ index }) => index), rate: frames_per_second };
  })()`);
  const wanted = frames.length > 0 ? frames : isAll ? meta.indices : [0];
  for (const frame of wanted)
    if (!meta.indices.includes(frame))
      throw new Error(`${file} does not hold frame ${frame} (it has ${meta.indices.length})`);
  return { page, wanted, rate: meta.rate / Math.max((meta.indices[1] ?? 1) - meta.indices[0], 1) };
}

/** Shows a frame and returns its picture: "png", "jpeg" or "webp". */
async function takePicture(page, frame, view, format) {
  await page.evaluate(`location.hash = ${JSON.stringify(`frame=${frame}&play=0&${view}`)}`);
  await page.until(`document.documentElement.dataset.frame === "${frame}"`);
  await page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
  return page.screenshot(format);
}

const kFormats = { ".jpg": "jpeg", ".webp": "webp", ".png": "png" };

async function takePictures(browser, options) {
  const { page, wanted } = await openRun(browser, options, false);
  const ending = Object.keys(kFormats).find((name) => options.prefix.endsWith(name));
  const prefix = ending ? options.prefix.slice(0, -ending.length) : options.prefix;
  for (const frame of wanted) {
    const picture = `${prefix}${String(frame).padStart(5, "0")}${ending ?? ".png"}`;
    write(picture, await takePicture(page, frame, options.view, kFormats[ending ?? ".png"]));
    console.log(picture);
  }
}

/** Pipes the frames' pictures to ffmpeg, which waits for each: memory holds a few of them at a time. */
async function makeFilm(browser, options) {
  const { page, wanted, rate } = await openRun(browser, options, true);
  const codec = options.film.endsWith(".mp4")
    ? ["-c:v", "libx264", "-preset", "slow", "-crf", String(options.quality ?? 20), "-movflags", "+faststart"]
    : ["-c:v", "libvpx-vp9", "-b:v", "0", "-crf", String(options.quality ?? 32)];
  const ffmpeg = spawn("ffmpeg", [
    "-y", "-loglevel", "error", "-f", "image2pipe", "-framerate", String(options.fps ?? rate), "-c:v", "png", "-i", "-",
    // Both codecs store colours at half the size, so width and height are made even.
    "-vf", "crop=trunc(iw/2)*2:trunc(ih/2)*2", "-pix_fmt", "yuv420p", ...codec, options.film,
  ], { stdio: ["pipe", "ignore", "pipe"] });
  let complaint = "";
  ffmpeg.stderr.on("data", (text) => (complaint = (complaint + text).slice(-1000)));
  ffmpeg.stdin.on("error", () => {}); // ffmpeg ended early; its exit status says so
  const ended = new Promise((done) => {
    ffmpeg.on("error", ({ code }) => done(code === "ENOENT" ? "it is not installed (Debian: apt-get install ffmpeg)" : code));
    ffmpeg.on("exit", (status) => done(status === 0 ? null : complaint.trim().split("\n").at(-1) || `status ${status}`));
  });
  for (const frame of wanted) {
    if (ffmpeg.exitCode !== null || !ffmpeg.stdin.writable) break;
    const picture = await takePicture(page, frame, options.view, "png");
    await new Promise((done) => ffmpeg.stdin.write(picture, done));
  }
  ffmpeg.stdin.end();
  const failure = await ended;
  if (failure) throw new Error(`${options.film}: ffmpeg could not write it: ${failure}`);
  console.log(options.film);
}

async function render(options) {
  if (!existsSync(options.run)) throw new Error(`${options.run} is not there: it is to be the folder of a run`);
  const file = resolve(options.run, "viewer.html");
  if (!existsSync(file)) throw new Error(`${file} is not there. Make it with: arris export ${options.run} --formats viewer`);
  const browser = new Browser();
  try {
    await (options.film ? makeFilm : takePictures)(browser, options);
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

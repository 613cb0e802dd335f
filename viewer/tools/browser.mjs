// SPDX-License-Identifier: MIT
// Drives a headless Chromium over a pipe by its DevTools protocol: only Chromium and Node must be installed.

import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const kAnswerSeconds = 60;
const kPictureQuality = 80; // of JPEG and WebP, per cent

export function findChromium() {
  const places = ["/usr/bin", "/usr/local/bin", "/snap/bin"];
  const names = ["chromium", "chromium-browser", "google-chrome"];
  const found = places.flatMap((place) => names.map((name) => join(place, name))).find(existsSync);
  if (!found) throw new Error("Chromium was not found. On Debian: apt-get install chromium");
  return found;
}

export class Browser {
  #process;
  #profile = mkdtempSync(join(tmpdir(), "arris-viewer-"));
  #next = 0;
  #waiting = new Map();
  #listeners = new Set();
  #log = "";

  /** `hasGraphics`: with WebGL, drawn by the processor so that every machine draws equal pixels. */
  constructor({ hasGraphics = true } = {}) {
    const graphics = hasGraphics ? ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
                                 : ["--disable-gpu", "--disable-software-rasterizer", "--disable-3d-apis"];
    // As root, Chromium's own sandbox cannot start; the pages shown are files of our own making.
    const sandbox = process.getuid?.() === 0 ? ["--no-sandbox"] : [];
    this.#process = spawn(findChromium(), [
      "--headless=new", "--remote-debugging-pipe", `--user-data-dir=${this.#profile}`, "--hide-scrollbars",
      "--disable-dev-shm-usage", "--no-first-run", "--disable-background-networking", "--mute-audio",
      ...graphics, ...sandbox, "about:blank",
    ], { stdio: ["ignore", "ignore", "pipe", "pipe", "pipe"] });
    this.#process.stderr.on("data", (text) => (this.#log = (this.#log + text).slice(-4000)));
    this.#process.on("exit", () => this.#abandon());
    this.#process.on("error", () => this.#abandon());
    let text = "";
    this.#process.stdio[4].setEncoding("utf8").on("data", (piece) => {
      const messages = (text + piece).split("\0");
      text = messages.pop();
      messages.forEach((message) => this.#receive(JSON.parse(message)));
    });
    this.#process.stdio[3].on("error", () => this.#abandon());
  }

  send(method, params = {}, sessionId = undefined) {
    const id = ++this.#next;
    return new Promise((resolve, reject) => {
      const timer = setTimeout(() => reject(new Error(`Chromium did not answer ${method}.\n${this.#log}`)),
                               1000 * kAnswerSeconds);
      this.#waiting.set(id, { resolve, reject, timer });
      this.#process.stdio[3].write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    });
  }

  onEvent(listener) {
    this.#listeners.add(listener);
  }

  /** Opens a page of this size in pixels; `scheme`: "light" or "dark". */
  async open(address, { width = 1280, height = 800, scheme = "light" } = {}) {
    const { targetId } = await this.send("Target.createTarget", { url: "about:blank" });
    const { sessionId } = await this.send("Target.attachToTarget", { targetId, flatten: true });
    const page = new Page(this, sessionId, targetId);
    await page.send("Page.enable");
    await page.send("Runtime.enable");
    await page.send("Log.enable");
    await page.send("Network.enable");
    await page.send("Emulation.setDeviceMetricsOverride", { width, height, deviceScaleFactor: 1, mobile: false });
    await page.setScheme(scheme);
    await page.go(address);
    return page;
  }

  async close() {
    const gone = new Promise((resolve) => this.#process.once("exit", resolve));
    this.send("Browser.close").catch(() => {});
    await gone;
    rmSync(this.#profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
  }

  #receive(message) {
    const waiting = this.#waiting.get(message.id);
    if (!waiting) {
      this.#listeners.forEach((listener) => listener(message));
      return;
    }
    this.#waiting.delete(message.id);
    clearTimeout(waiting.timer);
    if (message.error) waiting.reject(new Error(message.error.message));
    else waiting.resolve(message.result);
  }

  #abandon() {
    for (const { reject, timer } of this.#waiting.values()) {
      clearTimeout(timer);
      reject(new Error(`Chromium ended.\n${this.#log}`));
    }
    this.#waiting.clear();
  }
}

export class Page {
  #browser;
  #session;
  #target;
  #onLoad = () => {};
  requests = []; // addresses the page asked for
  dialogs = 0; // alerts it opened
  problems = []; // errors and warnings in its console

  constructor(browser, session, target) {
    [this.#browser, this.#session, this.#target] = [browser, session, target];
    browser.onEvent(({ method, params, sessionId }) => {
      if (sessionId !== session) return;
      if (method === "Page.loadEventFired") this.#onLoad();
      if (method === "Runtime.exceptionThrown") this.problems.push(params.exceptionDetails.text);
      if (method === "Runtime.consoleAPICalled" && ["error", "warning"].includes(params.type))
        this.problems.push(params.args.map(({ value }) => value).join(" "));
      if (method === "Log.entryAdded" && params.entry.level === "error") this.problems.push(params.entry.text);
      if (method === "Network.requestWillBeSent") this.requests.push(params.request.url);
      if (method === "Page.javascriptDialogOpening") {
        ++this.dialogs;
        this.send("Page.handleJavaScriptDialog", { accept: true }).catch(() => {});
      }
    });
  }

  send(method, params = {}) {
    return this.#browser.send(method, params, this.#session);
  }

  /** Loads an address and waits until the page is loaded completely. */
  async go(address) {
    const loaded = new Promise((resolve) => (this.#onLoad = resolve));
    const { errorText } = await this.send("Page.navigate", { url: address });
    if (errorText) throw new Error(`${address}: ${errorText}`);
    await loaded;
  }

  setScheme(scheme) {
    return this.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-color-scheme", value: scheme }] });
  }

  /** The value of an expression in the page; a promise is awaited. */
  async evaluate(expression) {
    const { result, exceptionDetails } =
      await this.send("Runtime.evaluate", { expression, awaitPromise: true, returnByValue: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Waits until an expression in the page is true; after a time limit throws an error that names the expression. */
  async until(expression, seconds = 30) {
    const end = Date.now() + 1000 * seconds;
    while (Date.now() < end) {
      if (await this.evaluate(`Boolean(${expression})`)) return;
      await new Promise((resolve) => setTimeout(resolve, 25));
    }
    throw new Error(`Not true within ${seconds} s: ${expression}`);
  }

  async press(key, code = key) {
    const text = key.length === 1 ? key : undefined;
    await this.send("Input.dispatchKeyEvent", { type: "keyDown", key, code, text });
    await this.send("Input.dispatchKeyEvent", { type: "keyUp", key, code });
  }

  /** The page as bytes of a picture: "png", "jpeg" or "webp". */
  async screenshot(format = "png") {
    const quality = format === "png" ? {} : { quality: kPictureQuality };
    const { data } = await this.send("Page.captureScreenshot", { format, ...quality });
    return Buffer.from(data, "base64");
  }

  close() {
    return this.#browser.send("Target.closeTarget", { targetId: this.#target });
  }
}

// SPDX-License-Identifier: MIT
// The page: opens the run. On every screen refresh the clock selects the frame that is due, which is decoded and
// drawn. The address may choose the first view: viewer.html#frame=12&colour=strain&edges=1&ui=0 (see ../README.md).

import { Clock } from "./clock.js";
import { Cloth } from "./cloth.js";
import { onPaletteChange } from "./colours.js";
import {
  addNotice, firstTops, hideMessage, showAxes, showFacts, showHeading, showLegend, showMessage, showMoment,
} from "./panels.js";
import { Obstacles } from "./obstacles.js";
import { BrokenData } from "./blocks.js";
import { boxOf } from "./boxes.js";
import { Run } from "./run.js";
import { Stage } from "./stage.js";

const kModes = ["none", "checker", "strain", "speed", "contact"];
const kViewNames = ["front", "side", "top", "first"]; // keys 1 to 4
const kAhead = 4; // frames decoded before they are due
const kPlayIcon = "M4 2.5v11l9-5.5z";
const kPauseIcon = "M3.5 2.5h3.2v11H3.5zM9.3 2.5h3.2v11H9.3z";

const byId = (id) => document.getElementById(id);

class Viewer {
  #run = new Run(document);
  #stage = this.#openStage();
  #cloth = new Cloth();
  #obstacles = new Obstacles(this.#run);
  #clock = new Clock(this.#run.time(this.#run.frames.length - 1), this.#run.stride / this.#run.framesPerSecond);
  #wanted = 0; // position in the run's list of frames
  #shown = -1;
  #isLoading = true; // the obstacles, then one frame at a time
  #mode = "none";
  #hasEdges = false;
  #hasEol = true;
  #hasObstacles = true;
  #asked = null; // name and changes of the view of the whole run that is shown
  #tops = firstTops(this.#run);

  start() {
    this.#stage.add(this.#cloth.group);
    this.#stage.add(this.#obstacles.group);
    this.#stage.add(this.#obstacles.marks);
    this.#obstacles.load()
      .catch((error) => addNotice(error.message))
      .finally(() => (this.#isLoading = false));
    showHeading(this.#run);
    byId("scrub").max = this.#run.frames.length - 1;
    byId("obstacles").hidden = this.#run.obstacles.length === 0;
    byId("eol").hidden = !this.#run.hasEol;
    this.#setMode(this.#run.hasEol ? "checker" : "none");
    this.#connect();
    this.#resize();
    this.#view("first");
    if (!window.matchMedia("(prefers-reduced-motion: reduce)").matches && this.#run.frames.length > 1)
      this.#clock.play();
    this.#applyAddress();
    requestAnimationFrame((now) => this.#tick(now));
  }

  #openStage() {
    try {
      return new Stage(byId("stage"), this.#run);
    } catch (error) {
      throw new BrokenData("This browser gives the page no WebGL 2, which it needs to draw. Another browser, or " +
                           `hardware acceleration in this browser's settings, may help.\n\n(${error.message})`);
    }
  }

  #tick(now) {
    requestAnimationFrame((next) => this.#tick(next));
    this.#clock.tick(now);
    if (this.#clock.isPlaying) this.#wanted = this.#run.positionAt(this.#clock.time);
    this.#showPlaying();
    this.#bringFrame();
    if (this.#stage.draw()) showAxes(this.#stage.axes());
    const marks = document.documentElement.dataset; // state for scripts that watch the page
    marks.wanted = this.#run.frames[this.#wanted].index;
    marks.frame = this.#shown < 0 ? "" : this.#run.frames[this.#shown].index;
  }

  /** Shows the wanted frame if it is decoded. Otherwise decodes the frame; until then the frame shown stays. */
  #bringFrame() {
    if (this.#wanted === this.#shown || this.#isLoading) return;
    const frame = this.#run.peek(this.#wanted);
    if (frame) {
      this.#showFrame(this.#wanted, frame);
      this.#decodeAhead();
      return;
    }
    const position = this.#wanted;
    this.#isLoading = true;
    this.#run.load(position)
      .then((loaded) => this.#showFrame(position, loaded), (error) => this.#showBroken(position, error))
      .finally(() => (this.#isLoading = false));
  }

  #decodeAhead() {
    if (!this.#clock.isPlaying) return;
    for (let step = 1; step <= kAhead; ++step) {
      const due = this.#clock.time + (step * Math.max(this.#clock.speed, 1) * this.#run.stride) / this.#run.framesPerSecond;
      const position = this.#run.positionAt(due);
      // A damaged frame is reported when it is due, not before.
      if (!this.#run.peek(position)) this.#run.load(position).catch(() => {});
    }
  }

  #showFrame(position, frame) {
    this.#shown = position;
    this.#cloth.show(frame);
    this.#obstacles.show(position, frame.poses);
    this.#stage.follow(this.#run.drift(position));
    this.#stage.aimShadow(this.#run.litBox(position));
    showMoment(this.#run, position);
    showFacts(this.#run, frame, this.#stage.cell);
    this.#showLegend();
    hideMessage();
  }

  #showBroken(position, error) {
    this.#shown = position;
    this.#cloth.hide();
    this.#obstacles.show(position);
    this.#stage.follow(this.#run.drift(position));
    this.#stage.isStale = true;
    showMoment(this.#run, position);
    showMessage(error.message);
  }

  /** Rebuilds the legend only if its content changed, because a rebuilt input would lose the text being typed. */
  #legendState = "";
  #showLegend(isForced = false) {
    const topology = this.#run.peek(this.#shown)?.topology;
    const features = {
      edges: this.#hasEol && topology?.edges.length > 0, corners: this.#hasEol && topology?.corners.length > 0,
      marks: this.#run.hasMarks,
    };
    const top = this.#tops[this.#mode];
    const state = JSON.stringify([this.#mode, top, features]);
    if (state === this.#legendState && !isForced) return;
    this.#legendState = state;
    showLegend(this.#run, this.#mode, top, features, (value) => this.#setTop(value));
    this.#refit();
  }

  #showPlaying() {
    const isPlaying = this.#clock.isPlaying;
    const play = byId("play");
    if (play.dataset.playing === String(isPlaying)) return;
    play.dataset.playing = isPlaying;
    play.setAttribute("aria-label", isPlaying ? "Pause" : "Play");
    byId("play-icon").setAttribute("d", isPlaying ? kPauseIcon : kPlayIcon);
  }

  #goTo(position) {
    this.#clock.pause();
    this.#wanted = Math.min(Math.max(position, 0), this.#run.frames.length - 1);
    this.#clock.time = this.#run.time(this.#wanted);
  }

  #togglePlay() {
    if (this.#clock.isPlaying) this.#clock.pause();
    else this.#clock.play();
  }

  #setLoop(isLooping) {
    this.#clock.isLooping = isLooping;
    byId("loop").setAttribute("aria-pressed", isLooping);
  }

  #setMode(mode) {
    this.#mode = mode;
    byId("colour").value = mode;
    this.#cloth.setMode(mode);
    if (mode in this.#tops) this.#cloth.setTop(this.#tops[mode]);
    this.#stage.isStale = true;
    this.#showLegend();
  }

  /** Sets the top of the present scale; modes without a scale have none. */
  #setTop(top) {
    if (!(this.#mode in this.#tops)) return;
    this.#tops[this.#mode] = top;
    this.#cloth.setTop(top);
    this.#stage.isStale = true;
    this.#showLegend(true);
  }

  #setEdges(areShown) {
    this.#hasEdges = areShown;
    byId("edges").setAttribute("aria-pressed", areShown);
    this.#cloth.setEdges(areShown);
    this.#stage.isStale = true;
  }

  #setEol(isShown) {
    this.#hasEol = isShown;
    byId("eol").setAttribute("aria-pressed", isShown);
    this.#cloth.setEol(isShown);
    this.#stage.isStale = true;
    this.#showLegend();
  }

  #setObstacles(areShown) {
    this.#hasObstacles = areShown;
    byId("obstacles").setAttribute("aria-pressed", areShown);
    this.#obstacles.group.visible = areShown;
    this.#stage.isStale = true;
  }

  #setSpeed(step) {
    const speed = byId("speed");
    speed.selectedIndex = Math.min(Math.max(speed.selectedIndex + step, 0), speed.options.length - 1);
    this.#clock.speed = Number(speed.value);
  }

  /** Fits the view again after the panels have changed, unless the reader has turned it. */
  #refit() {
    if (this.#asked && !this.#stage.isTurned) this.#view(this.#asked.name, this.#asked.view);
  }

  /** Fits the view to the cloth of the present frame. */
  #fit(view) {
    this.#asked = null;
    const drift = this.#run.drift(this.#wanted);
    this.#stage.fit([this.#run.frames[this.#wanted]], { ...view, isWhole: false, drift });
  }

  /** Turns to one of the preset views, of the whole run or of the box that `view` names. */
  #view(name, view = {}) {
    this.#asked = { name, view };
    this.#setInsets();
    const boxes = view.box ? [view.box] : this.#run.viewBoxes();
    this.#stage.fit(boxes, { view: name, ...view, isWhole: !view.box, isFixed: Boolean(view.box) });
  }

  /** Passes on what wide panels at the top and the bottom cover of the view. */
  #setInsets() {
    const isBare = document.body.classList.contains("bare");
    const boxes = isBare ? [] : ["heading", "display", "legend", "transport"]
      .map((id) => byId(id).getBoundingClientRect()).filter(({ width }) => width > window.innerWidth / 2);
    const height = Math.max(window.innerHeight, 1);
    const [above, below] = [boxes.filter(({ top }) => top < height / 2), boxes.filter(({ top }) => top >= height / 2)];
    this.#stage.setInsets(Math.max(0, ...above.map(({ bottom }) => bottom)) / height,
                          Math.max(0, ...below.map(({ top }) => height - top)) / height);
  }

  #resize() {
    this.#stage.resize(window.innerWidth, window.innerHeight, window.devicePixelRatio);
    this.#refit();
  }

  #connect() {
    const actions = {
      play: () => this.#togglePlay(),
      back: () => this.#goTo(this.#wanted - 1),
      on: () => this.#goTo(this.#wanted + 1),
      loop: () => this.#setLoop(!this.#clock.isLooping),
      edges: () => this.#setEdges(!this.#hasEdges),
      fit: () => this.#fit(),
      eol: () => this.#setEol(!this.#hasEol),
      obstacles: () => this.#setObstacles(!this.#hasObstacles),
    };
    for (const [id, action] of Object.entries(actions)) byId(id).addEventListener("click", action);
    byId("scrub").addEventListener("input", (event) => this.#goTo(event.target.valueAsNumber));
    byId("speed").addEventListener("change", (event) => (this.#clock.speed = Number(event.target.value)));
    byId("view").addEventListener("change", (event) => {
      this.#view(event.target.value);
      event.target.value = ""; // the same view may be asked for again
    });
    byId("colour").addEventListener("change", (event) => this.#setMode(event.target.value));
    window.addEventListener("keydown", (event) => this.#onKey(event, actions));
    window.addEventListener("resize", () => this.#resize());
    window.addEventListener("hashchange", () => this.#applyAddress());
    byId("stage").addEventListener("webglcontextlost", () =>
      showMessage("The browser took the graphics context away. Reload the page to go on."));
    onPaletteChange(() => {
      this.#cloth.usePalette();
      this.#obstacles.usePalette();
      this.#stage.usePalette();
      this.#showLegend(true);
    });
  }

  #onKey(event, actions) {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // Input fields keep their keys, and the space bar presses the focused button.
    const { target } = event;
    if (target.matches("select, input[type=number]")) return;
    if (event.key === " " && target.matches("button, summary")) return;
    const keys = {
      " ": actions.play, ArrowLeft: actions.back, ArrowRight: actions.on, e: actions.edges, f: actions.fit,
      l: actions.loop, s: actions.eol, o: actions.obstacles,
      "-": () => this.#setSpeed(-1), "+": () => this.#setSpeed(1), "=": () => this.#setSpeed(1), c: () => this.#setMode(kModes[(kModes.indexOf(this.#mode) + 1) % kModes.length]),
      Home: () => this.#goTo(0), End: () => this.#goTo(this.#run.frames.length - 1),
    };
    kViewNames.forEach((name, index) => (keys[index + 1] = () => this.#view(name)));
    const action = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action) return;
    event.preventDefault();
    action();
  }

  /** Applies the parameters in the address; invalid values are ignored. */
  #applyAddress() {
    const asked = new URLSearchParams(window.location.hash.slice(1));
    const number = (name) => {
      const text = asked.get(name);
      return text !== null && text.trim() !== "" && Number.isFinite(Number(text)) ? Number(text) : undefined;
    };
    if (number("frame") !== undefined) this.#goTo(this.#run.positionOf(number("frame")));
    if (asked.get("play") === "0") this.#clock.pause();
    if (kModes.includes(asked.get("colour"))) this.#setMode(asked.get("colour"));
    if (number("top") > 0) this.#setTop(number("top") / (this.#mode === "strain" ? 100 : 1));
    if (asked.has("edges")) this.#setEdges(asked.get("edges") === "1");
    if (asked.has("eol")) this.#setEol(asked.get("eol") === "1");
    if (asked.has("obstacles")) this.#setObstacles(asked.get("obstacles") === "1");
    const wasBare = document.body.classList.contains("bare");
    document.body.classList.toggle("bare", asked.get("ui") === "0");
    const zoom = number("zoom") > 0 ? Math.min(Math.max(number("zoom"), 0.01), 100) : undefined;
    const view = { azimuth: number("azimuth"), elevation: number("elevation"), zoom, box: boxOf(asked.get("box")) };
    const preset = kViewNames.includes(asked.get("view")) ? asked.get("view") : undefined;
    const isAsked = preset !== undefined || Object.values(view).some((value) => value !== undefined);
    if (asked.get("fit") === "frame") this.#fit({ ...view, view: preset });
    else if (isAsked || wasBare !== document.body.classList.contains("bare")) this.#view(preset ?? "first", view);
  }
}

function fail(error) {
  document.documentElement.dataset.problem = error.message;
  showMessage(error instanceof BrokenData ? error.message : `The viewer met an error of its own: ${error.message}`);
}

window.addEventListener("error", (event) => fail(event.error ?? new Error(event.message)));
window.addEventListener("unhandledrejection", (event) => fail(event.reason));
document.addEventListener("DOMContentLoaded", () => {
  if (!("DecompressionStream" in window))
    throw new BrokenData("This browser is too old for this page: it cannot unpack the frames (DecompressionStream).");
  new Viewer().start();
});

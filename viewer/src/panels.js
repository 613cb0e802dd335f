// SPDX-License-Identifier: MIT
// The panels around the picture: read-outs, legend, axes. All words of a run are set as text, never as markup.

import { kBeyond, kRamp, palette, roundUp } from "./colours.js";

const byId = (id) => document.getElementById(id);

function element(name, properties = {}, ...children) {
  const result = document.createElement(name);
  Object.assign(result, properties);
  result.append(...children);
  return result;
}

/** A number of digits fit for reading: 3 significant ones, without an exponent where it is not needed. */
function readable(value) {
  return String(Number(value.toPrecision(3))).replace("-", "\u2212");
}

export function percent(strain) {
  return `${readable(100 * strain)} %`;
}

function metres(length) {
  if (length >= 1) return `${readable(length)} m`;
  if (length >= 0.01) return `${readable(100 * length)} cm`;
  return `${readable(1000 * length)} mm`;
}

export function showHeading(run) {
  const title = run.title.trim() || "Untitled run";
  document.title = `${title} – Arris`;
  byId("title").textContent = title;
  const notices = [];
  if (run.stride !== 1)
    notices.push(`Shows ${run.frames.length} of ${run.runFrames} frames (one in ${run.stride}, and the last): ` +
                 "all of them would take more memory than a page should.");
  if (run.leftOut.length > 0)
    notices.push(`Without ${run.leftOut.join(", ")}: obstacles too large for a page.`);
  notices.forEach(addNotice);
}

/** Adds a remark on the whole run below its title. */
export function addNotice(text) {
  byId("notice").textContent = `${byId("notice").textContent} ${text}`.trim();
  byId("notice").hidden = false;
}

export function showFacts(run, frame, cell) {
  const { faces, edges } = frame.topology;
  const count = (number) => number.toLocaleString("en");
  const facts = [`${count(frame.positions.length / 3)} vertices`, `${count(faces.length / 3)} faces`];
  if (edges.length > 0) facts.push(`${count(edges.length / 2)} EOL edges`);
  if (cell !== null) facts.push(`grid ${metres(cell)}`);
  byId("facts").textContent = facts.join(" · ");
}

export function showMoment(run, position) {
  const digits = run.framesPerSecond > 100 ? 4 : 3;
  const end = run.time(run.frames.length - 1);
  byId("time").textContent = `${run.time(position).toFixed(digits)} / ${end.toFixed(digits)} s`;
  byId("frame").textContent = `frame ${run.frames[position].index} / ${run.runFrames - 1}`;
  byId("scrub").value = position;
  byId("scrub").setAttribute("aria-valuetext", `frame ${run.frames[position].index}`);
}

export function showMessage(text, isProblem = true) {
  byId("message").textContent = text;
  byId("message").classList.toggle("problem", isProblem);
  byId("message").hidden = false;
}

export function hideMessage() {
  byId("message").hidden = true;
}

/** The initial tops of the scales: round numbers that few faces or vertices of the run exceed. */
export function firstTops({ strain, speed }) {
  return {
    strain: roundUp(strain.typical > 0 ? strain.typical : Math.max(strain.greatest, 1e-3)),
    speed: roundUp(speed.typical > 0 ? speed.typical : Math.max(speed.greatest, 1e-3)),
  };
}

function key(className, colour, text) {
  const swatch = element("span", { className: `swatch ${className}` });
  swatch.style.background = colour;
  return element("div", { className: "key" }, swatch, text);
}

/** The scales: `heading`, a number's text, `unit` behind the input and the number of it that is 1. */
const kScales = {
  strain: { heading: "Greatest principal strain", text: percent, unit: "%", factor: 100, name: "percent",
    range: ({ strain }) => `in this run ${percent(strain.least)} to ${percent(strain.greatest)}` },
  speed: { heading: "Speed of the material", text: (speed) => `${readable(speed)} m/s`, unit: "m/s", factor: 1,
    name: "metres a second", range: ({ speed }) => `in this run up to ${readable(speed.greatest)} m/s` },
};

function scale(run, mode, top, onTop) {
  const { heading, text, unit, range } = kScales[mode];
  const bar = element("div", { className: "bar" });
  bar.style.setProperty("--ramp", kRamp.join(", "));
  const ticks = element("div", { className: "ticks" });
  for (const part of [1, 0.75, 0.5, 0.25, 0]) ticks.append(element("span", { textContent: text(part * top) }));
  return [
    element("h2", { textContent: heading }),
    key("", kBeyond, `above ${text(top)}`),
    element("div", { className: "scale" }, bar, ticks),
    element("label", { className: "faint" }, "scale up to ", topInput(mode, top, onTop), ` ${unit}`),
    element("div", { className: "faint range", textContent: range(run) }),
  ];
}

/** Lets the user type the top of the scale. A value that is not a positive number is replaced by the former one. */
function topInput(mode, top, onTop) {
  const { factor, name } = kScales[mode];
  const input = element("input", { type: "number", min: "0", step: "any", value: Number((factor * top).toPrecision(3)) });
  input.id = `${mode}-top`;
  input.setAttribute("aria-label", `Top of the ${mode} scale, ${name}`);
  input.addEventListener("change", () => onTop(input.valueAsNumber > 0 ? input.valueAsNumber / factor : top));
  return input;
}

/** Shows the legend. `mode`: quantity shown by colour; `features`: whether EOL { edges, corners } and marks are drawn. */
export function showLegend(run, mode, top, features, onTop) {
  const colours = palette();
  const parts = mode in kScales ? scale(run, mode, top, onTop) : [];
  if (mode === "contact") parts.push(key("", colours.contact, "pressed by a contact"), key("", colours.free, "free"));
  if (mode === "none" || mode === "checker") parts.push(key("", colours.front, "front"), key("", colours.back, "back"));
  if (features.edges) parts.push(key("line", colours.eol, "EOL edge"));
  if (features.corners) parts.push(key("dot", colours.eol, "EOL vertex on a corner"));
  if (features.marks) parts.push(key("", colours.mark, "crosses or touches"));
  byId("legend").dataset.mode = mode;
  byId("legend").replaceChildren(...parts);
}

const kAxisColours = ["#d8433b", "#3f9142", "#3a76d0"];

/** Draws the axes, given as in Stage.axes. Axes that point away from the viewer are drawn first and fainter. */
export function showAxes(axes) {
  const make = (name, attributes) => {
    const result = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [attribute, value] of Object.entries(attributes)) result.setAttribute(attribute, value);
    return result;
  };
  const order = [0, 1, 2].sort((a, b) => axes[a][2] - axes[b][2]);
  const parts = order.flatMap((axis) => {
    const [x, y, z] = axes[axis];
    const opacity = z < -0.2 ? 0.55 : 1;
    const text = make("text", { x: 29 * x, y: -29 * y, fill: kAxisColours[axis], opacity });
    text.textContent = "xyz"[axis];
    return [make("line", { x1: 0, y1: 0, x2: 21 * x, y2: -21 * y, stroke: kAxisColours[axis], opacity }), text];
  });
  byId("axes").replaceChildren(...parts);
}

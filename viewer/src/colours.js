// SPDX-License-Identifier: MIT
// The colours of the cloth, its lines and the strain scale, for a light and a dark page.

import { Color } from "three";

/**
 * The strain scale, in even steps of lightness from the grey of unstrained cloth to a deep red. Lightness decreases
 * monotonically, so the scale can be read without distinguishing hues. The scale begins light, which leaves room for
 * light and shadow on unstrained cloth.
 */
export const kRamp = ["#e9e6df", "#f6deaa", "#fbc672", "#f8a44a", "#ee7d35", "#d8562b", "#b53329", "#8a1a2c", "#5e0d2b"];
export const kBeyond = "#3b35e6"; // strains above the scale's top

const kLight = { front: "#4f8fc9", back: "#e0a458", edge: "#0d1b2a", eol: "#c2185b", contact: "#0a9b63",
                 free: "#c9ced6", sky: "#ffffff", floor: "#d8d0c6", gridLine: "#39424f", gridStrength: 0.3, shadow: 0.18,
                 obstacle: "#b9b4ac", obstacleLine: "#4a443c", mark: "#e5121f" };
const kDark = { front: "#5b9bd8", back: "#dba055", edge: "#05090f", eol: "#ff3db5", contact: "#14b877",
                free: "#b4bac4", sky: "#eaf0fa", floor: "#8f8a84", gridLine: "#aab6c6", gridStrength: 0.24, shadow: 0.42,
                obstacle: "#77736d", obstacleLine: "#d9d2c6", mark: "#ff3b44" };

const kScheme = window.matchMedia("(prefers-color-scheme: dark)");

export function palette() {
  return kScheme.matches ? kDark : kLight;
}

export function onPaletteChange(listener) {
  kScheme.addEventListener("change", listener);
}

/** `colour` as three linear components, which shaders use. */
export function linear(colour) {
  return new Color(colour);
}

const kRoundSteps = [1, 1.2, 1.6, 2, 2.4, 3, 4, 5, 6, 8, 10]; // quarters of these have few digits, too

/** The smallest round number that is not below `value`. */
export function roundUp(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * (kRoundSteps.find((step) => step * power >= value * (1 - 1e-9)) ?? 10);
}

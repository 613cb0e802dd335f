// SPDX-License-Identifier: MIT
// Reads the JSON element that lists the frames, and checks it. Code after this can rely on the types that the format
// defines (../README.md).

import { BrokenData, require } from "./blocks.js";

const kFormat = 3;

const isCount = (value) => Number.isSafeInteger(value) && value >= 0;
const isNumbers = (value, count) =>
  Array.isArray(value) && value.length === count && value.every((number) => Number.isFinite(number));

const isBox = (box) => isNumbers(box?.least, 3) && isNumbers(box.size, 3);

/**
 * Checks an obstacle's entry: one placement if it has no motion, otherwise one for each frame; if it deforms, the box
 * of its points for each frame.
 */
function isMesh(mesh, frameCount) {
  return typeof mesh?.name === "string" && isCount(mesh.points) && mesh.points > 0 && isCount(mesh.faces) &&
    isCount(mesh.segments) && isCount(mesh.lone_points) && isNumbers(mesh.size, 3) && Array.isArray(mesh.placements) &&
    [undefined, true].includes(mesh.mark) &&
    (mesh.placements.length === 1 || mesh.placements.length === frameCount) &&
    mesh.placements.every((placement) => isNumbers(placement, 12)) && (mesh.poses === undefined ||
      (Array.isArray(mesh.poses) && mesh.poses.length === frameCount && mesh.poses.every(isBox)));
}

/** Returns what the element holds; throws BrokenData if that is not a list of frames. */
export function readMeta(document) {
  const element = document.getElementById("arris-meta");
  require(element, "There is no run in this page: it is the viewer's template, or it was cut off.");
  let meta;
  try {
    meta = JSON.parse(element.textContent);
  } catch (error) {
    throw new BrokenData(`The list of frames is not valid JSON (${error.message}).`);
  }
  require(meta.format === kFormat, `The data have format ${meta.format}; this page reads format ${kFormat}.`);
  require(typeof meta.title === "string", "The run has no title.");
  require(meta.frames_per_second > 0, "The number of frames a second is not positive.");
  require(isCount(meta.run_frames) && isCount(meta.stride), "The number of frames is missing.");
  require(Number.isFinite(meta.strain?.least) && Number.isFinite(meta.strain.greatest) &&
          Number.isFinite(meta.strain.typical), "The range of strains is missing.");
  require(Number.isFinite(meta.typical_speed), "The typical speed is missing.");
  require(Array.isArray(meta.topologies) && meta.topologies.every((topology) =>
    isCount(topology.id) && isCount(topology.vertices) && isCount(topology.faces) && isCount(topology.edges) &&
    isCount(topology.corners) && isNumbers(topology.least, 2) && isNumbers(topology.size, 2)),
  "The list of meshes is damaged.");
  require(Array.isArray(meta.frames) && meta.frames.length > 0, "The run has no frames.");
  const known = new Set(meta.topologies.map((topology) => topology.id));
  for (const frame of meta.frames)
    require(isCount(frame.index) && known.has(frame.topology) &&
            isBox(frame) && isNumbers(frame.strain, 2) && Number.isFinite(frame.speed),
    "The list of frames is damaged.");
  meta.meshes ??= [];
  meta.left_out ??= [];
  require(Array.isArray(meta.meshes) && meta.meshes.every((mesh) => isMesh(mesh, meta.frames.length)) &&
          Array.isArray(meta.left_out) && meta.left_out.every((name) => typeof name === "string"),
  "The list of obstacles is damaged.");
  return meta;
}

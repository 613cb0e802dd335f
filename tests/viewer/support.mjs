// SPDX-License-Identifier: MIT
// Runs for the tests, made by the program that ARRIS_MAKE_RUN names, and a reader of their frames.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

export const directory = mkdtempSync(join(tmpdir(), "arris-viewer-test-"));
process.on("exit", () => rmSync(directory, { recursive: true, force: true }));

/** Makes a run of `frames` frames of cells x cells squares, with `obstacles` ("obstacles", "deforming" or
 * "marks") or without. Returns its directory. */
export function makeRun(name, { title = name, frames = 60, cells = 40, mostBytes, obstacles } = {}) {
  const program = process.env.ARRIS_MAKE_RUN;
  if (!program) throw new Error("ARRIS_MAKE_RUN must name the program made from make_run.cpp");
  const run = join(directory, name);
  execFileSync(program, [run, title, frames, cells, ...(mostBytes || obstacles ? [mostBytes ?? 72e6] : []),
                         ...(obstacles ? [obstacles] : [])].map(String));
  return run;
}

export function pageOf(run) {
  return readFileSync(join(run, "viewer.html"), "utf8");
}

/** Writes a changed page as a file and returns its path. */
export function writePage(name, page) {
  const path = join(directory, `${name}.html`);
  writeFileSync(path, page);
  return path;
}

/** A minimal document for Run: the script elements of a page by their id. */
export function documentOf(page) {
  const elements = new Map();
  for (const [, id, textContent] of page.matchAll(/<script type="[a-z/]+" id="([^"]+)">([^<]*)<\/script>/g))
    elements.set(id, { textContent });
  return { getElementById: (id) => elements.get(id) ?? null };
}

/** Reads a frame as `arris run` writes it: { positions, material, speed, strain, contact, faces, edges }. */
export function readPly(path) {
  const bytes = readFileSync(path);
  const end = bytes.indexOf("end_header\n") + "end_header\n".length;
  const header = bytes.toString("latin1", 0, end);
  const [n, m, e] = ["vertex", "face", "edge"].map((name) => Number(header.match(`element ${name} (\\d+)`)[1]));
  const frame = { positions: [], material: [], speed: [], strain: [], contact: [], faces: [], edges: [] };
  let at = end;
  for (let v = 0; v < n; ++v, at += 94) {
    frame.positions.push(bytes.readDoubleLE(at), bytes.readDoubleLE(at + 8), bytes.readDoubleLE(at + 16));
    frame.material.push(bytes.readDoubleLE(at + 24), bytes.readDoubleLE(at + 32));
    frame.speed.push(Math.hypot(...[64, 72, 80].map((offset) => bytes.readDoubleLE(at + offset))));
    frame.contact.push(bytes[at + 93]);
  }
  for (let f = 0; f < m; ++f, at += 37) {
    frame.faces.push(bytes.readInt32LE(at + 1), bytes.readInt32LE(at + 5), bytes.readInt32LE(at + 9));
    frame.strain.push(bytes.readDoubleLE(at + 13));
  }
  for (let i = 0; i < 2 * e; ++i, at += 4) frame.edges.push(bytes.readInt32LE(at));
  return frame;
}

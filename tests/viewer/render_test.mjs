// SPDX-License-Identifier: MIT
// Arguments that scripts/render refuses with one line each; no browser is needed.

import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { directory, makeRun } from "./support.mjs";

const kProgram = fileURLToPath(new URL("../../viewer/tools/render.mjs", import.meta.url));
const run = makeRun("rendered", { frames: 3, cells: 4 });

function render(...words) {
  const { status, stderr } = spawnSync(process.execPath, [kProgram, ...words], { encoding: "utf8" });
  return { status, line: stderr };
}

const kWrongViews = {
  side: /^scripts\/render: --view side: unknown; allowed: colour, .*fit.*\n$/,
  "ui=0&color=strain": /^scripts\/render: --view color: unknown; allowed: colour, .*\n$/,
  "colour=red": /^scripts\/render: --view colour=red: allowed: none, checker, strain, speed, contact\n$/,
  "azimuth=north": /^scripts\/render: --view azimuth=north: allowed: a number\n$/,
  "box=0,0,0,1,1": /^scripts\/render: --view box=0,0,0,1,1: allowed: x,y,z,x,y,z of two corners, m\n$/,
  "zoom=0": /^scripts\/render: --view zoom=0: allowed: a number above 0\n$/,
  "frame=3": /^scripts\/render: --view frame: frames stand behind OUT_PREFIX\n$/,
};
for (const [view, expected] of Object.entries(kWrongViews)) {
  test(`the view ${view} is refused in one line`, () => {
    const { status, line } = render("--view", view, run, join(directory, "p_"));
    assert.match(line, expected);
    assert.equal(status, 2);
  });
}

test("a folder without a viewer is refused in one line that says how to make one", () => {
  const { status, line } = render(directory, join(directory, "p_"));
  assert.match(line, /^scripts\/render: .*viewer.html is not there. Make it with: arris export .*\n$/);
  assert.equal(status, 1);
});

test("a folder that is not there is said to be missing", () => {
  const { status, line } = render(join(directory, "nowhere"), join(directory, "p_"));
  assert.match(line, /^scripts\/render: .*nowhere is not there: it is to be the folder of a run\n$/);
  assert.equal(status, 1);
});

test("every name that the viewer's address takes is one of a view", () => {
  const readme = readFileSync(new URL("../../viewer/README.md", import.meta.url), "utf8");
  const table = readme.slice(readme.indexOf("| name | value |"), readme.indexOf("## Pictures"));
  const names = [...table.matchAll(/^\| (.*?) \|/gm)].flatMap(([, cell]) => [...cell.matchAll(/`(\w+)`/g)].map((m) => m[1]));
  assert.ok(names.length >= 9, names.join());
  const { line } = render("--view", "side", run, join(directory, "p_"));
  for (const name of names.filter((name) => name !== "frame")) assert.match(line, new RegExp(`\\b${name}\\b`));
});

for (const words of [["--film", "film.avi"], ["--fps", "0", "--film", "film.mp4"], ["--quality", "20"]]) {
  test(`the words ${words.join(" ")} are answered with the usage`, () => {
    const { status, line } = render(...words, run, join(directory, "p_"));
    assert.match(line, /^usage: scripts\/render .*--film FILE/s);
    assert.equal(status, 2);
  });
}

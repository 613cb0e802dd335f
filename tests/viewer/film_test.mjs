// SPDX-License-Identifier: MIT
// Films by scripts/render --film, read back with ffmpeg's own tools.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { directory, makeRun } from "./support.mjs";

const kProgram = fileURLToPath(new URL("../../viewer/tools/render.mjs", import.meta.url));
const run = makeRun("filmed", { frames: 8, cells: 8 });
const render = (...words) => spawnSync(process.execPath, [kProgram, ...words], { encoding: "utf8" });

test("a film has every frame, the size asked for, and true time", () => {
  for (const [film, codec] of [["film.mp4", "h264"], ["film.webm", "vp9"]]) {
    const path = join(directory, film);
    const { status, stderr } = render("--size", "161x120", "--film", path, run);
    assert.equal(status, 0, stderr);
    const fields = execFileSync("ffprobe", ["-v", "error", "-count_frames", "-select_streams", "v", "-of", "csv=p=0",
      "-show_entries", "stream=codec_name,width,height,r_frame_rate,nb_read_frames", path], { encoding: "utf8" });
    assert.equal(fields.trim(), `${codec},160,120,24/1,8`);
    // Grey pictures of all frames: each differs from the one before.
    const pixels = execFileSync("ffmpeg", ["-v", "error", "-i", path, "-f", "rawvideo", "-pix_fmt", "gray", "-"]);
    const pictures = Array.from({ length: 8 }, (_, k) => pixels.subarray(k * 160 * 120, (k + 1) * 160 * 120));
    for (let k = 1; k < 8; ++k) {
      let changed = 0;
      pictures[k].forEach((value, i) => (changed += Math.abs(value - pictures[k - 1][i]) > 16));
      assert.ok(changed > 100, `${film}: frames ${k - 1} and ${k} differ in ${changed} pixels`);
    }
  }
});

test("a film that cannot be written is refused in one line", () => {
  const path = join(directory, "no_such_folder", "film.mp4");
  const { status, stderr } = render("--film", path, run);
  assert.match(stderr, /^scripts\/render: .*film\.mp4: ffmpeg could not write it: .*\n$/);
  assert.equal(status, 1);
  assert.ok(!existsSync(path));
});

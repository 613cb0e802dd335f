// SPDX-License-Identifier: MIT
// Compares the page's reader with the frames on disk, without a browser.

import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { deflateSync, inflateSync } from "node:zlib";
import { BrokenData } from "../../viewer/src/blocks.js";
import { boxOf } from "../../viewer/src/boxes.js";
import { Run, normalGroups } from "../../viewer/src/run.js";
import { documentOf, makeRun, pageOf, readPly } from "./support.mjs";

const kFloatRounding = 1e-7; // single precision, relative to the run's extent
const run = makeRun("reader", { frames: 30, cells: 12 });
const page = pageOf(run);
const open = (text) => new Run(documentOf(text));
const frameFile = (index) => join(run, "frames", `cloth_${String(index).padStart(5, "0")}.ply`);

test("every frame is what is on disk, to half a level of its box", async () => {
  const reader = open(page);
  assert.equal(reader.frames.length, 30);
  for (const position of [29, 0, 10, 11, 9, 10, 20]) {
    const [frame, truth, { size, strain }] =
      [await reader.load(position), readPly(frameFile(position)), reader.frames[position]];
    assert.equal(frame.positions.length, truth.positions.length);
    truth.positions.forEach((value, i) => {
      const error = Math.abs(frame.positions[i] + reader.origin[i % 3] - value);
      assert.ok(error <= 0.5001 * size[i % 3] / 65535 + kFloatRounding, `coordinate ${i}: ${error}`);
    });
    truth.strain.forEach((value, f) =>
      assert.ok(Math.abs(frame.strain[f] - value) <= 0.5001 * strain[1] / 65535 + kFloatRounding));
    truth.contact.forEach((value, v) => assert.equal((frame.contact[v >> 3] >> (v & 7)) & 1, value));
    const { least } = frame.topology; // the cloth of make_run is 1 m wide and moves with up to 2 m/s
    truth.material.forEach((value, i) =>
      assert.ok(Math.abs(frame.material[i] + least[i % 2] - value) <= 0.5001 / 65535 + kFloatRounding, `material ${i}`));
    truth.speed.forEach((value, v) => assert.ok(Math.abs(frame.speed[v] - value) <= 0.501 * 2 / 255, `speed ${v}`));
    assert.deepEqual([...frame.topology.faces], truth.faces);
    assert.deepEqual([...frame.topology.edges], truth.edges);
  }
});

test("frames are found by time and by number", () => {
  const reader = open(page);
  assert.equal(reader.time(29), 29 / 24);
  for (const rate of [24, 29.97, 1000 / 7, 0.3]) {
    const other = open(page.replace('"frames_per_second":24.0', `"frames_per_second":${rate}`));
    for (let k = 0; k < 30; ++k) assert.equal(other.positionAt(other.time(k)), k, `frame ${k} at ${rate} a second`);
  }
  assert.equal(reader.positionAt(12.9 / 24), 12);
  assert.equal(reader.positionAt(1e9), 29);
  assert.equal(reader.positionAt(-1), 0);
  const thin = open(pageOf(makeRun("thin", { frames: 30, cells: 12, mostBytes: 12000 })));
  assert.ok(thin.stride >= 4, `stride ${thin.stride}`);
  assert.equal(thin.frames.at(-1).index, 29);
  const indices = thin.frames.map((frame) => frame.index);
  for (let k = 0; k < 30; ++k) {
    const nearest = Math.min(...indices.map((index) => Math.abs(index - k)));
    assert.equal(Math.abs(indices[thin.positionOf(k)] - k), nearest, `frame ${k}`);
  }
});

test("normals are shared within the cloth and split along EOL edges", () => {
  // A fan of four faces around vertex 4, in the middle of the square 0 1 2 3.
  const faces = new Uint32Array([0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4]);
  const middle = [2, 5, 8, 11];
  const groupsOf = (edges) => middle.map((corner) => normalGroups(faces, new Uint32Array(edges), 5).groups[corner]);
  assert.equal(new Set(groupsOf([])).size, 1);
  assert.equal(new Set(groupsOf([0, 4])).size, 1, "an edge that ends at the vertex does not part its faces");
  const [a, b, c, d] = groupsOf([1, 4, 4, 3]);
  assert.ok(b === c && d === a && a !== b, "two edges part them in two");
  const { groups, groupCount } = normalGroups(faces, new Uint32Array([1, 4, 4, 3]), 5);
  assert.ok(groups.every((group) => group < groupCount));
});

const kBreaks = {
  "no meta": (text) => text.replace('id="arris-meta"', 'id="other"'),
  "meta cut off": (text) => text.replace('"run_frames"', ""),
  "another format": (text) => text.replace('"format":3', '"format":1'),
  "no frames": (text) => text.replace(/"frames":\[.*\]\}<\/script>/, '"frames":[]}</script>'),
  "a box that is no number": (text) => text.replace(/"least":\[[^\]]*\]/, '"least":[0,0,null]'),
  "a mesh that is not listed": (text) => text.replace('"topology":0', '"topology":77'),
  "no frames a second": (text) => text.replace('"frames_per_second":24.0', '"frames_per_second":0'),
};
for (const [name, damage] of Object.entries(kBreaks)) {
  test(`a list with ${name} is refused in words`, () => {
    assert.notEqual(damage(page), page);
    assert.throws(() => open(damage(page)), (error) => error instanceof BrokenData && error.message.length > 20);
  });
}

const block = /(id="arris-frame-0">)([^<]*)/;
const kFrameBreaks = {
  "missing data": (text) => text.replace('id="arris-frame-0"', 'id="other"'),
  "data that are no base64": (text) => text.replace(block, "$1*$2"),
  "data cut off": (text) => text.replace(block, (_, head, data) => head + data.slice(0, 400)),
  "no data": (text) => text.replace(block, "$1"),
  "damaged data": (text) => text.replace(block, (_, head, data) => `${head}${data.slice(0, 200)}AAAA${data.slice(204)}`),
  "another frame's length": (text) => text.replace('"vertices":169', '"vertices":170'),
  "too few vertices for its mesh": (text) => text.replace('"vertices":169', '"vertices":168'),
  "a missing mesh": (text) => text.replace('id="arris-topology-0"', 'id="other"'),
};
/**
 * Changes the first corner's vertex from 0 to 200 (there are 169). All other corners change too, as differences are
 * stored.
 */
kFrameBreaks["a mesh that names vertices that do not exist"] = (text) =>
  text.replace(/(id="arris-topology-0">)([^<]*)/, (_, head, data) => {
    const bytes = inflateSync(Buffer.from(data, "base64"));
    const count = bytes.length / 4;
    bytes[2 * count] = 400 >> 8;
    bytes[3 * count] = 400 & 255;
    return head + deflateSync(bytes).toString("base64");
  });

for (const [name, damage] of Object.entries(kFrameBreaks)) {
  test(`a frame with ${name} is refused by name, and the others are shown`, async () => {
    assert.notEqual(damage(page), page);
    const reader = open(damage(page));
    await assert.rejects(reader.load(0), (error) => error instanceof BrokenData && /^Frame 0 cannot be shown/.test(error.message));
    await reader.load(29);
  });
}

const obstaclesPage = pageOf(makeRun("obstacles", { frames: 25, cells: 6, obstacles: "obstacles" }));

test("obstacles are where make_run puts them", async () => {
  const reader = open(obstaclesPage);
  assert.deepEqual(reader.meshes.map(({ name, placements }) => [name, placements.length]),
                   [["table", 1], ["wire", 25], ["nails", 25]]);
  /** World positions of an obstacle's points at a frame. */
  const pointsAt = (index, { positions }, position) => {
    const m = reader.placement(reader.meshes[index], position);
    return Array.from({ length: positions.length / 3 }, (_, p) => [0, 1, 2].map((row) =>
      reader.origin[row] + m[4 * row + 3] +
      [0, 1, 2].reduce((sum, column) => sum + m[4 * row + column] * positions[3 * p + column], 0)));
  };
  const assertNear = (value, truth) => assert.ok(Math.abs(value - truth) < 1e-6, `${value}, not ${truth}`);

  const table = await reader.loadMesh(0);
  assert.equal(table.faces.length, 36);
  for (const position of [0, 24])
    for (const [x, y, z] of pointsAt(0, table, position)) {
      assertNear(Math.abs(x - 0.3), 0.25);
      assertNear(Math.abs(y - 0.5), 0.6);
      assertNear(Math.abs(z - 0.35), 0.05);
    }

  const wire = await reader.loadMesh(1);
  assert.deepEqual([...wire.segments], [0, 1, 1, 2]);
  // 24 frames a second: the last frame is at 1 s, turned by 0.5 rad about (1.1, 0.5).
  const [x, y, z] = pointsAt(1, wire, 24)[0];
  assertNear(x, 1.1 + 0.5 * Math.sin(0.5));
  assertNear(y, 0.5 - 0.5 * Math.cos(0.5));
  assertNear(z, 0.4);

  const nails = await reader.loadMesh(2);
  assert.deepEqual([...nails.lonePoints], [0, 1]);
  assertNear(pointsAt(2, nails, 12)[1][2], 0.5);
});

const deformingPage = pageOf(makeRun("deforming", { frames: 25, cells: 6, obstacles: "deforming" }));

test("an obstacle that deforms has its points in each frame", async () => {
  const reader = open(deformingPage);
  const [pole] = reader.meshes;
  assert.deepEqual([pole.name, pole.placements.length, pole.poses.length], ["pole", 1, 25]);
  const { faces, segments, lonePoints } = await reader.loadMesh(0);
  assert.deepEqual([faces.length, [...segments], [...lonePoints]], [36, [8, 9], [10]]);
  for (const position of [0, 24]) {
    const [points] = (await reader.load(position)).poses;
    const m = reader.placement(pole, position);
    const x = (p) => reader.origin[0] + m[3] + points[3 * p];
    const top = -0.3 - 0.5 * (position / 24);
    assert.ok(Math.abs(x(8) - top) < 1e-4, `${x(8)}, not ${top}`);
  }
});

test("view and light contain what an obstacle that deforms reaches", () => {
  const reader = open(deformingPage);
  const left = ({ least }) => least[0];
  const assertNear = (value, truth) => assert.ok(Math.abs(value - truth) < 1e-4, `${value}, not ${truth}`);
  assertNear(left(reader.litBox(0)), -0.35);
  assertNear(left(reader.litBox(24)), -0.85);
  assertNear(left(reader.surroundings), -0.85);
});

test("damaged points of an obstacle are refused with their frame and name, and other frames are shown", async () => {
  const reader = open(deformingPage.replace('id="arris-pose-0-3"', 'id="other"'));
  await assert.rejects(reader.load(3), (error) =>
    error instanceof BrokenData && /^Frame 3 cannot be shown: the points of the obstacle pole/.test(error.message));
  await reader.load(4);
});

test("a view shows the cloth and what is near of the obstacles", () => {
  const plain = open(page);
  assert.deepEqual(plain.surroundings, plain.bounds);
  const { surroundings, bounds } = open(obstaclesPage);
  assert.ok(surroundings.least[1] <= -0.1 + 1e-9, "the table's end is in it");
  const far = open(obstaclesPage.replace(/"size":\[0.5,1.2,0.1\d*\]/, '"size":[1e4,1e4,0.1]'));
  assert.notDeepEqual(far.surroundings, surroundings);
  const diagonal = Math.hypot(...bounds.size);
  assert.ok(Math.hypot(...far.surroundings.size) < 3 * diagonal, "a floor does not make the cloth a dot");
});

test("cloth that has left is not followed by the first view", () => {
  /** The page with its cloth lowered by another `drop` metres in each frame from the `first` one on. */
  const dropped = (text, first, drop) => text.replace(/(id="arris-meta">)([^<]*)/, (_, head, json) => {
    const meta = JSON.parse(json);
    meta.frames.forEach((frame, k) => (frame.least[2] -= drop * Math.max(0, k - first + 1)));
    return head + JSON.stringify(meta);
  });
  const lowest = (box) => box.least[2];

  const { surroundings } = open(obstaclesPage);
  const fallen = open(dropped(obstaclesPage, 12, 10));
  assert.ok(Math.hypot(...fallen.bounds.size) > 100, "it fell far");
  assert.ok(Math.hypot(...fallen.surroundings.size) < 1.2 * Math.hypot(...surroundings.size), "the view stays");
  assert.ok(lowest(open(dropped(obstaclesPage, 24, 0.3)).surroundings) < lowest(surroundings) - 0.1,
            "cloth that is still near is seen whole");
  const back = dropped(obstaclesPage, 12, 1).replace(/"least":\[[^\]]*\](?![^]*"least":)/, '"least":[0,0,0.4]');
  assert.ok(Math.hypot(...open(back).surroundings.size) > 10, "cloth that comes back is followed all the way");

  const free = open(dropped(page, 1, 10));
  const size = Math.hypot(...free.frames[0].size);
  assert.ok(Math.hypot(...free.bounds.size) > 100 && Math.hypot(...free.surroundings.size) < 5 * size,
            "free fall is followed for some of the cloth's sizes");
});

/** The obstacles' page with its cloth lowered by another `drop` metres in each frame from the 12th on. */
const falling = (drop) => open(obstaclesPage.replace(/(id="arris-meta">)([^<]*)/, (_, head, json) => {
  const meta = JSON.parse(json);
  meta.frames.forEach((frame, k) => (frame.least[2] -= drop * Math.max(0, k - 11)));
  return head + JSON.stringify(meta);
}));

test("the ground is at the lowest point in view, and where an obstacle is the floor there is no other", () => {
  const reader = open(obstaclesPage);
  assert.equal(reader.groundHeight(), Math.min(reader.bounds.least[2], 0.3), "the table's underside is at 0.3 m");
  const legs = open(obstaclesPage.replace(/"size":\[0.5,1.2,0.1\d*\]/, '"size":[0.5,0.6,1.1]'));
  assert.ok(Math.abs(legs.groundHeight() - (0.35 - 0.55)) < 1e-9, `${legs.groundHeight()}`);
  assert.equal(open(obstaclesPage.replace(/"size":\[0.5,1.2,0.1\d*\]/, '"size":[9,9,0.1]')).groundHeight(), null);
  assert.equal(falling(10).groundHeight(), null, "the cloth falls through every ground");
});

test("the camera follows cloth that leaves the stage, and no other", () => {
  const still = open(obstaclesPage);
  for (let k = 0; k < 25; ++k) assert.deepEqual(still.drift(k), [0, 0, 0]);
  const fallen = falling(10);
  assert.deepEqual(fallen.drift(5), [0, 0, 0]);
  const [x, y, z] = fallen.drift(24);
  assert.ok(x === 0 && y === 0 && z < -100, `${[x, y, z]}`);
});

test("the light covers whole obstacles near the cloth", () => {
  const reader = open(obstaclesPage);
  const { least, size } = reader.litBox(0);
  assert.ok(least[1] <= -0.1 + 1e-9 && least[1] + size[1] >= 1.1 - 1e-9, "the table from end to end");
});

test("neither light nor first view reaches for a floor, so that shadows stay fine and the cloth large", () => {
  const reader = open(obstaclesPage.replace(/"size":\[0.5,1.2,0.1\d*\]/, '"size":[4,4,0.1]'));
  for (const { least, size } of [reader.litBox(0), ...reader.viewBoxes()])
    assert.ok(least[1] > -0.2 && least[1] + size[1] < 1.2, `${least} ${size}`);
});

test("a vessel is an obstacle that the cloth ends in", () => {
  assert.equal(open(obstaclesPage).endsInVessel(), false);
  const tub = (size) => open(obstaclesPage.replace(/"size":\[0.5,1.2,0.1\d*\]/, `"size":${size}`)).endsInVessel();
  assert.equal(tub("[4,4,2]"), true);
  assert.equal(tub("[4,4,5]"), false, "it is a body that wears the cloth");
  assert.equal(tub("[4,4,0.1]"), false, "the cloth is above it");
  assert.equal(tub("[4,0.5,2]"), false, "the cloth reaches beyond it");
});

test("a box is read from two opposite corners", () => {
  assert.deepEqual(boxOf("1,2,3,0,4,-1"), { least: [0, 2, -1], size: [1, 2, 4] });
  for (const text of [null, "", "1,2,3,4,5", "1,2,3,4,5,", "1,2,3,4,5,x", "1,2,3,4,5,6,7"])
    assert.equal(boxOf(text), undefined, `${text}`);
});

test("a list of obstacles with a box of points too few or damaged is refused in words", () => {
  for (const damage of [
    (text) => text.replace(/"poses":\[\{[^}]*\},/, '"poses":['),
    (text) => text.replace(/"poses":\[\{"least":\[[^,]*,/, '"poses":[{"least":['),
  ]) {
    assert.notEqual(damage(deformingPage), deformingPage);
    assert.throws(() => open(damage(deformingPage)), /obstacles is damaged/);
  }
});

const kMeshBreaks = {
  "a placement that is none": (text) => text.replace(/"placements":\[\[[^,]*,/, '"placements":[[null,'),
  "too few placements": (text) => text.replace(/("name":"wire".*?"placements":\[)\[[^\]]*\],/, "$1"),
  "no points": (text) => text.replace('"points":8', '"points":0'),
};
for (const [name, damage] of Object.entries(kMeshBreaks)) {
  test(`a list of obstacles with ${name} is refused in words`, () => {
    assert.notEqual(damage(obstaclesPage), obstaclesPage);
    assert.throws(() => open(damage(obstaclesPage)), /obstacles is damaged/);
  });
}

test("a damaged obstacle is refused by name, and the others are shown", async () => {
  for (const damage of [
    (text) => text.replace('id="arris-mesh-0"', 'id="other"'),
    (text) => text.replace('"points":8', '"points":7'),
    (text) => text.replace('"points":8,"faces":12', '"points":4,"faces":16'),
  ]) {
    assert.notEqual(damage(obstaclesPage), obstaclesPage);
    const reader = open(damage(obstaclesPage));
    await assert.rejects(reader.loadMesh(0), (error) => error instanceof BrokenData && /^The obstacle table/.test(error.message));
    await reader.loadMesh(1);
  }
});

test("obstacles too large for a page are named, and do not cost the cloth its frames", () => {
  const reader = open(pageOf(makeRun("small", { frames: 5, cells: 6, obstacles: "obstacles", mostBytes: 120 })));
  assert.ok(reader.leftOut.includes("table"), reader.leftOut.join());
  assert.equal(reader.frames.at(-1).index, 4);
});

// SPDX-License-Identifier: MIT
// The panels at the sizes of windows and phones: nothing is cut off or covered, and the page has no faults that axe
// finds. axe-core is a development package (viewer/package.json); without it that test is not there.

import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";
import { Browser } from "../../viewer/tools/browser.mjs";
import { makeRun } from "./support.mjs";

const kAxe = new URL("../../viewer/node_modules/axe-core/axe.min.js", import.meta.url);
const kSizes = [[1280, 800], [844, 390], [390, 844], [320, 568]];
const kRounding = 0.51; // pixels
const run = makeRun("layout", { title: "A cloth with a rather long title over a table", frames: 40, cells: 20, obstacles: "obstacles" });
const browser = new Browser();
after(() => browser.close());

const open = (width, height, scheme = "light") => browser.open(
  `${pathToFileURL(join(run, "viewer.html")).href}#play=0&frame=30`, { width, height, scheme });
const kShown = `document.documentElement.dataset.frame === "30"`;

/** Names and rectangles [left, top, right, bottom] of the visible elements that match `selector`. */
const rectangles = (page, selector) => page.evaluate(`[...document.querySelectorAll(${JSON.stringify(selector)})]
  .filter((element) => element.checkVisibility()).map((element) => {
    const { left, top, right, bottom } = element.getBoundingClientRect();
    return { name: element.id || element.textContent, box: [left, top, right, bottom] };
  })`);

const meet = ([a, b, c, d], [e, f, g, h]) =>
  Math.min(c, g) - Math.max(a, e) > kRounding && Math.min(d, h) - Math.max(b, f) > kRounding;

function assertApart(things, size) {
  things.forEach(({ name, box }, i) => {
    const [left, top, right, bottom] = box;
    assert.ok(left >= -kRounding && top >= -kRounding && right <= size[0] + kRounding && bottom <= size[1] + kRounding,
              `${name} is cut off at ${size}: ${box}`);
    for (const other of things.slice(i + 1))
      assert.ok(!meet(box, other.box), `${name} and ${other.name} cover each other at ${size}: ${box}, ${other.box}`);
  });
}

for (const size of kSizes) {
  test(`panels and controls are whole and apart at ${size.join(" x ")}, and so is the cloth`, async () => {
    const page = await open(...size);
    await page.until(kShown);
    for (const colour of ["checker", "strain", "speed", "contact"]) {
      await page.evaluate(`location.hash = "play=0&frame=30&colour=${colour}"`);
      await page.until(`document.getElementById("legend").dataset.mode === "${colour}"`);
      const panels = await rectangles(page, ".panel, #axes");
      assert.ok(panels.length >= 4, panels.map(({ name }) => name).join());
      assertApart(panels, size);
      assertApart(await rectangles(page, ".panel button, .panel select, .panel input, .panel summary, .panel output, .panel .key, .panel .scale"), size);
      const tallest = Math.max(...panels.filter(({ box }) => box[1] < size[1] / 2).map(({ box }) => box[3]));
      const lowest = Math.min(...panels.filter(({ box }) => box[1] >= size[1] / 2).map(({ box }) => box[1]));
      assert.ok(lowest - tallest > 0.35 * size[1], `the picture has ${lowest - tallest} of ${size[1]} pixels`);
    }
    await page.evaluate(`document.getElementById("help").open = true`);
    const [help] = await rectangles(page, "#help dl");
    assertApart([help], size);
    assert.deepEqual(page.problems, []);
    await page.close();
  });
}

test("the page is the same for one who asks for less motion, but begins paused", async () => {
  const page = await open(320, 240);
  await page.send("Emulation.setEmulatedMedia", { features: [{ name: "prefers-reduced-motion", value: "reduce" }] });
  await page.go(pathToFileURL(join(run, "viewer.html")).href);
  await page.until(`document.documentElement.dataset.frame === "0"`);
  await new Promise((resolve) => setTimeout(resolve, 400));
  assert.equal(await page.evaluate("document.documentElement.dataset.frame"), "0");
  await page.close();
});

if (existsSync(kAxe)) {
  const axe = readFileSync(kAxe, "utf8");
  for (const scheme of ["light", "dark"]) {
    test(`axe finds no fault in the ${scheme} page`, async () => {
      for (const size of [kSizes[0], kSizes[2]]) {
        const page = await open(...size, scheme);
        await page.until(kShown);
        await page.evaluate(`document.getElementById("help").open = true`);
        await page.send("Runtime.evaluate", { expression: axe });
        const faults = await page.evaluate(`axe.run().then(({ violations }) => violations.map(({ id, nodes }) =>
          id + ": " + nodes.map(({ html }) => html.slice(0, 120)).join(" | ")))`);
        assert.deepEqual(faults, []);
        await page.close();
      }
    });
  }
}

// SPDX-License-Identifier: MIT
// Tests of the page in a browser: what a person sees and does.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, test } from "node:test";
import { pathToFileURL } from "node:url";
import { Browser } from "../../viewer/tools/browser.mjs";
import { makeRun, pageOf, writePage } from "./support.mjs";

const kTemplate = new URL("../../viewer/dist/viewer_template.html", import.meta.url);
const kHostileTitle = "</script><img src=x onerror=alert(1)>";
const run = makeRun("page", { title: kHostileTitle });
const html = pageOf(run);
const browser = new Browser();
after(() => browser.close());

const text = (id) => `document.getElementById("${id}").textContent`;
const shows = (frame) => `document.documentElement.dataset.frame === "${frame}"`;

async function open(fragment = "play=0&frame=0", path = join(run, "viewer.html"), options = {}) {
  return browser.open(`${pathToFileURL(path).href}#${fragment}`, options);
}

async function openFrame(frame, fragment = "", options = {}) {
  const page = await open(`play=0&frame=${frame}&${fragment}`, undefined, options);
  await page.until(shows(frame));
  return page;
}

/** Shares of a picture's pixels that pass each test. A test is a JavaScript expression in r, g, b. */
async function shares(page, tests) {
  await page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
  const picture = `data:image/png;base64,${(await page.screenshot()).toString("base64")}`;
  return page.evaluate(`(async () => {
    const image = new Image();
    image.src = ${JSON.stringify(picture)};
    await image.decode();
    const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const tests = [${tests.map((condition) => `(r, g, b) => ${condition}`).join(", ")}];
    return tests.map((holds) => {
      let count = 0;
      for (let i = 0; i < data.length; i += 4) if (holds(data[i], data[i + 1], data[i + 2])) ++count;
      return count / (data.length / 4);
    });
  })()`);
}

const kBlue = "b > 1.5 * r && b > g && b > 70"; // the cloth's front
const kOchre = "r > 1.4 * b && r > g && g > 0.5 * r && r > 60"; // its back
const kMagenta = "r > 150 && g < 90 && b > 90"; // EOL
const kGreen = "g > 1.6 * r && g > 1.2 * b"; // contact
const kWarm = "r > 1.3 * b && r > 90"; // strain
const kMessage = `!document.getElementById("message").hidden && ${text("message")}`;

test("a frame shows the cloth, its EOL edge and where it is in time", async () => {
  const page = await openFrame(30, "ui=0");
  const [blue, magenta] = await shares(page, [kBlue, kMagenta]);
  assert.ok(blue > 0.06, `cloth on ${blue} of the picture`);
  assert.ok(magenta > 0.0003, `EOL edge on ${magenta}`); // about 300 pixels long and 1.6 wide, of 1280 x 800
  assert.equal(await page.evaluate(text("time")), "1.250 / 2.458 s");
  assert.equal(await page.evaluate(text("frame")), "frame 30 / 59");
  assert.match(await page.evaluate(text("facts")), /1,681 vertices · 3,200 faces · 40 EOL edges · grid 10 cm/);
  await page.close();
});

test("the back has its own colour, and a frame before the fold has no EOL edge", async () => {
  const page = await openFrame(0, "ui=0&azimuth=120&elevation=-30");
  const [blue, ochre, magenta] = await shares(page, [kBlue, kOchre, kMagenta]);
  assert.ok(ochre > 0.06 && blue < 0.01 && magenta === 0, `${[blue, ochre, magenta]}`);
  await page.close();
});

test("a box in the address is what the view contains", async () => {
  const page = await openFrame(0, "ui=0");
  const [whole] = await shares(page, [kBlue]);
  await page.evaluate('location.hash = "frame=0&play=0&ui=0&box=0.4,0.4,0.5,0.6,0.6,0.7"');
  const [near] = await shares(page, [kBlue]);
  await page.evaluate('location.hash = "frame=0&play=0&ui=0&box=-4,-4,-4,5,5,5"');
  const [far] = await shares(page, [kBlue]);
  assert.ok(near > 2 * whole && far < whole / 4, `${[near, whole, far]}`);
  await page.close();
});

test("strain, speed and contact colour the cloth and have their legend", async () => {
  const page = await openFrame(30, "colour=checker");
  await page.press("c");
  let [blue, warm] = await shares(page, [kBlue, kWarm]);
  assert.ok(warm > 0.01 && blue < 0.02, `strain: ${[blue, warm]}`);
  assert.match(await page.evaluate(text("legend")), /Greatest principal strain.*8 %.*in this run −1 % to 7 %/);
  await page.press("c");
  [warm] = await shares(page, [kWarm]);
  assert.ok(warm > 0.01, `speed: ${warm}`);
  assert.match(await page.evaluate(text("legend")), /Speed of the material.*2 m\/s.*in this run up to 2 m\/s/);
  await page.press("c");
  const [green] = await shares(page, [kGreen]);
  assert.ok(green > 0.005, `contact: ${green}`);
  assert.match(await page.evaluate(text("legend")), /pressed by a contact/);
  await page.press("c");
  [blue] = await shares(page, [kBlue]);
  assert.ok(blue > 0.04);
  await page.close();
});

test("the strain scale takes another top and puts back what is none", async () => {
  const page = await openFrame(30, "colour=strain");
  const type = (value) => page.evaluate(`(() => {
    const input = document.getElementById("strain-top");
    input.value = ${JSON.stringify(value)};
    input.dispatchEvent(new Event("change"));
  })()`);
  await type("2");
  assert.match(await page.evaluate(text("legend")), /above 2 %/);
  const [beyond] = await shares(page, ["b > 120 && r < 110 && g < 110"]);
  assert.ok(beyond > 0.005, `above the scale: ${beyond}`);
  for (const value of ["", "-3", "0"]) {
    await type(value);
    assert.match(await page.evaluate(text("legend")), /above 2 %/);
    assert.equal(await page.evaluate(`document.getElementById("strain-top").value`), "2");
  }
  await page.close();
});

test("a run with EOL edges begins with a checkerboard fixed to the material, any other without", async () => {
  const page = await openFrame(30, "ui=0");
  assert.equal(await page.evaluate(`document.getElementById("colour").value`), "checker");
  const tones = ["b > 1.5 * r && b > g && b > 140", "b > 1.5 * r && b > g && b > 40 && b <= 120"];
  const [bright, dark] = await shares(page, tones);
  assert.ok(bright > 0.02 && dark > 0.02, `${bright} of the picture bright, ${dark} dark`);
  await page.evaluate("location.hash = 'frame=30&play=0&ui=0&colour=none'");
  const [, darkWithout] = await shares(page, tones);
  assert.ok(darkWithout < dark / 3, `${darkWithout} dark without the checkerboard, ${dark} with it`);
  await page.close();
});

test("switches hide EOL edges and obstacles, views turn the camera", async () => {
  const crowded = makeRun("switches", { frames: 10, obstacles: "obstacles" });
  const page = await open("play=0&frame=9&ui=0&colour=none", join(crowded, "viewer.html"));
  await page.until(shows(9));
  const [magenta, grey] = await shares(page, [kMagenta, kGrey]);
  await page.press("s");
  await page.press("o");
  const [noMagenta, noGrey] = await shares(page, [kMagenta, kGrey]);
  assert.ok(magenta > 0.0003 && noMagenta < magenta / 10, `EOL: ${magenta} to ${noMagenta}`);
  assert.ok(grey > 0.005 && noGrey < grey / 10, `obstacles: ${grey} to ${noGrey}`);
  const pictures = new Set();
  for (const key of "1234") {
    await page.press(key);
    await page.evaluate("new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))");
    pictures.add((await page.screenshot()).toString("base64"));
  }
  assert.equal(pictures.size, 4);
  await page.close();
});

test("a title is text, whatever it holds, and the page fetches nothing", async () => {
  const page = await openFrame(0);
  assert.equal(await page.evaluate(text("title")), kHostileTitle);
  assert.equal(await page.evaluate("document.title"), `${kHostileTitle} – Arris`);
  assert.equal(await page.evaluate("document.images.length"), 0);
  assert.equal(page.dialogs, 0);
  assert.deepEqual(page.requests.map((address) => address.split("#")[0]),
                   [pathToFileURL(join(run, "viewer.html")).href]);
  await page.close();
});

test("the page runs no script but its own", async () => {
  const path = writePage("injected", html.replace("<footer", "<img src=x onerror=alert(1)><script>alert(2)</script><footer"));
  const page = await open("play=0&frame=0", path);
  await page.until(shows(0));
  assert.equal(page.dialogs, 0);
  await page.close();
});

test("it plays by itself, in time, and pauses", async () => {
  const page = await open("", undefined, { width: 320, height: 240 });
  await page.until("Number(document.documentElement.dataset.frame) > 2");
  // Compares time between two moments of the run with wall time, inside the page so that round trips do not count.
  // The delay of a busy machine is measured too: a frame may be late by one refresh. The clock does not catch up on
  // refreshes longer than half a second.
  const [wall, shown, late] = await page.evaluate(`(async () => {
    const frame = () => Number(document.documentElement.dataset.frame);
    let before = performance.now(), longest = 0, lost = 0;
    const change = async () => {
      for (const old = frame(); frame() === old;) {
        const now = await new Promise((done) => requestAnimationFrame(done));
        longest = Math.max(longest, now - before);
        lost += Math.max(0, now - before - 500);
        before = now;
      }
      return before;
    };
    const [begin, first] = [await change(), frame()];
    let last = first, end = begin;
    while (end - begin < 1200) { end = await change(); last = frame(); }
    return [(end - begin) / 1000, ((last - first + 60) % 60) / 24, (2 * longest + lost) / 1000];
  })()`);
  assert.ok(Math.abs(wall - shown) < 1 / 24 + late, `${shown} s of the run in ${wall} s, at most ${late} s late`);
  await page.press(" ", "Space");
  const paused = await page.evaluate("document.documentElement.dataset.wanted");
  await new Promise((resolve) => setTimeout(resolve, 300));
  assert.equal(await page.evaluate("document.documentElement.dataset.wanted"), paused);
  await page.until(`document.getElementById("play").getAttribute("aria-label") === "Play"`);
  await page.close();
});

test("keys step, jump and switch, and no further than the ends", async () => {
  const page = await openFrame(5);
  const keys = [["ArrowRight", 6], ["ArrowRight", 7], ["ArrowLeft", 6], ["Home", 0], ["ArrowLeft", 0], ["End", 59],
                ["ArrowRight", 59]];
  for (const [key, frame] of keys) {
    await page.press(key);
    await page.until(shows(frame));
  }
  const pressed = (id) => page.evaluate(`document.getElementById("${id}").getAttribute("aria-pressed")`);
  assert.deepEqual([await pressed("loop"), await pressed("edges")], ["true", "false"]);
  await page.press("l");
  await page.press("E");
  assert.deepEqual([await pressed("loop"), await pressed("edges")], ["false", "true"]);
  await page.close();
});

test("the slider and the address choose frames", async () => {
  const page = await openFrame(5);
  await page.evaluate(`(() => {
    const slider = document.getElementById("scrub");
    slider.value = 44;
    slider.dispatchEvent(new Event("input"));
  })()`);
  await page.until(shows(44));
  await page.evaluate(`document.getElementById("scrub").focus()`);
  await page.press("ArrowRight");
  await page.until(shows(45));
  await page.evaluate("location.hash = 'frame=12&ui=0'");
  await page.until(shows(12));
  const isShown = (id) => page.evaluate(`document.getElementById("${id}").checkVisibility()`);
  for (const id of ["heading", "display", "legend", "axes", "transport"]) assert.equal(await isShown(id), false, id);
  for (const nonsense of ["frame=1e99", "frame=-5", "frame=x&zoom=0&azimuth=NaN", "frame=&top=-1&colour=../x", "zoom=-2"])
    await page.evaluate(`location.hash = ${JSON.stringify(nonsense)}`);
  await page.until(shows(0));
  const [blue] = await shares(page, [kBlue]);
  assert.ok(blue > 0.03, "the cloth is still in view");
  await page.close();
});

test("edges draw lines, fit brings the cloth back into view", async () => {
  const page = await openFrame(30, "ui=0&zoom=2");
  const dark = "r < 60 && b < 110 && b > r";
  const [before] = await shares(page, [dark]);
  await page.press("e");
  const [after] = await shares(page, [dark]);
  assert.ok(after > before + 0.005, `${before} to ${after}`);
  await page.evaluate("location.hash = 'ui=0&zoom=0.02'");
  const [far] = await shares(page, [kBlue]);
  await page.press("f");
  const [near] = await shares(page, [kBlue]);
  assert.ok(far < 0.005 && near > 0.04, `${far} to ${near}`);
  await page.close();
});

test("the page follows the reader's light or dark scheme", async () => {
  const page = await openFrame(0, "ui=0", { scheme: "dark" });
  const isDark = "r + g + b < 200";
  assert.ok((await shares(page, [isDark]))[0] > 0.5);
  await page.setScheme("light");
  assert.ok((await shares(page, [isDark]))[0] < 0.1);
  await page.close();
});

const kGrey = "r > g && g > b && r < 1.12 * b && r > 60 && r < 200"; // an obstacle's face, warmer than the page's greys
const kDark = "r < 95 && r > b && r < 1.6 * b"; // its wires and dots

test("obstacles are drawn where the frame has them", async () => {
  const crowded = makeRun("crowded", { frames: 25, obstacles: "obstacles" });
  const page = await open("play=0&frame=0&ui=0", join(crowded, "viewer.html"));
  await page.until(shows(0));
  const [blue, grey, dark] = await shares(page, [kBlue, kGrey, kDark]);
  assert.ok(blue > 0.03 && grey > 0.01 && dark > 0.0005, `${[blue, grey, dark]}`);
  const first = await page.screenshot();
  await page.evaluate("location.hash = 'frame=24&play=0&ui=0'");
  await page.until(shows(24));
  assert.ok((await shares(page, [kGrey]))[0] > 0.01);
  assert.notDeepEqual(await page.screenshot(), first);
  await page.close();

  const bare = await openFrame(0, "ui=0");
  const [none] = await shares(bare, [kGrey]);
  assert.ok(none < grey / 10, `${none} without obstacles, ${grey} with them`);
  await bare.close();
});

test("an obstacle that deforms is drawn as the frame has it, and not where its points are damaged", async () => {
  const bending = pageOf(makeRun("bending", { frames: 25, obstacles: "deforming" }));
  const path = writePage("bending_page", bending.replace('id="arris-pose-0-12"', 'id="other"'));
  const view = "play=0&ui=0&azimuth=-90&elevation=0&box=-1,0,0,0.4,1,1.4";
  const page = await open(`frame=0&${view}`, path);
  await page.until(shows(0));
  const first = await page.screenshot();
  const [grey] = await shares(page, [kGrey]);
  assert.ok(grey > 0.005, `${grey}`);
  await page.evaluate(`location.hash = "frame=24&${view}"`);
  await page.until(shows(24));
  assert.ok((await shares(page, [kGrey]))[0] > 0.005);
  assert.notDeepEqual(await page.screenshot(), first);
  await page.evaluate(`location.hash = "frame=12&${view}"`);
  await page.until(shows(12));
  assert.match(await page.evaluate(kMessage), /^Frame 12 cannot be shown: the points of the obstacle pole/);
  await page.evaluate(`location.hash = "frame=0&${view}"`);
  await page.until(shows(0));
  assert.deepEqual(await page.screenshot(), first);
  await page.close();
});

test("what crosses at the start shines through, is in the legend, and is no obstacle", async () => {
  const kRed = "r > 150 && g < 0.4 * r && b < 0.45 * r";
  const still = makeRun("still", { cells: 10, obstacles: "marks" });
  const page = await open("play=0&frame=0&ui=0", join(still, "viewer.html"));
  await page.until(shows(0));
  const [blue, red] = await shares(page, [kBlue, kRed]);
  assert.ok(blue > 0.02 && red > 0.002, `${[blue, red]}`);
  assert.match(await page.evaluate(text("legend")), /crosses or touches/);
  await page.evaluate('location.hash = "obstacles=0&play=0&ui=0"');
  const [grey, still_red] = await shares(page, [kGrey, kRed]);
  assert.ok(still_red > 0.002 && grey < 0.001, `${[grey, still_red]}`);
  await page.close();
  const bare = await openFrame(0);
  assert.doesNotMatch(await bare.evaluate(text("legend")), /crosses/);
  await bare.close();
});

test("a damaged obstacle is named, and all else is shown", async () => {
  const crowded = pageOf(makeRun("damaged", { frames: 5, obstacles: "obstacles" }));
  const path = writePage("damaged_page", crowded.replace('id="arris-mesh-0"', 'id="other"'));
  const page = await open("play=0&frame=0", path);
  await page.until(shows(0));
  assert.match(await page.evaluate(text("notice")), /^The obstacle table cannot be shown/);
  assert.equal(await page.evaluate(kMessage), false);
  assert.ok((await shares(page, [kBlue]))[0] > 0.03);
  await page.close();
});

test("a thinned run says so", async () => {
  const thin = makeRun("thin", { frames: 40, cells: 30, mostBytes: 60000 });
  const page = await open("play=0&frame=0", join(thin, "viewer.html"));
  await page.until(shows(0));
  assert.match(await page.evaluate(text("notice")), /^Shows \d+ of 40 frames \(one in [248], and the last\): all of them would take more memory/);
  assert.equal(await page.evaluate(`document.getElementById("notice").checkVisibility()`), true);
  await page.close();
});

const kBroken = {
  "its template alone": () => readFileSync(kTemplate, "utf8"),
  "a page cut off within its list": () => html.slice(0, html.indexOf('id="arris-meta"') + 300),
  "a list that is no JSON": () => html.replace('"format":3', '"format":'),
};
for (const [name, make] of Object.entries(kBroken)) {
  test(`${name} gives a message, not a blank page`, async () => {
    const page = await open("", writePage("broken", make()));
    await page.until("document.documentElement.dataset.problem");
    const message = await page.evaluate(kMessage);
    assert.ok(message.length > 30 && !message.includes("error of its own"), message);
    await page.close();
  });
}

test("a page cut off within its script still says something", async () => {
  const page = await open("", writePage("broken", html.slice(0, html.indexOf("</script>") - 5000)));
  assert.match(await page.evaluate(kMessage), /cut off/);
  await page.close();
});

test("a page cut off within its frames shows those it has, and names the ones it has not", async () => {
  const page = await open("play=0&frame=0", writePage("short", html.slice(0, html.indexOf("arris-frame-20") + 500)));
  await page.until(shows(0));
  assert.equal(await page.evaluate(kMessage), false);
  await page.evaluate("location.hash = 'frame=40&play=0'");
  await page.until(shows(40));
  assert.match(await page.evaluate(kMessage), /^Frame 40 cannot be shown/);
  await page.evaluate("location.hash = 'frame=10&play=0'");
  await page.until(shows(10));
  assert.equal(await page.evaluate(kMessage), false);
  await page.close();
});

test("without WebGL the page says what is missing", async () => {
  const bare = new Browser({ hasGraphics: false });
  try {
    const page = await bare.open(pathToFileURL(join(run, "viewer.html")).href);
    await page.until("document.documentElement.dataset.problem");
    assert.match(await page.evaluate(kMessage), /no WebGL 2/);
  } finally {
    await bare.close();
  }
});

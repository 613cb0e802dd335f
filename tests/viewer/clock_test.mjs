// SPDX-License-Identifier: MIT
import assert from "node:assert/strict";
import { test } from "node:test";
import { Clock } from "../../viewer/src/clock.js";

/** Ticks every `gap` ms until `end`. The first tick sets the clock's zero. */
function run(clock, gap, end) {
  for (let now = 0; now <= end; now += gap) clock.tick(1000 + now);
}

test("time runs with the wall, whatever the refresh rate", () => {
  for (const gap of [4, 16, 100, 400]) {
    const clock = new Clock(10, 0.04);
    clock.play();
    run(clock, gap, 2000);
    assert.ok(Math.abs(clock.time - 2) < 1e-9, `${clock.time} s with ticks every ${gap} ms`);
  }
});

test("speed scales time, and may change while playing", () => {
  const clock = new Clock(10, 0.04);
  clock.play();
  clock.speed = 0.25;
  run(clock, 20, 1000);
  clock.speed = 4;
  clock.tick(2100);
  assert.ok(Math.abs(clock.time - (0.25 + 0.4)) < 1e-9, `${clock.time}`);
});

test("a loop shows the last frame as long as any other", () => {
  const clock = new Clock(1, 0.25);
  clock.play();
  clock.tick(0);
  clock.tick(400);
  clock.tick(800);
  clock.tick(1200);
  assert.ok(Math.abs(clock.time - 1.2) < 1e-9);
  clock.tick(1300);
  assert.ok(Math.abs(clock.time - 0.05) < 1e-9, `${clock.time}`);
});

test("without a loop it stops on the last frame, and playing again starts over", () => {
  const clock = new Clock(1, 0.25);
  clock.isLooping = false;
  clock.play();
  run(clock, 50, 3000);
  assert.equal(clock.time, 1);
  assert.equal(clock.isPlaying, false);
  clock.play();
  assert.equal(clock.time, 0);
});

test("a page that slept, or a clock that went back, does not jump", () => {
  const clock = new Clock(100, 0.04);
  clock.play();
  clock.tick(0);
  clock.tick(3600e3);
  assert.equal(clock.time, 0.5);
  clock.tick(0);
  assert.equal(clock.time, 0.5);
  clock.pause();
  clock.tick(20);
  assert.equal(clock.time, 0.5);
});

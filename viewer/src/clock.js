// SPDX-License-Identifier: MIT
// Where playback is. Time runs with the clock on the wall, times the speed: a slow machine leaves frames out, it does
// not slow the motion down.

const kLongestGap = 0.5; // s between two ticks; more means that the page was asleep, not that it was watched

export class Clock {
  time = 0; // s of the run
  speed = 1;
  isPlaying = false;
  isLooping = true;
  #end;
  #period;
  #last = null;

  /** `end`: time of the last frame, s; `period`: how long a frame stands, s, so that the last one is seen in a loop. */
  constructor(end, period) {
    this.#end = end;
    this.#period = period;
  }

  play() {
    if (this.time >= this.#end) this.time = 0;
    this.isPlaying = true;
    this.#last = null;
  }

  pause() {
    this.isPlaying = false;
  }

  /** `now` in ms, as requestAnimationFrame gives it. */
  tick(now) {
    const gap = this.#last === null ? 0 : (now - this.#last) / 1000;
    this.#last = now;
    if (!this.isPlaying) return;
    this.time += Math.min(Math.max(gap, 0), kLongestGap) * this.speed;
    if (this.time < this.#end + this.#period) return;
    if (this.isLooping) {
      this.time %= this.#end + this.#period;
    } else {
      this.time = this.#end;
      this.isPlaying = false;
    }
  }
}

// SPDX-License-Identifier: MIT
// The playback time. It runs with wall time, times the speed: a slow machine skips frames but does not slow the
// motion.

const kLongestGap = 0.5; // s between two ticks; time beyond this is skipped, as the page was suspended

export class Clock {
  time = 0; // s of the run
  speed = 1;
  isPlaying = false;
  isLooping = true;
  #end;
  #period;
  #last = null;

  /**
   * `end`: time of the last frame, s. `period`: duration of a frame, s; in a loop the last frame is shown that long,
   * too.
   */
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

  /** Advances the clock to `now`, ms, as given by requestAnimationFrame. */
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

// SPDX-License-Identifier: GPL-3.0-or-later
// How fast the world goes, from the times of frames.

const kWindow = 2000;  // ms

export class Pace {
  constructor() { this.spans = []; }

  /** Begins anew: what came before says nothing of what follows. */
  reset() {
    this.spans = [];
    this.last = null;
  }

  /** A frame that came at `now`, in ms, shows the world at t, in s. */
  add(t, now) {
    const {last} = this;
    this.last = {t, now};
    if (!last || now <= last.now) return;
    this.spans.push({now, wall: now - last.now, rate: 1000 * (t - last.t) / (now - last.now)});
    while (this.spans.length > 1 && now - this.spans[0].now > kWindow) this.spans.shift();
  }

  /** Simulated seconds a second; 0 where it is not known.
   *
   * The median over the time of the window: a jump to another time, or the old frame that a new connection begins
   * with, takes but an instant of it. */
  get rate() {
    const spans = [...this.spans].sort((a, b) => a.rate - b.rate);
    let left = spans.reduce((sum, {wall}) => sum + wall, 0) / 2;
    return Math.max(0, spans.find(({wall}) => (left -= wall) <= 0)?.rate ?? 0);
  }
}

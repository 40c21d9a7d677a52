// SPDX-License-Identifier: GPL-3.0-or-later
// The remarkable events of a record, beside the slider of its time.
import {markText} from './events.js';

const kThumb = 16;  // pixels of the slider's knob
const kNear = 6;  // pixels from a mark that count as it

export class MarkStrip {
  /** strip: a canvas below the slider; seekBar goes to times; tell(text, bad) */
  constructor(strip, seekBar, tell) {
    Object.assign(this, {strip, seekBar, tell, marks: []});
    strip.addEventListener('click', event => {
      const mark = this.at(event.offsetX);
      if (mark) this.go(mark);
    });
    strip.addEventListener('pointermove', event => { strip.title = this.at(event.offsetX)?.said ?? ''; });
    new ResizeObserver(() => this.draw()).observe(strip);
  }

  /** Those of a scene. */
  list(marks, colors) {
    this.marks = marks.map(mark => ({...mark, ...markText(mark)}));
    this.colors = colors;
    this.draw();
  }

  /** Where a time is on the strip. */
  x(t) { return kThumb / 2 + t / Math.max(1e-9, this.seekBar.end) * (this.strip.clientWidth - kThumb); }

  at(px) {
    const away = mark => Math.abs(this.x(mark.t) - px);
    const best = this.marks.reduce((least, mark) => !least || away(mark) < away(least) ? mark : least, null);
    return best && away(best) <= kNear ? best : null;
  }

  /** Goes to the next mark (1) or the one before (-1). */
  step(way) {
    const now = this.seekBar.time, later = mark => way * (mark.t - now) > 1e-6;
    const mark = way > 0 ? this.marks.find(later) : this.marks.findLast(later);
    if (mark) this.go(mark);
  }

  go(mark) {
    this.seekBar.seek(mark.t);
    this.tell(mark.said, mark.bad);
  }

  draw() {
    const {strip} = this;
    strip.hidden = this.marks.length === 0 || this.seekBar.input.hidden;
    if (strip.hidden || strip.clientWidth === 0) return;
    const ratio = window.devicePixelRatio || 1, height = strip.clientHeight;
    strip.width = Math.round(strip.clientWidth * ratio);
    strip.height = Math.round(height * ratio);
    const context = strip.getContext('2d'), style = getComputedStyle(strip);
    context.scale(ratio, ratio);
    for (const bad of [false, true]) {  // those lie above the others
      context.fillStyle = bad ? style.borderTopColor : style.color;
      for (const mark of this.marks) if (mark.bad === bad) context.fillRect(this.x(mark.t) - 1, bad ? 0 : height / 3, 2, height);
    }
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The course of states over time, kept while the page is open, and a plot of one of them.
import {momentText} from './clock.js';

const kMost = 4000;  // values of a state

export class History {
  /** part(id): an element of the page */
  constructor(part) {
    Object.assign(this, {part, series: new Map(), shown: null});
    part('plot-close').onclick = () => this.show(null);
    new ResizeObserver(() => this.draw()).observe(part('plot'));
  }

  /** A state has a value from t on; texts are kept out, and values less than `apart` seconds after the last one. */
  add(name, t, value, apart = 0) {
    const number = Number(value);
    if (value === '' || Number.isNaN(number)) return;
    const series = this.series.get(name) ?? this.series.set(name, []).get(name);
    if (series.length > 0 && series.at(-1)[0] > t) series.length = 0;  // the world went back
    if (series.at(-1)?.[1] === number || t - series.at(-1)?.[0] < apart) return;
    series.push([t, number]);
    if (series.length > kMost) series.shift();
  }

  has(name) { return this.series.has(name); }

  /** Shows the course of a state; none: no more. */
  show(name) {
    this.shown = name === this.shown ? null : name;
    this.part('course').hidden = !this.shown;
    this.part('course-name').textContent = this.shown ?? '';
    this.draw();
  }

  /** The world is at t. */
  tick(t) {
    this.now = t;
    if (this.shown) this.draw();
  }

  draw() {
    const series = this.series.get(this.shown), canvas = this.part('plot');
    if (!series || canvas.clientWidth === 0) return;
    const ratio = window.devicePixelRatio || 1, {clientWidth: width, clientHeight: height} = canvas;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext('2d'), style = getComputedStyle(canvas);
    context.scale(ratio, ratio);
    const values = series.map(([, value]) => value), low = Math.min(...values), high = Math.max(...values);
    const begin = series[0][0], end = Math.max(this.now ?? 0, series.at(-1)[0]), kTop = 14, kBottom = 16;
    const x = t => 2 + (t - begin) / Math.max(1e-9, end - begin) * (width - 4);
    const y = value => height - kBottom - (value - low) / Math.max(1e-12, high - low) * (height - kTop - kBottom);
    context.strokeStyle = style.color;
    context.lineWidth = 1.5;
    context.beginPath();
    series.forEach(([t, value], i) => {  // it holds until the next one
      if (i > 0) context.lineTo(x(t), y(series[i - 1][1]));
      context.lineTo(x(t), y(value));
    });
    context.lineTo(x(end), y(values.at(-1)));
    context.stroke();
    context.font = '11px system-ui, sans-serif';
    context.fillStyle = style.color;
    context.textAlign = 'left';
    context.fillText(`${+high.toPrecision(4)}`, 2, 10);
    context.fillText(`${low === high ? '' : +low.toPrecision(4)}  from ${momentText(begin, 0)}`, 2, height - 3);
    context.textAlign = 'right';
    context.fillText(`${momentText(end, 0)}: ${+values.at(-1).toPrecision(6)}`, width - 2, height - 3);
  }
}

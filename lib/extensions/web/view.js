// SPDX-License-Identifier: GPL-3.0-or-later
// Which part of the plane the canvas shows: metres with y up, to pixels of the page.

const kMinScale = 0.2, kMaxScale = 2000;  // pixels a metre

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.x = this.y = 0;  // in the middle
    this.scale = 50;
    this.width = this.height = 1;
  }

  /** Takes the canvas' size; true if that changed. */
  measure() {
    const {clientWidth: width, clientHeight: height} = this.canvas;
    const ratio = window.devicePixelRatio || 1;
    if (width === this.width && height === this.height && ratio === this.ratio) return false;
    Object.assign(this, {width, height, ratio});
    this.canvas.width = Math.round(width * ratio);
    this.canvas.height = Math.round(height * ratio);
    return true;
  }

  fit([x0, y0, x1, y1]) {
    const rim = Math.min(48, 0.08 * this.width);
    this.x = (x0 + x1) / 2;
    this.y = (y0 + y1) / 2;
    this.scaleTo(Math.min((this.width - rim) / (x1 - x0), (this.height - rim) / (y1 - y0)));
  }

  /** Whether any of a box is shown. */
  meets([x0, y0, x1, y1]) {
    const [left, top] = this.toWorld(0, 0), [right, bottom] = this.toWorld(this.width, this.height);
    return x0 < right && x1 > left && y0 < top && y1 > bottom;
  }

  scaleTo(scale) { this.scale = Math.min(kMaxScale, Math.max(kMinScale, scale)); }

  /** Zooms; what lies at a pixel stays there. */
  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const [x, y] = this.toWorld(px, py);
    this.scaleTo(this.scale * factor);
    this.x = x - (px - this.width / 2) / this.scale;
    this.y = y + (py - this.height / 2) / this.scale;
  }

  pan(dx, dy) {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  toWorld(px, py) {
    return [this.x + (px - this.width / 2) / this.scale, this.y - (py - this.height / 2) / this.scale];
  }

  toPage(x, y) {
    return [this.width / 2 + (x - this.x) * this.scale, this.height / 2 - (y - this.y) * this.scale];
  }

  /** From now on a context draws in metres. */
  inMetres(context) {
    const k = this.scale * this.ratio;
    context.setTransform(k, 0, 0, -k, this.ratio * this.width / 2 - k * this.x,
                         this.ratio * this.height / 2 + k * this.y);
  }

  /** From now on a context draws in pixels of the page. */
  inPixels(context) { context.setTransform(this.ratio, 0, 0, this.ratio, 0, 0); }

  get key() { return [this.x, this.y, this.scale, this.width, this.height, this.ratio].join(); }
}

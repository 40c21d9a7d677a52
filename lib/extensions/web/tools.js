// SPDX-License-Identifier: GPL-3.0-or-later
// What a pointer does on the map besides selecting and panning: each tool has press(x, y), and perhaps
// drag(x, y), letGo(x, y, moved), draw(context, view), end(). Where drag is missing, dragging pans.

/** Sends the selected robot or person to a point; a drag from there gives its heading. */
export class SendTool {
  /** mover(): whom; go(mover, x, y, heading) */
  constructor(mover, go) { Object.assign(this, {mover, go, from: null}); }

  get hint() { return 'Press where it is to go; drag from there to turn it.'; }

  press(x, y) { this.from = this.to = [x, y]; }
  drag(x, y) { this.to = [x, y]; }

  letGo(x, y, moved) {
    const {from} = this;
    this.from = null;
    if (!from || !this.mover()) return;
    const heading = moved ? Math.atan2(y - from[1], x - from[0]) * 180 / Math.PI : undefined;
    this.go(this.mover(), ...from, heading);
  }

  draw(context, view) { if (this.from) drawArrow(context, view, this.from, this.to, '#d55e00'); }
  end() { this.from = null; }
}

/** A point and, if another one is given, the direction there. */
export function drawArrow(context, view, from, to, color) {
  view.inPixels(context);
  const [x0, y0] = view.toPage(...from), [x1, y1] = view.toPage(...to), length = Math.hypot(x1 - x0, y1 - y0);
  context.strokeStyle = context.fillStyle = color;
  context.lineWidth = 2;
  context.beginPath();
  context.arc(x0, y0, 6, 0, 2 * Math.PI);
  if (length > 8) {
    const [dx, dy] = [(x1 - x0) / length, (y1 - y0) / length];
    context.moveTo(x0 + 6 * dx, y0 + 6 * dy);
    context.lineTo(x1, y1);
    context.lineTo(x1 - 10 * dx + 5 * dy, y1 - 10 * dy - 5 * dx);
    context.moveTo(x1, y1);
    context.lineTo(x1 - 10 * dx - 5 * dy, y1 - 10 * dy + 5 * dx);
  }
  context.stroke();
}

/** Lengths along points, and the area that three or more enclose. */
export class Ruler {
  /** say(text): shows the result */
  constructor(say) { Object.assign(this, {say, points: []}); }

  get hint() { return 'Press from point to point: lengths, and the area between three or more. Escape ends it.'; }

  press() {}

  letGo(x, y, moved) {
    if (moved) return;
    this.points.push([x, y]);
    this.tell();
  }

  tell() {
    const {points} = this, lengths = points.slice(1).map(([x, y], i) => Math.hypot(x - points[i][0], y - points[i][1]));
    if (lengths.length === 0) return this.say(this.hint);
    const total = lengths.reduce((sum, length) => sum + length, 0);
    const [dx, dy] = [0, 1].map(k => points.at(-1)[k] - points.at(-2)[k]);
    const parts = [`${total.toFixed(3)} m`];
    if (lengths.length > 1) parts.push(`last ${lengths.at(-1).toFixed(3)} m`);
    parts.push(`${(Math.atan2(dy, dx) * 180 / Math.PI).toFixed(1)}°`);
    if (points.length > 2) parts.push(`${this.area().toFixed(2)} m²`);
    this.say(parts.join(', '));
  }

  area() {
    const {points} = this;
    return Math.abs(points.reduce((sum, [x, y], i) => {
      const [u, v] = points[(i + 1) % points.length];
      return sum + x * v - u * y;
    }, 0)) / 2;
  }

  draw(context, view) {
    const pixels = this.points.map(point => view.toPage(...point));
    view.inPixels(context);
    context.strokeStyle = context.fillStyle = '#7b3294';
    context.lineWidth = 2;
    if (pixels.length > 2) {
      context.globalAlpha = 0.12;
      context.beginPath();
      for (const pixel of pixels) context.lineTo(...pixel);
      context.fill();
      context.globalAlpha = 1;
    }
    context.beginPath();
    for (const pixel of pixels) context.lineTo(...pixel);
    context.stroke();
    context.font = '600 12px system-ui, sans-serif';
    context.textAlign = 'center';
    pixels.forEach(([x, y], i) => {
      context.fillRect(x - 3, y - 3, 6, 6);
      if (i === 0) return;
      const [px, py] = pixels[i - 1], [a, b] = [this.points[i - 1], this.points[i]];
      const text = `${Math.hypot(b[0] - a[0], b[1] - a[1]).toFixed(2)} m`;
      context.lineWidth = 3;
      context.strokeStyle = '#fffdf8d9';
      context.strokeText(text, (x + px) / 2, (y + py) / 2 - 5);
      context.fillText(text, (x + px) / 2, (y + py) / 2 - 5);
    });
  }

  end() { this.points = []; }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// The fixed part: floor, walls, things, a grid, the bar of scale. Drawn once for each view.

/** A shape of the scene as a path in metres. */
function pathOf(shape) {
  const path = new Path2D();
  if (shape.arc) {
    const [x, y, radius, from, to] = shape.arc;
    path.arc(x, y, radius, from * Math.PI / 180, to * Math.PI / 180);
  }
  for (const curve of shape.area ?? shape.lines ?? []) {
    for (let i = 0; i < curve.length; i += 2) {
      if (i === 0) path.moveTo(curve[0], curve[1]);
      else path.lineTo(curve[i], curve[i + 1]);
    }
    if (shape.area) path.closePath();
  }
  return path;
}

function boxOf(shapes) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  const add = (x, y) => {
    box[0] = Math.min(box[0], x);
    box[1] = Math.min(box[1], y);
    box[2] = Math.max(box[2], x);
    box[3] = Math.max(box[3], y);
  };
  for (const {area, lines, arc} of shapes) {
    for (const curve of area ?? lines ?? [])
      for (let i = 0; i < curve.length; i += 2) add(curve[i], curve[i + 1]);
    if (arc) {
      add(arc[0] - arc[2], arc[1] - arc[2]);
      add(arc[0] + arc[2], arc[1] + arc[2]);
    }
  }
  return box;
}

/** 1, 2 or 5 times a power of ten, at least `least`. */
function roundStep(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map(factor => factor * power).find(step => step >= least);
}

export class Plan {
  constructor(scene) {
    this.box = scene.plan.box;
    this.colors = scene.colors;
    this.layers = scene.plan.layers.map(({name, groups}) => ({
      name,
      groups: groups.map(({id, title, shapes}) => ({
        id, title, box: boxOf(shapes),
        shapes: shapes.map(shape => ({path: pathOf(shape), inks: shape.inks})),
      })),
    }));
    this.cache = document.createElement('canvas');
  }

  draw(context, view, withNames) {
    const key = view.key + withNames;
    if (key !== this.key) {
      this.key = key;
      this.cache.width = view.canvas.width;
      this.cache.height = view.canvas.height;
      this.redraw(this.cache.getContext('2d'), view, withNames);
    }
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.drawImage(this.cache, 0, 0);
  }

  redraw(context, view, withNames) {
    const [x0, y1] = view.toWorld(0, 0), [x1, y0] = view.toWorld(view.width, view.height);
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = '#ece8df';
    context.fillRect(0, 0, view.canvas.width, view.canvas.height);
    view.inMetres(context);
    context.lineJoin = context.lineCap = 'round';
    // Pens are for a plan some 1000 pixels wide.
    const pen = Math.min(2, Math.max(0.6, view.scale * (this.box[2] - this.box[0]) / 1000)) / view.scale;
    for (const {name, groups} of this.layers) {
      for (const {box, shapes} of groups) {
        if (box[0] > x1 || box[2] < x0 || box[1] > y1 || box[3] < y0) continue;
        for (const {path, inks} of shapes) this.ink(context, path, inks, pen);
      }
      if (name === 'floor') this.grid(context, view, [x0, y0, x1, y1]);
    }
    view.inPixels(context);
    if (withNames) this.zoneNames(context, view);
    this.scaleBar(context, view);
  }

  ink(context, path, inks, pen) {
    for (const {fill, line, width, dash} of inks) {
      if (fill) {
        context.fillStyle = fill;
        context.fill(path, 'evenodd');
      } else {
        context.strokeStyle = line;
        context.lineWidth = width * pen;
        context.setLineDash(dash ? dash.map(length => length * pen) : []);
        context.stroke(path);
      }
    }
    context.setLineDash([]);
  }

  grid(context, view, [x0, y0, x1, y1]) {
    const step = roundStep(14 / view.scale);
    const [left, low, right, high] = this.box;
    context.lineWidth = 0.6 / view.scale;
    context.strokeStyle = this.colors.grid + '40';
    context.beginPath();
    for (let x = Math.ceil(Math.max(x0, left) / step) * step; x <= Math.min(x1, right); x += step) {
      context.moveTo(x, low);
      context.lineTo(x, high);
    }
    for (let y = Math.ceil(Math.max(y0, low) / step) * step; y <= Math.min(y1, high); y += step) {
      context.moveTo(left, y);
      context.lineTo(right, y);
    }
    context.stroke();
  }

  zoneNames(context, view) {
    const zones = this.layers.find(layer => layer.name === 'zones');
    context.font = '12px system-ui, sans-serif';
    context.fillStyle = this.colors.faint;
    context.textAlign = 'left';
    for (const {id, box} of zones?.groups ?? []) {
      const [x, y] = view.toPage(box[0], box[1]);
      if ((box[2] - box[0]) * view.scale > context.measureText(id).width + 10) context.fillText(id, x + 6, y - 6);
    }
  }

  scaleBar(context, view) {
    const length = roundStep(50 / view.scale), x = 14, y = view.height - 16;
    context.strokeStyle = this.colors.ink;
    context.lineWidth = 1.5;
    context.beginPath();
    context.moveTo(x, y - 5);
    context.lineTo(x, y);
    context.lineTo(x + length * view.scale, y);
    context.lineTo(x + length * view.scale, y - 5);
    context.stroke();
    context.fillStyle = this.colors.ink;
    context.font = '12px system-ui, sans-serif';
    context.textAlign = 'left';
    context.fillText(`${+length.toPrecision(2)} m`, x + length * view.scale + 6, y + 1);
  }

  /** What stands at a place, the smallest first; for people. */
  titleAt(x, y) {
    let best, least = Infinity;
    for (const {groups} of this.layers) {
      for (const {id, title, box} of groups) {
        const size = (box[2] - box[0]) * (box[3] - box[1]);
        if (!id || x < box[0] || x > box[2] || y < box[1] || y > box[3] || size >= least) continue;
        least = size;
        best = title;
      }
    }
    return best;
  }
}

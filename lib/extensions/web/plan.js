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
    this.passages = (scene.passages ?? []).map(({id, kind, outline}) => ({
      id, kind, outline, path: pathOf({area: [outline]}), box: boxOf([{area: [outline]}]),
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
    for (const passage of this.passages) this.passage(context, passage, pen);
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

  /** As plans have them: steps and the way up, the cross of a cabin, the dashed rim of an opening. */
  passage(context, {kind, outline, path}, pen) {
    const corner = i => outline.slice(2 * i, 2 * i + 2);
    const between = ([x0, y0], [x1, y1], share) => [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
    const line = (from, to) => {
      context.moveTo(...from);
      context.lineTo(...to);
    };
    context.fillStyle = '#ffffff80';
    context.strokeStyle = this.colors.faint;
    context.lineWidth = 1.2 * pen;
    context.fill(path);
    if (kind === 'shaft') context.setLineDash([6 * pen, 4 * pen]);
    context.stroke(path);
    context.setLineDash([]);
    if (outline.length !== 8) return;
    context.beginPath();
    if (kind === 'lift') {
      line(corner(0), corner(2));
      line(corner(1), corner(3));
    } else if (kind === 'stairs') {
      const [right, head, left, foot] = [0, 1, 2, 3].map(corner);
      const length = Math.hypot(head[0] - right[0], head[1] - right[1]), steps = Math.max(2, Math.round(length / 0.28));
      for (let i = 1; i < steps; ++i) line(between(right, head, i / steps), between(foot, left, i / steps));
      const from = between(right, foot, 0.5), to = between(head, left, 0.5), tip = between(to, from, 0.2 / length);
      line(from, to);
      line(between(tip, between(right, head, 1 - 0.2 / length), 0.4), to);
      line(between(tip, between(foot, left, 1 - 0.2 / length), 0.4), to);
    }
    context.stroke();
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
    for (const {id, box} of [...zones?.groups ?? [], ...this.passages]) {
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

  /** The id of the smallest thing at a place that fits; thin ones are as wide as a finger. */
  idAt(x, y, fits) {
    const kFinger = 0.15;  // metres
    let best, least = Infinity;
    for (const {groups} of this.layers) {
      for (const {id, box: [x0, y0, x1, y1]} of groups) {
        const size = (x1 - x0) * (y1 - y0);
        const is_there = x >= x0 - kFinger && x <= x1 + kFinger && y >= y0 - kFinger && y <= y1 + kFinger;
        if (!id || !is_there || size >= least || !fits(id)) continue;
        least = size;
        best = id;
      }
    }
    return best;
  }

  /** The id of the smallest zone at a place, also just beside it, as doors are; '' without one. */
  zoneAt(x, y) {
    const kBeside = 0.4;  // metres
    this.probe ??= document.createElement('canvas').getContext('2d');
    const zones = (this.layers.find(({name}) => name === 'zones')?.groups ?? []).filter(({id}) => id);
    const sizeOf = ({box: [x0, y0, x1, y1]}) => (x1 - x0) * (y1 - y0);
    for (const [dx, dy] of [[0, 0], [kBeside, 0], [-kBeside, 0], [0, kBeside], [0, -kBeside]]) {
      const holds = ({path}) => this.probe.isPointInPath(path, x + dx, y + dy, 'evenodd');
      const there = zones.filter(({shapes}) => shapes.some(holds)).sort((a, b) => sizeOf(a) - sizeOf(b));
      if (there.length > 0) return there[0].id;
    }
    return '';
  }

  /** What something is drawn by. */
  outlineOf(wanted) {
    for (const {groups} of this.layers)
      for (const {id, shapes} of groups) if (id === wanted) return shapes.map(({path}) => path);
    return [];
  }

  /** The middle of something, if the plan has it. */
  middleOf(wanted) {
    for (const {groups} of this.layers)
      for (const {id, box: [x0, y0, x1, y1]} of groups) if (id === wanted) return [(x0 + x1) / 2, (y0 + y1) / 2];
    return undefined;
  }

  /** What stands at a place, the smallest first; for people. */
  titleAt(x, y) {
    let best, least = Infinity;
    const passages = this.passages.map(({id, kind, box}) => ({id, title: `${kind} ${id}`, box}));
    for (const {groups} of [...this.layers, {groups: passages}]) {
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

// SPDX-License-Identifier: GPL-3.0-or-later
// What moves, and what it senses, drawn from the newest frame.

const kRad = Math.PI / 180;
const kTrail = 600;  // places
const kTrailStep = 0.02;  // metres between them

/** A row of a frame in metres and degrees. */
function stateOf([x, y, heading, speed, rotspeed, stall, phase]) {
  return {
    x: x / 1000, y: y / 1000, heading: heading / 100, speed: speed / 1000, rotspeed: rotspeed / 100,
    stall: stall === 1, phase: phase / 1000,
  };
}

/** Pairs of metres from numbers in millimetres. */
function pointsOf(numbers) {
  return Array.from({length: numbers.length / 2}, (_, i) => [numbers[2 * i] / 1000, numbers[2 * i + 1] / 1000]);
}

export class Movers {
  /** before: the movers of the scene that this one replaces; one that is in both stays where it is, with its trail */
  constructor(scene, before) {
    this.colors = scene.colors;
    this.actuators = scene.actuators ?? [];
    this.all = scene.movers;
    this.sensors = scene.sensors;
    const seers = scene.sensors.filter(sensor => sensor.view);
    this.colorOf = new Map(seers.map(({id}, i) => [id, scene.colors.series[i % scene.colors.series.length]]));
    this.scans = new Map();
    this.nearest = new Map();  // of each scan: the shortest range in metres
    this.ways = new Map();  // by id: the points ahead, and ways that begin behind stairs and lifts
    this.floor = new Map();  // PIR sensors, mats and gates
    this.tracks = before?.tracks ?? new Map();  // by name: what trackers tell, with its trail
    this.byId = new Map(this.all.map(mover => [mover.id, mover]));
    for (const mover of this.all) {
      const {x, y, heading, speed, rotspeed, stall, phase, trail = []} = before?.byId.get(mover.id) ?? {};
      Object.assign(mover, {x, y, heading, speed, rotspeed, stall, phase, trail});
    }
  }

  take(frame) {
    frame.movers.forEach((row, i) => {
      const mover = this.all[i];
      if (!mover) return;
      Object.assign(mover, stateOf(row));
      const last = mover.trail.at(-1);
      const step = last ? Math.hypot(mover.x - last[0], mover.y - last[1]) : Infinity;
      if (step < kTrailStep) return;
      if (step > 2 && last) mover.trail = [];  // put elsewhere
      mover.trail.push([mover.x, mover.y]);
      if (mover.trail.length > kTrail) mover.trail.shift();
    });
    if (frame.all) {
      this.scans.clear();
      this.ways.clear();
    }
    for (const {id, way, later = []} of frame.ways ?? []) {
      if (way.length + later.length > 0) this.ways.set(id, {way: pointsOf(way), later: later.map(pointsOf)});
      else this.ways.delete(id);
    }
    this.takeTracks(frame.tracks ?? []);
    for (const reading of frame.readings) {
      if (reading.r) {
        this.scans.set(reading.id, this.pathsOf(reading));
        this.nearest.set(reading.id, reading.r.reduce((least, range) => range < 0 ? least : Math.min(least, range / 1000), Infinity));
      }
      else if (reading.points)
        this.scans.set(reading.id, {area: new Path2D(), hits: reading.points.map(part => part / 1000), size: 7});
      else this.floor.set(reading.id, reading);
    }
  }

  /** Rows [name, x, y] of the tracks that are told now. */
  takeTracks(rows) {
    const told = new Set();
    for (const [name, x, y] of rows) {
      const track = this.tracks.get(name) ?? {trail: []};
      Object.assign(track, {x: x / 1000, y: y / 1000});
      const last = track.trail.at(-1);
      if (!last || Math.hypot(track.x - last[0], track.y - last[1]) > kTrailStep) track.trail.push([track.x, track.y]);
      if (track.trail.length > kTrail) track.trail.shift();
      this.tracks.set(name, track);
      told.add(name);
    }
    for (const name of [...this.tracks.keys()]) if (!told.has(name)) this.tracks.delete(name);
  }

  /** A scan as an area seen and the places it hit, in metres. */
  pathsOf({pose, first, step, max, r}) {
    const [x, y] = [pose[0] / 1000, pose[1] / 1000];
    const [heading, tilt, roll] = pose.slice(2).map(angle => angle / 100 * kRad);
    const area = new Path2D(), hits = [];
    const full = step * r.length >= 359.999;
    if (!full) area.moveTo(x, y);
    r.forEach((range, i) => {
      // Rz(heading) Ry(-tilt) Rx(roll) applied to the beam, from above.
      const bearing = (first + i * step) * kRad, length = range < 0 ? max : range / 1000;
      const left = Math.sin(bearing) * Math.cos(roll);
      const ahead = Math.cos(bearing) * Math.cos(tilt) - Math.sin(bearing) * Math.sin(roll) * Math.sin(tilt);
      const px = x + length * (ahead * Math.cos(heading) - left * Math.sin(heading));
      const py = y + length * (ahead * Math.sin(heading) + left * Math.cos(heading));
      if (full && i === 0) area.moveTo(px, py);
      else area.lineTo(px, py);
      if (range >= 0) hits.push(px, py);
    });
    area.closePath();
    return {area, hits};
  }

  /** The ids of range finders on a mover. */
  scannersOf(mover) {
    const carrier = this.all.indexOf(mover);
    return this.sensors.filter(({id, on}) => on === carrier && this.nearest.has(id)).map(({id}) => id);
  }

  /** The colour of a kind of sensors, of the first one of it. */
  colorOfKind(kind) {
    const {id} = this.sensors.find(sensor => sensor.kind === kind);
    return this.colorOf.get(id) ?? (kind === 'mat' ? this.colors.mat : this.colors.sensor);
  }

  /** isOn(id): whether something is switched on; colorOf(id): its colour; lookOf(kind): of sensors, see Layers */
  draw(context, view, {scans, trails, ways, tracks, names, chosen, selected, isOn, colorOf, lookOf}) {
    this.lookOf = lookOf;
    this.drawFloorSensors(context, view);
    const rides = ({on}) => on !== undefined;
    this.drawActuators(context, view, this.actuators.filter(one => !rides(one)), isOn, colorOf);
    if (scans) this.drawScans(context, view, selected);
    if (trails) this.drawTrails(context, view, selected);
    if (ways) this.drawWays(context, view, chosen);
    this.drawSensors(context, view);
    for (const mover of this.all) {
      if (mover.x === undefined) continue;
      view.inMetres(context);
      context.translate(mover.x, mover.y);
      context.rotate(mover.heading * kRad);
      if (mover.kind === 'robot') this.drawRobot(context, view, mover);
      else if (mover.body) this.drawBody(context, view, mover);
      else this.drawPerson(context, view, mover);
      if (mover === selected) this.ring(context, view, mover);
    }
    this.drawActuators(context, view, this.actuators.filter(rides), isOn, colorOf);
    if (tracks) this.drawTracks(context, view, names);
    view.inPixels(context);
    if (names) this.drawNames(context, view);
  }

  drawScans(context, view, selected) {
    view.inMetres(context);
    const faint = 0.14 * Math.min(1, Math.sqrt(20 / this.scans.size));
    for (const [id, {area, hits, size: pixels = 2}] of this.scans) {
      const sensor = this.sensors.find(other => other.id === id), look = this.lookOf(sensor?.kind);
      if (!look.shown) continue;
      const color = look.color || (this.colorOf.get(id) ?? this.colors.sensor);
      const strong = selected && sensor?.on !== undefined && this.all[sensor.on] === selected;
      context.globalAlpha = look.opacity * (strong ? 0.26 : faint);
      context.fillStyle = color;
      context.fill(area);
      context.globalAlpha = look.opacity * (strong ? 0.9 : 0.65);
      const size = pixels / view.scale;
      for (let i = 0; i < hits.length; i += 2) context.fillRect(hits[i] - size / 2, hits[i + 1] - size / 2, size, size);
    }
    context.globalAlpha = 1;
  }

  drawTrails(context, view, selected) {
    view.inMetres(context);
    context.lineWidth = 1.5 / view.scale;
    for (const mover of this.all) {
      if (mover.trail.length < 2) continue;
      context.globalAlpha = mover === selected ? 0.9 : 0.4;
      context.strokeStyle = this.colors[mover.kind];
      context.beginPath();
      for (const [x, y] of mover.trail) context.lineTo(x, y);
      context.lineTo(mover.x, mover.y);
      context.stroke();
    }
    context.globalAlpha = 1;
  }

  /** Planned ways, to a point or to stairs and lifts; that of the chosen one is strong. */
  drawWays(context, view, chosen) {
    view.inMetres(context);
    context.strokeStyle = '#0072b2';
    context.setLineDash([6 / view.scale, 5 / view.scale]);
    for (const [id, {way, later}] of this.ways) {
      const {x, y} = this.byId.get(id) ?? {};
      const lines = way.length > 0 && x !== undefined ? [[[x, y], ...way], ...later] : later;
      context.globalAlpha = id === chosen ? 1 : 0.45;
      context.lineWidth = (id === chosen ? 2 : 1.3) / view.scale;
      for (const line of lines) {
        context.beginPath();
        for (const point of line) context.lineTo(...point);
        context.stroke();
      }
    }
    context.setLineDash([]);
    context.globalAlpha = 1;
  }

  /** What trackers tell, as diamonds with dotted trails, beside the truth. */
  drawTracks(context, view, names) {
    const size = 8 / view.scale, color = '#d6008f';
    for (const [name, {x, y, trail}] of this.tracks) {
      view.inMetres(context);
      context.strokeStyle = color;
      context.lineWidth = 1.5 / view.scale;
      context.setLineDash([2 / view.scale, 3 / view.scale]);
      context.beginPath();
      for (const point of trail) context.lineTo(...point);
      context.stroke();
      context.setLineDash([]);
      context.lineWidth = 2 / view.scale;
      context.beginPath();
      for (const [dx, dy] of [[1, 0], [0, 1], [-1, 0], [0, -1]]) context.lineTo(x + dx * size, y + dy * size);
      context.closePath();
      context.stroke();
      if (!names) continue;
      const [px, py] = view.toPage(x, y);
      view.inPixels(context);
      context.strokeStyle = '#ffffff';
      context.lineWidth = 3;
      context.strokeText(name, px + 14, py - 12);
      context.fillStyle = color;
      context.fillText(name, px + 14, py - 12);
    }
  }

  drawFloorSensors(context, view) {
    for (const {id, kind, pose, size} of this.sensors) {
      const look = this.lookOf(kind);
      if (!size || !look.shown) continue;
      const {on} = this.floor.get(id) ?? {};
      view.inMetres(context);
      context.translate(pose[0], pose[1]);
      context.rotate(pose[2] * kRad);
      context.lineWidth = 1.5 / view.scale;
      context.globalAlpha = look.opacity;
      context.strokeStyle = look.color || (kind === 'mat' ? this.colors.mat : this.colors.sensor);
      context.fillStyle = (look.color || this.colors.mat) + (on ? 'aa' : '33');
      if (kind === 'gate') context.setLineDash([5 / view.scale, 4 / view.scale]);
      else context.fillRect(-size[0] / 2, -size[1] / 2, size[0], size[1]);
      context.strokeRect(-size[0] / 2, -size[1] / 2, size[0], size[1]);
      context.setLineDash([]);
      context.globalAlpha = 1;
    }
  }

  /** Where an actuator is: on a robot, it goes with it. */
  placeOf({at, on}) {
    if (on === undefined) return at;
    const {x, y, heading} = this.all[on];
    const [c, s] = [Math.cos(heading * kRad), Math.sin(heading * kRad)];
    return x === undefined ? undefined : [x + c * at[0] - s * at[1], y + s * at[0] + c * at[1]];
  }

  /** A bulb, or a box with a bar, filled while it is on; an LED in its colour. */
  drawActuators(context, view, actuators, isOn, colorOf) {
    for (const actuator of actuators) {
      const {id, kind} = actuator, is_on = isOn(id), at = this.placeOf(actuator);
      if (!at) continue;
      const size = (kind === 'led' ? 4 : 7) / view.scale;
      view.inMetres(context);
      context.translate(...at);
      context.fillStyle = !is_on ? '#fff' : kind === 'led' ? colorOf(id) : '#f0b429';
      context.strokeStyle = this.colors.ink;
      context.lineWidth = 1.3 / view.scale;
      context.beginPath();
      if (kind === 'led') {
        context.arc(0, 0, size, 0, 2 * Math.PI);
      } else if (kind === 'lamp') {
        context.arc(0, 0, size, 0, 2 * Math.PI);
        for (const turn of [1, 3]) {
          const [x, y] = [size * Math.cos(turn * Math.PI / 4), size * Math.sin(turn * Math.PI / 4)];
          context.moveTo(-x, -y);
          context.lineTo(x, y);
        }
      } else {
        context.rect(-size, -0.7 * size, 2 * size, 1.4 * size);
      }
      context.fill();
      context.stroke();
    }
  }

  /** The actuator at a pixel. */
  actuatorAt(view, px, py) {
    const kFinger = 14;
    return this.actuators.find(actuator => {
      const at = this.placeOf(actuator);
      if (!at) return false;
      const [x, y] = view.toPage(...at);
      return Math.hypot(px - x, py - y) <= kFinger;
    });
  }

  /** Those with a place of their own: a dot, and where they look. */
  drawSensors(context, view) {
    const radius = 4 / view.scale;
    for (const {id, kind, pose, on, view: span, size} of this.sensors) {
      const look = this.lookOf(kind);
      if (on !== undefined || size || !look.shown) continue;
      view.inMetres(context);
      context.translate(pose[0], pose[1]);
      context.rotate(pose[2] * kRad);
      context.fillStyle = context.strokeStyle = look.color || (this.colorOf.get(id) ?? this.colors.sensor);
      if (span) {
        context.globalAlpha = look.opacity * (this.floor.get(id)?.motion ? 0.9 : 0.35);
        context.beginPath();
        context.moveTo(0, 0);
        context.arc(0, 0, 5 * radius, span[0] * kRad, span[1] * kRad);
        context.fill();
      }
      context.globalAlpha = look.opacity;
      context.beginPath();
      context.arc(0, 0, radius, 0, 2 * Math.PI);
      context.fill();
      context.lineWidth = 1.5 / view.scale;
      context.strokeStyle = '#fff';
      context.stroke();
      context.globalAlpha = 1;
    }
  }

  drawRobot(context, view, {length, width, center, radius, stall}) {
    const least = 4 / view.scale;  // seen from afar it is a dot
    context.fillStyle = this.colors.robot;
    context.strokeStyle = stall ? '#d55e00' : '#fff';
    context.lineWidth = (stall ? 3 : 1.2) / view.scale;
    context.beginPath();
    if (length > 0 && radius > least)
      context.roundRect(center - length / 2, -width / 2, length, width, 0.18 * Math.min(length, width));
    else
      context.arc(0, 0, Math.max(radius, least), 0, 2 * Math.PI);
    context.fill();
    context.stroke();
    const tip = length > 0 ? center + length / 2 : radius, size = Math.max(radius, least);
    context.fillStyle = '#fff';
    context.beginPath();
    context.moveTo(0.85 * tip, 0);
    context.lineTo(0.85 * tip - 0.5 * size, 0.32 * size);
    context.lineTo(0.85 * tip - 0.5 * size, -0.32 * size);
    context.fill();
  }

  /** Feet that step, shoulders, nose, head. */
  drawPerson(context, view, {height, stall, speed, phase}) {
    const tall = Math.max(height, 12 / view.scale);
    const stride = Math.min(1, Math.abs(speed) / 0.5) * 0.13 * tall * Math.sin(2 * Math.PI * phase);
    context.fillStyle = this.colors.ink;
    for (const side of [1, -1]) {
      context.beginPath();
      context.ellipse(side * stride, side * 0.06 * tall, 0.07 * tall, 0.03 * tall, 0, 0, 2 * Math.PI);
      context.fill();
    }
    context.fillStyle = this.colors.person;
    context.strokeStyle = stall ? '#d55e00' : '#fff';
    context.lineWidth = 1.2 / view.scale;
    context.globalAlpha = 0.75;
    context.beginPath();
    context.ellipse(0, 0, 0.1 * tall, 0.25 * tall, 0, 0, 2 * Math.PI);
    context.fill();
    context.globalAlpha = 1;
    context.stroke();
    context.beginPath();
    context.moveTo(0.12 * tall, 0);
    context.lineTo(0.03 * tall, 0.045 * tall);
    context.lineTo(0.03 * tall, -0.045 * tall);
    context.fill();
    context.beginPath();
    context.arc(0, 0, 0.065 * tall, 0, 2 * Math.PI);
    context.fill();
    context.stroke();
  }

  /** A person that sits, lies or points, from above: [x, y, radius, 0] or [x, y, half length, half width]. */
  drawBody(context, view, {body, stall}) {
    context.fillStyle = this.colors.person;
    context.strokeStyle = stall ? '#d55e00' : '#fff';
    context.lineWidth = 1 / view.scale;
    for (const [x, y, length, width] of body) {
      context.beginPath();
      if (width > 0) context.rect(x - length, y - width, 2 * length, 2 * width);
      else context.arc(x, y, length, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    }
  }

  ring(context, view, {radius}) {
    context.strokeStyle = '#0072b2';
    context.lineWidth = 2.5 / view.scale;
    context.beginPath();
    context.arc(0, 0, Math.max(radius, 5 / view.scale) + 5 / view.scale, 0, 2 * Math.PI);
    context.stroke();
  }

  drawNames(context, view) {
    if (this.all.length > 200) return;
    context.font = '600 12px system-ui, sans-serif';
    context.textAlign = 'center';
    context.lineWidth = 3;
    context.lineJoin = 'round';
    context.strokeStyle = '#fffdf8d9';
    const taken = [];
    const write = (text, x, wanted, color) => {
      const y = this.freeRow(taken, x, wanted, context.measureText(text).width / 2);
      context.strokeText(text, x, y);
      context.fillStyle = color;
      context.fillText(text, x, y);
    };
    for (const {id, kind, x, y, radius} of this.all) {
      if (x === undefined) continue;
      const [px, py] = view.toPage(x, y);
      write(id, px, py + Math.max(radius * view.scale, 6) + 14, this.colors[kind]);
    }
    for (const {id, kind, pose, on} of this.sensors) {
      if (on !== undefined || this.sensors.length > 60 || !this.lookOf(kind).shown) continue;
      const [px, py] = view.toPage(pose[0], pose[1]);
      const gate = this.floor.get(id);
      write(gate?.in === undefined ? id : `${id} ${gate.in} in, ${gate.out} out`, px, py - 9, this.colors.faint);
    }
  }

  /** Where a label is in nobody's way, at best where it belongs. */
  freeRow(taken, x, wanted, half) {
    const kRow = 14, rows = [0, -1, 1, -2, 2].map(row => wanted + row * kRow);
    const isFree = y => taken.every(other => Math.abs(other.y - y) >= kRow || Math.abs(other.x - x) >= other.half + half);
    const y = rows.find(isFree) ?? wanted;
    taken.push({x, y, half});
    return y;
  }

  /** The camera with a place of its own at a pixel. */
  cameraAt(view, px, py) {
    const kFinger = 14;
    return this.sensors.find(({kind, on, pose}) => {
      if (kind !== 'camera' || on !== undefined) return false;
      const [x, y] = view.toPage(pose[0], pose[1]);
      return Math.hypot(px - x, py - y) <= kFinger;
    });
  }

  /** The mover at a pixel; a finger's width counts. */
  at(view, px, py) {
    let best, least = Infinity;
    for (const mover of this.all) {
      if (mover.x === undefined) continue;
      const [x, y] = view.toPage(mover.x, mover.y), away = Math.hypot(px - x, py - y);
      if (away < least && away <= Math.max(14, mover.radius * view.scale + 4)) {
        least = away;
        best = mover;
      }
    }
    return best;
  }
}

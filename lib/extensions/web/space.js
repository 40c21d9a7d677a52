// SPDX-License-Identifier: GPL-3.0-or-later
// The compiled room in three dimensions, with robots and people: WebGL, and the mesh that the server makes of the scene.

const kVertex = `
attribute vec3 position, normal, tint;
uniform mat4 clip, model;
uniform vec3 color;
varying vec3 lit;
void main() {
  vec3 facing = (model * vec4(normal, 0.0)).xyz;
  float sun = max(dot(normalize(facing), normalize(vec3(0.35, -0.5, 0.8))), 0.0);
  lit = (color.r < 0.0 ? tint : color) * (0.55 + 0.45 * sun);
  gl_Position = clip * model * vec4(position, 1.0);
}`;
const kFragment = 'precision mediump float; varying vec3 lit; void main() { gl_FragColor = vec4(lit, 1.0); }';
const kIdentity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const kView = [-0.6, 0.9, 1];  // radians from the south and above the floor, and how far, 1 for all of the room
const kOfVertices = [-1, -1, -1];  // as colour of all: each vertex has its own

// Matrices are by columns, as WebGL has them.

function product(a, b) {
  return a.map((_, i) => [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + i % 4] * b[4 * Math.floor(i / 4) + k], 0));
}

function perspective(height, ratio, near, far) {
  const f = 1 / Math.tan(height / 2);
  return [f / ratio, 0, 0, 0, 0, f, 0, 0, 0, 0, (far + near) / (near - far), -1, 0, 0, 2 * far * near / (near - far), 0];
}

/** Of a node of glTF. */
function matrixOf({matrix, translation: [x, y, z] = [0, 0, 0], rotation: [a, b, c, d] = [0, 0, 0, 1], scale: [s, t, u] = [1, 1, 1]}) {
  return matrix ?? [
    s * (1 - 2 * (b * b + c * c)), s * 2 * (a * b + c * d), s * 2 * (a * c - b * d), 0,
    t * 2 * (a * b - c * d), t * (1 - 2 * (a * a + c * c)), t * 2 * (b * c + a * d), 0,
    u * 2 * (a * c + b * d), u * 2 * (b * c - a * d), u * (1 - 2 * (a * a + b * b)), 0, x, y, z, 1,
  ];
}

/** The triangles of a GLB: positions and normals with z up, a colour for each vertex. */
export function trianglesOf(bytes) {
  const data = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength), length = data.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + length))), start = 28 + length;
  const out = {positions: [], normals: [], tints: []};
  const read = (index, width, get, size) => {
    const {bufferView, byteOffset = 0, count} = json.accessors[index], view = json.bufferViews[bufferView];
    const step = view.byteStride ?? width * size, at = start + (view.byteOffset ?? 0) + byteOffset;
    return Array.from({length: count * width}, (_, i) => get(at + Math.floor(i / width) * step + i % width * size));
  };
  const float = at => data.getFloat32(at, true), sizes = {5121: 1, 5123: 2, 5125: 4};
  const whole = {5121: at => data.getUint8(at), 5123: at => data.getUint16(at, true), 5125: at => data.getUint32(at, true)};
  const visit = (index, parent) => {
    const node = json.nodes[index], m = product(parent, matrixOf(node));
    for (const {attributes, indices, material, mode = 4} of json.meshes[node.mesh]?.primitives ?? []) {
      if (mode !== 4) continue;
      const points = read(attributes.POSITION, 3, float, 4), facing = read(attributes.NORMAL, 3, float, 4);
      const kind = json.accessors[indices]?.componentType;
      const order = indices === undefined ? Array(points.length / 3).keys() : read(indices, 1, whole[kind], sizes[kind]);
      const color = json.materials?.[material]?.pbrMetallicRoughness?.baseColorFactor ?? [0.7, 0.7, 0.7, 1];
      for (const i of order) {
        const at = row => [0, 4, 8].reduce((sum, k, j) => sum + m[k + row] * points[3 * i + j], m[12 + row]);
        const to = row => [0, 4, 8].reduce((sum, k, j) => sum + m[k + row] * facing[3 * i + j], 0);
        out.positions.push(at(0), -at(2), at(1));
        out.normals.push(to(0), -to(2), to(1));
        out.tints.push(color[0] ** 0.6, color[1] ** 0.6, color[2] ** 0.6);  // from light to a screen, nearly
      }
    }
    for (const child of node.children ?? []) visit(child, m);
  };
  for (const index of json.scenes?.[json.scene ?? 0]?.nodes ?? []) visit(index, kIdentity);
  return out;
}

/** A prism of unit height over a regular polygon in the unit circle; of a box, four corners. */
function prism(corners) {
  const out = {positions: [], normals: [], tints: []}, turn = i => (2 * i + 1) * Math.PI / corners;
  const push = (points, normal) => points.forEach(point => {
    out.positions.push(...point);
    out.normals.push(...normal);
    out.tints.push(1, 1, 1);
  });
  for (let i = 0; i < corners; ++i) {
    const [a, b] = [turn(i), turn(i + 1)], [p, q] = [[Math.cos(a), Math.sin(a)], [Math.cos(b), Math.sin(b)]];
    const between = (a + b) / 2;
    push([[...p, 0], [...q, 0], [...q, 1], [...p, 0], [...q, 1], [...p, 1]], [Math.cos(between), Math.sin(between), 0]);
    push([[0, 0, 1], [...p, 1], [...q, 1]], [0, 0, 1]);
  }
  return out;
}

function rgb(css) { return [1, 3, 5].map(i => parseInt(css.slice(i, i + 2), 16) / 255); }

export class Space {
  /** canvas: lies over the map; ask(): fetches the mesh; changed(): is to be drawn anew; fail(text) */
  constructor(canvas, {ask, changed, fail}) {
    Object.assign(this, {canvas, ask, changed, fail, isOn: false});
    [this.yaw, this.pitch, this.away] = kView;
    const pointers = new Map();
    canvas.addEventListener('pointerdown', event => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, event);
    });
    canvas.addEventListener('pointermove', event => {
      const last = pointers.get(event.pointerId);
      if (!last) return;
      const [dx, dy] = [event.clientX - last.clientX, event.clientY - last.clientY];
      if (pointers.size === 2) {
        const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
        const span = one => Math.max(1, Math.hypot(one.clientX - other.clientX, one.clientY - other.clientY));
        this.away *= span(last) / span(event);
      }
      if (pointers.size === 2 || event.shiftKey || event.buttons > 1) this.pan(dx, dy);
      else this.turn(dx * 0.006, dy * 0.006);
      pointers.set(event.pointerId, event);
    });
    for (const name of ['pointerup', 'pointercancel']) canvas.addEventListener(name, event => pointers.delete(event.pointerId));
    canvas.addEventListener('contextmenu', event => event.preventDefault());
    canvas.addEventListener('wheel', event => {
      event.preventDefault();
      this.zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)));
    }, {passive: false});
    new ResizeObserver(() => changed()).observe(canvas);
  }

  /** Shows the room so, or no more. \returns whether it does */
  show(on) {
    this.isOn = on && this.begin();
    this.canvas.hidden = !this.isOn;
    if (this.isOn && !this.isAsked) {
      this.isAsked = true;
      this.ask();
    }
    this.changed();
    return this.isOn;
  }

  begin() {
    if (this.gl) return true;
    const gl = this.gl = this.canvas.getContext('webgl', {antialias: true});
    if (!gl) {
      this.fail('this browser has no WebGL');
      return false;
    }
    const program = gl.createProgram();
    for (const [type, text] of [[gl.VERTEX_SHADER, kVertex], [gl.FRAGMENT_SHADER, kFragment]]) {
      const shader = gl.createShader(type);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    ['position', 'normal', 'tint'].forEach((name, i) => gl.bindAttribLocation(program, i, name));
    gl.linkProgram(program);
    gl.useProgram(program);
    this.places = Object.fromEntries(['clip', 'model', 'color'].map(name => [name, gl.getUniformLocation(program, name)]));
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);  // so one sees into a room from outside
    this.box = this.stored(prism(4));
    this.round = this.stored(prism(24));
    this.canvas.addEventListener('webglcontextlost', () => {
      this.gl = this.room = null;
      this.isAsked = false;
      this.canvas.hidden = true;
      this.isOn = false;
    });
    return true;
  }

  stored({positions, normals, tints}) {
    const {gl} = this, buffers = [positions, normals, tints].map(numbers => {
      const buffer = gl.createBuffer();
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(numbers), gl.STATIC_DRAW);
      return buffer;
    });
    return {buffers, count: positions.length / 3};
  }

  /** The mesh that was asked for. */
  take(bytes) {
    if (!this.gl) return;
    for (const buffer of this.room?.buffers ?? []) this.gl.deleteBuffer(buffer);
    this.room = bytes.length > 28 ? this.stored(trianglesOf(bytes)) : null;
    if (!this.room) this.fail('there is no mesh of this room');
    this.changed();
  }

  /** The scene is another one. */
  forget(box) {
    if (box.join() !== this.limits?.join()) this.at = undefined;
    this.limits = box;
    this.isAsked = false;
    if (this.isOn) this.show(true);
  }

  turn(yaw, pitch) {
    this.yaw -= yaw;
    this.pitch = Math.min(1.55, Math.max(0.05, this.pitch + pitch));
    this.changed();
  }

  pan(dx, dy) {
    const step = this.distance / Math.max(1, this.canvas.clientHeight), [sin, cos] = [Math.sin(this.yaw), Math.cos(this.yaw)];
    this.at[0] += step * (-dx * cos - dy * sin);
    this.at[1] += step * (-dx * sin + dy * cos);
    this.changed();
  }

  zoom(factor) {
    this.away = Math.min(5, Math.max(0.02, this.away / factor));
    this.changed();
  }

  fit() {
    this.at = undefined;
    [this.yaw, this.pitch, this.away] = kView;
    this.changed();
  }

  get distance() {
    const [x0, y0, x1, y1] = this.limits, ratio = this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight);
    return this.away * 1.5 * Math.max(y1 - y0, (x1 - x0) / ratio, 2);
  }

  draw(movers, selected, follows) {
    const {gl, canvas, limits} = this, ratio = window.devicePixelRatio || 1;
    if (!this.isOn || !limits || canvas.clientWidth === 0) return;
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map(size => Math.round(size * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    this.at ??= [(limits[0] + limits[2]) / 2, (limits[1] + limits[3]) / 2];
    const kAbout = 1.5;  // metres about the one that is followed; what stands before them is cut away
    const is_near = follows && selected?.x !== undefined;
    if (is_near) this.at = [selected.x, selected.y];
    const far = 20 * this.distance, near = Math.max(far / 2000, is_near ? this.distance - kAbout : 0);
    const [sy, cy, sp, cp] = [Math.sin(this.yaw), Math.cos(this.yaw), Math.sin(this.pitch), Math.cos(this.pitch)];
    // From the world to an eye that looks at a point of the floor.
    const turn = [cy, -sy * sp, sy * cp, 0, sy, cy * sp, -cy * cp, 0, 0, cp, sp, 0, 0, 0, 0, 1];
    const toEye = product([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -this.distance, 1],
                          product(turn, [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -this.at[0], -this.at[1], 0, 1]));
    gl.viewport(0, 0, width, height);
    const is_dark = matchMedia('(prefers-color-scheme: dark)').matches;
    gl.clearColor(...is_dark ? [0.2, 0.19, 0.17] : [0.925, 0.91, 0.875], 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.uniformMatrix4fv(this.places.clip, false, product(perspective(0.9, width / height, near, far), toEye));
    if (this.room) this.put(this.room, kIdentity, kOfVertices);
    for (const mover of movers.all) this.drawMover(mover, mover === selected ? [0, 0.45, 0.7] : rgb(movers.colors[mover.kind]));
  }

  drawMover({x, y, heading, kind, length, width, center, radius, height}, color) {
    if (x === undefined) return;
    const angle = heading * Math.PI / 180, [s, c] = [Math.sin(angle), Math.cos(angle)];
    // `wide` and `deep` are half of a box, or radii.
    const put = (shape, ahead, wide, deep, low, high, tint) => this.put(shape, [
      wide * c, wide * s, 0, 0, -deep * s, deep * c, 0, 0, 0, 0, high - low, 0, x + ahead * c, y + ahead * s, low, 1,
    ], tint);
    const corner = Math.SQRT2 / 2, white = [1, 1, 1];  // a box has its corners on the circle
    if (kind === 'person') {
      put(this.round, 0, 0.1 * height, 0.15 * height, 0, 0.82 * height, color);
      put(this.round, 0, 0.06 * height, 0.06 * height, 0.84 * height, height, color);
      put(this.round, 0.06 * height, 0.02 * height, 0.02 * height, 0.88 * height, 0.94 * height, white);
      return;
    }
    if (length > 0) put(this.box, center, corner * length, corner * width, 0.02, height, color);
    else put(this.round, 0, radius, radius, 0.02, height, color);
    const tip = length > 0 ? center + 0.35 * length : 0.6 * radius, size = 0.15 * (length || 2 * radius);
    put(this.box, tip, size, size, height, height + 0.02, white);
  }

  put({buffers, count}, model, color) {
    const {gl} = this;
    buffers.forEach((buffer, i) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.enableVertexAttribArray(i);
      gl.vertexAttribPointer(i, 3, gl.FLOAT, false, 0, 0);
    });
    gl.uniformMatrix4fv(this.places.model, false, model);
    gl.uniform3fv(this.places.color, color);
    gl.drawArrays(gl.TRIANGLES, 0, count);
  }
}

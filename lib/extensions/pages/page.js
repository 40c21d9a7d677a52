// SPDX-License-Identifier: GPL-3.0-or-later
'use strict';

// A map: layers to switch, zoom, and a readout of the sensors that see a spot.
for (const figure of document.querySelectorAll('figure.map')) {
  const index = JSON.parse(figure.dataset.index), svg = figure.querySelector('svg');
  const [scale, worldX, worldY, pageX, pageY] = index.view;
  const whole = svg.viewBox.baseVal, full = [whole.x, whole.y, whole.width, whole.height];
  let box = full.slice();

  const make = (tag, parent, text) => {
    const element = document.createElement(tag);
    if (text) element.textContent = text;
    parent.append(element);
    return element;
  };
  const bar = document.createElement('div'), output = document.createElement('output');
  bar.className = 'tools';
  svg.before(bar);
  svg.after(output);

  // Zoom keeps a point of the picture where it is.
  const show = () => svg.setAttribute('viewBox', box.map((v) => +v.toFixed(2)).join(' '));
  const zoom = (factor, [x, y] = [box[0] + box[2] / 2, box[1] + box[3] / 2]) => {
    const width = Math.min(full[2], Math.max(full[2] / 64, box[2] / factor)), by = width / box[2];
    box = [x - (x - box[0]) * by, y - (y - box[1]) * by, width, box[3] * by];
    pan(0, 0);
  };
  const pan = (dx, dy) => {
    for (const [i, by] of [[0, dx], [1, dy]])
      box[i] = Math.min(full[i] + full[i + 2] - box[i + 2], Math.max(full[i], box[i] + by));
    show();
  };
  const button = (text, label, act) => {
    const one = make('button', bar, text);
    one.type = 'button';
    one.setAttribute('aria-label', label);
    one.addEventListener('click', act);
    return one;
  };
  button('+', 'zoom in', () => zoom(1.5));
  button('\u2212', 'zoom out', () => zoom(1 / 1.5));
  button('whole', 'show the whole map', () => { box = full.slice(); show(); });

  // Layers.
  const layers = make('fieldset', bar);
  layers.className = 'layers';
  make('legend', layers, 'layers');
  const allLayers = [...svg.querySelectorAll('[data-layer]')], large = ' (large)';
  for (const layer of allLayers) {
    const name = layer.dataset.layer;
    if (['frame', 'floor', 'walls'].includes(name) || name.endsWith(large) || !layer.childElementCount) continue;
    // The same layer in larger text, which the style shows on narrow screens.
    const twin = allLayers.find((other) => other.dataset.layer === name + large);
    const label = make('label', layers), box = make('input', label);
    box.type = 'checkbox';
    box.checked = !index.hidden.includes(name);
    label.append(' ' + name);
    const set = () => {
      for (const one of [layer, twin]) if (one) one.classList.toggle('off', !box.checked);
    };
    box.addEventListener('change', set);
    set();
  }

  // Each sensor's view, by a button.
  const groups = [...svg.querySelectorAll('[data-layer="views"] > g')];
  const buttons = document.createElement('div');
  buttons.className = 'tools';
  output.after(buttons);
  index.sensors.forEach((sensor, i) => {
    const one = make('button', buttons, sensor.id);
    one.type = 'button';
    one.setAttribute('aria-pressed', 'false');
    one.title = `show the floor that ${sensor.noun} ${sensor.id} sees`;
    const swatch = document.createElement('span');
    swatch.className = 'swatch';
    swatch.style.background = sensor.color;
    one.prepend(swatch);
    const path = groups[i] && groups[i].querySelector('path');
    if (path) path.style.fill = sensor.color;
    one.addEventListener('click', () => {
      const on = groups[i].classList.toggle('on');
      one.setAttribute('aria-pressed', on);
    });
  });

  // Pixels a metre: pixels a radian of the lens over the distance.
  const densityOf = (sensor, dx, dy, dz) => {
    const along = ([x, y, z]) => dx * x + dy * y + dz * z;
    const [depth, left, up] = [along(sensor.axis), along(sensor.left), along(sensor.up)];
    const rings = sensor.resolution.length / sensor.bearings - 1;
    const ring = Math.min(rings, Math.atan2(Math.hypot(left, up), depth) / sensor.widest * rings);
    const turn = (Math.atan2(-up, -left) / (2 * Math.PI) + 1) % 1 * sensor.bearings;
    const pixelsAt = (bearing) => {
      const first = bearing % sensor.bearings * (rings + 1), k = Math.min(rings - 1, Math.floor(ring));
      const [low, high] = [sensor.resolution[first + k], sensor.resolution[first + k + 1]];
      return low + (ring - k) * (high - low);
    };
    const bearing = Math.floor(turn), low = pixelsAt(bearing), high = pixelsAt(bearing + 1);
    return (low + (turn - bearing) * (high - low)) / Math.hypot(dx, dy, dz);
  };

  // The readout.
  const tell = ([px, py]) => {
    const x = worldX + (px - pageX) / scale, y = worldY - (py - pageY) / scale;
    const point = svg.createSVGPoint();
    [point.x, point.y] = [px, py];
    const seers = index.sensors.filter((sensor, i) => {
      const path = groups[i] && groups[i].querySelector('path');
      return path && path.isPointInFill(point);
    }).map((sensor) => {
      const [dx, dy, dz] = [x - sensor.at[0], y - sensor.at[1], sensor.plane - sensor.at[2]];
      const text = `${sensor.id} ${Math.hypot(dx, dy, dz).toFixed(2)} m`;
      return sensor.resolution ? `${text}, ${densityOf(sensor, dx, dy, dz).toFixed(0)} px/m` : text;
    });
    output.textContent = `(${x.toFixed(2)}, ${y.toFixed(2)}) m: ` +
      (seers.length ? `seen by ${seers.length}: ${seers.join('; ')}` : 'seen by no sensor');
  };
  const pageOf = (event) => {
    const point = svg.createSVGPoint();
    [point.x, point.y] = [event.clientX, event.clientY];
    const at = point.matrixTransform(svg.getScreenCTM().inverse());
    return [at.x, at.y];
  };
  let drag = null;
  svg.addEventListener('pointerdown', (event) => { drag = pageOf(event); });
  svg.addEventListener('pointerup', () => { drag = null; });
  svg.addEventListener('pointerleave', () => { drag = null; });
  svg.addEventListener('pointermove', (event) => {
    const at = pageOf(event);
    if (drag && event.buttons) pan(drag[0] - at[0], drag[1] - at[1]);
    tell(pageOf(event));
  });
  svg.addEventListener('wheel', (event) => {
    if (!event.ctrlKey && document.activeElement !== svg) return;
    event.preventDefault();
    zoom(event.deltaY < 0 ? 1.2 : 1 / 1.2, pageOf(event));
  }, {passive: false});
  svg.tabIndex = 0;
  svg.setAttribute('aria-description', 'arrow keys move, + and - zoom; the middle is read out');
  svg.addEventListener('keydown', (event) => {
    const step = box[2] / 10;
    const move = {ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step]}[event.key];
    if (move) pan(...move);
    else if (event.key === '+' || event.key === '=') zoom(1.5);
    else if (event.key === '-') zoom(1 / 1.5);
    else if (event.key === '0') { box = full.slice(); show(); } else return;
    event.preventDefault();
    tell([box[0] + box[2] / 2, box[1] + box[3] / 2]);
  });
  output.setAttribute('aria-live', 'polite');
  output.textContent = 'Point at the map, or tap it, to read which sensors see a spot.';
}

for (const code of document.querySelectorAll('pre')) {
  const button = document.createElement('button');
  button.type = 'button';
  button.textContent = 'copy';
  button.addEventListener('click', () => {
    navigator.clipboard.writeText(code.textContent).then(() => { button.textContent = 'copied'; });
  });
  code.before(button);
}

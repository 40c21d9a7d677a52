// SPDX-License-Identifier: GPL-3.0-or-later
// The page: what is shown, and what people do with it.
import {Link, complaint, keysOf} from './link.js';
import {View} from './view.js';
import {Plan} from './plan.js';
import {Movers} from './movers.js';
import {Driver} from './drive.js';
import {Cameras} from './camera.js';
import {eventText} from './events.js';
import {SeekBar} from './seek.js';
import {States} from './states.js';

const part = id => document.getElementById(id);
const canvas = part('map'), context = canvas.getContext('2d');
const view = new View(canvas);
const drivers = new Map();  // by id
const cameras = new Cameras(part, why => tell(why, true));
const states = new States(part, tell);
const seekBar = new SeekBar(part('seek'), tell);
let plan, movers, frame, selected, following = false, fitted = false;
let link, dirty = false, asked = false;

// What the server says.

function connect() {
  link = new Link({
    open: () => {
      banner('');
      link.takeRole('WORLD').then(answer => {
        if (answer.startsWith('ERR')) tell(complaint(answer), true);
        else {
          link.ask('EVENTS');
          link.ask('LIST').then(listRooms);
          states.open(link);
          seekBar.open(link);
        }
      });
      link.send('FRAME');
      asked = true;
    },
    json: object => object.plan ? takeScene(object) : takeFrame(object),
    line: line => {
      states.line(line);
      const {text, bad} = eventText(line);
      if (text) tell(text, bad);
    },
    close: code => {
      banner(code === 1001 ? 'The run has ended.' : 'No connection to simrun: trying again…');
      document.body.classList.add('paused');
      if (code !== 1001) setTimeout(connect, 2000);
    },
  });
}

/** The rooms of a building, to choose from. */
function listRooms(answer) {
  const rooms = keysOf(answer).rooms?.split(',') ?? [];
  if (rooms.length === 0 || Link.rooms.length > 0) return;
  Link.rooms = rooms;
  Link.room = rooms[0];
  part('rooms').replaceChildren(...rooms.map(room => new Option(room)));
  part('rooms').hidden = false;
}

part('rooms').addEventListener('change', () => {
  Link.room = part('rooms').value;
  selected = null;
  fitted = false;
  const old = link;
  old.on = {};
  old.close();
  connect();
});

function takeScene(scene) {
  const id = selected?.id;
  plan = new Plan(scene);
  movers = new Movers(scene);
  frame = null;
  selected = movers.byId.get(id);
  part('title').textContent = document.title = scene.title || 'simrun';
  if (!fitted) {
    view.measure();
    view.fit(plan.box);
    fitted = true;
  }
  listMovers();
  cameras.list(movers.sensors);
  states.know(movers.sensors);
}

function takeFrame(next) {
  asked = false;
  showClock(next);
  frame = next;
  movers.take(next);
  showDetails();
  redraw();
}

function banner(text) {
  part('banner').textContent = text;
  part('banner').hidden = text === '';
}

function tell(text, bad = false) {
  const item = document.createElement('li');
  item.textContent = text;
  item.classList.toggle('bad', bad);
  part('log').prepend(item);
  if (part('log').children.length > 100) part('log').lastChild.remove();
}

// Drawing: once for each picture the browser shows, and only then the next frame is asked for.

function redraw() {
  if (dirty) return;
  dirty = true;
  requestAnimationFrame(draw);
}

function draw() {
  dirty = false;
  if (!plan) return;
  view.measure();
  if (following && selected) [view.x, view.y] = [selected.x, selected.y];
  const shown = name => part(name).checked;
  plan.draw(context, view, shown('names'));
  if (frame) {
    movers.draw(context, view, {scans: shown('scans'), trails: shown('trails'), names: shown('names'), selected});
    for (const driver of drivers.values()) drawGoal(driver.mover, driver.goal, '#0072b2');
    if (drag?.x !== undefined && drag.moved) drawGoal(drag.mover, drag, '#d55e00');
  }
  if (asked) return;
  asked = true;
  link.send('FRAME');
}

function drawGoal(mover, goal, color) {
  if (!goal) return;
  view.inPixels(context);
  const [x0, y0] = view.toPage(mover.x, mover.y), [x, y] = view.toPage(goal.x, goal.y);
  context.strokeStyle = color;
  context.lineWidth = 2;
  context.setLineDash([6, 5]);
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x, y);
  context.stroke();
  context.setLineDash([]);
  context.beginPath();
  context.arc(x, y, Math.max(6, mover.radius * view.scale), 0, 2 * Math.PI);
  context.stroke();
}

// Beside the map.

let pace = null;
/** How fast the world goes, once a second. */
function paceOf(next) {
  const now = performance.now();
  if (!frame || next.paused || next.t < pace?.t) pace = null;
  if (!pace || now - pace.now > 1000) {
    const rate = pace ? (next.t - pace.t) / (now - pace.now) * 1000 : 0;
    pace = {now, t: next.t, rate};
  }
  const digits = pace.rate >= 9.5 ? 0 : pace.rate >= 0.95 ? 1 : 2;
  // One that has just begun has none yet.
  return pace.rate < 0.005 ? '' : `${pace.rate.toFixed(digits)} × real time`;
}

function showClock(next) {
  part('time').textContent = `${next.t.toFixed(2)} s`;
  seekBar.show(next.t);
  const rate = paceOf(next);
  part('pace').textContent = (next.replay ? 'record, ' : '') + (next.over ? 'at its end' : next.paused ? 'paused' : rate);
  document.body.classList.toggle('paused', next.paused);
  part('run').textContent = next.paused ? 'Resume' : 'Pause';
  part('run').disabled = next.clock === 'step' || next.over;
  part('step').disabled = !next.paused || next.over;
  if (next.replay !== frame?.replay) showHelp(next.replay);
}

/** Who is in a record goes where it went. */
function showHelp(is_replay) {
  part('pad').hidden = !selected || is_replay;
  part('pad').classList.toggle('sidles', selected?.side > 0);
  part('hint').textContent = is_replay ?
    'This is a record: pause it, take single steps, go to a time by the slider, follow who is in it.' :
    !selected ? 'Select a robot here or on the map. Drag it to where it is to go, or drive it with the arrow keys.' :
    `Arrow keys drive${selected.side > 0 ? ', Q and E go sideways' : ''}, Escape stops. Drag ${selected.id} to where it is to go.`;
}

function listMovers() {
  part('movers').replaceChildren(...movers.all.slice(0, 500).map(mover => {
    const item = document.createElement('li'), button = document.createElement('button');
    const model = document.createElement('span');
    model.className = 'model';
    model.textContent = mover.model ?? '';
    button.append(mover.id, model);
    button.classList.add(mover.kind);
    button.onclick = () => select(mover === selected ? undefined : mover);
    mover.button = button;
    item.append(button);
    return item;
  }));
  select(selected);
}

function showDetails() {
  for (const {button, stall, model} of movers.all) {
    if (!button || button.classList.contains('stall') === Boolean(stall)) continue;
    button.classList.toggle('stall', stall);
    button.lastChild.textContent = stall ? 'stalled' : model ?? '';
  }
  part('name').textContent = selected ? selected.id : 'Nothing selected';
  const facts = selected?.x === undefined ? [] : [
    ['x', `${selected.x.toFixed(3)} m`], ['y', `${selected.y.toFixed(3)} m`],
    ['heading', `${selected.heading.toFixed(1)}°`],
    ['speed', `${selected.speed.toFixed(2)} m/s`], ['turn', `${selected.rotspeed.toFixed(0)}°/s`],
  ];
  const list = part('facts');
  while (list.children.length > 2 * facts.length) list.lastChild.remove();
  facts.forEach(([name, value], i) => {
    if (!list.children[2 * i]) list.append(document.createElement('dt'), document.createElement('dd'));
    list.children[2 * i].textContent = name;
    list.children[2 * i + 1].textContent = value;
  });
}

function select(mover) {
  for (const [id, driver] of drivers) {
    if (id === mover?.id || driver.busy) continue;
    driver.release();
    drivers.delete(id);
  }
  selected = mover;
  for (const {button, id} of movers.all) button?.setAttribute('aria-pressed', id === mover?.id);
  showHelp(frame?.replay);
  if (!mover) follow(false);
  showDetails();
  redraw();
}

function follow(on) {
  following = on && Boolean(selected);
  part('follow').setAttribute('aria-pressed', following);
  redraw();
}

/** Who drives the selected one; made when it is first needed. */
function driverOf(mover) {
  const known = drivers.get(mover.id);
  if (known && !known.gone) {
    known.mover = mover;
    return known;
  }
  const driver = new Driver(mover, tell, redraw);
  drivers.set(mover.id, driver);
  return driver;
}

// Buttons and keys.

async function request(text) {
  const answer = await link.ask(text);
  if (answer.startsWith('ERR')) tell(complaint(answer), true);
}

const actions = {
  run: () => { if (frame && frame.clock !== 'step') request(frame.paused ? 'RESUME' : 'PAUSE'); },
  step: () => { if (frame?.paused) request('STEP'); },
  follow: () => follow(!following),
  fit: () => { follow(false); view.fit(plan.box); redraw(); },
  closer: () => { view.zoom(1.3); redraw(); },
  farther: () => { view.zoom(1 / 1.3); redraw(); },
};
for (const [id, act] of Object.entries(actions)) part(id).onclick = () => plan && act();
for (const id of ['scans', 'trails', 'names']) part(id).onchange = redraw;

const shortcuts = {' ': 'run', '.': 'step', f: 'follow', 0: 'fit', '+': 'closer', '=': 'closer', '-': 'farther'};
/** Of keys that drive, how far they move the map when nobody is selected. */
const arrows = {ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60], q: [0, 0], e: [0, 0]};

/** As on a keyboard with Caps Lock or without. */
function keyName(event) { return event.key.length === 1 ? event.key.toLowerCase() : event.key; }

function key(name, down, repeated = false) {
  if (name in arrows) {
    if (selected && !frame?.replay) {
      if (!repeated) driverOf(selected).press(name, down);
    } else if (down) {
      view.pan(...arrows[name]);
      redraw();
    }
    return true;
  }
  if (!down) return false;
  if (name === 'Escape' && selected) {
    const driver = drivers.get(selected.id);
    if (driver?.busy) driver.stop();
    else select();
    return true;
  }
  if (name in shortcuts) actions[shortcuts[name]]();
  return name in shortcuts;
}

window.addEventListener('keydown', event => {
  if (!plan || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.target.matches?.('#state-list input')) return;  // typed there
  const onButton = event.target.closest?.('button, input');
  if (onButton && event.key === ' ') return;  // presses that
  if (onButton === part('seek') && event.key in arrows) return;  // moves that
  if (key(keyName(event), true, event.repeat)) event.preventDefault();
});
window.addEventListener('keyup', event => { if (plan && keyName(event) in arrows) key(keyName(event), false); });
window.addEventListener('blur', () => { for (const driver of drivers.values()) if (driver.keys.size) driver.stop(); });
for (const button of part('pad').children) {
  button.addEventListener('pointerdown', event => {
    event.preventDefault();
    button.setPointerCapture(event.pointerId);
    key(button.dataset.key, true);
  });
  for (const name of ['pointerup', 'pointercancel'])
    button.addEventListener(name, () => { if (button.dataset.key in arrows) key(button.dataset.key, false); });
}

// The map under a pointer or two.

let drag = null, pinch = null;
const pointers = new Map();

function placeOf(event) {
  const box = canvas.getBoundingClientRect();
  return [event.clientX - box.left, event.clientY - box.top];
}

canvas.addEventListener('pointerdown', event => {
  if (!movers) return;
  canvas.focus({preventScroll: true});
  canvas.setPointerCapture(event.pointerId);
  const [px, py] = placeOf(event);
  pointers.set(event.pointerId, [px, py]);
  if (pointers.size === 2) {
    drag = null;
    pinch = spanOf();
    return;
  }
  drag = {px, py, mover: movers.at(view, px, py), moved: false};
  if (drag.mover && drag.mover !== selected) select(drag.mover);
});

function spanOf() {
  const [[x0, y0], [x1, y1]] = pointers.values();
  return {length: Math.max(1, Math.hypot(x1 - x0, y1 - y0)), x: (x0 + x1) / 2, y: (y0 + y1) / 2};
}

canvas.addEventListener('pointermove', event => {
  if (!movers) return;
  const [px, py] = placeOf(event), [x, y] = view.toWorld(px, py);
  if (pointers.has(event.pointerId)) pointers.set(event.pointerId, [px, py]);
  if (pinch && pointers.size === 2) {
    const span = spanOf();
    view.pan(span.x - pinch.x, span.y - pinch.y);
    view.zoom(span.length / pinch.length, span.x, span.y);
    pinch = span;
  } else if (drag) {
    drag.moved ||= Math.hypot(px - drag.px, py - drag.py) > 6;
    if (drag.mover && !frame?.replay) Object.assign(drag, {x, y});
    else if (drag.moved) {
      follow(false);
      view.pan(px - drag.px, py - drag.py);
      Object.assign(drag, {px, py});
    }
  }
  const over = movers.at(view, px, py) ?? movers.cameraAt(view, px, py);
  canvas.classList.toggle('over', Boolean(over));
  canvas.classList.toggle('moving', Boolean(drag?.moved));
  const what = over?.id ?? plan.titleAt(x, y);
  part('place').textContent = `${x.toFixed(2)}, ${y.toFixed(2)}${what ? ` · ${what}` : ''}`;
  if (drag || pinch) redraw();
});

function letGo(event) {
  pointers.delete(event.pointerId);
  if (pointers.size < 2) pinch = null;
  const done = drag;
  drag = null;
  canvas.classList.remove('moving');
  if (event.type === 'pointerup' && done?.x !== undefined && done.moved) driverOf(done.mover).goTo(done.x, done.y);
  else if (event.type === 'pointerup' && done && !done.mover && !done.moved) {
    const camera = movers.cameraAt(view, ...placeOf(event));
    if (camera) cameras.look(camera.id);
    else select();
  }
  redraw();
}
canvas.addEventListener('pointerup', letGo);
canvas.addEventListener('pointercancel', letGo);
canvas.addEventListener('pointerleave', () => { if (!drag) part('place').textContent = ''; });
canvas.addEventListener('wheel', event => {
  event.preventDefault();
  view.zoom(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), ...(following ? [] : placeOf(event)));
  redraw();
}, {passive: false});
new ResizeObserver(() => {
  if (!plan) return;
  const before = view.width;
  view.measure();
  if (before <= 1) view.fit(plan.box);
  redraw();
}).observe(canvas);

connect();

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
import {History} from './history.js';
import {Building} from './building.js';
import {Pace} from './pace.js';
import {Editor} from './edit.js';
import {Layers} from './layers.js';
import {Space} from './space.js';
import {MarkStrip} from './marks.js';
import {Ruler, SendTool, drawArrow} from './tools.js';
import {dayText, showHours, timeText} from './clock.js';

const part = id => document.getElementById(id);
const canvas = part('map'), context = canvas.getContext('2d');
const view = new View(canvas);
const drivers = new Map();  // by id
const cameras = new Cameras(part, why => tell(why, true));
const history = new History(part);
/** The device that the page shows alone, as a handheld does: ?device=ID; '' for the room. */
const device = new URLSearchParams(location.search).get('device') ?? '';
document.body.classList.toggle('device', device !== '');
const states = new States(part, tell, history, redraw, device);
const seekBar = new SeekBar(part('seek'), tell);
const marks = new MarkStrip(part('marks'), seekBar, tell);
const layers = new Layers(part('kinds'), redraw);
const space = new Space(part('space'), {ask: () => link.send('ROOM'), changed: redraw, fail: text => tell(text, true)});
const building = new Building(moved);
const pace = new Pace();
const buttons = new Map();  // of the movers in the list, by id
let plan, movers, frame;
let chosen;  // the id of what is selected, wherever it is
let selected;  // it, if it is in the room that is shown
let following = false, untouched = true;  // untouched: the map shows the whole room, as nobody has moved it
let link, dt = 0, dirty = false, asked = false, ended = false;

// What the server says.

function connect() {
  let listed;
  const are_listed = new Promise(done => { listed = done; });
  link = new Link({
    open: () => {
      if (ended) return location.reload();  // another run, perhaps of another version
      banner('');
      pace.reset();
      const begun = link;
      link.takeRole('WORLD').then(answer => {
        if (begun !== link) return;
        if (answer.startsWith('ERR')) return tell(complaint(answer), true);
        dt = Number(keysOf(answer).dt);
        link.ask('EVENTS');
        link.ask('LIST').then(list => {
          if (begun === link && building.open(link, list)) listRooms();
          listed();
        });
        states.open(link).then(checkDevice);
        seekBar.open(link).then(() => marks.draw());
      });
      link.send('FRAME');
      asked = true;
    },
    bytes: (line, bytes) => { if (line.startsWith('ROOM ')) space.take(bytes); },
    json: object => object.plan ? takeScene(object) : takeFrame(object),
    line: line => {
      states.line(line);
      building.tellEvent(line, one => {
        const {text, bad} = eventText(one);
        if (text) tell(text, bad);
      });
    },
    close: code => {
      building.close();
      ended ||= code === 1001;
      banner(ended ? 'The run has ended. The next one here is shown as soon as it begins.'
                   : 'No connection to simrun: trying again…');
      document.body.classList.add('paused');
      if (part('token').hidden) setTimeout(connect, 2000);
    },
  });
  link.listed = are_listed;
}

// Where the run wants a token that the address does not give, or refuses the one that it gives: a form.

Link.refused = answer => {
  part('token').hidden = false;
  part('token-later').hidden = !plan;
  part('token-why').textContent = Link.token ? `${complaint(answer)}.` : 'This run wants its token.';
  part('token-text').focus();
};

part('token').addEventListener('submit', event => {
  event.preventDefault();
  Link.token = part('token-text').value.trim();
  part('token').hidden = true;
  reconnect();
});
part('token-later').onclick = () => {
  part('token').hidden = true;
  if (link.isClosed) reconnect();
};

function reconnect() {
  const old = link;
  old.on = {};
  building.close();
  old.close();
  connect();
}

/** The rooms of a building, to choose from. */
function listRooms() {
  part('rooms').replaceChildren(...Link.rooms.map(room => new Option(room)));
  part('rooms').value = Link.room;
  part('rooms').hidden = Link.rooms.length === 0;
}

function showRoom(room) {
  if (room === Link.room) return;
  Link.room = part('rooms').value = room;
  selected = null;
  untouched = true;
  reconnect();
}

part('rooms').addEventListener('change', () => {
  follow(false);
  showRoom(part('rooms').value);
});

/** A mover has come to another room: the list says so, and the map goes along with the one that it follows. */
function moved() {
  listMovers();
  if (following && building.where.has(chosen)) showRoom(building.where.get(chosen));
}

function takeScene(scene) {
  plan = new Plan(scene);
  movers = new Movers(scene, movers);
  selected = movers.byId.get(chosen);
  for (const [id, driver] of drivers) driver.mover = movers.byId.get(id) ?? driver.mover;
  part('title').textContent = document.title = scene.title || 'simrun';
  fitUntouched();
  space.forget(plan.box);
  listMovers();
  cameras.list(movers.sensors);
  layers.show(movers.sensors, kind => movers.colorOfKind(kind));
  marks.list(scene.marks ?? [], scene.colors);
  states.know(movers.sensors, zoneOf, scene.switched ?? []);
  editor.open(link, scene);
  if (!device) return;
  part('title').textContent = document.title = device;
  if (isCamera(device) && cameras.shown?.id !== device) cameras.look(device);
}

function isCamera(id) { return movers?.sensors.some(sensor => sensor.id === id && sensor.kind === 'camera'); }

/** Says so if there is no such device. */
function checkDevice() {
  if (device && plan && !states.has(device) && !isCamera(device)) banner(`No thing with states, and no camera, is ${device}.`);
}

/** The zone in which something of the room is. */
function zoneOf(id) {
  const sensor = movers.sensors.find(other => other.id === id);
  const actuator = movers.actuators.find(other => other.id === id);
  const at = (actuator && movers.placeOf(actuator)) ??
    (sensor ? sensor.on === undefined && sensor.pose : plan.middleOf(id));
  return at ? plan.zoneAt(at[0], at[1]) : '';
}

/** Unless people have moved the map, it shows the whole room. */
function fitUntouched() {
  view.measure();
  if (untouched || !view.meets(plan.box)) view.fit(plan.box);
}

function takeFrame(next) {
  asked = false;
  showClock(next);
  frame = next;
  movers.take(next);
  if (selected) for (const [name, , value] of factsOf(selected)) history.add(`${selected.id} ${name}`, next.t, value, 0.1);
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
  item.hidden = !isWanted(item);
  part('log').prepend(item);
  if (part('log').children.length > 100) part('log').lastChild.remove();
  if (bad) notice(text);
}

/** Says on the map, too, what goes wrong: the log may be out of sight. */
function notice(text) {
  clearTimeout(notice.timer);
  part('notice').textContent = text;
  part('notice').hidden = false;
  notice.timer = setTimeout(() => { part('notice').hidden = true; }, 6000);
}

/** Whether a line has what people look for in the log. */
function isWanted(item) { return item.textContent.toLowerCase().includes(part('log-find').value.trim().toLowerCase()); }

part('log-find').addEventListener('input', () => {
  for (const item of part('log').children) item.hidden = !isWanted(item);
});

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
  if (space.isOn) space.draw(movers, selected, following);
  else if (!device) drawMap(shown);
  if (asked) return;
  asked = true;
  link.send('FRAME');
}

function drawMap(shown) {
  plan.draw(context, view, shown('names'));
  if (frame) {
    movers.draw(context, view, {
      scans: shown('scans'), trails: shown('trails'), ways: shown('ways'), tracks: shown('tracks'), names: shown('names'),
      chosen, selected,
      isOn: id => states.isOn(id), colorOf: id => states.colorOf(id), lookOf: kind => layers.of(kind),
    });
    for (const driver of drivers.values()) {
      if (driver.goal?.room === Link.room) drawGoal(driver.mover, driver.goal, '#0072b2');
      if (driver.refused?.room === Link.room) drawRefused(driver.refused);
    }
    if (drag?.x !== undefined && drag.moved) drawAim(drag);
  }
  tool?.draw(context, view);
}

/** A goal that is dragged from a mover. */
function drawAim({mover, x, y}) {
  view.inPixels(context);
  context.strokeStyle = '#d55e00';
  context.lineWidth = 2;
  context.setLineDash([6, 5]);
  context.beginPath();
  context.moveTo(...view.toPage(mover.x, mover.y));
  context.lineTo(...view.toPage(x, y));
  context.stroke();
  context.setLineDash([]);
  drawGoal(mover, {x, y}, '#d55e00');
}

/** A goal, and its heading if it has one; see Movers for ways. */
function drawGoal({radius = 0}, goal, color) {
  view.inPixels(context);
  const [x, y] = view.toPage(goal.x, goal.y);
  context.strokeStyle = color;
  context.lineWidth = 2;
  context.beginPath();
  context.arc(x, y, Math.max(6, radius * view.scale), 0, 2 * Math.PI);
  context.stroke();
  if (goal.heading === undefined) return;
  const angle = goal.heading * Math.PI / 180, length = 28 / view.scale;
  drawArrow(context, view, [goal.x, goal.y], [goal.x + length * Math.cos(angle), goal.y + length * Math.sin(angle)], color);
}

/** A goal that could not be reached, and why. */
function drawRefused({x, y, why}) {
  const [px, py] = view.toPage(x, y), size = 8;
  view.inPixels(context);
  context.strokeStyle = context.fillStyle = '#b3261e';
  context.lineWidth = 3;
  context.beginPath();
  for (const way of [1, -1]) {
    context.moveTo(px - size, py - way * size);
    context.lineTo(px + size, py + way * size);
  }
  context.stroke();
  context.font = '600 12px system-ui, sans-serif';
  context.textAlign = 'center';
  context.strokeStyle = '#fffdf8';
  context.strokeText(why, px, py - size - 6);
  context.fillText(why, px, py - size - 6);
}

// Beside the map.

/** Whether the hour matters: people follow days, or the record of such a run lasts a day. */
function lived(next) { return next.days || seekBar.end >= 86400; }

function showClock(next) {
  showHours(lived(next));
  part('time').textContent = lived(next) ? dayText(next.t) : timeText(next.t, dt);
  part('time').title = lived(next) ? timeText(next.t, dt) : '';
  seekBar.show(next.t);
  history.tick(next.t);
  if (next.paused || next.t < frame?.t) pace.reset();
  else pace.add(next.t, performance.now());
  const {rate} = pace, digits = rate >= 9.5 ? 0 : rate >= 0.95 ? 1 : 2;
  const going = rate < 0.005 ? '' : `${rate.toFixed(digits)} × real time`;  // not yet known
  part('pace').textContent = (next.replay ? 'record, ' : '') + (next.over ? 'at its end' : next.paused ? 'paused' : going);
  document.body.classList.toggle('paused', next.paused);
  showRate(next);
  part('run').textContent = next.paused ? 'Resume' : 'Pause';
  part('run').disabled = next.clock === 'step' || next.over;
  part('step').disabled = !next.paused || next.over;
  if (next.replay !== frame?.replay) showHelp(next.replay);
}

const kRates = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 300];

/** The rate of the clock, to choose from; one that is none of ours joins them. */
function showRate({clock, rate}) {
  const list = part('rate');
  list.hidden = clock !== 'real';
  if (list.hidden || Number(list.value) === rate || document.activeElement === list) return;
  const rates = [...new Set([...kRates, rate])].sort((a, b) => a - b);
  list.replaceChildren(...rates.map(one => new Option(`${one} ×`, one, false, one === rate)));
}

part('rate').addEventListener('change', () => {
  pace.reset();
  request(`RATE ${part('rate').value}`);
});

/** Movers of a record go where they went. */
function showHelp(is_replay) {
  part('pad').hidden = !selected || is_replay;
  part('pad').classList.toggle('sidles', selected?.side > 0);
  part('send').disabled = !sendable() || is_replay;
  if (part('send').disabled && tool === tools.send) choose(null);
  part('hint').textContent = is_replay ?
    'This is a record: pause it, take single steps, go to a time by the slider or to the next mark (n), follow who is in it.' :
    !selected && sendable() ? `${chosen} is in ${building.where.get(chosen)}. Send it (g) to a point of this storey.` :
    !selected ? 'Select a robot here or on the map. Drag it to where it is to go, or drive it with the arrow keys.' :
    `Arrow keys drive${selected.side > 0 ? ', Q and E go sideways' : ''}, Escape stops. Drag ${selected.id} to where it is to go, or Send it (g).`;
}

/** Those of all rooms, in the order of the record; what is in the list stays there, with the focus. */
function listMovers() {
  const others = [...building.where.keys()].filter(id => !movers?.byId.has(id));
  const ids = [...movers?.all.map(({id}) => id) ?? [], ...others].slice(0, 500);
  for (const [id, button] of buttons) {
    if (ids.includes(id)) continue;
    button.parentNode.remove();
    buttons.delete(id);
  }
  for (const id of ids) if (!buttons.has(id)) addButton(id);
  part('others').hidden = buttons.size === 0;
  select(chosen);
}

function addButton(id) {
  const item = document.createElement('li'), button = document.createElement('button');
  const note = document.createElement('span');
  note.className = 'model';
  button.append(id, note);
  button.onclick = () => {
    if (id === chosen) return select();
    select(id);
    if (building.where.has(id)) showRoom(building.where.get(id));
  };
  buttons.set(id, button);
  item.append(button);
  part('movers').append(item);
}

/** What the list says of each: that it stands, its model, or in which other room it is. */
function showNotes() {
  for (const [id, button] of buttons) {
    const mover = movers.byId.get(id), room = building.where.get(id) ?? '';
    const note = !mover ? room : mover.stall ? 'stalled' : mover.model ?? '';
    const kind = mover?.kind ?? (button.classList.contains('person') ? 'person' : 'robot');
    const look = `${kind}${mover?.stall ? ' stall' : ''}${mover ? '' : ' away'}`;
    if (button.lastChild.textContent !== note) button.lastChild.textContent = note;
    if (button.className !== look) button.className = look;
  }
}

/** Names, texts and values of what is known of a mover: its motion, and how near its range finders see something. */
function factsOf(mover) {
  const {x, y, heading, speed, rotspeed} = mover;
  const near = movers.scannersOf(mover).map(id => [id, movers.nearest.get(id)]);
  return [
    ['x', `${x.toFixed(3)} m`, x], ['y', `${y.toFixed(3)} m`, y], ['heading', `${heading.toFixed(1)}°`, heading],
    ['speed', `${speed.toFixed(2)} m/s`, speed], ['turn', `${rotspeed.toFixed(0)}°/s`, rotspeed],
    ...near.map(([id, range]) => [`${id} nearest`, range < Infinity ? `${range.toFixed(2)} m` : 'none', range]),
  ];
}

/** A row of facts, with a button for the course of its value. */
function addFact(list) {
  const value = document.createElement('dd'), text = document.createElement('span'), course = document.createElement('button');
  course.className = 'course';
  course.onclick = () => history.show(course.dataset.name);
  value.append(text, course);
  list.append(document.createElement('dt'), value);
}

function showDetails() {
  showNotes();
  part('name').textContent = chosen ?? 'Nothing selected';
  const facts = selected ? (selected.x === undefined ? [] : factsOf(selected)) :
    building.where.has(chosen) ? [['in', building.where.get(chosen)]] : [];
  const list = part('facts');
  while (list.children.length > 2 * facts.length) list.lastChild.remove();
  facts.forEach(([name, value], i) => {
    if (!list.children[2 * i]) addFact(list);
    const [text, course] = list.children[2 * i + 1].children;
    list.children[2 * i].textContent = name;
    text.textContent = value;
    course.dataset.name = `${chosen} ${name}`;
    course.title = course.ariaLabel = `course of ${chosen} ${name}`;
    course.hidden = !history.has(course.dataset.name);
  });
}

/** Selects by id; none: nothing. */
function select(id) {
  for (const [known, driver] of drivers) {
    if (known === id || driver.busy) continue;
    driver.release();
    drivers.delete(known);
  }
  selected = movers?.byId.get(id);
  chosen = selected || building.where.has(id) ? id : undefined;
  for (const [known, button] of buttons) button.setAttribute('aria-pressed', known === chosen);
  if (!chosen) follow(false);
  if (!movers) return;
  showHelp(frame?.replay);
  showDetails();
  redraw();
}

function follow(on) {
  following = on && chosen !== undefined;
  part('follow').setAttribute('aria-pressed', following);
  redraw();
}

/** The driver of a mover; made when it is first needed. */
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

/** The one that Send sends: the selected one, in a building also if it is on another storey. */
function sendable() {
  return selected ?? (building.where.has(chosen) ? {id: chosen, kind: building.kinds.get(chosen)} : undefined);
}

// Tools of the map.

let tool = null;
const tools = {
  send: new SendTool(sendable, (mover, x, y, heading) => driverOf(mover).goTo(x, y, heading)),
  measure: new Ruler(text => say(text)),
  edit: null,
};
const editor = tools.edit = new Editor(part, {idAt: thingAt, poseOf, outlineOf: id => plan.outlineOf(id)}, {
  tell, say, changed: redraw, take: () => { if (tool !== editor) choose(editor); },
});

/** The id of the record at a pixel. */
function thingAt(px, py) {
  const kFinger = 14;
  const sensor = movers.sensors.find(({on, pose, size}) => {
    if (on !== undefined || size) return false;
    const [x, y] = view.toPage(pose[0], pose[1]);
    return Math.hypot(px - x, py - y) <= kFinger;
  });
  const found = movers.at(view, px, py) ?? sensor ?? movers.actuatorAt(view, px, py);
  if (found) return found.id;
  const mat = movers.sensors.find(({pose, size}) => {
    const [x, y] = view.toWorld(px, py);
    return size && Math.hypot(x - pose[0], y - pose[1]) <= Math.max(0.15, Math.max(...size) / 2);
  });
  return plan.idAt(...view.toWorld(px, py), id => editor.records.has(id) && id !== mat?.id) ?? mat?.id;
}

/** Where something is now: {x, y, heading}. */
function poseOf(id) {
  const mover = movers.byId.get(id), sensor = movers.sensors.find(other => other.id === id);
  const {at, heading} = editor.records.get(id)?.keys ?? {};
  if (mover) return mover.x === undefined ? undefined : mover;
  if (sensor && sensor.on === undefined) return {x: sensor.pose[0], y: sensor.pose[1], heading: sensor.pose[2]};
  const [x, y] = at?.split(',').map(Number) ?? plan.middleOf(id) ?? [];
  return x === undefined ? undefined : {x, y, heading: Number(heading ?? 0)};
}

/** Takes up a tool, or lays down the one that is used. */
function choose(next) {
  if (space.isOn && next) actions.solid();  // they are about the plan
  tool?.end();
  tool = next === tool ? null : next;
  for (const [id, one] of Object.entries(tools)) part(id).setAttribute('aria-pressed', one === tool);
  canvas.classList.toggle('aims', Boolean(tool));
  say(tool?.hint ?? '');
  redraw();
}

function say(text) {
  part('said').textContent = text;
  part('said').hidden = text === '';
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
  fit: () => { follow(false); untouched = true; view.fit(plan.box); space.fit(); },
  closer: () => space.isOn ? space.zoom(1.3) : zoomed(1.3),
  farther: () => space.isOn ? space.zoom(1 / 1.3) : zoomed(1 / 1.3),
  solid: () => {
    if (tool) choose(null);
    part('solid').setAttribute('aria-pressed', space.show(!space.isOn));
  },
  send: () => { if (!part('send').disabled) choose(tools.send); },
  measure: () => choose(tools.measure),
  edit: () => choose(tools.edit),
};

function zoomed(factor, ...at) {
  untouched = false;
  view.zoom(factor, ...at);
  redraw();
}

function panned(dx, dy) {
  if (space.isOn) return space.turn(dx / 200, dy / 200);
  untouched = false;
  view.pan(dx, dy);
  redraw();
}

for (const [id, act] of Object.entries(actions)) part(id).onclick = () => plan && act();
for (const id of ['scans', 'trails', 'ways', 'tracks', 'names']) part(id).onchange = redraw;

const shortcuts = {' ': 'run', '.': 'step', f: 'follow', g: 'send', m: 'measure', v: 'solid', 0: 'fit', '+': 'closer', '=': 'closer', '-': 'farther'};
/** Of keys that seek in a record, how many seconds. */
const jumps = {'[': -1, ']': 1, '{': -60, '}': 60};
/** Of keys that go to marks in a record, the direction. */
const leaps = {n: 1, p: -1};
/** Of keys that drive, how far they move the map when nobody is selected. */
const arrows = {ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60], q: [0, 0], e: [0, 0]};

/** As on a keyboard with Caps Lock or without. */
function keyName(event) { return event.key.length === 1 ? event.key.toLowerCase() : event.key; }

function key(name, down, repeated = false) {
  if (name in arrows) {
    if (selected && !frame?.replay) {
      if (!repeated) driverOf(selected).press(name, down);
    } else if (down) {
      panned(...arrows[name]);
    }
    return true;
  }
  if (!down) return false;
  if (name === 'Escape' && tool) {
    choose(null);
    return true;
  }
  if (name === 'Escape' && selected) {
    const driver = drivers.get(selected.id);
    if (driver?.busy) driver.stop();
    else select();
    return true;
  }
  if (name === 'Delete' && tool === editor) {
    editor.remove();
    return true;
  }
  if (name in shortcuts) actions[shortcuts[name]]();
  if (name in jumps) seekBar.move(jumps[name]);
  if (name in leaps) marks.step(leaps[name]);
  return name in shortcuts || name in jumps || name in leaps;
}

window.addEventListener('keydown', event => {
  if (event.ctrlKey && event.key === 'z' && tool === editor && !event.target.matches?.('input')) editor.undo();
  if (!plan || event.ctrlKey || event.metaKey || event.altKey) return;
  if (event.target.matches?.('select, input:not([type=checkbox], [type=range])')) return;  // typed there
  if (event.target.matches?.('#state-list input') && event.key in arrows) return;  // moves that slider
  const onButton = event.target.closest?.('button, input');
  if (onButton && (event.key === ' ' || event.key === 'Enter')) return;  // presses that
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
  // Space or Enter drive as long as they are down, as a finger does.
  const pressed = (event, down) => {
    if (event.key !== ' ' && event.key !== 'Enter') return;
    event.preventDefault();
    if (!event.repeat && (down || button.dataset.key in arrows)) key(button.dataset.key, down);
  };
  button.addEventListener('keydown', event => pressed(event, true));
  button.addEventListener('keyup', event => pressed(event, false));
  button.addEventListener('blur', () => { if (button.dataset.key in arrows) key(button.dataset.key, false); });
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
    if (tool?.drag) tool.end();
    pinch = spanOf();
    return;
  }
  drag = {px, py, mover: tool ? undefined : movers.at(view, px, py), moved: false, tool};
  tool?.press(...view.toWorld(px, py), px, py);
  if (drag.mover && drag.mover !== selected) select(drag.mover.id);
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
    panned(span.x - pinch.x, span.y - pinch.y);
    zoomed(span.length / pinch.length, span.x, span.y);
    pinch = span;
  } else if (drag) {
    drag.moved ||= Math.hypot(px - drag.px, py - drag.py) > 6;
    if (drag.tool?.drag) drag.tool.drag(x, y);
    else if (drag.mover && !frame?.replay) Object.assign(drag, {x, y});
    else if (drag.moved) {
      follow(false);
      panned(px - drag.px, py - drag.py);
      Object.assign(drag, {px, py});
    }
  }
  const over = movers.at(view, px, py) ?? movers.cameraAt(view, px, py);
  const is_switch = !over && switchAt(px, py) !== undefined;
  canvas.classList.toggle('over', Boolean(over) || is_switch);
  canvas.classList.toggle('moving', Boolean(drag?.moved));
  const what = over?.id ?? switchAt(px, py) ?? plan.titleAt(x, y);
  part('place').textContent = `${x.toFixed(2)}, ${y.toFixed(2)}${what ? ` · ${what}` : ''}`;
  if (drag || pinch || tool) redraw();
});

/** The id of what a press on the map switches: a lamp, a door. */
function switchAt(px, py) {
  const fits = id => states.switchOf(id) !== undefined;
  const actuator = movers.actuatorAt(view, px, py);
  return actuator && fits(actuator.id) ? actuator.id : plan.idAt(...view.toWorld(px, py), fits);
}

function letGo(event) {
  pointers.delete(event.pointerId);
  if (pointers.size < 2) pinch = null;
  const done = drag;
  drag = null;
  canvas.classList.remove('moving');
  if (done?.tool) {
    if (event.type === 'pointerup' && done.tool === tool) tool.letGo(...view.toWorld(...placeOf(event)), done.moved);
  } else if (event.type === 'pointerup' && done?.x !== undefined && done.moved) driverOf(done.mover).goTo(done.x, done.y);
  else if (event.type === 'pointerup' && done && !done.mover && !done.moved) {
    const camera = movers.cameraAt(view, ...placeOf(event));
    const thing = switchAt(...placeOf(event));
    if (camera) cameras.look(camera.id);
    else if (thing) states.press(thing);
    else select();
  }
  redraw();
}
canvas.addEventListener('pointerup', letGo);
canvas.addEventListener('pointercancel', letGo);
canvas.addEventListener('pointerleave', () => { if (!drag) part('place').textContent = ''; });
canvas.addEventListener('wheel', event => {
  event.preventDefault();
  zoomed(Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0015)), ...(following ? [] : placeOf(event)));
}, {passive: false});
new ResizeObserver(() => {
  if (!plan) return;
  fitUntouched();
  redraw();
}).observe(canvas);

// Sections that people have folded stay folded.

for (const fold of document.querySelectorAll('aside details')) {
  const kept = `ispace-fold-${fold.parentNode.getAttribute('aria-labelledby')}`;
  try {
    if (localStorage.getItem(kept) === 'folded') fold.open = false;
    // A click comes before it folds, and is kept at once: the event "toggle" comes later, and not if the page is left.
    fold.querySelector('summary').addEventListener('click', () => {
      localStorage.setItem(kept, fold.open ? 'folded' : 'open');
    });
  } catch { /* a browser may keep none */ }
}

connect();

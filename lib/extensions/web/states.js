// SPDX-License-Identifier: GPL-3.0-or-later
// The states of the room: a button for each that is on or off, a field for each other one of an actuator.
import {Link, complaint, keysOf} from './link.js';

/** The states of the answer to STATE, as [id, key, value]; in a building those of the room that is shown. */
function statesOf(answer) {
  const room = Link.room && `${Link.room}/`;
  return answer.split(' ').slice(3).filter(word => word.startsWith(room)).map(word => {
    const equals = word.indexOf('='), name = word.slice(room.length, equals), dot = name.lastIndexOf('.');
    return [name.slice(0, dot), name.slice(dot + 1), word.slice(equals + 1)];
  });
}

/** The state of an EVENT state, if it is of the room that is shown. */
function changeOf(line) {
  const {t, id, room, ...state} = keysOf(line);
  return (room ?? '') === Link.room ? [[id, ...Object.entries(state)[0]]] : [];
}

/** Keys of states that are on or off: those of sensors, and those of actuators, which the scene names. */
const SWITCHES = new Set(['open', 'motion']);

/** #rrggbb of a colour in shares, and back. */
function hexOf(color) {
  const parts = color.split(',').map(part => Math.round(255 * Math.min(1, Math.max(0, Number(part) || 0))));
  return `#${parts.map(part => part.toString(16).padStart(2, '0')).join('')}`;
}
function sharesOf(hex) { return [1, 3, 5].map(i => +(parseInt(hex.slice(i, i + 2), 16) / 255).toFixed(3)).join(); }

export class States {
  /**
   * part(id): an element of the page; tell(text, bad): says something to people; changed(): the map shows one; only: the
   * id of the one thing whose states are listed, '' for all
   */
  constructor(part, tell, history, changed, only = '') {
    this.only = only;
    this.section = part('states');
    this.list = part('state-list');
    this.tell = tell;
    this.history = history;
    this.changed = changed;
    this.shown = new Map();  // by id.key: shows a value
    this.values = new Map();  // likewise
    this.sensors = new Set();
    this.roomOf = () => '';
    this.lists = new Map();  // by room, its <ul>
    part('state-find').addEventListener('input', () => this.find(part('state-find').value));
  }

  /** Those of a world whose role the link has. */
  async open(link) {
    this.link = link;
    const answer = await link.ask('STATE');
    if (!answer.startsWith('OK')) return;
    const states = statesOf(answer), t = Number(keysOf(answer).t);
    // Those of a changed room are mostly the same: a field keeps its text.
    const names = states.map(([id, key]) => `${id}.${key} ${this.sensors.has(id)} ${this.roomOf(id)}`).concat(...SWITCHES).join();
    if (names !== this.names) {
      this.list.replaceChildren();
      this.lists.clear();
      this.shown.clear();
      this.values.clear();
      this.names = names;
    }
    this.take(states, t);
  }

  /**
   * Sensors report, and nobody presses them. roomOf(id): the zone in which something is, '' in none; switched: the
   * keys of actuators that are on or off
   */
  know(sensors, roomOf, switched) {
    for (const key of switched) SWITCHES.add(key);
    this.sensors = new Set(sensors.map(({id}) => id));
    this.roomOf = roomOf;
    if (this.link) this.open(this.link);
  }

  line(line) { if (line.startsWith('EVENT state ')) this.take(changeOf(line), Number(keysOf(line).t)); }

  take(states, t) {
    for (const [id, key, value] of states) {
      const name = `${id}.${key}`;
      this.values.set(name, value);
      this.history.add(Link.whole(`${id} ${key}`), t, value);
      if (this.only && id !== this.only) continue;
      (this.shown.get(name) ?? this.add(id, key))(value);
    }
    this.section.hidden = this.shown.size === 0;
    this.changed();
  }

  /** The switch of a thing of the plan: its key; none: it has none that people press. */
  switchOf(id) {
    return this.sensors.has(id) ? undefined : ['on', 'open', 'blind'].find(key => this.values.has(`${id}.${key}`));
  }

  /** Whether something has states. */
  has(id) { return [...this.values.keys()].some(name => name.startsWith(`${id}.`)); }

  /** Its colour, #rrggbb. */
  colorOf(id) { return hexOf(this.values.get(`${id}.color`) ?? '1,1,1'); }

  /** Whether it is pressed. */
  isOn(id) { return this.values.get(`${id}.${this.switchOf(id)}`) === '1'; }

  /** Presses that. */
  press(id) {
    const key = this.switchOf(id);
    if (key) this.set(id, key, this.values.get(`${id}.${key}`) === '1' ? '0' : '1');
  }

  /** Lists those whose names have a text, and hides the others. */
  find(text) {
    const wanted = text.trim().toLowerCase();
    for (const item of this.list.querySelectorAll('li')) item.hidden = !item.dataset.name.includes(wanted);
    for (const {list, title} of this.lists.values()) title.hidden = [...list.children].every(({hidden}) => hidden);
  }

  /** The list of a room, below its name; those of no room come last. */
  listOf(room) {
    if (this.lists.has(room)) return this.lists.get(room).list;
    const title = document.createElement('h3'), list = document.createElement('ul');
    title.textContent = room || 'elsewhere';
    const rooms = [...this.lists.keys(), room].sort((a, b) => (a === '') - (b === '') || a.localeCompare(b));
    const next = this.lists.get(rooms[rooms.indexOf(room) + 1])?.title ?? null;
    this.list.insertBefore(title, next);
    this.list.insertBefore(list, next);
    this.lists.set(room, {title, list});
    this.list.classList.toggle('grouped', this.lists.size > 1 || room !== '');
    return list;
  }

  add(id, key) {
    const item = document.createElement('li'), is_fixed = this.sensors.has(id);
    item.dataset.name = `${id} ${key} ${this.roomOf(id)}`.toLowerCase();
    const show = SWITCHES.has(key) || is_fixed ? this.addButton(item, id, key) : this.addField(item, id, key);
    const course = document.createElement('button');
    course.textContent = '∿';
    course.className = 'course';
    course.title = course.ariaLabel = `course of ${id} ${key}`;
    course.onclick = () => this.history.show(Link.whole(`${id} ${key}`));
    item.append(course);
    this.shown.set(`${id}.${key}`, value => {
      course.hidden = !this.history.has(Link.whole(`${id} ${key}`));
      show(value);
    });
    this.listOf(this.roomOf(id)).append(item);
    return this.shown.get(`${id}.${key}`);
  }

  addButton(item, id, key) {
    const button = document.createElement('button'), text = document.createElement('span');
    text.className = 'model';
    button.append(`${id} ${key} `, text);
    button.disabled = this.sensors.has(id);
    button.onclick = () => this.set(id, key, button.getAttribute('aria-pressed') === 'true' ? '0' : '1');
    item.append(button);
    return value => {
      text.textContent = SWITCHES.has(key) ? '' : value;
      button.setAttribute('aria-pressed', SWITCHES.has(key) && value === '1');
    };
  }

  addField(item, id, key) {
    const label = document.createElement('label'), field = document.createElement('input');
    let known = '';
    field.onclick = () => field.select();
    field.onchange = async () => {
      field.blur();  // so that it shows the value as the world has it
      await this.set(id, key, field.value.trim());
      // No event follows a refusal, nor the same value in another form, such as 50% for 0.5.
      if (document.activeElement !== field) field.value = known;
    };
    label.append(`${id} ${key} `, field);
    item.append(label);
    const more = key === 'level' ? this.addSlider(item, id, key) : key === 'color' ? this.addColor(item, id, key) : () => {};
    return value => {
      known = value;
      if (document.activeElement !== field) field.value = value;
      more(value);
    };
  }

  addSlider(item, id, key) {
    const slider = Object.assign(document.createElement('input'), {type: 'range', min: 0, max: 1, step: 0.01});
    slider.ariaLabel = `${id} ${key}`;
    slider.onchange = () => this.set(id, key, slider.value);
    item.append(slider);
    return value => { slider.value = value; };
  }

  addColor(item, id, key) {
    const color = Object.assign(document.createElement('input'), {type: 'color'});
    color.ariaLabel = `${id} ${key}`;
    color.onchange = () => this.set(id, key, sharesOf(color.value));
    item.append(color);
    return value => { color.value = hexOf(value); };
  }

  async set(id, key, value) {
    const answer = await this.link.ask(`ACT ${Link.whole(id)} ${key}=${value}`);
    if (!answer.startsWith('OK')) this.tell(complaint(answer), true);
    else if (SWITCHES.has(key)) this.take([[id, key, value]], Number(keysOf(answer).t));
  }
}

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

/** The state of an EVENT state. */
function changeOf(line) {
  const {t, id, ...state} = keysOf(line);
  return [[id, ...Object.entries(state)[0]]];
}

const SWITCHES = new Set(['on', 'open', 'blind', 'motion']);

export class States {
  constructor(part, tell) {
    this.section = part('states');
    this.list = part('state-list');
    this.tell = tell;
    this.shown = new Map();  // by id.key: shows a value
    this.sensors = new Set();
  }

  /** Those of a world whose role the link has. */
  async open(link) {
    this.link = link;
    const answer = await link.ask('STATE');
    if (!answer.startsWith('OK')) return;
    const states = statesOf(answer);
    // Those of a changed room are mostly the same: a field keeps its text.
    const names = states.map(([id, key]) => `${id}.${key} ${this.sensors.has(id)}`).join();
    if (names !== this.names) {
      this.list.replaceChildren();
      this.shown.clear();
      this.names = names;
    }
    this.take(states);
  }

  /** Sensors report, and nobody presses them. */
  know(sensors) {
    this.sensors = new Set(sensors.map(({id}) => id));
    if (this.link) this.open(this.link);
  }

  line(line) { if (line.startsWith('EVENT state ')) this.take(changeOf(line)); }

  take(states) {
    for (const [id, key, value] of states) (this.shown.get(`${id}.${key}`) ?? this.add(id, key))(value);
    this.section.hidden = this.shown.size === 0;
  }

  add(id, key) {
    const item = document.createElement('li'), is_fixed = this.sensors.has(id);
    const show = SWITCHES.has(key) || is_fixed ? this.addButton(item, id, key) : this.addField(item, id, key);
    this.shown.set(`${id}.${key}`, show);
    this.list.append(item);
    return show;
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
    return value => {
      known = value;
      if (document.activeElement !== field) field.value = value;
    };
  }

  async set(id, key, value) {
    const answer = await this.link.ask(`ACT ${id} ${key}=${value}`);
    if (!answer.startsWith('OK')) this.tell(complaint(answer), true);
    else if (SWITCHES.has(key)) this.take([[id, key, value]]);
  }
}

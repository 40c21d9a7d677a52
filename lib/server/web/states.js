// SPDX-License-Identifier: GPL-3.0-or-later
// The states of the room: what sensors and actuators report, with a button for each that is on or off.
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

export class States {
  constructor(part, tell) {
    this.section = part('states');
    this.list = part('state-list');
    this.tell = tell;
    this.buttons = new Map();  // by id.key
    this.sensors = new Set();
  }

  /** Those of a world whose role the link has. */
  async open(link) {
    this.link = link;
    const answer = await link.ask('STATE');
    if (!answer.startsWith('OK')) return;
    this.list.replaceChildren();
    this.buttons.clear();
    this.take(statesOf(answer));
  }

  /** Sensors report, and nobody presses them. */
  know(sensors) {
    this.sensors = new Set(sensors.map(({id}) => id));
    if (this.link) this.open(this.link);
  }

  line(line) { if (line.startsWith('EVENT state ')) this.take(changeOf(line)); }

  take(states) {
    for (const [id, key, value] of states) {
      const button = this.buttons.get(`${id}.${key}`) ?? this.add(id, key);
      const is_switch = value === '0' || value === '1';
      button.lastChild.textContent = is_switch ? '' : value;
      button.disabled = this.sensors.has(id) || !is_switch;
      button.setAttribute('aria-pressed', value === '1');
    }
    this.section.hidden = this.buttons.size === 0;
  }

  add(id, key) {
    const item = document.createElement('li'), button = document.createElement('button');
    const value = document.createElement('span');
    value.className = 'model';
    button.append(`${id} ${key} `, value);
    button.onclick = () => this.press(id, key, button.getAttribute('aria-pressed') !== 'true');
    this.buttons.set(`${id}.${key}`, button);
    item.append(button);
    this.list.append(item);
    return button;
  }

  async press(id, key, on) {
    const answer = await this.link.ask(`ACT ${id} ${key}=${on ? 1 : 0}`);
    if (!answer.startsWith('OK')) return this.tell(complaint(answer), true);
    this.take([[id, key, on ? '1' : '0']]);
  }
}

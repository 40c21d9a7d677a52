// SPDX-License-Identifier: GPL-3.0-or-later
// The storeys, stairs and lifts of a building, and the room of each mover.
import {Link, keysOf} from './link.js';

const kEvery = 1000;  // ms between looks
const kTogether = 100;  // ms in which the changes of a moment come

/** Of lines of changes, those to be told: a mover that is deleted in one room and added to another at the same moment
 * goes there, with what it carries. */
function withPassages(lines) {
  const gone = new Set(), come = new Set();
  const deleted = line => {
    const [, t, ids] = / t=(\S+) what=DELETE (.*) room=/.exec(line) ?? [];
    return ids?.split(' ').map(id => `${t} ${id}`) ?? [];
  };
  const added = line => / t=(\S+) what=ADD (\w+) id=(\S+).* room=(\S+)/.exec(line) ?? [];
  for (const line of lines) for (const one of deleted(line)) gone.add(one);
  for (const line of lines) {
    const [, t, , id] = added(line);
    if (gone.has(`${t} ${id}`)) come.add(`${t} ${id}`);
  }
  return lines.flatMap(line => {
    const [, t, kind, id, room] = added(line), ids = deleted(line);
    if (come.has(`${t} ${id}`)) return kind === 'robot' || kind === 'human' ? [`EVENT passage t=${t} id=${id} to=${room}`] : [];
    return ids.length > 0 && ids.every(one => come.has(one)) ? [] : [line];
  });
}

export class Building {
  /** changed(): a mover has come to another room */
  constructor(changed) {
    this.changed = changed;
    this.changes = [];  // lines that are told together
    this.kinds = new Map();  // of each mover: robot or person
    this.where = new Map();  // of each mover, the id of its room; empty where the run has one world
  }

  /** Learns the rooms from the answer to LIST over a link in the role WORLD. \returns whether they are new */
  open(link, list) {
    this.link = link;
    const rooms = keysOf(list).rooms?.split(',') ?? [];
    const are_new = rooms.join() !== Link.rooms.join();
    if (are_new) {
      Link.rooms = rooms;
      if (!rooms.includes(Link.room)) Link.room = rooms[0] ?? '';
    }
    if (rooms.length > 0) this.look();
    return are_new;
  }

  /** Tells a line of events, in a building together with others of its moment. */
  tellEvent(line, tell) {
    if (Link.rooms.length === 0 || !line.startsWith('EVENT change ')) return tell(line);
    this.changes.push(line);
    this.telling ??= setTimeout(() => {
      this.telling = null;
      withPassages(this.changes.splice(0)).forEach(tell);
    }, kTogether);
  }

  async look() {
    const {link} = this;
    clearTimeout(this.timer);
    if (!link) return;
    const {poses = '', people = '', rooms = ''} = keysOf(await link.ask('POSES'));
    if (link !== this.link || link.isClosed) return;
    const ids = [...poses.split(';'), ...people.split(';')].filter(Boolean).map(row => row.split(',')[0]);
    this.kinds = new Map(ids.map((id, i) => [id, i < poses.split(';').filter(Boolean).length ? 'robot' : 'person']));
    const where = new Map(ids.map((id, i) => [id, rooms.split(',')[i]]));
    const moved = where.size !== this.where.size || [...where].some(([id, room]) => this.where.get(id) !== room);
    this.where = where;
    if (moved) this.changed();
    this.timer = setTimeout(() => this.look(), kEvery);
  }

  close() {
    clearTimeout(this.timer);
    this.link = null;
  }
}

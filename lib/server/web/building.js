// SPDX-License-Identifier: GPL-3.0-or-later
// The storeys, stairs and lifts of a building, and the room of each mover.
import {Link, keysOf} from './link.js';

const kEvery = 1000;  // ms between looks

export class Building {
  /** changed(): somebody has come to another room */
  constructor(changed) {
    this.changed = changed;
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

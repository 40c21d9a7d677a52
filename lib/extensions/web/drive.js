// SPDX-License-Identifier: GPL-3.0-or-later
// Driving: a connection with the role ROBOT or PERSON for each one that is driven, as long as it is
// selected or on its way.
import {Link, complaint, keysOf} from './link.js';

// Of the arrow keys and of Q and E, at most: m/s, degrees a second.
const kSpeed = {robot: 0.5, person: 1.2}, kTurn = 45, kSide = 0.3;

const kStill = '0,0,0';
const kShown = 6000;  // ms that a refused goal stays on the map

export class Driver {
  /** tell(text, bad): says something to people; changed(): something is to be drawn anew */
  constructor(mover, tell, changed) {
    Object.assign(this, {mover, tell, changed});
    this.keys = new Set();
    this.speeds = kStill;
    this.link = new Link({line: line => this.event(line), close: () => { this.gone = true; this.goal = null; this.changed(); }});
    this.ready = this.link.takeRole(`${mover.kind === 'person' ? 'PERSON' : 'ROBOT'} ${mover.id}`).then(answer => {
      this.limits = keysOf(answer);
      if (answer.startsWith('OK')) return true;
      tell(`${mover.id}: ${complaint(answer)}`, true);
      this.release();
      return false;
    });
  }

  /** Asks, once it has its role; null if it failed. */
  async ask(request) {
    if (!await this.ready || this.gone) return null;
    const answer = await this.link.ask(request);
    if (answer.startsWith('OK')) return answer;
    this.why = complaint(answer);
    this.tell(`${this.mover.id}: ${this.why}`, true);
    return null;
  }

  /** Ends of commands. */
  event(line) {
    const {id, reason} = keysOf(line);
    if (!this.command || id !== this.command.id) return;
    const {tell} = this.command;
    this.command = null;
    tell(line.startsWith('DONE') ? 'done' : reason);
  }

  /** A command that comes to an end: how it ended; null if it did not begin. */
  async run(request) {
    const answer = await this.ask(request);
    if (!answer) return null;
    return new Promise(tell => { this.command = {id: keysOf(answer).id, tell}; });
  }

  /** Goes to a point, round walls and things where the run finds ways, else straight; turns to a heading there. */
  async goTo(x, y, heading) {
    const goal = this.goal = {x, y, heading, room: Link.room}, {mover} = this;
    this.refused = null;
    this.changed();
    this.help ??= await this.ask('HELP') ?? '';
    const place = `${x.toFixed(3)},${y.toFixed(3)}`, turn = heading === undefined ? '' : `,${heading.toFixed(1)}`;
    const order = /\bGOTO\b/.test(this.help) ? `GOTO ${Link.whole(place)}${turn}` : `PATH ${place}`;
    const end = await this.run(order);
    if (this.goal !== goal) return;  // a newer one
    this.goal = null;
    if (end !== 'done') this.showRefused(goal, end ?? this.why ?? 'not possible');
    if (end) this.tell(end === 'done' ? `${mover.id} has arrived` : `${mover.id} did not arrive: ${end}`, end !== 'done');
    this.changed();
  }

  showRefused(goal, why) {
    const refused = this.refused = {...goal, why};
    setTimeout(() => {
      if (this.refused === refused) this.refused = null;
      this.changed();
    }, kShown);
  }

  /** Keeps to the speeds of the keys that are down. */
  async press(key, down) {
    if (down) this.keys.add(key);
    else this.keys.delete(key);
    const held = name => this.keys.has(name) ? 1 : 0;
    const along = held('ArrowUp') - held('ArrowDown'), round = held('ArrowLeft') - held('ArrowRight');
    const side = this.mover.side > 0 ? held('q') - held('e') : 0;
    const speeds = `${along},${round},${side}`;
    if (speeds === this.speeds) return;
    this.speeds = speeds;
    this.goal = null;
    if (!await this.ready || speeds !== this.speeds) return;  // others were pressed meanwhile
    const {max_speed, max_rotspeed, max_sidespeed} = this.limits;
    this.ask(`SPEED ${along * Math.min(kSpeed[this.mover.kind], max_speed)}`);
    this.ask(`ROTSPEED ${round * Math.min(kTurn, max_rotspeed)}`);
    if (this.mover.side > 0) this.ask(`SIDESPEED ${side * Math.min(kSide, max_sidespeed)}`);
  }

  stop() {
    this.keys.clear();
    this.speeds = kStill;
    this.goal = null;
    this.ask('STOP');
  }

  /** True while letting go would stop it on its way. */
  get busy() { return Boolean(this.goal) || this.speeds !== kStill; }

  /** Lets go: others may drive it. */
  release() {
    this.gone = true;
    this.link.close();
  }
}

// SPDX-License-Identifier: GPL-3.0-or-later
// Changes of the room: things, sensors and people are added, moved, turned and deleted by requests of the protocol.
import {Link, complaint, keysOf} from './link.js';
import {drawArrow} from './tools.js';

const kTurn = 15;  // degrees
const kUndo = 200;  // changes that can be taken back
const kFixed = new Set(['ispace', 'inside']);  // keywords that pointers do not move: they are the floor under all others

/** {id, keyword, text, keys} of a record's line. */
function parsed(text) {
  const keys = Object.fromEntries([...text.matchAll(/(\w+)=("(?:[^"\\]|\\.)*"|\S+)/g)].map(match => [match[1], match[2]]));
  return {id: keys.id, keyword: text.split(' ')[0], text, keys};
}

function rounded(value, digits = 2) { return String(+value.toFixed(digits)); }

/** A tool of the map, see tools.js, and a section beside it. */
export class Editor {
  /** room: {idAt(px, py), poseOf(id), outlineOf(id), view}; tell(text, bad), say(text), changed() */
  constructor(part, room, {tell, say, changed, take}) {
    Object.assign(this, {part, room, tellPeople: tell, say, changed, take, records: new Map(), undone: [], files: {}});
    part('edit-add').addEventListener('submit', event => {
      event.preventDefault();
      this.begin(part('edit-kind').value.trim(), part('edit-keys').value.trim());
    });
    part('edit-set').addEventListener('submit', event => {
      event.preventDefault();
      this.set(part('edit-value').value.trim());
    });
    part('edit-left').onclick = () => this.turn(kTurn);
    part('edit-right').onclick = () => this.turn(-kTurn);
    part('edit-delete').onclick = () => this.remove();
    part('edit-undo').onclick = () => this.undo();
    for (const form of ['env', '3dm']) part(`save-${form}`).onclick = () => this.save(form);
  }

  /** Learns the records of a new scene; without additions people change no rooms here. */
  async open(link, {additions = [], title}) {
    this.link = link;
    this.isOff = additions.length === 0;
    this.part('editing').hidden = this.part('edit').hidden = this.isOff;
    if (this.isOff) return;
    this.title = title;
    if (this.part('edit-kinds').children.length !== additions.length)
      this.part('edit-kinds').replaceChildren(...additions.map(text => new Option(text, text)));
    await link.listed;  // the rooms, one of which RECORDS wants
    const answer = await link.ask(`RECORDS ${Link.room}`.trim()), [head, ...lines] = answer.split('\n');
    if (link !== this.link) return;
    if (!head.startsWith('OK')) return this.tellPeople(complaint(head), true);
    const count = Number(keysOf(head).room);
    this.files = {env: lines.slice(0, count), '3dm': lines.slice(count)};
    this.records = new Map(lines.map(parsed).map(record => [record.id, record]));
    this.show();
  }

  get hint() {
    return this.adding ? `Press where ${this.adding.kind.split(' ')[0]} is to be; drag from there to turn it.`
                       : 'Press something to choose it, drag it to move it.';
  }

  // The pointer.

  press(x, y, px, py) {
    this.from = this.to = [x, y];
    if (!this.adding) this.choose(this.room.idAt(px, py));
  }

  drag(x, y) { this.to = [x, y]; }

  letGo(x, y, moved) {
    const {from, adding} = this;
    this.from = null;
    if (!from) return;
    if (adding) return this.add(from, moved ? Math.atan2(y - from[1], x - from[0]) * 180 / Math.PI : undefined);
    if (moved && this.isMovable) this.move(x - from[0], y - from[1]);
  }

  end() { this.from = this.adding = null; }

  draw(context, view) {
    if (this.adding && this.from) drawArrow(context, view, this.from, this.to, '#d55e00');
    const pose = this.chosen && this.room.poseOf(this.chosen);
    if (!pose) return;
    const moves = this.from && !this.adding && this.isMovable;
    const [dx, dy] = moves ? [this.to[0] - this.from[0], this.to[1] - this.from[1]] : [0, 0];
    view.inMetres(context);
    context.translate(dx, dy);
    context.strokeStyle = '#d55e00';
    context.lineWidth = 2.5 / view.scale;
    const paths = this.room.outlineOf(this.chosen);
    for (const path of paths) context.stroke(path);
    if (paths.length > 0) return;
    context.beginPath();
    context.arc(pose.x, pose.y, 12 / view.scale, 0, 2 * Math.PI);
    context.stroke();
  }

  // What is chosen.

  choose(id) {
    this.chosen = this.records.has(id) ? id : undefined;
    this.show();
  }

  get record() { return this.records.get(this.chosen); }

  /** Whether a pointer moves it: it has a point of its own in the room. */
  get isMovable() {
    const {record} = this;
    return Boolean(record?.keys.at) && !record.keys.on && !record.keys.wall && !kFixed.has(record.keyword);
  }

  show() {
    const {part, record} = this;
    part('edit-chosen').hidden = !record;
    part('edit-record').textContent = record?.text ?? '';
    part('edit-undo').disabled = this.undone.length === 0;
    this.changed();
  }

  // Requests. Each that succeeds keeps the one that takes it back.

  async ask(request, back) {
    const asked = this.link.ask(request);
    this.asked = asked;
    const answer = await asked;
    if (!answer.startsWith('OK')) {
      this.tellPeople(complaint(answer), true);
      return null;
    }
    const warning = answer.split(' warning=')[1];
    if (warning) this.tellPeople(warning, true);
    if (back) this.undone.push(back);
    if (this.undone.length > kUndo) this.undone.shift();
    this.show();
    return answer;
  }

  /** Takes back the last change, also one whose answer is still on its way. */
  async undo() {
    await this.asked;
    const back = this.undone.pop();
    if (back) this.ask(back);
  }

  /** A record is to be added: at once if its keys say where, else where people press. */
  begin(kind, keys) {
    if (!kind) return;
    const keyword = kind.split(' ')[0];
    let id = /(?:^| )id=(\S+)/.exec(keys)?.[1], n = 1;
    while (!id || (this.records.has(id) && !/(?:^| )id=/.test(keys))) id = `${keyword}${n++}`;
    const z = /(?:^| )z=(\S+)/.exec(keys)?.[1];
    this.adding = {kind, id, z, keys: keys.replace(/(?:^| )(?:id|z)=\S+/g, '').trim()};
    if (/(?:^| )(?:at|on|path|from|wall)=/.test(keys)) return this.add();
    this.take();
    this.say(this.hint);
  }

  async add(at, heading) {
    const {kind, id, z, keys} = this.adding, [keyword, ...more] = kind.split(' ');
    const place = at ? [`at=${[...at.map(part => rounded(part)), ...z ? [z] : []].join()}`, ...heading === undefined ? [] : [`heading=${rounded(heading, 0)}`]] : [];
    const request = ['ADD', keyword, `id=${Link.whole(id)}`, ...more, ...place, keys].filter(Boolean).join(' ');
    this.adding = null;
    this.say(this.hint);
    if (await this.ask(request, `DELETE ${Link.whole(id)}`)) this.chosen = id;
  }

  async move(dx, dy) {
    const {record} = this, {x, y} = this.room.poseOf(record.id), [, , ...z] = record.keys.at.split(',');
    const set = (a, b) => `SET ${Link.whole(record.id)}.at=${[rounded(a), rounded(b), ...z].join()}`;
    await this.ask(set(x + dx, y + dy), set(x, y));
  }

  async turn(by) {
    const {record} = this, heading = this.room.poseOf(record.id)?.heading ?? Number(record.keys.heading ?? 0);
    const set = degrees => `SET ${Link.whole(record.id)}.heading=${rounded(((degrees + 540) % 360) - 180, 1)}`;
    await this.ask(set(heading + by), set(heading));
  }

  async set(text) {
    const {record} = this, [, key, value] = /^(\w+)\s*=\s*(.*)$/.exec(text) ?? [];
    if (!key) return this.tellPeople(`wanted key=value, like size=1.2,0.6, not ${text}`, true);
    if (key === 'z' && this.isMovable) return this.set(`at=${[...record.keys.at.split(',').slice(0, 2), value].join()}`);
    const old = record.keys[key] ?? '', name = Link.whole(record.id);
    if (await this.ask(`SET ${name}.${key}=${value}`, `SET ${name}.${key}=${old}`)) this.part('edit-value').value = '';
  }

  async remove() {
    const {record} = this;
    if (!record) return;
    const whole = record.text.replace(/ id=\S+/, ` id=${Link.whole(record.id)}`);
    if (await this.ask(`DELETE ${Link.whole(record.id)}`, `ADD ${whole}`)) this.choose();
  }

  /** Hands the room (env) or what is placed in it (3dm) over as a file. */
  save(form) {
    const text = [`#${form} 1`, ...this.files[form]].join('\n') + '\n', link = document.createElement('a');
    const name = Link.room || this.title.replace(/\.\w+$/, '') || 'room';
    link.href = URL.createObjectURL(new Blob([text], {type: 'text/plain'}));
    link.download = `${name}.${form}`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
}

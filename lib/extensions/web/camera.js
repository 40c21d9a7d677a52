// SPDX-License-Identifier: GPL-3.0-or-later
// What a camera sees: a connection with the role SENSOR as long as it is shown.
import {Link, complaint} from './link.js';

const kPause = 250;  // ms between pictures, at least
const kShare = 3;  // of the time that a picture takes, to leave the world its own

class Camera {
  /** show(bitmap, time): a new picture; fail(text): there is none, and will be none */
  constructor(id, show, fail) {
    Object.assign(this, {id, show, fail});
    this.link = new Link({bytes: (line, bytes) => this.take(line, bytes), close: () => this.end('no connection')});
    this.link.takeRole(`SENSOR ${Link.whole(id)}`).then(answer => {
      if (answer.startsWith('OK')) this.next();
      else this.end(complaint(answer));
    });
  }

  /** Asks for the newest picture; while nobody looks at the page, for none. */
  async next() {
    if (this.gone) return;
    if (document.hidden) {
      this.timer = setTimeout(() => this.next(), kPause);
      return;
    }
    this.asked = performance.now();
    const answer = await this.link.ask('SCAN');
    if (!answer.startsWith('SCAN')) this.end(complaint(answer));
  }

  async take(line, bytes) {
    try {
      const bitmap = await createImageBitmap(new Blob([bytes], {type: 'image/png'}));
      if (!this.gone) this.show(bitmap, /\bt=(\S+)/.exec(line)?.[1]);
    } catch {
      return this.end('its picture cannot be read');
    }
    const took = performance.now() - this.asked;
    this.timer = setTimeout(() => this.next(), Math.max(kPause, kShare * took));
  }

  end(why) {
    if (this.gone) return;
    this.release();
    this.fail(`${this.id}: ${why}`);
  }

  release() {
    this.gone = true;
    clearTimeout(this.timer);
    this.link.close();
  }
}

/** The list of cameras, and the picture of the one that is looked through. */
export class Cameras {
  /** part(id): an element of the page; fail(text): says something to people */
  constructor(part, fail) {
    Object.assign(this, {part, fail, shown: null});
    part('camera-close').onclick = () => this.look();
  }

  /** Those of a new scene. */
  list(sensors) {
    const {part} = this;
    const ids = sensors.filter(({kind}) => kind === 'camera').map(({id}) => id).slice(0, 100);
    part('cameras').hidden = ids.length === 0;
    if (ids.join() !== this.ids?.join()) {
      this.ids = ids;
      part('lenses').replaceChildren(...ids.map(id => {
        const button = document.createElement('button');
        button.textContent = id;
        button.onclick = () => this.look(id);
        return button;
      }));
    }
    if (this.shown && !ids.includes(this.shown.id)) this.look();
    this.mark();
  }

  /** Shows what a camera sees, and no other; that which is shown already: none. */
  look(id) {
    const {part} = this, same = this.shown?.id === id;
    this.shown?.release();
    this.shown = id && !same ? new Camera(id, (...picture) => this.draw(...picture), why => {
      this.fail(why);
      this.look();
    }) : null;
    part('camera').hidden = !this.shown;
    part('camera-name').textContent = id ?? '';
    part('picture').width = part('picture').height = 1;
    this.mark();
  }

  draw(bitmap, time) {
    const picture = this.part('picture');
    Object.assign(picture, {width: bitmap.width, height: bitmap.height});
    picture.getContext('2d').drawImage(bitmap, 0, 0);
    this.part('camera-name').textContent = `${this.shown.id} at ${Number(time).toFixed(2)} s`;
  }

  mark() {
    for (const button of this.part('lenses').children)
      button.setAttribute('aria-pressed', button.textContent === this.shown?.id);
  }
}

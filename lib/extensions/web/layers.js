// SPDX-License-Identifier: GPL-3.0-or-later
// Which kinds of sensors the map shows, in which colour, and how strongly. The browser keeps it.
const kKept = 'ispace-layers';

export class Layers {
  /** list: where they are; changed(): the map is to be drawn anew */
  constructor(list, changed) {
    Object.assign(this, {list, changed, looks: {}});
    try {
      this.looks = JSON.parse(localStorage.getItem(kKept)) ?? {};
    } catch { /* a browser may keep none */ }
  }

  /** {shown, color, opacity} of a kind; without a colour each sensor has its own. */
  of(kind) { return {shown: true, color: '', opacity: 1, ...this.looks[kind]}; }

  /** Those of a scene. colorOf(kind): the colour that one of them has by itself */
  show(sensors, colorOf) {
    const kinds = [...new Set(sensors.map(({kind}) => kind))].sort();
    if (kinds.join() === this.kinds) return;
    this.kinds = kinds.join();
    this.list.replaceChildren(...kinds.map(kind => this.row(kind, colorOf(kind))));
  }

  row(kind, own) {
    const item = document.createElement('li'), label = document.createElement('label');
    const field = (type, name, more) => Object.assign(document.createElement('input'), {type, ariaLabel: `${name} of ${kind}`, title: name, ...more});
    const look = this.of(kind);
    const box = Object.assign(document.createElement('input'), {type: 'checkbox', checked: look.shown});
    const color = field('color', 'colour', {value: look.color || own});
    const opacity = field('range', 'opacity', {min: 0.1, max: 1, step: 0.05, value: look.opacity});
    box.onchange = () => this.set(kind, {shown: box.checked});
    color.oninput = () => this.set(kind, {color: color.value});
    opacity.oninput = () => this.set(kind, {opacity: Number(opacity.value)});
    label.append(box, ` ${kind}`);
    item.dataset.kind = kind;
    item.append(label, color, opacity);
    return item;
  }

  set(kind, look) {
    this.looks[kind] = {...this.of(kind), ...look};
    try {
      localStorage.setItem(kKept, JSON.stringify(this.looks));
    } catch { /* likewise */ }
    this.changed();
  }
}

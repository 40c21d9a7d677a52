// SPDX-License-Identifier: GPL-3.0-or-later
// The slider of a record's time.
import {complaint, keysOf} from './link.js';

export class SeekBar {
  /** A range input, hidden where no time can be gone to. tell(text, bad) */
  constructor(input, tell) {
    this.input = input;
    this.tell = tell;
    this.wanted = null;  // a time to be asked for
    this.busy = false;
    this.end = 0;  // of the record, s
    input.addEventListener('input', () => {
      this.wanted = Number(input.value);
      this.go();
    });
  }

  /** Finds out over a link in the role WORLD whether and how far there is something to seek. */
  async open(link) {
    this.link = link;
    const help = await link.ask('HELP'), end = Number(keysOf(await link.ask('TIME')).end);
    this.end = end > 0 ? end : 0;
    this.input.hidden = !/\bSEEK\b/.test(help) || !this.end;
    if (!this.input.hidden) this.input.max = end;
  }

  /** The time that is shown, or will be. */
  get time() { return this.wanted ?? Number(this.input.value); }

  /** Goes so many seconds on, or back. */
  move(seconds) { this.seek(this.time + seconds); }

  seek(time) {
    if (this.input.hidden) return;
    this.input.value = this.wanted = Math.min(Number(this.input.max), Math.max(0, time));
    this.go();
  }

  /** The world's time. */
  show(time) {
    if (!this.busy) this.input.value = time;
  }

  /** One request at a time: what was wanted last counts. */
  async go() {
    if (this.busy) return;
    this.busy = true;
    while (this.wanted !== null) {
      const time = this.wanted;
      this.wanted = null;
      const answer = await this.link.ask(`SEEK ${time}`);
      if (answer.startsWith('ERR')) this.tell(complaint(answer), true);
    }
    this.busy = false;
  }
}

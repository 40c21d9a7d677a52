// SPDX-License-Identifier: GPL-3.0-or-later
// A WebSocket to simrun: lines of the Simulator TCP Protocol, and frames of the world's state.

/** True for a line that answers a request; all others come by themselves. */
function isAnswer(line) {
  return /^(OK|ERR|SCAN)\b/.test(line) && !line.includes(' stream=1 ');
}

export class Link {
  /** The rooms of a building and the one that is shown; none and '' where the run has one world. */
  static rooms = [];
  static room = '';
  /** Called with each answer that wants a token, or another one. */
  static refused = () => {};
  /** The id of something in the room, as requests want it. */
  static whole(id) { return Link.room && !id.includes('/') ? `${Link.room}/${id}` : id; }

  /** on: {open, close(code), line(text), json(object), bytes(line, bytes)}, all optional */
  constructor(on = {}) {
    this.on = on;
    this.waiting = [];  // of each request without an answer, its receiver
    const room = Link.rooms.indexOf(Link.room);
    this.socket = new WebSocket(`ws://${location.host}/ws${room > 0 ? `/${room}` : ''}`);
    this.socket.binaryType = 'arraybuffer';
    this.socket.onopen = () => this.on.open?.();
    this.socket.onclose = event => {
      this.isClosed = true;
      for (const tell of this.waiting.splice(0)) tell('ERR 0 the connection is closed');
      this.on.close?.(event.code);
    };
    this.socket.onmessage = event => this.receive(event.data);
  }

  receive(data) {
    if (typeof data !== 'string') return this.receiveBytes(data);
    if (data.startsWith('{')) return this.on.json?.(JSON.parse(data));
    for (const line of data.split('\n')) {
      if (line === '' || line.startsWith('ISPACE ')) continue;
      if (this.rest?.length < this.lines) {
        this.rest.push(line);
        if (this.rest.length === this.lines) this.waiting.shift()?.(this.rest.join('\n'));
        continue;
      }
      if (line.startsWith('OK RECORDS ')) {  // with a line for each of them
        const {room, placed} = keysOf(line);
        this.rest = [line];
        this.lines = 1 + Number(room) + Number(placed);
        if (this.lines > 1) continue;
      }
      if (line.startsWith('ERR 401 ')) Link.refused(line);
      if (isAnswer(line)) this.waiting.shift()?.(line);
      else this.on.line?.(line);
    }
  }

  /** A line and the bytes that it counts. */
  receiveBytes(data) {
    const all = new Uint8Array(data), end = all.indexOf(10);
    if (end < 0) return;
    const line = new TextDecoder().decode(all.subarray(0, end));
    if (isAnswer(line)) this.waiting.shift()?.(line);
    this.on.bytes?.(line, all.subarray(end + 1));
  }

  /** The answer to the request for a role. Where the run has a token, the page's address gives it:
   * `#token=…`, which stays in the browser. A token that is refused is the answer, also where none is needed. */
  async takeRole(request) {
    const token = Link.token;
    const admitted = token ? this.ask(`TOKEN ${token}`) : 'OK', role = this.ask(request);
    const refusal = await admitted;
    return refusal.startsWith('ERR') ? refusal : role;
  }

  static get token() {
    const text = /#token=(.+)/.exec(location.hash)?.[1] ?? '';
    let token = text;
    try {
      token = decodeURIComponent(text);
    } catch { /* it has a bare % */ }
    return /[\x00-\x20]/.test(token) ? '' : token;  // one line: an address makes no requests
  }
  static set token(text) { history.replaceState(null, '', `#token=${encodeURIComponent(text)}`); }

  /** The answer to a request, as it comes. */
  ask(request) {
    return new Promise(tell => {
      if (this.socket.readyState > WebSocket.OPEN) return tell('ERR 0 the connection is closed');
      this.waiting.push(tell);
      this.send(request);
    });
  }

  send(text) {
    if (this.socket.readyState === WebSocket.OPEN) return this.socket.send(text);
    this.socket.addEventListener('open', () => this.socket.send(text), {once: true});
  }

  close() { this.socket.close(1000); }
}

/** What an error says to people: without its number. */
export function complaint(answer) { return answer.replace(/^ERR \d+ /, ''); }

/** The keys of a line: {x: '1.000', …} */
export function keysOf(line) {
  return Object.fromEntries([...line.matchAll(/(\w+)=(\S+)/g)].map(match => [match[1], match[2]]));
}

// SPDX-License-Identifier: GPL-3.0-or-later
// What happens in the world, for people.
import {momentText} from './clock.js';
import {keysOf} from './link.js';

const kTexts = {
  collision: ({id, into}) => `${id} ran into ${into}`,
  unreached: ({id, to, x, y, text}) =>
    `${id} gives up its way to ${[to, x && `(${x}, ${y})`].filter(Boolean).join(' ')}${text ? `: ${text}` : ''}`,
  enter: ({id, zone}) => `${id} enters ${zone}`,
  leave: ({id, zone}) => `${id} leaves ${zone}`,
  mat: ({id, who, on}) => `${who} steps ${on === '1' ? 'on' : 'off'} ${id}`,
  activity: ({id, name, on, text}) => `${id} ${on === '1' ? 'begins' : 'ends'} ${name}: ${text}`,
  state: ({id, t, room, ...state}) => Object.entries(state).map(([key, value]) => `${id}: ${key} ${value}`).join(', '),
  gate: ({id, who, way}) => `${who} goes ${way} through ${id}`,
  seen: ({id, by}) => `${id} is in sight of ${by}`,
  lost: ({id}) => `${id} is out of sight`,
  mark: ({text}) => text,
  passage: ({id, to}) => `${id} comes to ${to}`,
  change: ({what}) => `changed: ${what}`,
};

/** {said, bad} of a mark of a record: {t, kind, id, other, text}. */
export function markText({t, kind, id, other, text}) {
  const said = kTexts[kind]({id, into: other, to: other, text, what: text});
  return {said: `${momentText(t)}  ${said}`, bad: kind === 'collision' || kind === 'unreached'};
}

/** {text, bad} of a line that comes by itself; no text for what is not worth one. */
export function eventText(line) {
  const [, kind] = /^EVENT (\w+)/.exec(line) ?? [];
  if (!kTexts[kind]) return {};
  const keys = keysOf(line);
  if (keys.room && keys.id && !keys.id.includes('/')) keys.id = `${keys.room}/${keys.id}`;
  for (const rest of ['text', 'what']) if (rest in keys) keys[rest] = line.split(` ${rest}=`)[1];  // of the line
  return {text: `${momentText(Number(keys.t))}  ${kTexts[kind](keys)}`, bad: kind === 'collision' || kind === 'unreached'};
}

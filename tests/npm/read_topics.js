// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an MCAP file of `simrun --mcap` with Foxglove's libraries and holds its topics against the record of the
// same run, if given: node read_topics.js FILE.mcap [RUN]
// Prints a line for each topic: its name, its type, and the number of its messages. Exit status: 0 all is equal.
'use strict';

const assert = require('assert');
const fs = require('fs');
const path = require('path');
const { McapIndexedReader } = require('@mcap/core');
const { parse } = require('@foxglove/rosmsg');
const { MessageReader } = require('@foxglove/rosmsg2-serialization');
const fzstd = require('fzstd');

async function main() {
  const bytes = fs.readFileSync(process.argv[2]);
  const reader = await McapIndexedReader.Initialize({
    readable: {
      size: async () => BigInt(bytes.length),
      read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
    },
    decompressHandlers: { zstd: (data, size) => fzstd.decompress(data, new Uint8Array(Number(size))) },
  });
  assert.strictEqual(reader.header.profile, 'ros2');
  const readers = new Map();
  const counts = new Map();
  const frames = new Map(); // "1.5 r1": x and y in the map
  const scans = new Map(); // "1.5 l1": ranges
  let people = 0;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const { topic, schemaId } = reader.channelsById.get(message.channelId);
    const schema = reader.schemasById.get(schemaId);
    if (!readers.has(schemaId))
      readers.set(schemaId, new MessageReader(parse(Buffer.from(schema.data).toString(), { ros2: true })));
    const content = readers.get(schemaId).readMessage(message.data);
    const row = `${topic} ${schema.name}`;
    counts.set(row, (counts.get(row) || 0) + 1);
    const time = (Number(message.logTime) / 1e9).toFixed(3);
    if (topic === '/tf')
      for (const { child_frame_id: frame, transform } of content.transforms)
        frames.set(`${time} ${frame}`, transform.translation);
    if (topic.endsWith('/scan')) scans.set(`${time} ${topic.split('/')[1]}`, content.ranges);
    if (topic === '/people') people = content.markers.length;
  }
  if (process.argv[3]) console.log(`compared ${compare(process.argv[3], frames, scans)}`);
  console.log(`people ${people}`);
  for (const row of [...counts.keys()].sort()) console.log(`${row} ${counts.get(row)}`);
}

/// Compares people's positions and scans with those of a record; returns their number.
function compare(run, frames, scans) {
  const rows = fs.readFileSync(path.join(run, 'people.csv'), 'utf8').trim().split('\n').slice(1);
  let compared = 0;
  for (const line of rows) {
    const [t, id, x, y] = line.split(',');
    const frame = frames.get(`${Number(t).toFixed(3)} ${id}`);
    if (!frame) continue; // between two messages
    assert(Math.hypot(frame.x - x, frame.y - y) < 1e-3, `${id} at ${t}: ${frame.x},${frame.y} and ${x},${y}`);
    ++compared;
  }
  assert(compared > 0, 'no person compared');
  for (const line of fs.readFileSync(path.join(run, 'scans.jsonl'), 'utf8').trim().split('\n').map(JSON.parse)) {
    if (!line.ranges) continue;
    const ranges = scans.get(`${line.t.toFixed(3)} ${line.sensor}`);
    assert(ranges, `no scan of ${line.sensor} at ${line.t}`);
    line.ranges.forEach((range, i) => assert(
      range === null ? ranges[i] === Infinity : Math.abs(ranges[i] - range) < 1e-3,
      `beam ${i} of ${line.sensor} at ${line.t}`));
    ++compared;
  }
  return compared;
}

main().catch((error) => {
  console.error(error.message);
  process.exit(1);
});

// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an MCAP file with Foxglove's libraries and holds its messages against the readings of the same
// scan as JSON lines: node read_mcap.js FILE.mcap FILE.jsonl [SCANS [RUN]]
// SCANS are those of a sweep. RUN is the folder of a recorded run, whose robots and people have to be where
// its tables say.
// Prints what it read, a line for each topic. Exit status: 0 all is equal, 1 something differs.
'use strict';

const assert = require('assert');
const fs = require('fs');
const { McapIndexedReader, McapStreamReader } = require('@mcap/core');
const { parse } = require('@foxglove/rosmsg');
const { MessageReader } = require('@foxglove/rosmsg2-serialization');
const { crc32 } = require('@foxglove/crc');
const fzstd = require('fzstd');

const decompressHandlers = {
  zstd: (bytes, size) => fzstd.decompress(bytes, new Uint8Array(Number(size))),
};

/// Decodes messages by the schemas that the file brings.
class Decoder {
  constructor() {
    this.readers = new Map();
  }
  decode(schema, data) {
    assert.strictEqual(schema.encoding, 'ros2msg');
    if (!this.readers.has(schema.id)) {
      const text = Buffer.from(schema.data).toString();
      this.readers.set(schema.id, new MessageReader(parse(text, { ros2: true })));
    }
    return this.readers.get(schema.id).readMessage(data);
  }
}

async function readIndexed(bytes) {
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, size) => bytes.subarray(Number(offset), Number(offset + size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  assert.strictEqual(reader.header.profile, 'ros2');
  const decoder = new Decoder();
  const messages = [];
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const channel = reader.channelsById.get(message.channelId);
    assert.strictEqual(channel.messageEncoding, 'cdr');
    const schema = reader.schemasById.get(channel.schemaId);
    messages.push({
      topic: channel.topic,
      type: schema.name,
      time: message.logTime,
      sequence: message.sequence,
      bytes: message.data,
      content: decoder.decode(schema, message.data),
    });
  }
  const statistics = reader.statistics;
  assert.strictEqual(Number(statistics.messageCount), messages.length);
  assert.strictEqual(statistics.chunkCount, reader.chunkIndexes.length);
  const counted = [...statistics.channelMessageCounts.values()].reduce((a, b) => a + b, 0n);
  assert.strictEqual(Number(counted), messages.length);
  for (let i = 1; i < messages.length; ++i) assert(messages[i].time >= messages[i - 1].time);
  return { reader, messages };
}

/// The same file read from front to back, without its index.
function readStreamed(bytes) {
  const reader = new McapStreamReader({ validateCrcs: true, decompressHandlers });
  // In pieces, as from a pipe.
  const piece = 65521;
  let count = 0;
  let at = 0;
  while (!reader.done()) {
    if (at < bytes.length) reader.append(bytes.subarray(at, at + piece));
    else assert.fail('the file ends too soon');
    at += piece;
    for (let record; (record = reader.nextRecord()); ) if (record.type === 'Message') ++count;
  }
  return count;
}

function checkDataCrc(bytes, summaryStart) {
  const end = Number(summaryStart) - (1 + 8 + 4);
  assert.strictEqual(bytes[end], 0x0f);
  assert.strictEqual(bytes.readUInt32LE(end + 9), crc32(bytes.subarray(0, end)));
}

const orNone = (value) => (value === null ? Infinity : Math.fround(value));

function close(a, b, what) {
  assert(Math.abs(a - b) < 1e-6, `${what}: ${a} and ${b}`);
}

/// The rotation of [heading, tilt, roll] as a matrix: Rz(heading) Ry(-tilt) Rx(roll).
function matrixOf([h, t, r]) {
  const [ch, sh, ct, st, cr, sr] = [h, t, r].flatMap((a) => [Math.cos(a), Math.sin(a)]);
  return [
    [ch * ct, -sh * cr - ch * st * sr, sh * sr - ch * st * cr],
    [sh * ct, ch * cr - sh * st * sr, -ch * sr - sh * st * cr],
    [st, ct * sr, ct * cr],
  ];
}

function matrixOfQuaternion({ x, y, z, w }) {
  return [
    [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
    [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
    [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
  ];
}

function checkPose(transform, pose, frame) {
  assert.strictEqual(transform.header.frame_id, 'map');
  assert.strictEqual(transform.child_frame_id, frame);
  const { translation, rotation } = transform.transform;
  [translation.x, translation.y, translation.z].forEach((v, i) => close(v, pose[i], 'place'));
  const turned = matrixOfQuaternion(rotation);
  matrixOf(pose.slice(3)).forEach((row, i) =>
    row.forEach((v, k) => close(turned[i][k], v, 'rotation')));
}

function pointsOf(cloud) {
  assert.deepStrictEqual(cloud.fields.map((f) => [f.name, f.offset, f.datatype, f.count]),
    [['x', 0, 7, 1], ['y', 4, 7, 1], ['z', 8, 7, 1]]);
  assert.strictEqual(cloud.point_step, 12);
  assert.strictEqual(cloud.row_step, 12 * cloud.width);
  assert.strictEqual(cloud.data.length, cloud.row_step * cloud.height);
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset, cloud.data.byteLength);
  return Array.from({ length: cloud.width * cloud.height }, (_, i) =>
    [0, 4, 8].map((k) => view.getFloat32(12 * i + k, true)));
}

/// Depths of a picture, and the points of its cloud, which are multiples of the rays.
function checkDepths(line, take, name, transforms) {
  const cloud = take(`/${name}/points`);
  assert.deepStrictEqual([cloud.width, cloud.height], [line.width, line.height]);
  assert.strictEqual(cloud.header.frame_id, name);
  const points = pointsOf(cloud);
  const pinhole = line.projection === 'pinhole';
  line.depths.forEach((depth, i) => {
    const [x, y, z] = points[i];
    if (depth === null) assert(Number.isNaN(x));
    else close(pinhole ? x : Math.hypot(x, y, z), depth, 'depth of a point');
  });
  if (!pinhole) return;
  const optical = transforms[1];
  assert.deepStrictEqual([optical.header.frame_id, optical.child_frame_id],
    [name, `${name}_optical`]);
  const image = take(`/${name}/depth/image_rect`);
  assert.deepStrictEqual([image.encoding, image.width, image.height, image.step],
    ['32FC1', line.width, line.height, 4 * line.width]);
  const view = new DataView(image.data.buffer, image.data.byteOffset, image.data.byteLength);
  const info = take(`/${name}/depth/camera_info`);
  [line.fx, 0, line.cx, 0, line.fy, line.cy, 0, 0, 1].forEach((v, i) => close(info.k[i], v, 'k'));
  const turn = matrixOfQuaternion(optical.transform.rotation);
  line.depths.forEach((depth, i) => {
    const value = view.getFloat32(4 * i, true);
    if (depth === null) return assert(Number.isNaN(value));
    assert.strictEqual(value, Math.fround(depth));
    // REP 118: by camera_info a pixel and its depth are a place in the optical frame.
    const [column, row] = [i % line.width, Math.floor(i / line.width)];
    const ray = [(column - info.k[2]) / info.k[0], (row - info.k[5]) / info.k[4], 1];
    turn.forEach((axis, k) =>
      close(axis.reduce((sum, v, j) => sum + v * ray[j] * value, 0), points[i][k], 'optical'));
  });
}

function checkScan(line, scan, name) {
  assert.strictEqual(scan.header.frame_id, name);
  for (const key of ['angle_min', 'angle_max', 'angle_increment', 'range_min', 'range_max'])
    assert(scan[key] === Math.fround(line[key]), key);  // -0 is 0
  assert.deepStrictEqual(Array.from(scan.ranges), line.ranges.map(orNone));
}

/// The points of one scan of a sweep, in the world.
function checkSwept(line, cloud) {
  assert.strictEqual(cloud.header.frame_id, 'map');
  assert.strictEqual(cloud.width, line.ranges.length);
  const points = pointsOf(cloud).slice(line.scan * cloud.width, (line.scan + 1) * cloud.width);
  const turn = matrixOf(line.pose.slice(3));
  line.ranges.forEach((range, k) => {
    if (range === null) return assert(points[k].every(Number.isNaN));
    const bearing = line.angle_min + k * line.angle_increment;
    const [x, y] = [range * Math.cos(bearing), range * Math.sin(bearing)];
    points[k].forEach((v, i) => close(v, line.pose[i] + turn[i][0] * x + turn[i][1] * y, 'point'));
  });
}

/// Lines of a table as objects, by `t id`.
function tableOf(file) {
  const [head, ...lines] = fs.readFileSync(file, 'utf8').trim().split('\n');
  const keys = head.split(',');
  return new Map(lines.map((line) => {
    const words = line.split(',');
    const row = Object.fromEntries(keys.map((key, i) => [key, key === 'id' ? words[i] : Number(words[i])]));
    return [`${Math.round(row.t * 1e9)} ${row.id}`, row];
  }));
}

/// A row's pose as a matrix that takes points of the body to the table's frame.
const flat = (x, y, turn) => [
  [Math.cos(turn), -Math.sin(turn), x], [Math.sin(turn), Math.cos(turn), y], [0, 0, 1]];
const ofRow = (row) => flat(row.x, row.y, (row.heading_deg * Math.PI) / 180);
const ofQuaternion = ({ x, y, z }, q) => {
  close(z, 0, 'height');
  close(q.x, 0, 'level');
  close(q.y, 0, 'level');
  return flat(x, y, 2 * Math.atan2(q.z, q.w));
};
const times = (a, b) => a.map((row) => b[0].map((_, k) => row.reduce((sum, v, j) => sum + v * b[j][k], 0)));
function same(a, b, what) {
  a.forEach((row, i) => row.forEach((v, k) => close(v, b[i][k], what)));
}

/// \return how many poses of robots, their odometry and people were compared
function checkRun(folder, messages) {
  const table = (name) => (fs.existsSync(`${folder}/${name}`) ? tableOf(`${folder}/${name}`) : new Map());
  const [robots, odometry, people] = ['robots.csv', 'odometry.csv', 'people.csv'].map(table);
  const counts = [0, 0, 0];
  for (const { topic, time, content } of messages) {
    const own = (rows, id) => {
      const row = rows.get(`${time} ${id}`);
      assert(row, `${id} is not in the run at ${time}`);
      return row;
    };
    const odom = /^\/(.*)\/odom$/.exec(topic);
    if (odom) {
      const believed = own(odometry, odom[1]);
      const row = own(robots, odom[1]);
      assert.deepStrictEqual([content.header.frame_id, content.child_frame_id], [`${odom[1]}_odom`, odom[1]]);
      same(ofQuaternion(content.pose.pose.position, content.pose.pose.orientation), ofRow(believed), 'odometry');
      close(content.twist.twist.linear.x, row.speed, 'speed');
      close(content.twist.twist.angular.z, (row.rotspeed_deg * Math.PI) / 180, 'turn');
      ++counts[1];
    }
    if (topic !== '/tf') continue;
    const frames = new Map(content.transforms.map((each) => [each.child_frame_id,
      { parent: each.header.frame_id, at: each.transform }]));
    const inMap = (frame) => {
      const { parent, at } = frames.get(frame);
      const pose = ofQuaternion(at.translation, at.rotation);
      return parent === 'map' ? pose : times(inMap(parent), pose);
    };
    for (const id of frames.keys()) {
      const rows = [robots, people].findIndex((each) => each.has(`${time} ${id}`));
      if (rows < 0) continue;
      same(inMap(id), ofRow([robots, people][rows].get(`${time} ${id}`)), id);
      ++counts[2 * rows];
    }
  }
  return counts;
}

async function main() {
  const bytes = fs.readFileSync(process.argv[2]);
  const { reader, messages } = await readIndexed(bytes);
  assert.strictEqual(readStreamed(bytes), messages.length);
  checkDataCrc(bytes, reader.footer.summaryStart);

  const byPlace = new Map();
  const topics = new Map();
  for (const message of messages) {
    topics.set(message.topic, (topics.get(message.topic) || 0) + 1);
    if (message.topic !== '/tf') byPlace.set(`${message.topic} ${message.sequence}`, message);
  }
  const lines = fs.readFileSync(process.argv[3], 'utf8').trim().split('\n').map(JSON.parse);
  let compared = 0;
  for (const line of lines) {
    if (line.sensor === undefined) continue;
    const name = line.sensor.replace(/[^a-zA-Z0-9]+/g, '_');
    const time = BigInt(Math.round(line.t * 1e9));
    const scans = line.scan === undefined ? 1 : Number(process.argv[4]);
    const sequence = line.frame * scans + (line.scan || 0);
    const take = (topic) => {
      const message = byPlace.get(`${topic} ${sequence}`);
      assert(message, `no message ${sequence} of ${topic}`);
      assert.strictEqual(message.time, time);
      ++compared;
      return message.content;
    };
    const poses = messages.filter((m) => m.topic === '/tf' && m.time === time &&
      m.content.transforms[0].child_frame_id === name);
    assert(poses.length >= 1, `no pose of ${name} at ${line.t}`);
    const transforms = poses[0].content.transforms;
    checkPose(transforms[0], line.pose, name);
    if (line.ranges) checkScan(line, take(`/${name}/scan`), name);
    if (line.scan !== undefined)
      checkSwept(line, byPlace.get(`/${name}/points ${(line.frame + 1) * scans - 1}`).content);
    if (line.depths) checkDepths(line, take, name, transforms);
    if (line.png) {
      const image = take(`/${name}/image_raw/compressed`);
      assert.strictEqual(image.format, 'png');
      assert(Buffer.from(line.png, 'base64').equals(Buffer.from(image.data)));
      const info = take(`/${name}/camera_info`);
      assert.deepStrictEqual([info.width, info.height], [line.width, line.height]);
      close(info.k[0], line.fx, 'fx');
      assert.strictEqual(info.d.length, info.distortion_model === 'equidistant' ? 4 : 5);
    }
    if (line.heard && line.position) {
      const { point } = take(`/${name}/position`);
      close(point.x, line.position[0], 'x');
      close(point.y, line.position[1], 'y');
    }
  }
  console.log(`compared ${compared}`);
  if (process.argv[5]) console.log(`robots, odometry, people ${checkRun(process.argv[5], messages).join(' ')}`);
  for (const topic of [...topics.keys()].sort()) console.log(`${topic} ${topics.get(topic)}`);
}

main().catch((error) => {
  console.error(error.message);
  process.exit(1);
});

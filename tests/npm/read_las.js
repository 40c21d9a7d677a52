// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a LAS file with the copc package, which knows plain LAS, too, and prints its points as CSV:
// node read_las.js FILE.las. Fails if the head and the points disagree.
'use strict';

const assert = require('assert');
const fs = require('fs');
const { Las } = require('copc');

async function main() {
  const bytes = fs.readFileSync(process.argv[2]);
  const header = Las.Header.parse(bytes);
  assert.deepStrictEqual([header.majorVersion, header.minorVersion], [1, 4]);
  assert.strictEqual(header.pointDataRecordFormat, 1);
  const get = async (begin, end) => bytes.subarray(begin, end);
  const records = await Las.Vlr.walk(get, header);
  const names = new Map();
  for (const record of records) {
    assert.deepStrictEqual([record.userId, record.recordId], ['LASF_Spec', 3]);
    const text = bytes.toString('utf8', record.contentOffset, record.contentOffset + record.contentLength);
    for (const line of text.trim().split('\n')) {
      const [number, ...id] = line.split(' ');
      names.set(Number(number), id.join(' '));
    }
  }
  const points = bytes.subarray(header.pointDataOffset);
  assert.strictEqual(points.length, header.pointCount * header.pointDataRecordLength);
  assert.strictEqual(header.pointCountByReturn[0], header.pointCount);
  const view = Las.View.create(points, header);
  assert.strictEqual(view.pointCount, header.pointCount);
  const read = ['PointSourceId', 'GpsTime', 'X', 'Y', 'Z'].map((name) => view.getter(name));
  const returns = [view.getter('ReturnNumber'), view.getter('NumberOfReturns')];
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < view.pointCount; ++i) {
    const [source, ...rest] = read.map((one) => one(i));
    assert.deepStrictEqual(returns.map((one) => one(i)), [1, 1]);
    console.log([names.get(source), ...rest].join(','));
    rest.slice(1).forEach((value, axis) => {
      low[axis] = Math.min(low[axis], value);
      high[axis] = Math.max(high[axis], value);
    });
  }
  if (view.pointCount === 0) return;
  for (let axis = 0; axis < 3; ++axis) {
    assert(Math.abs(low[axis] - header.min[axis]) < 1e-9);
    assert(Math.abs(high[axis] - header.max[axis]) < 1e-9);
  }
}

main().catch((error) => {
  console.error(error.message);
  process.exit(1);
});

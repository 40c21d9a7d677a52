// SPDX-License-Identifier: GPL-3.0-or-later
// compare_scans.js RECEIVED RECORDED SENSOR: each received scan is one of the record's (scans.jsonl), by its time and
// float by float. Prints their number.
'use strict';
const fs = require('fs');
const [received, recorded, sensor] = process.argv.slice(2);
const lines = file => fs.readFileSync(file, 'utf8').split('\n').filter(line => line.startsWith('{')).map(JSON.parse);
const known = new Map();
for (const scan of lines(recorded))
    if (scan.sensor === sensor) known.set(Math.round(scan.t * 1e6), scan.ranges);
let count = 0;
for (const scan of lines(received)) {
    const ranges = known.get(Math.round(scan.t * 1e6));
    const same = ranges !== undefined && ranges.length === scan.ranges.length &&
        ranges.every((range, i) => range === null ? scan.ranges[i] === null
                                                  : Math.fround(range) === scan.ranges[i]);
    if (!same) {
        console.error(`the scan of t=${scan.t} differs from the record`);
        process.exit(1);
    }
    ++count;
}
console.log('compared', count);

// SPDX-License-Identifier: GPL-3.0-or-later
// Times Clipper 2's union, compiled to WebAssembly, of the outlines that `union_bench --write FOLDER`
// wrote, beside what that says all depths, and an Overlay with its edges, take; processor time, the
// least of eight, without start-up.
//
//     NODE_PATH=build/npm/node_modules node clipper2_union.js FOLDER      (what tests/bench/run.sh does)
const fs = require('fs');
const path = require('path');

const STEP = 2 ** -30;  // metres

function millisecondsOf(work) {
    let least = Infinity;
    for (let round = 0; round < 8; ++round) {
        const start = process.cpuUsage();
        work();
        const spent = process.cpuUsage(start);
        least = Math.min(least, (spent.user + spent.system) / 1000);
    }
    return least;
}

async function main(folder) {
    const clipper = await require('clipper2-wasm/dist/umd/clipper2z.js')();
    console.log('scene and k         depths, ms  Overlay, ms  Clipper 2, WebAssembly, ms   ratio');
    const files = fs.readdirSync(folder).filter((name) => name.endsWith('.json'));
    const inOrder = (a, b) => a.localeCompare(b, 'en', {numeric: true});
    for (const file of files.sort(inOrder)) {
        const test = JSON.parse(fs.readFileSync(path.join(folder, file)));
        const paths = new clipper.Paths64();
        for (const outline of test.outlines)
            paths.push_back(clipper.MakePath64(outline.map((v) => BigInt(Math.round(v / STEP)))));
        let area = 0;
        const spent = millisecondsOf(() => {
            const union = clipper.UnionSelf64(paths, clipper.FillRule.NonZero);
            area = clipper.AreaPaths64(union) * STEP * STEP;
            union.delete();
        });
        if (Math.abs(area - test.area) > 1e-8 * test.area)
            throw new Error(`${file}: the union has ${area} m2, wanted ${test.area}`);
        console.log(file.replace('.json', '').padEnd(16), test.depths_ms.toFixed(2).padStart(13),
                    test.overlay_ms.toFixed(2).padStart(12),
                    spent.toFixed(2).padStart(27), (spent / test.depths_ms).toFixed(2).padStart(7));
    }
}

main(process.argv[2] || '.').catch((error) => {
    console.error(String(error));
    process.exit(1);
});

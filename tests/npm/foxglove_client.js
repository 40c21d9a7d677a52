// SPDX-License-Identifier: GPL-3.0-or-later
// foxglove_client.js URL SCANS: a client with Foxglove's own libraries. Reads a message of each topic by the definition
// that the server sends, drives the robot r1 in both encodings, calls services, sets parameters, fetches the room, and
// appends the scans of /l1/scan to the file SCANS, a line of JSON each. Exits with 1 and the reason if one fails.
'use strict';
const assert = require('assert');
const fs = require('fs');
const {FoxgloveClient} = require('@foxglove/ws-protocol');
const {parse} = require('@foxglove/rosmsg');
const {MessageReader, MessageWriter} = require('@foxglove/rosmsg2-serialization');
const WebSocket = require('ws');

const [url, scansFile] = process.argv.slice(2);
const patience = setTimeout(() => fail('no answer for a minute'), 60000);

function fail(why) {
    console.error('foxglove_client:', why);
    process.exit(1);
}

/** Waits until a condition holds, in turns. */
async function until(condition, what) {
    for (let i = 0; i < 3000; ++i) {
        const value = condition();
        if (value) return value;
        await new Promise(done => setTimeout(done, 10));
    }
    fail(`waited for ${what}; the server said: ${seen.statuses}`);
}

/** Repeats an order, as teleoperation does, until a condition holds. */
async function drive(order, condition, what) {
    order();
    const repeated = setInterval(order, 200);
    await until(condition, what);
    clearInterval(repeated);
}

let seen;

async function main(protocol) {
    const client = new FoxgloveClient({ws: new WebSocket(url, [protocol])});
    seen = {channels: new Map(), services: new Map(), newest: new Map(), scans: [], statuses: []};
    client.on('error', error => fail(error));
    client.on('serverInfo', info => seen.info = info);
    client.on('status', status => seen.statuses.push(status.message));
    client.on('advertiseServices', list => list.forEach(one => seen.services.set(one.name, one)));
    client.on('time', ({timestamp}) => seen.time = timestamp);
    client.on('parameterValues', ({parameters}) => seen.parameters = parameters);
    client.on('fetchAssetResponse', asset => seen.asset = asset);
    client.on('serviceCallResponse', answer => seen.answer = answer);
    client.on('connectionGraphUpdate', graph => seen.graph = graph);
    client.on('serviceCallFailure', failure => seen.failure = failure);
    const subscribed = new Map();
    client.on('advertise', list => {
        for (const channel of list) {
            assert.strictEqual(channel.encoding, 'cdr');
            const reader = new MessageReader(parse(channel.schema, {ros2: true}));
            seen.channels.set(channel.topic, channel);
            subscribed.set(client.subscribe(channel.id), {topic: channel.topic, reader});
        }
    });
    client.on('message', ({subscriptionId, data}) => {
        const {topic, reader} = subscribed.get(subscriptionId);
        const message = reader.readMessage(data);
        seen.newest.set(topic, message);
        if (topic === '/l1/scan') seen.scans.push(message);
    });

    await until(() => seen.info && seen.channels.size > 0, 'the greeting');
    assert.deepStrictEqual(seen.info.supportedEncodings, ['json', 'cdr']);
    const topics = [...seen.channels.keys()];
    await until(() => topics.every(topic => seen.newest.has(topic)),
                'a message of each topic: ' + topics.filter(topic => !seen.newest.has(topic)));
    await until(() => seen.time > 0n, 'the time');
    const map = seen.newest.get('/map');
    assert.strictEqual(map.data.length, map.info.width * map.info.height);
    assert.ok(map.data.includes(0) && map.data.includes(100) && map.data.includes(-1));
    assert.strictEqual(seen.newest.get('/people').markers[1].type, 3);
    assert.strictEqual(seen.newest.get('/c1/image_raw/compressed').format, 'png');
    const points = seen.newest.get('/d1/points');
    assert.strictEqual(points.data.length, points.width * points.height * points.point_step);

    // Drive: JSON forward, then CDR back.
    const place = () => seen.newest.get('/r1/odom').pose.pose.position.x;
    const start = place();
    const forward = client.advertise({topic: '/cmd_vel', encoding: 'json', schemaName: 'geometry_msgs/Twist'});
    await drive(() => client.sendMessage(forward, Buffer.from(JSON.stringify({linear: {x: 0.4}, angular: {z: 0}}))),
                () => place() > start + 0.1, 'the robot to go');
    await until(() => seen.newest.get('/r1/odom').twist.twist.linear.x === 0, 'the watchdog');
    const definition = parse(`std_msgs/Header header
geometry_msgs/Twist twist
===
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
===
MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
===
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z`, {ros2: true});
    const far = place();
    const back = client.advertise(
        {topic: '/r1/cmd_vel', encoding: 'cdr', schemaName: 'geometry_msgs/msg/TwistStamped'});
    const zero = {x: 0, y: 0, z: 0};
    const order = new MessageWriter(definition).writeMessage(
        {header: {stamp: {sec: 0, nanosec: 0}, frame_id: ''}, twist: {linear: {...zero, x: -0.4}, angular: zero}});
    await drive(() => client.sendMessage(back, order), () => place() < far - 0.05, 'the robot to come back');

    // Services, parameters, assets.
    const call = name => client.sendServiceCallRequest(
        {serviceId: seen.services.get(name).id, callId: 5, encoding: 'json', data: new TextEncoder().encode('{}')});
    call('/pause');
    await until(() => seen.answer?.callId === 5, 'the pause');
    client.getParameters(['clock.paused'], 'p');
    await until(() => seen.parameters?.[0]?.value === true, 'a parameter');
    seen.parameters = undefined;
    client.setParameters([{name: 'clock.paused', value: false}], 's');
    await until(() => seen.parameters?.[0]?.value === false, 'a parameter that is set');
    client.subscribeConnectionGraph();
    const graph = await until(() => seen.graph, 'the graph of nodes');
    // Orders are channels, too, once a client has sent one.
    const written = topics.filter(topic => !topic.endsWith('/cmd_vel'));
    assert.deepStrictEqual(graph.publishedTopics.map(one => one.name).sort(), written.sort());
    assert.ok(graph.subscribedTopics.some(one => one.name === '/r1/cmd_vel' && one.subscriberIds[0] === '/simrun'));
    client.fetchAsset('package://ispace/room.glb', 8);
    const asset = await until(() => seen.asset, 'the room');
    assert.strictEqual(asset.status, 0, asset.error);
    assert.strictEqual(Buffer.from(asset.data.buffer, asset.data.byteOffset, 4).toString(), 'glTF');
    assert.deepStrictEqual(seen.statuses, []);
    fs.appendFileSync(scansFile, seen.scans.map(scan => JSON.stringify({
        t: scan.header.stamp.sec + scan.header.stamp.nanosec / 1e9, angle_min: scan.angle_min,
        ranges: [...scan.ranges].map(range => Number.isFinite(range) ? range : null)}) + '\n').join(''));
    client.close();
    return `${topics.length} topics, ${seen.scans.length > 0 ? 'scans' : 'no scans'}`;
}

main('foxglove.websocket.v1').then(async said => {
    // The protocol of Foxglove's SDK differs in its name.
    console.log(said, '\n' + await main('foxglove.sdk.v1'));
    clearTimeout(patience);
    process.exit(0);
}, fail);

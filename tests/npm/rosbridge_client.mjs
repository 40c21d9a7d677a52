// SPDX-License-Identifier: GPL-3.0-or-later
// rosbridge_client.mjs URL SCANS: a client with roslib. Looks around by rosapi, reads topics as JSON, CBOR and PNG,
// throttled and not, and frames by both TF clients, drives the robot r1, sends it to goals, calls a service, and appends
// the scans of /l1/scan to the file SCANS, a line of JSON each. Exits with 1 and the reason if one fails.
import assert from 'assert';
import fs from 'fs';

const {Action, Ros, ROS2TFClient, TFClient, Topic, Service} =
    await import(`${process.env.NODE_PATH}/roslib/dist/RosLib.js`);
const [url, scansFile] = process.argv.slice(2);

function fail(why) {
    console.error('rosbridge_client:', why);
    process.exit(1);
}
const patience = setTimeout(() => fail('no answer for a minute'), 60000);
process.on('unhandledRejection', fail);

async function until(condition, what) {
    for (let i = 0; i < 3000; ++i) {
        const value = condition();
        if (value) return value;
        await new Promise(done => setTimeout(done, 10));
    }
    fail('waited for ' + what);
}

const ros = new Ros({url});
ros.on('error', fail);
await new Promise(done => ros.on('connection', done));

// rosapi.
const {topics, types} = await new Promise((done, failed) => ros.getTopics(done, failed));
assert.strictEqual(types[topics.indexOf('/l1/scan')], 'sensor_msgs/msg/LaserScan');
assert.deepStrictEqual(await new Promise((done, failed) => ros.getNodes(done, failed)), ['/simrun']);
const services = await new Promise((done, failed) => ros.getServices(done, failed));
assert.ok(services.includes('/reset'));
assert.strictEqual(await new Promise((done, failed) => ros.getTopicType('/tf', done, failed)),
                   'tf2_msgs/msg/TFMessage');
const details = await new Promise(
    (done, failed) => ros.getMessageDetails('geometry_msgs/Twist', done, failed));
assert.strictEqual(details.length, 2);

// Topics.
const newest = new Map(), counts = new Map(), scans = [];
function listen(name, messageType, options = {}) {
    const topic = new Topic({ros, name, messageType, ...options});
    topic.subscribe(message => {
        newest.set(name, message);
        counts.set(name, (counts.get(name) ?? 0) + 1);
        if (name === '/l1/scan') scans.push(message);
    });
    return topic;
}
const scan = listen('/l1/scan', 'sensor_msgs/LaserScan', {compression: 'cbor'});
listen('/r1/odom', 'nav_msgs/Odometry');
listen('/map', 'nav_msgs/OccupancyGrid', {compression: 'cbor'});
listen('/clock', 'rosgraph_msgs/Clock', {throttle_rate: 500, queue_length: 1});
listen('/tf_static', 'tf2_msgs/TFMessage');
await until(() => newest.size === 5, 'a message of each topic');
assert.ok(newest.get('/l1/scan').ranges instanceof Float32Array);
const map = newest.get('/map');
assert.strictEqual(map.data.length, map.info.width * map.info.height);
await until(() => counts.get('/r1/odom') >= 50, 'odometry');
assert.ok(counts.get('/clock') * 5 < counts.get('/r1/odom'), 'the clock is throttled');

// Drive, and find the robot where the odometry says.
const place = () => newest.get('/r1/odom').pose.pose.position.x;
const start = place();
const command = new Topic({ros, name: '/cmd_vel', messageType: 'geometry_msgs/Twist'});
const order = () => command.publish({linear: {x: 0.4, y: 0, z: 0}, angular: {x: 0, y: 0, z: 0}});
order();
const repeated = setInterval(order, 200);
await until(() => place() > start + 0.1, 'the robot to go');
clearInterval(repeated);
await until(() => newest.get('/r1/odom').twist.twist.linear.x === 0, 'the watchdog');

// Nav2's action: a goal, one that is refused, and one that is cancelled.
const navigate = new Action({ros, name: '/navigate_to_pose', actionType: 'nav2_msgs/action/NavigateToPose'});
const goal = (x, y) => ({pose: {header: {frame_id: 'map'}, pose: {
    position: {x, y, z: 0}, orientation: {x: 0, y: 0, z: 0, w: 1}}}, behavior_tree: ''});
const left = [];
await new Promise((done, failed) =>
    navigate.sendGoal(goal(0, -0.8), done, feedback => left.push(feedback.distance_remaining), failed));
assert.ok(left.length > 1 && left.at(-1) < left[0], `feedback: ${left}`);
const refusal = await new Promise((done, failed) => navigate.sendGoal(goal(90, 0), failed, null, done));
assert.match(refusal, /goal of r1/);
const cancelled = await new Promise((done, failed) => {
    const id = navigate.sendGoal(goal(-1.2, -0.5), failed, () => navigate.cancelGoal(id), done);
});
assert.match(cancelled, /cancel/i);

// Frames by both TF clients of roslib, and messages in pictures.
for (const Client of [ROS2TFClient, TFClient]) {
    const client = new Client({ros, fixedFrame: 'map', angularThres: 0.001, transThres: 0.001, rate: 20});
    const pose = await new Promise(done => client.subscribe('/r1', done));
    assert.ok(Math.hypot(pose.translation.x + 1.2, pose.translation.y + 0.5) < 3, JSON.stringify(pose));
    assert.ok(Math.abs(Math.hypot(pose.rotation.z, pose.rotation.w) - 1) < 1e-9);
    client.dispose();
}
// By the service of tf2_web_republisher, as roslib 1 has it without groovyCompatibility.
const republished = await new Promise((done, failed) => new Service(
    {ros, name: '/republish_tfs', serviceType: 'tf2_web_republisher/RepublishTFs'}).callService(
        {source_frames: ['r1'], target_frame: 'map', angular_thres: 0.001, trans_thres: 0.001, rate: 20,
         timeout: {secs: 2, nsecs: 0}}, done, failed));
const array = new Topic({ros, name: republished.topic_name, messageType: 'tf2_web_republisher/TFArray'});
const {transforms} = await new Promise(done => array.subscribe(done));
assert.strictEqual(transforms[0].child_frame_id, 'r1');
assert.ok(Math.hypot(transforms[0].transform.translation.x + 1.2, transforms[0].transform.translation.y + 0.5) < 3);
array.unsubscribe();
const picture = new Topic({ros, name: '/tf', messageType: 'tf2_msgs/TFMessage', compression: 'png'});
const inPicture = await new Promise(done => picture.subscribe(done));
assert.ok(inPicture.transforms.some(one => one.child_frame_id === 'r1'));
picture.unsubscribe();

// A service, and one that there is not.
const reset = name => new Promise((done, failed) => new Service(
    {ros, name, serviceType: 'std_srvs/srv/Empty'}).callService({}, done, failed));
scan.unsubscribe();
await reset('/pause');
await reset('/resume');
await reset('/none').then(() => fail('a service that does not exist'), why => assert.match(String(why), /no service/));
fs.appendFileSync(scansFile, scans.map(one => JSON.stringify({
    t: one.header.stamp.sec + one.header.stamp.nanosec / 1e9, angle_min: one.angle_min,
    ranges: [...one.ranges].map(range => Number.isFinite(range) ? range : null)}) + '\n').join(''));
console.log(`${topics.length} topics, ${scans.length > 0 ? 'scans' : 'no scans'}`);
clearTimeout(patience);
ros.close();
process.exit(0);

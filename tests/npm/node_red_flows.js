// SPDX-License-Identifier: GPL-3.0-or-later
// node_red_flows.js PORT FOLDER: writes FOLDER/settings.js and FOLDER/flows.json for Node-RED without its editor. Flows:
// what the broker at PORT sends goes to FOLDER/heard, a line of JSON each ([topic, payload]); motion of s1 switches the
// lamp l1; and each entity of Home Assistant's discovery is subscribed by the topics of its description, to FOLDER/found.
'use strict';
const fs = require('fs');
const path = require('path');

const [port, folder] = process.argv.slice(2);
const broker = {id: 'broker', type: 'mqtt-broker', name: '', broker: '127.0.0.1', port, clientid: '', autoConnect: true,
                usetls: false, protocolVersion: '4', keepalive: '60', cleansession: true};
const tab = {id: 'tab', type: 'tab', label: 'a home'};

/** A node of the flow, wired to others. */
function node(id, type, wires, rest) { return {id, type, z: 'tab', x: 0, y: 0, wires: [wires], ...rest}; }
function reader(id, topic, wires) {
    return node(id, 'mqtt in', wires, {topic, qos: '1', datatype: 'utf8', broker: 'broker', nl: false, rap: true, rh: 0,
                                       inputs: 0});
}
function code(id, wires, func) {
    return node(id, 'function', wires, {func, outputs: 1, timeout: 0, noerr: 0, initialize: '', finalize: '', libs: []});
}
function writer(id, name) {
    return node(id, 'file', [], {filename: path.resolve(folder, name), filenameType: 'str', appendNewline: true,
                                 createDir: false, overwriteFile: 'false', encoding: 'utf8'});
}

fs.writeFileSync(path.join(folder, 'flows.json'), JSON.stringify([
    tab, broker,
    reader('states', 'ispace/+/+', ['pair', 'switch']),
    reader('status', 'ispace/status', ['pair']),
    reader('discovery', 'homeassistant/+/+/config', ['pair', 'follow']),
    code('pair', ['heard'], `
        if (msg.topic.endsWith('/image')) return null;
        msg.payload = JSON.stringify([msg.topic, msg.payload]);
        return msg;`),
    writer('heard', 'heard'),

    // The lamp follows the motion sensor.
    code('switch', ['lamp'], 'return msg.topic === "ispace/s1/motion" ? {payload: msg.payload} : null;'),
    node('lamp', 'mqtt out', [], {topic: 'ispace/l1/on/set', qos: '1', retain: 'false', broker: 'broker'}),

    // As Home Assistant does: the state of an entity is where its description says.
    code('follow', ['dynamic'], `
        const entity = JSON.parse(msg.payload);
        const topic = entity.state_topic ?? entity.topic ?? entity.position_topic;
        return topic && {action: 'subscribe', topic: [{topic, qos: 1}]};`),
    node('dynamic', 'mqtt in', ['found-pair'], {topic: '', qos: '1', datatype: 'buffer', broker: 'broker', nl: false,
                                                rap: true, rh: 0, inputs: 1}),
    code('found-pair', ['found'], 'msg.payload = JSON.stringify([msg.topic, msg.payload.length]); return msg;'),
    writer('found', 'found'),
], null, 1));
fs.writeFileSync(path.join(folder, 'settings.js'), `module.exports = {
    flowFile: 'flows.json', httpAdminRoot: false, httpNodeRoot: false, uiHost: '127.0.0.1', uiPort: 0, credentialSecret: false,
    telemetry: {enabled: false, updateNotification: false}, logging: {console: {level: 'info'}},
};
`);

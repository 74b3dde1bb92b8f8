// Flies with --live, follows the flight by Foxglove's own client, and compares what that saw with the run directory.
//   node interop.mjs NODE_MODULES RUN KARST ARGUMENTS...
import {createRequire} from 'node:module';
import {spawn} from 'node:child_process';
import {readFileSync} from 'node:fs';
import {connect} from 'node:net';
import {join} from 'node:path';

const [modules, run, karst, ...args] = process.argv.slice(2);
const require = createRequire(join(modules, '/'));
const {FoxgloveClient} = require('@foxglove/ws-protocol');
const {WebSocket} = require('ws');
const {parse} = require('@foxglove/rosmsg');
const {MessageReader} = require('@foxglove/rosmsg2-serialization');

let failures = 0, checks = 0;
function check(ok, what) {
  checks++;
  if (!ok && failures++ < 30) console.log('FAILED ' + what);
}
const near = (a, b, tolerance) => Math.abs(a - b) <= tolerance;
const seconds = (stamp) => stamp.sec + stamp.nanosec / 1e9;

class Follower {
  topics = new Map();
  statuses = [];
  times = [];
  constructor(url, subprotocol) {
    this.client = new FoxgloveClient({ws: new WebSocket(url, [subprotocol])});
    const channels = new Map();
    this.client.on('serverInfo', (info) => { this.info = info; });
    this.client.on('status', (status) => this.statuses.push(status));
    this.client.on('time', ({timestamp}) => this.times.push(timestamp));
    this.client.on('advertise', (list) => {
      for (const c of list) {
        check(c.encoding === 'cdr' && c.schemaEncoding === 'ros2msg', `encodings of ${c.topic}`);
        const reader = new MessageReader(parse(c.schema, {ros2: true}));
        channels.set(this.client.subscribe(c.id), {topic: c.topic, reader});
        this.topics.set(c.topic, []);
      }
    });
    this.client.on('message', ({subscriptionId, timestamp, data}) => {
      const {topic, reader} = channels.get(subscriptionId);
      const value = reader.readMessage(data);
      const stamp = value.header?.stamp ?? value.stamp ?? value.transforms?.[0].header.stamp ?? value.markers?.[0]?.header.stamp;
      if (stamp) check(BigInt(stamp.sec) * 1000000000n + BigInt(stamp.nanosec) === timestamp, 'stamp and time of ' + topic);
      this.topics.get(topic).push({t: Number(timestamp) / 1e9, value});
    });
    this.closed = new Promise((resolve) => this.client.on('close', (e) => resolve(e.reason)));
  }
  of(topic) { return this.topics.get(topic) ?? []; }
}

// The flight, and its clients as soon as it says where it is served.
const flight = spawn(karst, args, {stdio: ['ignore', 'ignore', 'pipe']});
const ended = new Promise((resolve) => flight.on('exit', resolve));
let said = '';
const url = await new Promise((resolve, reject) => {
  flight.stderr.on('data', (bytes) => {
    said += bytes;
    const found = /http:\/\/([0-9.:]+)\//.exec(said);
    if (found) resolve('ws://' + found[1] + '/');
  });
  flight.on('exit', () => reject(new Error('not served: ' + said)));
});
const followers = ['foxglove.websocket.v1', 'foxglove.sdk.v1', 'foxglove.websocket.v1'].map((p) => new Follower(url, p));
const dead = new WebSocket(url, ['foxglove.websocket.v1']);
dead.on('open', () => {
  dead.send(JSON.stringify({op: 'subscribe', subscriptions: Array.from({length: 13}, (_, i) => ({id: i, channelId: i}))}));
  dead._socket.pause();
});
dead.on('error', () => {});
const {hostname, port} = new URL(url), hostile = connect(Number(port), hostname);
hostile.on('error', () => {});
hostile.write('\x16\x03\x01garbage'.repeat(1000));
const reasons = await Promise.all(followers.map((f) => f.closed));
await ended;
dead.terminate();
reasons.forEach((r) => check(r === 'the flight is over', 'reason of the close: ' + r));

// Against the run directory: from the first message on none is missing, and each is what the record says.
const lines = (name) => readFileSync(join(run, name), 'utf8').trim().split('\n');
const poses = lines('trajectory.tum').map((l) => l.split(' ').map(Number));
const events = lines('events.jsonl').map((l) => JSON.parse(l));
const [columns, ...rows] = lines('telemetry.csv').map((l) => l.split(','));
const telemetry = rows.map((r) => Object.fromEntries(columns.map((c, i) => [c, r[i]])));
const growth = readFileSync(join(run, 'map_growth.bin'));
const resolution = 0.2;

function followsAll(f, topic, recorded, same) {
  const got = f.of(topic);
  check(got.length > 0, `${topic} has messages`);
  const begin = recorded.length - got.length;
  check(begin >= 0, `${topic} has ${got.length} messages, the record ${recorded.length}`);
  got.forEach((m, i) => check(begin >= 0 && same(m, recorded[begin + i]), `${topic} ${i} of ${got.length}`));
  return got.length / recorded.length;
}
const cells = (cloud) => {
  const view = new DataView(cloud.data.buffer, cloud.data.byteOffset), at = (i, o) => view.getFloat32(i * cloud.point_step + o, true);
  return Array.from({length: cloud.width}, (_, i) => [0, 4, 8].map((o) => Math.floor(at(i, o) / resolution)).join(' '));
};
const occupied = new Set();
for (let i = 0; i + 16 <= growth.length; i += 16) {
  const key = [0, 4, 8].map((o) => growth.readInt32LE(i + o)).join(' ');
  if (growth.readInt32LE(i + 12) >= 0) occupied.add(key); else occupied.delete(key);
}
const ply = readFileSync(join(run, 'map.ply')), head = ply.indexOf('end_header\n') + 11;
const stored = new Set();
const vertices = Number(/element vertex (\d+)/.exec(ply.subarray(0, head).toString())[1]);
for (let o = head; o < head + 12 * vertices; o += 12) stored.add([0, 4, 8].map((k) => Math.floor(ply.readFloatLE(o + k) / resolution)).join(' '));

let least = 1;
for (const f of followers) {
  check(f.info?.capabilities.includes('time') && f.info.metadata.policy === 'nearest_frontier', 'server info');
  check(f.statuses.length === 0, 'statuses: ' + JSON.stringify(f.statuses));
  check(f.times.length > 5 && f.times.every((t, i, all) => !i || t >= all[i - 1]), 'times rise');
  const samePose = ({t, value}, p) => near(t, p[0], 1e-6) && near(value.pose.pose.position.x, p[1], 1e-9) &&
    near(value.pose.pose.position.y, p[2], 1e-9) && near(value.pose.pose.position.z, p[3], 1e-9) &&
    near(value.pose.pose.orientation.w, p[7], 1e-6);
  least = Math.min(least, followsAll(f, '/odometry', poses, samePose));
  followsAll(f, '/tf', poses, ({t, value}, p) => near(t, p[0], 1e-6) && near(value.transforms[0].transform.translation.x, p[1], 1e-9));
  const kind = (k) => events.filter((e) => e.kind === k);
  followsAll(f, '/events', events.filter((e) => !['frontiers', 'drawing'].includes(e.kind)),
             ({t, value}, e) => near(t, e.t, 1e-6) && value.name === e.kind);
  const decisions = f.of('/events').filter((m) => m.value.name === 'decision');
  decisions.forEach((m, i) => {
    const e = kind('decision').at(i - decisions.length);
    check(m.value.msg.includes(`${e.policy} decides ${e.outcome}, ${e.goals} goals of ${e.frontiers} frontiers`), 'decision ' + i);
  });
  followsAll(f, '/phase', kind('phase'), ({value}, e) => value.markers.at(-1).text.startsWith(e.phase));
  followsAll(f, '/plan', kind('plan'), ({t, value}, e) => near(t, e.t, 1e-6) && value.poses.length === e.points.length);
  followsAll(f, '/goals', kind('goal'), ({value}, e) => value.markers.filter((m) => m.type === 9).at(-1).text.startsWith(e.state));
  f.of('/battery').forEach((m) => {
    const row = telemetry.find((r) => near(Number(r.t_s), m.t, 1e-6));
    check(row && near(m.value.percentage, Number(row.battery_fraction), 1e-6), `battery at ${m.t} s`);
  });
  check(f.of('/battery').length > 5, 'battery');
  // All that was added to the first map that came, less what ceased to be; and the last map as it was stored.
  const last = cells(f.of('/map').at(-1).value);
  const before = cells(f.of('/map').filter((m) => m.t < f.of('/map').at(-1).t).at(-1).value);
  check(before.length > last.length / 2, `/map before the last has ${before.length} cells`);
  check(stored.size === last.length && last.every((k) => stored.has(k)), `/map has ${last.length} cells, map.ply ${stored.size}`);
  const added = new Set([...cells(f.of('/map')[0].value), ...f.of('/map/new').flatMap((m) => cells(m.value))]);
  check([...occupied].every((k) => added.has(k)), 'every cell that the growth has came by /map or /map/new');
  const path = f.of('/path').at(-1).value.poses;
  check(path.every((p) => poses.some((q) => near(p.pose.position.x, q[1], 1e-9) && near(p.pose.position.y, q[2], 1e-9))), 'path');
}
console.log(`${followers[0].of('/odometry').length} of ${poses.length} poses, ${followers[0].of('/events').length} events, ` +
            `${occupied.size} cells; from ${Math.round(100 * (1 - least))} % of the flight on; ${checks} checks, ${failures} failures`);
process.exit(failures === 0 ? 0 : 1);

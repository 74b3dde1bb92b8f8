// Reads an exported run by Foxglove's libraries, and compares it with the run directory.
//   node interop.mjs NODE_MODULES FILE.mcap RUN [PICTURE.svg]
// With PICTURE.svg it draws the last map and path from above, of the file alone.
import {createRequire} from 'node:module';
import {readFileSync, writeFileSync, existsSync} from 'node:fs';
import {join} from 'node:path';

const [modules, file, run, picture] = process.argv.slice(2);
const require = createRequire(join(modules, '/'));
const {McapIndexedReader, McapStreamReader} = require('@mcap/core');
const {parse} = require('@foxglove/rosmsg');
const {MessageReader} = require('@foxglove/rosmsg2-serialization');
const {ros2humble} = require('@foxglove/rosmsg-msgs-common');
const {decompress} = require('fzstd');

let failures = 0, checks = 0;
function check(ok, what) {
  checks++;
  if (!ok && failures++ < 30) console.log('FAILED ' + what);
}
const near = (a, b, tolerance) => Math.abs(a - b) <= tolerance;
const seconds = (stamp) => stamp.sec + stamp.nanosec / 1e9;

const bytes = readFileSync(file);
const unpack = (packed, size) => decompress(new Uint8Array(packed), new Uint8Array(Number(size)));
const decompressHandlers = {zstd: unpack};

// As a stream, with all check sums.
const stream = new McapStreamReader({decompressHandlers, validateCrcs: true, includeChunks: true});
stream.append(bytes);
const seen = {};
for (let record; (record = stream.nextRecord());) seen[record.type] = (seen[record.type] ?? 0) + 1;
check(stream.done(), 'the stream ends');
check(seen.Footer === 1 && seen.DataEnd === 1, 'footer and end of data');

// By the index, in the order of time.
const reader = await McapIndexedReader.Initialize({
  readable: {size: async () => BigInt(bytes.length),
             read: async (offset, size) => new Uint8Array(bytes.subarray(Number(offset), Number(offset + size)))},
  decompressHandlers});
check(reader.header.profile === 'ros2', 'profile ' + reader.header.profile);

const decoders = new Map(), topics = new Map();
const named = (definition) => (definition.name ?? '').replace('/msg/', '/');
for (const [id, channel] of reader.channelsById) {
  const schema = reader.schemasById.get(channel.schemaId);
  check(channel.messageEncoding === 'cdr' && schema.encoding === 'ros2msg', `encodings of ${channel.topic}`);
  const definitions = parse(new TextDecoder().decode(schema.data), {ros2: true});
  decoders.set(id, new MessageReader(definitions));
  topics.set(channel.topic, {type: schema.name, messages: []});
  check(channel.metadata.get('offered_qos_profiles')?.includes('durability: ' + (channel.topic === '/tf_static' ? 1 : 2)),
        `QoS of ${channel.topic}`);
  // The definition is ROS's own: the same fields in the same order, of this message and those inside it.
  definitions.forEach((mine, i) => {
    const name = i === 0 ? schema.name.replace('/msg/', '/') : named(mine);
    const theirs = ros2humble[name] ?? ros2humble[name.replace('/', '/msg/')];
    if (!theirs) return check(name.startsWith('rcl_interfaces/'), `${name} is a message of ROS`);
    const fields = (d) => d.definitions.filter((f) => !f.isConstant).map((f) =>
      [f.type.replace('/msg/', '/'), f.name, !!f.isArray, f.arrayLength ?? 0].join(' '));
    const [a, b] = [fields(mine), fields(theirs)].map((f) => f.map((t) => t.replace(/^time /, 'builtin_interfaces/Time ')
      .replace(/^duration /, 'builtin_interfaces/Duration ')));
    check(JSON.stringify(a) === JSON.stringify(b), `${name}:\n  ${a.join(', ')}\n  ${b.join(', ')}`);
  });
}
let last = 0n, count = 0;
for await (const message of reader.readMessages()) {
  check(message.logTime >= last, 'times rise');
  last = message.logTime;
  count++;
  const topic = topics.get(reader.channelsById.get(message.channelId).topic);
  const value = decoders.get(message.channelId).readMessage(message.data);
  const stamp = value.header?.stamp ?? value.stamp ?? value.transforms?.[0].header.stamp ?? value.markers?.[0].header.stamp;
  check(BigInt(stamp.sec) * 1000000000n + BigInt(stamp.nanosec) === message.logTime, 'stamp and time of ' + topic.type);
  topic.messages.push(value);
}
check(BigInt(count) === reader.statistics.messageCount, 'count of messages');
for (const [id, n] of reader.statistics.channelMessageCounts)
  check(BigInt(topics.get(reader.channelsById.get(id).topic).messages.length) === n, 'messages of channel ' + id);
let distribution;
for await (const record of reader.readMetadata({name: 'rosbag2'})) distribution = record.metadata.get('ROS_DISTRO');
check(distribution === 'humble', 'whose numbers the quality of service has');
let metadata;
for await (const record of reader.readMetadata({name: 'karst'})) metadata = record.metadata;
check(metadata?.get('exported_by')?.startsWith('karst '), 'what made it');
const epoch = Number(metadata?.get('epoch_s') ?? 0);
const of = (name) => topics.get(name)?.messages ?? [];

// Against the run directory.
const lines = (name) => existsSync(join(run, name)) ? readFileSync(join(run, name), 'utf8').trim().split('\n') : [];
const tum = (name) => lines(name).filter((l) => !l.startsWith('#')).map((l) => l.split(' ').map(Number));
const events = lines('events.jsonl').map((l) => JSON.parse(l));
const samePose = (pose, [, x, y, z, qx, qy, qz, qw]) => near(pose.position.x, x, 1e-6) && near(pose.position.y, y, 1e-6) &&
  near(pose.position.z, z, 1e-6) &&
  near(Math.abs(pose.orientation.x * qx + pose.orientation.y * qy + pose.orientation.z * qz + pose.orientation.w * qw), 1, 1e-6);

const origin = Number(/^\s*time_origin\s+"?([-0-9.e+]+)/m.exec(lines('mission.info').join('\n'))?.[1] ?? 0);
const estimate = tum('trajectory.tum'), truth = tum('ground_truth.tum');
for (const [topic, poses, child] of [['/odometry', estimate, 'base_link'], ['/truth/odometry', truth, 'base_link_truth']]) {
  check(of(topic).length === poses.length, `${topic} has ${of(topic).length} of ${poses.length} poses`);
  of(topic).forEach((m, i) => {
    check(near(seconds(m.header.stamp), poses[i][0] - origin + epoch, 2e-6), `${topic} ${i}: stamp`);
    check(samePose(m.pose.pose, poses[i]), `${topic} ${i}: pose`);
    check(m.header.frame_id === 'map' && m.child_frame_id === child, `${topic} ${i}: frames`);
  });
  const moves = topics.get('/tf').messages.map((m) => m.transforms[0]).filter((t) => t.child_frame_id === child);
  check(moves.length === poses.length, `/tf of ${child}`);
  moves.forEach((t, i) => check(
    samePose({position: t.transform.translation, orientation: t.transform.rotation}, poses[i]), `/tf of ${child} ${i}`));
}
// The twist, in the body's frame, moves the vehicle as the poses say.
const rotate = ({x, y, z, w}, v) => {
  const t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])];
  return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2], v[2] + w * t[2] + x * t[1] - y * t[0]];
};
const odometry = of('/truth/odometry');
for (let i = 1; i + 1 < odometry.length; i++) {
  const {x, y, z} = odometry[i].twist.twist.linear, dt = truth[i + 1][0] - truth[i - 1][0];
  const v = rotate(odometry[i].pose.pose.orientation, [x, y, z]);
  for (let axis = 0; axis < 3; axis++)
    check(near(v[axis], (truth[i + 1][1 + axis] - truth[i - 1][1 + axis]) / dt, 1e-3), `velocity at ${truth[i][0]} s`);
}

// The map, replayed from its growth.
const resolution = Number(/^\s*resolution\s+"?([-0-9.e+]+)/m.exec(
  lines('mission.info').join('\n').split(/^map\s*\{?$/m)[1] ?? '')?.[1] ?? 0.2);
const growth = existsSync(join(run, 'map_growth.bin')) ? readFileSync(join(run, 'map_growth.bin')) : Buffer.alloc(0);
const column = (cloud, name) => {
  const field = cloud.fields.find((f) => f.name === name), view = new DataView(cloud.data.buffer, cloud.data.byteOffset);
  const get = {2: 'getUint8', 4: 'getUint16', 6: 'getUint32', 7: 'getFloat32', 8: 'getFloat64'}[field.datatype];
  return Array.from({length: cloud.width}, (_, i) => view[get](i * cloud.point_step + field.offset, true));
};
const cells = (cloud) => {
  const [x, y, z] = ['x', 'y', 'z'].map((n) => column(cloud, n));
  return new Set(x.map((_, i) => [x[i], y[i], z[i]].map((v) => Math.floor(v / resolution)).join(' ')));
};
let at = 0;
const occupied = new Set(), maps = of('/map');
for (const cloud of maps) {
  check(cloud.data.length === cloud.row_step && cloud.row_step === cloud.width * cloud.point_step, 'size of a cloud');
  const until = Math.round((seconds(cloud.header.stamp) - epoch) * 1000);
  for (; at + 16 <= growth.length && Math.abs(growth.readInt32LE(at + 12)) <= until; at += 16) {
    const key = [0, 4, 8].map((o) => growth.readInt32LE(at + o)).join(' ');
    if (growth.readInt32LE(at + 12) >= 0) occupied.add(key); else occupied.delete(key);
  }
  if (cloud === maps.at(-1) && existsSync(join(run, 'map.ply'))) break;  // that one is the stored map
  const mine = cells(cloud);
  check(mine.size === occupied.size && [...mine].every((k) => occupied.has(k)), `/map at ${until} ms: ${mine.size} cells of ${occupied.size}`);
}
const became = of('/map/new').reduce((n, cloud) => n + cloud.width, 0);
let appeared = 0;
for (let i = 0; i + 16 <= growth.length; i += 16) appeared += growth.readInt32LE(i + 12) >= 0 ? 1 : 0;
check(became <= appeared && became >= occupied.size, `/map/new has ${became} of ${appeared} cells`);
if (existsSync(join(run, 'map.ply'))) {
  const ply = readFileSync(join(run, 'map.ply')), head = ply.indexOf('end_header\n') + 11;
  const n = Number(/element vertex (\d+)/.exec(ply.subarray(0, head).toString())[1]), final = cells(of('/map').at(-1));
  check(final.size === n, `the last /map has ${final.size} cells, map.ply ${n}`);
  for (let i = 0; i < n; i++)
    check(final.has([0, 4, 8].map((o) => Math.floor(ply.readFloatLE(head + 12 * i + o) / resolution)).join(' ')), `cell ${i} of map.ply`);
}

// Events.
const count_of = (kind) => events.filter((e) => e.kind === kind).length;
check(of('/plan').length === count_of('plan'), 'plans');
events.filter((e) => e.kind === 'plan').forEach((e, i) => {
  const path = of('/plan')[i];
  check(near(seconds(path.header.stamp), e.t + epoch, 2e-6) && path.poses.length === e.points.length &&
        e.points.every((p, k) => near(p[0], path.poses[k].pose.position.x, 1e-9)), `plan ${i}`);
});
check(of('/frontiers').length === count_of('frontiers') + count_of('frontier'), 'frontiers');
check(of('/goals').length === count_of('goal'), 'goals');
events.filter((e) => e.kind === 'goal').forEach((e, i) => {
  const text = of('/goals')[i].markers.filter((m) => m.type === 9).at(-1)?.text ?? '';
  check(text.startsWith(e.state) && text.includes(e.why) && text.includes(e.score.toFixed(2)), `goal ${i}: ${text}`);
});
check(of('/events').length === events.filter((e) => !['frontiers', 'drawing'].includes(e.kind)).length, 'log');
check(of('/objects').length === count_of('object'), 'objects');
check(of('/phase').length === count_of('phase'), 'phases');
const battery = of('/battery');
check(battery.every((b) => b.percentage > 0 && b.percentage <= 1), 'battery');
const path = of('/path').at(-1);
check(path && path.poses.every((p) => estimate.some((e) => samePose(p.pose, e))), 'path');
for (const image of of('/camera/image_raw/compressed')) {
  const info = of('/camera/camera_info').find((c) => seconds(c.header.stamp) === seconds(image.header.stamp));
  check(image.format === 'jpeg' && image.data[0] === 0xff && image.data[1] === 0xd8 && info?.k[0] > 0, 'picture');
}

// Scans and IMU, if the run recorded them.
const folder = join(run, 'scans');
if (existsSync(folder)) {
  const imu = lines('scans/imu.csv').slice(1).map((l) => l.split(',').map(Number));
  check(of('/imu').length === imu.length, `/imu has ${of('/imu').length} of ${imu.length} samples`);
  of('/imu').forEach((m, i) => check(near(seconds(m.header.stamp), imu[i][0] + epoch, 1e-6) &&
    near(m.linear_acceleration.z, imu[i][3], 1e-9) && near(m.angular_velocity.x, imu[i][4], 1e-9), `imu ${i}`));
  const compass = lines('scans/compass.csv').slice(1).map((l) => l.split(',').map(Number));
  check(of('/compass').length === compass.length, `/compass has ${of('/compass').length} of ${compass.length} samples`);
  of('/compass').forEach((m, i) => check(near(seconds(m.header.stamp), compass[i][0] + epoch, 1e-6) &&
    ['x', 'y', 'z'].every((a, k) => near(m.magnetic_field[a] * 1e6, compass[i][1 + k], 1e-9)), `compass ${i}`));
  const barometer = lines('scans/barometer.csv').slice(1).map((l) => l.split(',').map(Number));
  check(of('/barometer').length === barometer.length, `/barometer has ${of('/barometer').length} of ${barometer.length}`);
  const height = (pascal) => 288.15 / 0.0065 * (1 - (pascal / 101325) ** (1 / 5.25588));
  of('/barometer').forEach((m, i) => check(near(seconds(m.header.stamp), barometer[i][0] + epoch, 1e-6) &&
    near(height(m.fluid_pressure), barometer[i][1], 1e-6), `barometer ${i}`));
  const {readdirSync} = await import('node:fs');
  const names = readdirSync(folder).filter((n) => n.endsWith('.pcd')).sort();
  check(of('/points').length === names.length, `/points has ${of('/points').length} of ${names.length} scans`);
  of('/points').forEach((cloud, i) => {
    const pcd = readFileSync(join(folder, names[i])), head = pcd.indexOf('DATA binary\n') + 12;
    const order = cloud.fields.map((f) => f.name).join(' ');
    check(pcd.subarray(0, head).toString().includes(`FIELDS ${order}\n`), `fields of ${names[i]}: ${order}`);
    check(Buffer.compare(Buffer.from(cloud.data), pcd.subarray(head)) === 0, `points of ${names[i]}`);
  });
}

if (picture) {
  const cloud = of('/map').at(-1), [x, y, z] = ['x', 'y', 'z'].map((n) => column(cloud, n));
  const way = path.poses.map((p) => p.pose.position);
  const low = (v) => v.reduce((a, b) => Math.min(a, b), Infinity), high = (v) => v.reduce((a, b) => Math.max(a, b), -Infinity);
  const [x0, x1, y0, y1, z0, z1] = [low(x), high(x), low(y), high(y), low(z), high(z)], r = resolution;
  const squares = x.map((_, i) => i).sort((a, b) => z[a] - z[b]).map((i) =>
    `<rect x="${x[i] - r / 2}" y="${-y[i] - r / 2}" width="${r}" height="${r}" fill="hsl(${Math.round(240 - 200 * (z[i] - z0) / (z1 - z0 || 1))},50%,60%)"/>`);
  const goals = of('/goals').flatMap((m) => m.markers).filter((m) => m.ns === 'goal').map((m) =>
    `<circle cx="${m.pose.position.x}" cy="${-m.pose.position.y}" r="0.15" fill="black"/>`);
  writeFileSync(picture, `<svg xmlns="http://www.w3.org/2000/svg" width="1200" viewBox="${x0 - 1} ${-y1 - 1} ${x1 - x0 + 2} ${y1 - y0 + 2}">` +
    `<rect x="${x0 - 1}" y="${-y1 - 1}" width="100%" height="100%" fill="white"/>` + squares.join('') + goals.join('') +
    `<polyline points="${way.map((p) => `${p.x},${-p.y}`).join(' ')}" fill="none" stroke="red" stroke-width="0.12"/></svg>`);
}
console.log(`${count} messages of ${topics.size} topics, ${checks} checks, ${failures} failures`);
process.exit(failures === 0 ? 0 : 1);

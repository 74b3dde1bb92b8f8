// Writes the walk through the room, which bag_interop wrote as files, into MCAP by @mcap/core, with CDR by
// @foxglove/rosmsg2-serialization; and the same messages as lines of JSON, for write_db3.py.
//   node interop.mjs FOLDER_OF_FILES OUT NODE_MODULES
import fs from 'node:fs';
import path from 'node:path';
import {createRequire} from 'node:module';

const [folder, out, modules] = process.argv.slice(2);
const require = createRequire(modules + '/');
const {McapWriter} = require('@mcap/core');
const {MessageWriter} = require('@foxglove/rosmsg2-serialization');
const {parse} = require('@foxglove/rosmsg');
const lz4 = require('lz4-napi');
const {ZstdCodec} = require('zstd-codec');
const zstd = await new Promise((resolve) => ZstdCodec.run((z) => resolve(new z.Simple())));

const LINE = '='.repeat(80);
const HEADER = `${LINE}\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n` +
    `${LINE}\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n`;
const CLOUD = `# A cloud of points\nstd_msgs/Header header\nuint32 height\nuint32 width\n` +
    `sensor_msgs/PointField[] fields\nbool is_bigendian  # the data\nuint32 point_step\nuint32 row_step\nuint8[] data\n` +
    `bool is_dense\n${LINE}\nMSG: sensor_msgs/PointField\nuint8 INT8=1\nuint8 UINT8 = 2\nuint8 FLOAT32=7\nstring name\n` +
    `uint32 offset\nuint8 datatype\nuint32 count\n` + HEADER;
const IMU = `std_msgs/Header header\n\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n` +
    `geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n` +
    `geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n` +
    `${LINE}\nMSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n` +
    `${LINE}\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n` + HEADER;
const topics = [{topic: '/os/points', type: 'sensor_msgs/msg/PointCloud2', text: CLOUD},
                {topic: '/os/imu', type: 'sensor_msgs/msg/Imu', text: IMU}];
for (const t of topics) t.writer = new MessageWriter(parse(t.text, {ros2: true}));

const nanoseconds = (text) => { const [s, ns] = text.split('.'); return BigInt(s) * 1000000000n + BigInt(ns); };
const header = (t) => ({stamp: {sec: Number(t / 1000000000n), nanosec: Number(t % 1000000000n)}, frame_id: 'os_sensor'});
const field = (name, offset, datatype) => ({name, offset, datatype, count: 1});
const messages = [];
fs.readFileSync(path.join(folder, 'stamps.txt'), 'utf8').trim().split('\n').forEach((line, i) => {
  const stamp = nanoseconds(line), data = fs.readFileSync(path.join(folder, `scan${i}.bin`)), width = data.length / 18;
  messages.push({topic: 0, time: stamp + 110000000n, bytes: topics[0].writer.writeMessage({
    header: header(stamp), height: 1, width,
    fields: [field('x', 0, 7), field('y', 4, 7), field('z', 8, 7), field('t', 12, 6), field('ring', 16, 4)],
    is_bigendian: false, point_step: 18, row_step: data.length, data: new Uint8Array(data), is_dense: true})});
});
for (const line of fs.readFileSync(path.join(folder, 'imu.txt'), 'utf8').trim().split('\n')) {
  const [t, ax, ay, az, wx, wy, wz] = line.split(' '), stamp = nanoseconds(t), none = new Float64Array(9);
  messages.push({topic: 1, time: stamp, bytes: topics[1].writer.writeMessage({
    header: header(stamp), orientation: {x: 0, y: 0, z: 0, w: 1}, orientation_covariance: none,
    angular_velocity: {x: +wx, y: +wy, z: +wz}, angular_velocity_covariance: none,
    linear_acceleration: {x: +ax, y: +ay, z: +az}, linear_acceleration_covariance: none})});
}
messages.sort((a, b) => a.time < b.time ? -1 : a.time > b.time ? 1 : a.topic - b.topic);

class File {
  constructor(name) { this.fd = fs.openSync(name, 'w'); this.at = 0n; }
  async write(bytes) { fs.writeSync(this.fd, bytes); this.at += BigInt(bytes.length); }
  position() { return this.at; }
}
const compressions = {
  none: undefined,
  lz4: (bytes) => ({compression: 'lz4', compressedData: lz4.compressFrameSync(Buffer.from(bytes))}),
  zstd: (bytes) => ({compression: 'zstd', compressedData: zstd.compress(bytes)}),
};
for (const [name, compressChunk] of Object.entries(compressions)) {
  for (const [variant, options] of Object.entries({
    whole: {},
    bare: {useStatistics: false, useSummaryOffsets: false, useChunkIndex: false, useMessageIndex: false,
           repeatSchemas: false, repeatChannels: false},
    ...(name === 'none' ? {loose: {useChunks: false}} : {}),
  })) {
    const writer = new McapWriter({writable: new File(path.join(out, `${name}_${variant}.mcap`)), compressChunk,
                                   chunkSize: 200000, ...options});
    await writer.start({profile: 'ros2', library: 'interop'});
    const channels = [];
    for (const t of topics) {
      const schemaId = await writer.registerSchema(
          {name: t.type, encoding: 'ros2msg', data: new TextEncoder().encode(t.text)});
      channels.push(await writer.registerChannel({schemaId, topic: t.topic, messageEncoding: 'cdr', metadata: new Map()}));
    }
    let sequence = 0;
    for (const m of messages)
      await writer.addMessage({channelId: channels[m.topic], sequence: sequence++, logTime: m.time, publishTime: m.time,
                               data: m.bytes});
    await writer.end();
  }
}
fs.writeFileSync(path.join(out, 'messages.jsonl'), [
  JSON.stringify(topics.map(({topic, type}) => ({topic, type}))),
  ...messages.map((m) => JSON.stringify([m.topic, m.time.toString(), Buffer.from(m.bytes).toString('base64')]))].join('\n'));

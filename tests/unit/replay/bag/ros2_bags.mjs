// Messages of ROS 2, with CDR by @foxglove/rosmsg2-serialization, and bags of them by @mcap/core.
import fs from 'node:fs';
import path from 'node:path';
import {createRequire} from 'node:module';

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

// "12.5" seconds as 12500000000n.
export function nanoseconds(text) {
  const [s, ns = ''] = text.split('.');
  return BigInt(s) * 1000000000n + BigInt(ns.padEnd(9, '0'));
}

// Messages {topic, time, bytes} of scans and IMU samples. Fields are [name, offset, datatype].
export function serializers(modules) {
  const require = createRequire(path.resolve(modules) + '/');
  const {MessageWriter} = require('@foxglove/rosmsg2-serialization');
  const {parse} = require('@foxglove/rosmsg');
  const [cloudWriter, imuWriter] = topics.map((t) => new MessageWriter(parse(t.text, {ros2: true})));
  const header = (t) =>
    ({stamp: {sec: Number(t / 1000000000n), nanosec: Number(t % 1000000000n)}, frame_id: 'os_sensor'});
  return {
    cloud: (stamp, time, fields, step, data) => ({topic: 0, time, bytes: cloudWriter.writeMessage({
      header: header(stamp), height: 1, width: data.length / step,
      fields: fields.map(([name, offset, datatype]) => ({name, offset, datatype, count: 1})),
      is_bigendian: false, point_step: step, row_step: data.length, data: new Uint8Array(data), is_dense: true})}),
    imu: (stamp, [ax, ay, az], [wx, wy, wz]) => {
      const none = new Float64Array(9);
      return {topic: 1, time: stamp, bytes: imuWriter.writeMessage({
        header: header(stamp), orientation: {x: 0, y: 0, z: 0, w: 1}, orientation_covariance: none,
        angular_velocity: {x: wx, y: wy, z: wz}, angular_velocity_covariance: none,
        linear_acceleration: {x: ax, y: ay, z: az}, linear_acceleration_covariance: none})};
    },
  };
}

class File {
  constructor(name) { this.fd = fs.openSync(name, 'w'); this.at = 0n; }
  async write(bytes) { fs.writeSync(this.fd, bytes); this.at += BigInt(bytes.length); }
  position() { return this.at; }
}

// Writes OUT/NAME_VARIANT.mcap for each compression and for each variant of the writer's options, and
// OUT/messages.jsonl for write_db3.py.
export async function writeBags(messages, out, modules, variants, chunkSize) {
  const require = createRequire(path.resolve(modules) + '/');
  const {McapWriter} = require('@mcap/core');
  const lz4 = require('lz4-napi');
  const {ZstdCodec} = require('zstd-codec');
  const zstd = await new Promise((resolve) => ZstdCodec.run((z) => resolve(new z.Simple())));
  const compressions = {
    none: undefined,
    lz4: (bytes) => ({compression: 'lz4', compressedData: lz4.compressFrameSync(Buffer.from(bytes))}),
    zstd: (bytes) => ({compression: 'zstd', compressedData: zstd.compress(bytes)}),
  };
  messages.sort((a, b) => a.time < b.time ? -1 : a.time > b.time ? 1 : a.topic - b.topic);
  for (const [name, compressChunk] of Object.entries(compressions)) {
    for (const [variant, options] of Object.entries(variants)) {
      if (options.useChunks === false && name !== 'none') continue;
      const writer = new McapWriter({writable: new File(path.join(out, `${name}_${variant}.mcap`)), compressChunk,
                                     chunkSize, ...options});
      await writer.start({profile: 'ros2', library: 'interop'});
      const channels = [];
      for (const t of topics) {
        const schemaId = await writer.registerSchema(
            {name: t.type, encoding: 'ros2msg', data: new TextEncoder().encode(t.text)});
        channels.push(await writer.registerChannel(
            {schemaId, topic: t.topic, messageEncoding: 'cdr', metadata: new Map()}));
      }
      let sequence = 0;
      for (const m of messages)
        await writer.addMessage({channelId: channels[m.topic], sequence: sequence++, logTime: m.time,
                                 publishTime: m.time, data: m.bytes});
      await writer.end();
    }
  }
  const lines = fs.openSync(path.join(out, 'messages.jsonl'), 'w');
  fs.writeSync(lines, JSON.stringify(topics.map(({topic, type}) => ({topic, type}))));
  for (const m of messages)
    fs.writeSync(lines, '\n' + JSON.stringify([m.topic, m.time.toString(), Buffer.from(m.bytes).toString('base64')]));
  fs.closeSync(lines);
}

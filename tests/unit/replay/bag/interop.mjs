// Writes the walk through the room, which bag_interop wrote as files, into bags of ROS 2.
//   node interop.mjs FOLDER_OF_FILES OUT NODE_MODULES
import fs from 'node:fs';
import path from 'node:path';
import {nanoseconds, serializers, writeBags} from './ros2_bags.mjs';

const [folder, out, modules] = process.argv.slice(2);
const {cloud, imu} = serializers(modules);
const lines = (name) => fs.readFileSync(path.join(folder, name), 'utf8').trim().split('\n');
const fields = [['x', 0, 7], ['y', 4, 7], ['z', 8, 7], ['t', 12, 6], ['ring', 16, 4]];
const messages = lines('stamps.txt').map((line, i) => {
  const stamp = nanoseconds(line);
  return cloud(stamp, stamp + 110000000n, fields, 18, fs.readFileSync(path.join(folder, `scan${i}.bin`)));
});
for (const line of lines('imu.txt')) {
  const [t, ...numbers] = line.split(' '), [ax, ay, az, wx, wy, wz] = numbers.map(Number);
  messages.push(imu(nanoseconds(t), [ax, ay, az], [wx, wy, wz]));
}
await writeBags(messages, out, modules, {
  whole: {},
  bare: {useStatistics: false, useSummaryOffsets: false, useChunkIndex: false, useMessageIndex: false,
         repeatSchemas: false, repeatChannels: false},
  loose: {useChunks: false},
}, 200000);

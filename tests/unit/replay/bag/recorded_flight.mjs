// Writes what a flight with record.scans recorded into bags of ROS 2.
//   node recorded_flight.mjs RUN/scans OUT NODE_MODULES
import fs from 'node:fs';
import path from 'node:path';
import {nanoseconds, serializers, writeBags} from './ros2_bags.mjs';

const [folder, out, modules] = process.argv.slice(2);
const {cloud, imu} = serializers(modules);
const fields = [['x', 0, 7], ['y', 4, 7], ['z', 8, 7], ['intensity', 12, 7], ['t', 16, 6], ['ring', 20, 4]];
const messages = [];
for (const name of fs.readdirSync(folder).filter((n) => n.endsWith('.pcd'))) {
  const pcd = fs.readFileSync(path.join(folder, name)), data = pcd.indexOf('DATA binary\n') + 12;
  const rings = pcd.subarray(0, data).toString().includes('FIELDS x y z intensity t ring\n');
  const stamp = BigInt(name.slice(0, -4));
  messages.push(cloud(stamp, stamp + 110000000n, rings ? fields : fields.slice(0, -1), rings ? 22 : 20,
                      pcd.subarray(data)));
}
for (const line of fs.readFileSync(path.join(folder, 'imu.csv'), 'utf8').trim().split('\n').slice(1)) {
  const [t, ...numbers] = line.split(','), [ax, ay, az, wx, wy, wz] = numbers.map(Number);
  messages.push(imu(nanoseconds(t), [ax, ay, az], [wx, wy, wz]));
}
await writeBags(messages, out, modules, {whole: {}}, 1000000);

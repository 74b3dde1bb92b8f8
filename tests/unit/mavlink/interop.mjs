// Compares karst's encoding of MAVLink with that of node-mavlink, in both directions.
//   node interop.mjs MAVLINK_INTEROP NODE_MODULES
import {execFileSync} from 'node:child_process';
import {createRequire} from 'node:module';
import {Readable} from 'node:stream';

const [program, modules] = process.argv.slice(2);
const require = createRequire(modules + '/');
const {minimal, common, MavLinkPacketSplitter, MavLinkPacketParser, MavLinkProtocolV2} = require('node-mavlink');

const REGISTRY = {...minimal.REGISTRY, ...common.REGISTRY};
const byName = Object.fromEntries(Object.values(REGISTRY).map((c) => [c.MSG_NAME, c]));
let failures = 0;
function check(ok, what) {
  if (!ok) { console.log('FAILED ' + what); failures++; }
}

function plain(value) {
  if (typeof value === 'bigint') return value.toString();
  if (Array.isArray(value)) return value.map(plain);
  if (typeof value === 'string') return value.replace(/\0.*$/s, '');
  return value;
}
function same(a, b) {
  if (Array.isArray(a)) return Array.isArray(b) && a.length === b.length && a.every((v, i) => same(v, b[i]));
  if (typeof a === 'number' && typeof b === 'number') return Math.fround(a) === Math.fround(b);
  return a === b;
}
function fieldsOf(clazz, data) {
  return Object.fromEntries(clazz.FIELDS.map((f) => [f.source, plain(data[f.name])]));
}
function compare(name, mine, theirs, what) {
  for (const [field, value] of Object.entries(mine))
    check(same(value, theirs[field]), `${what} ${name}.${field}: ${JSON.stringify(value)} ${JSON.stringify(theirs[field])}`);
  for (const field of Object.keys(theirs))
    check(field in mine, `${what} ${name}.${field} is not known to karst`);
}

// From karst to node-mavlink.
const lines = execFileSync(program, ['write'], {encoding: 'utf8'}).trim().split('\n').map((line) => {
  const [name, hex, ...json] = line.split(' ');
  return {name, bytes: Buffer.from(hex, 'hex'), fields: JSON.parse(json.join(' '))};
});
const packets = [];
const reader = Readable.from(lines.map((l) => l.bytes), {objectMode: true})
  .pipe(new MavLinkPacketSplitter()).pipe(new MavLinkPacketParser());
for await (const packet of reader) packets.push(packet);
check(packets.length === lines.length, `node-mavlink found ${packets.length} of ${lines.length} frames`);
packets.forEach((packet, i) => {
  const {name, fields} = lines[i], clazz = REGISTRY[packet.header.msgid];
  check(clazz?.MSG_NAME === name, `frame ${i} is ${clazz?.MSG_NAME}, not ${name}`);
  check(packet.header.sysid === 7 && packet.header.compid === 42, `sender of ${name}`);
  if (clazz) compare(name, fields, fieldsOf(clazz, packet.protocol.data(packet.payload, clazz)), 'read by node-mavlink:');
});

// From node-mavlink to karst.
const protocol = new MavLinkProtocolV2(3, 4);
const sent = lines.map(({name, fields}, i) => {
  const clazz = byName[name], message = new clazz();
  for (const f of clazz.FIELDS) {
    const value = fields[f.source];
    message[f.name] = typeof value === 'string' && /int64/.test(f.type) ? BigInt(value) : value;
  }
  return {name, fields, bytes: protocol.serialize(message, i % 256)};
});
const answer = execFileSync(program, ['read'], {
  encoding: 'utf8', input: sent.map((s) => s.bytes.toString('hex')).join('\n') + '\n'}).trim().split('\n');
check(answer.length === sent.length, `karst found ${answer.length} of ${sent.length} frames`);
answer.forEach((line, i) => {
  const [name, ...json] = line.split(' ');
  check(name === sent[i].name, `frame ${i}: ${name}, not ${sent[i].name}`);
  compare(name, JSON.parse(json.join(' ')), sent[i].fields, 'read by karst:');
});
console.log(`${lines.length} frames of ${new Set(lines.map((l) => l.name)).size} messages each way, ${failures} failures`);
process.exit(failures === 0 ? 0 : 1);

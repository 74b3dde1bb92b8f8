"""earlier_map_turned_cave.py IN.ply OUT RUN ANGLE_DEG DX DY DZ AWAY_M [mirror | scale FACTOR]

The cave turned about z and moved, with a start that lies AWAY_M along the flight RUN, whose map is of IN. Writes
OUT.ply, OUT.info and OUT.truth (the turn in rad, and the displacement)."""
import array
import math
import os
import struct
import sys

src, out, run = sys.argv[1:4]
a, dx, dy, dz, away = map(float, sys.argv[4:9])
mirror = sys.argv[9:10] == ["mirror"]
scale = float(sys.argv[10]) if sys.argv[9:10] == ["scale"] else 1.0
a = math.radians(a)
c, s = math.cos(a), math.sin(a)
def T(p):
    x, y, z = p
    if mirror: y = -y
    x, y, z = scale * x, scale * y, scale * z
    return (c * x - s * y + dx, s * x + c * y + dy, z + dz)
data = open(src, "rb").read()
end = data.index(b"end_header\n") + 11
n = int([l for l in data[:end].split(b"\n") if l.startswith(b"element vertex")][0].split()[-1])
v = array.array("f"); v.frombytes(data[end:end + 12 * n])
for i in range(0, 3 * n, 3):
    v[i], v[i + 1], v[i + 2] = T(v[i:i + 3])
rest = data[end + 12 * n:]
if mirror:  # keep the faces' orientation
    out_rest = bytearray(rest)
    o = 0
    while o < len(rest):
        k = rest[o]
        idx = struct.unpack_from("<%di" % k, rest, o + 1)
        struct.pack_into("<%di" % k, out_rest, o + 1, *reversed(idx))
        o += 1 + 4 * k
    rest = bytes(out_rest)
open(out + ".ply", "wb").write(data[:end] + v.tobytes() + rest)
track = [tuple(map(float, l.split()[1:4])) for l in open(run + "/ground_truth.tum") if not l.startswith("#")]
first = track[0]
start = next(p for p in track if math.dist(p[:2], first[:2]) > away)
p = T(start)
name = os.path.basename(out)
heading = (37 * len(name) + int(math.degrees(a)) * 3) % 360
open(out + ".info", "w").write('mesh "%s.ply"\nstart "%.3f %.3f %.3f %d"\nreflectivity 0.5\n' % (name, *p, heading))
open(out + ".truth", "w").write("%.9f %.6f %.6f %.6f\n" % (a, dx, dy, dz))

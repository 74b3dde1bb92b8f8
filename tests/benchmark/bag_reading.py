#!/usr/bin/env python3
"""Memory and speed of reading bags: bag_reading.py KARST FOLDER [GIGABYTES]

Writes bags of an Ouster with 64 x 1024 points at 10 Hz and an IMU at 100 Hz, reads each with `karst recording info`,
and prints a table: size, time on one core, times real time, peak memory. Chunks hold one scan. `lz4` and `zstd` are the
programs of these names; a variant is left out without them.
"""
import bz2
import json
import os
import shutil
import struct
import subprocess
import sys
import zlib

import numpy as np

START_S, COLUMNS, RINGS, STEP = 1_700_000_000, 1024, 64, 48


def cloud_points(noise):
    """A tube of 3 m radius, as Ouster's driver has it: x y z intensity t reflectivity ring ambient range."""
    column, ring = np.meshgrid(np.arange(COLUMNS), np.arange(RINGS))
    azimuth, elevation = np.pi * (1 - 2 * (column + 0.5) / COLUMNS), 0.39 - 0.78 * ring / (RINGS - 1)
    distance = 3 / np.maximum(0.15, np.hypot(np.cos(elevation) * np.sin(azimuth), np.sin(elevation)))
    distance = distance + noise.normal(0, 0.01, distance.shape)
    points = np.zeros((RINGS, COLUMNS), np.dtype({
        "names": ["x", "y", "z", "intensity", "t", "reflectivity", "ring", "ambient", "range"],
        "formats": ["<f4", "<f4", "<f4", "<f4", "<u4", "<u2", "<u2", "<u2", "<u4"],
        "offsets": [0, 4, 8, 16, 20, 24, 26, 28, 32], "itemsize": STEP}))
    points["x"] = distance * np.cos(elevation) * np.cos(azimuth)
    points["y"] = distance * np.cos(elevation) * np.sin(azimuth)
    points["z"] = distance * np.sin(elevation)
    points["intensity"], points["reflectivity"] = 100 + 10 * noise.random(distance.shape), column % 200
    points["t"], points["ring"], points["range"] = column * 97656, ring, 1000 * distance
    return points.tobytes()


class Serializer:
    """ROS 1 or little-endian CDR."""

    def __init__(self, ros1):
        self.ros1, self.bytes = ros1, bytearray() if ros1 else bytearray(b"\0\1\0\0")

    def number(self, kind, *values):
        size = struct.calcsize(kind)
        for v in values:
            if not self.ros1:
                self.bytes += bytes(-(len(self.bytes) - 4) % size)
            self.bytes += struct.pack("<" + kind, v)
        return self

    def text(self, t):
        data = t.encode() + (b"" if self.ros1 else b"\0")
        self.number("I", len(data)).bytes += data
        return self

    def header(self, ns):
        if self.ros1:
            self.number("I", 0)
        return self.number("I", ns // 10**9, ns % 10**9).text("os_sensor")


FIELDS = [("x", 0, 7), ("y", 4, 7), ("z", 8, 7), ("intensity", 16, 7), ("t", 20, 6), ("reflectivity", 24, 4),
          ("ring", 26, 4), ("ambient", 28, 4), ("range", 32, 6)]


def cloud_message(ros1, ns, points):
    s = Serializer(ros1).header(ns).number("I", RINGS, COLUMNS, len(FIELDS))
    for name, offset, kind in FIELDS:
        s.text(name).number("I", offset).number("B", kind).number("I", 1)
    s.number("B", 0).number("I", STEP, STEP * COLUMNS, len(points)).bytes += points
    return bytes(s.number("B", 1).bytes)


def imu_message(ros1, ns):
    s = Serializer(ros1).header(ns)
    s.number("d", 0, 0, 0, 1, *[0] * 9, 0, 0, 0, *[0] * 9, 0, 0, 9.81, *[0] * 9)
    return bytes(s.bytes)


HEADER1 = "=" * 80 + "\nMSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
CLOUD = ("std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"
         "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n" + "=" * 80 +
         "\nMSG: sensor_msgs/PointField\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n")
IMU = ("std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
       "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
       "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n" + "=" * 80 +
       "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n" + "=" * 80 +
       "\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n")
HEADER2 = ("=" * 80 + "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" + "=" * 80 +
           "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n")
TOPICS = [("/os/points", "sensor_msgs/PointCloud2", CLOUD), ("/os/imu", "sensor_msgs/Imu", IMU)]


def compressed(name, data):
    if name in ("", "none"):
        return data
    if name == "bz2":
        return bz2.compress(data)
    return subprocess.run([name, "-1", "-c", "-q"], input=data, stdout=subprocess.PIPE, check=True).stdout


def text(t):
    return struct.pack("<I", len(t)) + t.encode()


def mcap_record(opcode, body):
    return struct.pack("<BQ", opcode, len(body)) + body


def write_mcap(path, compression, chunks):
    descriptions = b"".join(
        mcap_record(3, struct.pack("<H", i + 1) + text(kind.replace("/", "/msg/")) + text("ros2msg") + text(d + HEADER2)) +
        mcap_record(4, struct.pack("<HH", i + 1, i + 1) + text(topic) + text("cdr") + struct.pack("<I", 0))
        for i, (topic, kind, d) in enumerate(TOPICS))
    indexes = []
    with open(path, "wb") as f:
        f.write(b"\x89MCAP0\r\n" + mcap_record(1, text("ros2") + text("bag_reading")))
        for messages in chunks(False):
            records = descriptions if not indexes else b""
            for topic, ns, data in messages:
                records += mcap_record(5, struct.pack("<HIQQ", topic + 1, 0, ns, ns) + data)
            span = struct.pack("<QQ", messages[0][1], messages[-1][1])
            stored = compressed(compression, records)
            body = span + struct.pack("<QI", len(records), zlib.crc32(records)) + text(compression) + \
                struct.pack("<Q", len(stored)) + stored
            indexes.append(mcap_record(8, span + struct.pack("<QQ", f.tell(), len(body) + 9) + bytes(32)))
            f.write(mcap_record(6, body))
        f.write(mcap_record(15, bytes(4)))
        summary = f.tell()
        f.write(descriptions + b"".join(indexes) + mcap_record(2, struct.pack("<QQI", summary, 0, 0)) + b"\x89MCAP0\r\n")


def ros_header(**fields):
    return b"".join(struct.pack("<I", len(k) + 1 + len(v)) + k.encode() + b"=" + v for k, v in fields.items())


def ros_record(header, data):
    return struct.pack("<I", len(header)) + header + struct.pack("<I", len(data)) + data


def ros_time(ns):
    return struct.pack("<II", ns // 10**9, ns % 10**9)


def write_rosbag(path, compression, chunks):
    connections = [ros_record(ros_header(op=b"\7", conn=struct.pack("<I", i), topic=topic.encode()),
                              ros_header(topic=topic.encode(), type=kind.encode(), md5sum=b"*",
                                         message_definition=(d + HEADER1).encode()))
                   for i, (topic, kind, d) in enumerate(TOPICS)]

    def bag_header(index, count):
        h = ros_header(op=b"\3", index_pos=struct.pack("<Q", index), conn_count=struct.pack("<I", 2),
                       chunk_count=struct.pack("<I", count))
        return b"#ROSBAG V2.0\n" + ros_record(h, b" " * (4096 - 8 - len(h)))

    infos = []
    with open(path, "wb") as f:
        f.write(bag_header(0, 0))
        for messages in chunks(True):
            chunk, entries = b"".join(connections) if not infos else b"", {}
            for topic, ns, data in messages:
                entries.setdefault(topic, b"")
                entries[topic] += ros_time(ns) + struct.pack("<I", len(chunk))
                chunk += ros_record(ros_header(op=b"\2", conn=struct.pack("<I", topic), time=ros_time(ns)), data)
            at = f.tell()
            f.write(ros_record(ros_header(op=b"\5", compression=compression.encode(), size=struct.pack("<I", len(chunk))),
                               compressed(compression, chunk)))
            for topic, e in entries.items():
                f.write(ros_record(ros_header(op=b"\4", ver=struct.pack("<I", 1), conn=struct.pack("<I", topic),
                                              count=struct.pack("<I", len(e) // 12)), e))
            infos.append(ros_record(
                ros_header(op=b"\6", ver=struct.pack("<I", 1), chunk_pos=struct.pack("<Q", at),
                           start_time=ros_time(messages[0][1]), end_time=ros_time(messages[-1][1]),
                           count=struct.pack("<I", len(entries))),
                b"".join(struct.pack("<II", t, len(e) // 12) for t, e in entries.items())))
        index = f.tell()
        f.write(b"".join(connections + infos))
        f.seek(0)
        f.write(bag_header(index, len(infos)))


def write_db3(path, _, chunks):
    import sqlite3
    db = sqlite3.connect(path)
    db.execute("CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT, "
               "offered_qos_profiles TEXT)")
    db.execute("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB)")
    db.execute("CREATE INDEX timestamp_idx ON messages (timestamp ASC)")
    for i, (topic, kind, _) in enumerate(TOPICS):
        db.execute("INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", (i + 1, topic, kind.replace("/", "/msg/")))
    for messages in chunks(False):
        db.executemany("INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)",
                       [(t + 1, ns, data) for t, ns, data in messages])
        db.commit()
    db.close()


# A process of its own: what wait4 tells of a child begins with the size of the process that started it.
MEASURE = """import json, os, resource, subprocess, sys, time
begin = time.monotonic()
done = subprocess.run(["taskset", "-c", "0"] + sys.argv[1:], stdout=subprocess.PIPE, stderr=subprocess.PIPE)
took, usage = time.monotonic() - begin, resource.getrusage(resource.RUSAGE_CHILDREN)
print(json.dumps([done.returncode, done.stdout.decode(), took, usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024]))
"""


def read(karst, path):
    """Exit code, topics by name, wall clock in s, processor time in s and peak memory in MB of reading a bag."""
    code, out, *figures = json.loads(subprocess.run(
        [sys.executable, "-S", "-c", MEASURE, karst, "recording", "info", path, "--json"],
        stdout=subprocess.PIPE, check=True).stdout)
    return code, {t["topic"]: t for t in json.loads(out)["topics"]} if out.strip() else {}, *figures


def main():
    karst, folder, gigabytes = sys.argv[1], sys.argv[2], float(sys.argv[3]) if len(sys.argv) > 3 else 2.0
    os.makedirs(folder, exist_ok=True)
    noise = np.random.default_rng(1)
    clouds = [cloud_points(noise) for _ in range(8)]
    scans = int(gigabytes * 1e9 / len(clouds[0]))

    def chunks_of(count):
        def chunks(ros1):
            for i in range(count):
                begin = START_S * 10**9 + i * 10**8
                imu = [(1, begin + k * 10**7, imu_message(ros1, begin + k * 10**7)) for k in range(10)]
                yield imu + [(0, begin + 10**8 - 1, cloud_message(ros1, begin, clouds[i % len(clouds)]))]
        return chunks

    print("| bag | scans | size | wall clock | processor | real time / processor time | peak memory |")
    print("|---|---|---|---|---|---|---|")
    for name, write, compression, fraction in (
            ("none.mcap", write_mcap, "", 1), ("lz4.mcap", write_mcap, "lz4", 0.25), ("zstd.mcap", write_mcap, "zstd", 0.25),
            ("none.bag", write_rosbag, "none", 1), ("lz4.bag", write_rosbag, "lz4", 0.25),
            ("bz2.bag", write_rosbag, "bz2", 0.05), ("sqlite.db3", write_db3, "", 1)):
        if compression in ("lz4", "zstd") and not shutil.which(compression):
            continue
        path, count = os.path.join(folder, name), max(10, int(scans * fraction))
        if os.path.exists(path):
            os.remove(path)
        write(path, compression, chunks_of(count))
        code, topics, took, used, memory = read(karst, path)
        assert code == 0 and topics["/os/points"]["messages"] == count, (code, topics)
        print(f"| `{name}` | {count} | {os.path.getsize(path) / 1e6:.0f} MB | {took:.2f} s | {used:.2f} s | "
              f"{count / 10 / used:.1f} | {memory:.0f} MB |", flush=True)
        os.remove(path)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Memory and time of reading damaged bags: bag_damage.py KARST FOLDER [GIGABYTES]

Writes the bags of bag_reading.py, damages each in several ways, reads it with `karst recording info`, and prints a table:
scans read, exit code, time, peak memory. Fails if a reading takes more than 500 MB, is killed, reads fewer scans than are
intact and can be found, or reads fewer than there are without saying so.
"""
import os
import struct
import sys

import numpy as np

import bag_reading as bags

LIMIT_MB = 500


class Patched:
    """A file with other bytes at a place, or cut; as it was afterwards."""

    def __init__(self, path, patches=(), cut=None):
        self.path, self.patches, self.cut, self.old, self.tail = path, patches, cut, [], b""

    def __enter__(self):
        with open(self.path, "r+b") as f:
            for at, data in self.patches:
                f.seek(at)
                self.old.append((at, f.read(len(data))))
                f.seek(at)
                f.write(data)
        if self.cut is not None:
            os.rename(self.path, self.path + ".whole")
            with open(self.path + ".whole", "rb") as whole, open(self.path, "wb") as f:
                for at in range(0, self.cut, 1 << 24):
                    f.write(whole.read(min(1 << 24, self.cut - at)))

    def __exit__(self, *_):
        if self.cut is not None:
            os.rename(self.path + ".whole", self.path)
        with open(self.path, "r+b") as f:
            for at, data in self.old:
                f.seek(at)
                f.write(data)


def mcap_chunks(path):
    """Places of the chunk records, and of the chunk indexes in the summary."""
    chunks, indexes = [], []
    with open(path, "rb") as f:
        f.seek(8)
        while len(head := f.read(9)) == 9:
            opcode, length = struct.unpack("<BQ", head)
            if opcode in (6, 8):
                (chunks if opcode == 6 else indexes).append(f.tell() - 9)
            if opcode == 2:
                break
            f.seek(length, 1)
    return chunks, indexes


def rosbag_chunks(path):
    """Places of the chunk records and of their data's length, and of the chunk infos."""
    chunks, infos = [], []
    with open(path, "rb") as f:
        f.seek(13)
        while len(head := f.read(4)) == 4:
            record = f.tell() - 4
            header = f.read(struct.unpack("<I", head)[0])
            length = f.tell()
            data = struct.unpack("<I", f.read(4))[0]
            if b"op=\5" in header:
                chunks.append((record, header, length))
            if b"op=\6" in header:
                infos.append((record, header))
            f.seek(data, 1)
    return chunks, infos


def mcap_damages(path, _):
    chunks, indexes = mcap_chunks(path)
    size, middle = os.path.getsize(path), chunks[len(chunks) // 2]
    n = len(chunks)
    yield "cut in a chunk in the middle", Patched(path, cut=middle + 1_000_000), n // 2
    yield "a chunk announces 2^40 bytes decompressed", Patched(path, [(middle + 9 + 16, struct.pack("<Q", 1 << 40))]), n - 1
    yield "all chunks announce 2^40 bytes decompressed", Patched(
        path, [(c + 9 + 16, struct.pack("<Q", 1 << 40)) for c in chunks]), n
    yield "all chunks announce 10 bytes decompressed", Patched(
        path, [(c + 9 + 16, struct.pack("<Q", 10)) for c in chunks]), n
    yield "a chunk's record announces 2^60 bytes", Patched(path, [(middle + 1, struct.pack("<Q", 1 << 60))]), n - 1
    # The lie ends at a record.
    far = chunks[len(chunks) // 2 + len(chunks) // 4]
    yield "a chunk announces all up to three quarters of the file", Patched(
        path, [(middle + 1, struct.pack("<Q", far - middle - 9)),
               (middle + 9 + 28 + 4 + len(compression_of(path, middle)), struct.pack(
                   "<Q", far - middle - 9 - 40 - len(compression_of(path, middle))))]), n - 1
    lies = [(i + 9 + 16, struct.pack("<QQ", 40 + 13 * k, size // 2)) for k, i in enumerate(indexes)]
    yield "the index names places without chunks, a record is damaged", Patched(path, [(middle, b"\0")] + lies), n // 2
    same = [(i + 9 + 16, struct.pack("<QQ", chunks[-1], size)) for i in indexes]
    yield "the index names one chunk for all, a record is damaged", Patched(path, [(middle, b"\0")] + same), n // 2


def compression_of(path, chunk):
    with open(path, "rb") as f:
        f.seek(chunk + 9 + 28)
        return f.read(struct.unpack("<I", f.read(4))[0])


def rosbag_damages(path, _):
    chunks, infos = rosbag_chunks(path)
    size, n = os.path.getsize(path), len(chunks)
    record, header, length = chunks[n // 2]
    declared = record + 4 + header.index(b"size=") + 5
    yield "cut in a chunk in the middle", Patched(path, cut=length + 1_000_000), n // 2
    yield "a chunk announces 2^32 - 1 bytes decompressed", Patched(path, [(declared, b"\xff" * 4)]), n - 1
    yield "all chunks announce 2^32 - 1 bytes decompressed", Patched(
        path, [(r + 4 + h.index(b"size=") + 5, b"\xff" * 4) for r, h, _ in chunks]), n
    yield "all chunks announce 10 bytes decompressed", Patched(
        path, [(r + 4 + h.index(b"size=") + 5, struct.pack("<I", 10)) for r, h, _ in chunks]), n
    yield "a chunk's length is 2^32 - 1", Patched(path, [(length, b"\xff" * 4)]), n - 1
    far = chunks[n // 2 + n // 4][0]
    yield "a chunk's length leads to three quarters of the file", Patched(
        path, [(length, struct.pack("<I", far - length - 4))]), n - 1
    places = [(r + 4 + h.index(b"chunk_pos=") + 10, struct.pack("<Q", size // 2 + 7 * k)) for k, (r, h) in enumerate(infos)]
    yield "the index names places without chunks, a record is damaged", Patched(
        path, [(record, b"\xff" * 4)] + places), n // 2
    with open(path, "rb") as f:
        at = f.read(4096).index(b"index_pos=") + 10
    yield "the index is said to begin at 1 % of the file, a record is damaged", Patched(
        path, [(at, struct.pack("<Q", size // 100)), (record, b"\xff" * 4)]), n // 2


def db3_damages(path, n):
    size = os.path.getsize(path)
    noise = np.random.default_rng(2)
    yield "cut in the middle", Patched(path, cut=size // 2 // 4096 * 4096), n // 2 - 1
    yield "20 pages of noise", Patched(
        path, [(4096 * int(p), noise.bytes(4096)) for p in noise.integers(100, size // 4096, 20)]), n - 20
    yield "it announces 2^32 - 1 pages", Patched(path, [(28, b"\xff" * 4)]), n


def bombs(folder, chunks):
    """A chunk of two gigabytes of zeros, which bz2 and lz4 make small, between two others."""
    for name, write, compression in (("bomb.mcap", bags.write_mcap, "zstd"), ("bomb_lz4.mcap", bags.write_mcap, "lz4"),
                                     ("bomb.bag", bags.write_rosbag, "bz2")):
        def with_bomb(ros1):
            for i, messages in enumerate(chunks(3)(ros1)):
                yield messages if i != 1 else messages + [(1, messages[-1][1], bytes(2_000_000_000))]
        path = os.path.join(folder, name)
        write(path, compression, with_bomb)
        yield path


def main():
    karst, folder, gigabytes = sys.argv[1], sys.argv[2], float(sys.argv[3]) if len(sys.argv) > 3 else 2.0
    os.makedirs(folder, exist_ok=True)
    noise = np.random.default_rng(1)
    clouds = [bags.cloud_points(noise) for _ in range(8)]
    count = int(gigabytes * 1e9 / len(clouds[0]))

    def chunks_of(n):
        def chunks(ros1):
            for i in range(n):
                begin = bags.START_S * 10**9 + i * 10**8
                imu = [(1, begin + k * 10**7, bags.imu_message(ros1, begin + k * 10**7)) for k in range(10)]
                yield imu + [(0, begin + 10**8 - 1, bags.cloud_message(ros1, begin, clouds[i % len(clouds)]))]
        return chunks

    failures = []
    print("| bag | size | damage | scans read | exit code | wall clock | processor | peak memory |")
    print("|---|---|---|---|---|---|---|---|")

    def row(path, damage, least, of):
        code, topics, took, used, memory = bags.read(karst, path)
        scans = topics.get("/os/points", {"messages": 0})["messages"]
        print(f"| `{os.path.basename(path)}` | {os.path.getsize(path) / 1e6:.0f} MB | {damage} | {scans} of {of} | {code} | "
              f"{took:.1f} s | {used:.1f} s | {memory:.0f} MB |", flush=True)
        if memory > LIMIT_MB or code < 0 or scans < least or (code == 0 and scans < of):
            failures.append(f"{path}: {damage}")

    for name, write, compression, damages, n in (
            ("none.mcap", bags.write_mcap, "", mcap_damages, count),
            ("zstd.mcap", bags.write_mcap, "zstd", mcap_damages, count // 4),
            ("none.bag", bags.write_rosbag, "none", rosbag_damages, count),
            ("lz4.bag", bags.write_rosbag, "lz4", rosbag_damages, count // 4),
            ("sqlite.db3", bags.write_db3, "", db3_damages, count)):
        path = os.path.join(folder, name)
        if os.path.exists(path):
            os.remove(path)
        write(path, compression, chunks_of(n))
        for damage, patched, least in damages(path, n):
            with patched:
                row(path, damage, least, n)
        os.remove(path)
    for path in bombs(folder, chunks_of):
        row(path, "a chunk that decompresses to 2 GB", 2, 3)
        os.remove(path)
    for f in failures:
        print("FAILED " + f)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

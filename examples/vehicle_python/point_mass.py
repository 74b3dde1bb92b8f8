#!/usr/bin/env python3
"""A vehicle for karst in one file, without a dependency: a point mass in a room, with a LiDAR.

    python3 point_mass.py tcp:127.0.0.1:14660
    karst fly --set vehicle=socket --set socket.address=tcp:14660 --set localization.source=pose_sensor --time 60s
    karst vehicle check tcp:127.0.0.1:14660 --fly

It flies in lockstep and in real time. The protocol is that of docs/vehicle_protocol.md, version 1. Replace the class
PointMass to put a vehicle of your own behind it.
"""
import math
import select
import socket
import struct
import sys
import time
from array import array

MAGIC, VERSION = 0x4556524B, 1
HELLO, START, RUN, RESUME, COMMAND, PING, BYE = range(1, 8)
WELCOME, REFUSE, CHECKS, SCHEDULE, PAUSE, DONE, PONG = range(32, 39)
IMU, MAGNETOMETER, BAROMETER, POSE, BATTERY, LIDAR = range(48, 54)
GROUND, LIFT_OFF, AUTHORITY, LOST = range(57, 61)
LOCKSTEP, REAL_TIME = 0, 1
MAX_WAITING = 1 << 16  # bytes for a client that reads too slowly
MS, S = 1_000_000, 1_000_000_000


# -- encoding ---------------------------------------------------------------------------------------------------------

def message(kind, body=b""):
    return struct.pack("<IHH", len(body), kind, 0) + body


def text(value):
    raw = value.encode()[:4096]
    return struct.pack("<H", len(raw)) + raw


def pose(position, orientation_xyzw):
    return struct.pack("<7d", *position, *orientation_xyzw)


def floats(values):
    return struct.pack("<I", len(values)) + values.tobytes()


class Command:
    """What of a command this vehicle uses: attitude rates and thrust."""

    def __init__(self, body=None):
        self.rate, self.thrust_n, self.armed = (0.0, 0.0, 0.0), 0.0, False
        if body is not None:
            x, y, z, self.thrust_n, armed = struct.unpack_from("<4dB", body)
            self.rate, self.armed = (x, y, z), armed == 1


# -- the vehicle ------------------------------------------------------------------------------------------------------

GRAVITY = 9.81
MASS_KG, MAX_THRUST_N, RADIUS_M = 1.5, 30.0, 0.3
DRAG_PER_S = 0.2                             # of the velocity
ROOM_MIN, ROOM_MAX = (-4.0, -3.0, 0.0), (8.0, 5.0, 4.0)
COLUMNS, CHANNELS = 180, 16
ELEVATIONS = [math.radians(30 - 4 * i) for i in range(CHANNELS)]
LIDAR_PERIOD, LIDAR_MIN_M, LIDAR_MAX_M = 100 * MS, 0.3, 30.0
STEP, COMMAND_TIMEOUT = 5 * MS, 500 * MS
STANDING_M = 0.1                             # of the body's centre above the floor
BATTERY_WH, HOVER_W = 40.0, 150.0


def rotate(q, v):
    """q as (x, y, z, w), body to world."""
    x, y, z, w = q
    tx, ty, tz = 2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])
    return (v[0] + w * tx + y * tz - z * ty, v[1] + w * ty + z * tx - x * tz, v[2] + w * tz + x * ty - y * tx)


def conjugate(q):
    return (-q[0], -q[1], -q[2], q[3])


def turned(q, rate, dt):
    """The orientation after turning by a rate in the body frame."""
    angle = math.sqrt(sum(r * r for r in rate)) * dt
    if angle < 1e-12:
        return q
    s = math.sin(angle / 2) * dt / angle
    ax, ay, az, aw = rate[0] * s, rate[1] * s, rate[2] * s, math.cos(angle / 2)
    x, y, z, w = q
    r = (w * ax + x * aw + y * az - z * ay, w * ay - x * az + y * aw + z * ax,
         w * az + x * ay - y * ax + z * aw, w * aw - x * ax - y * ay - z * az)
    n = math.sqrt(sum(c * c for c in r))
    return tuple(c / n for c in r)


BEAMS = [(math.cos(e) * math.cos(a), math.cos(e) * math.sin(a), math.sin(e))
         for e in ELEVATIONS
         for a in (math.pi * (1 - 2 * (j + 0.5) / COLUMNS) for j in range(COLUMNS))]


class PointMass:
    """Follows attitude rates and thrust at once. Times are nanoseconds since its start."""

    def __init__(self):
        self.p, self.v, self.q = [0.0, 0.0, STANDING_M], [0.0, 0.0, 0.0], (0.0, 0.0, 0.0, 1.0)
        self.force, self.rate = (0.0, 0.0, GRAVITY), (0.0, 0.0, 0.0)  # as the IMU measures them
        self.standing, self.lost, self.command, self.commanded_at = True, False, Command(), 0
        self.energy_wh = BATTERY_WH

    def description(self):
        lidar = text("room scanner") + struct.pack("<I", COLUMNS)
        lidar += floats(array("f", ELEVATIONS)) + struct.pack("<ffq", LIDAR_MIN_M, LIDAR_MAX_M, LIDAR_PERIOD)
        lidar += pose((0, 0, 0), (0, 0, 0, 1)) + struct.pack("<If", 0, 0.0)  # no offsets of azimuth or origin
        return (text("point mass") + struct.pack("<4d", RADIUS_M, MASS_KG, MAX_THRUST_N, 6.0)
                + b"\x01" + lidar + struct.pack("<I", 0)   # a LiDAR, no depth cameras
                + b"\x00" + b"\x01" + b"\x00" + b"\x00"    # no colour camera, a pose sensor, no detector, core steers
                + pose((0, 0, STANDING_M), (0, 0, 0, 1)))

    def obey(self, command, now):
        self.command, self.commanded_at = command, now

    def come_down(self):
        """Without commands: level, and down at 0.5 m/s."""
        c = Command()
        if self.standing:
            return c
        up = rotate(conjugate(self.q), (0, 0, 1))          # the world's up axis, seen from the body
        c.rate = (-4 * up[1], 4 * up[0], 0.0)              # turns the body's up axis towards it
        c.thrust_n = max(0.0, MASS_KG * (GRAVITY + 2 * (-0.5 - self.v[2])))
        c.armed = True
        return c

    def begin(self):
        return message(GROUND, struct.pack("<q", 0)) + self.battery(0)

    def step(self, now):
        """Advances to `now`, by STEP; returns the messages of this step."""
        dt, out = STEP / S, b""
        if self.lost:
            return out
        c = self.command if now - self.commanded_at <= COMMAND_TIMEOUT else self.come_down()
        thrust = min(max(c.thrust_n, 0.0), MAX_THRUST_N) / MASS_KG if c.armed else 0.0
        before = list(self.v)
        if self.standing and thrust <= GRAVITY:
            self.v, self.rate = [0.0, 0.0, 0.0], (0.0, 0.0, 0.0)
        else:
            if self.standing:
                self.standing = False
                out += message(LIFT_OFF, struct.pack("<q", now))
            self.rate = tuple(min(max(r, -6.0), 6.0) for r in c.rate)
            self.q = turned(self.q, self.rate, dt)
            up = rotate(self.q, (0, 0, thrust))
            a = [up[i] - DRAG_PER_S * self.v[i] - (GRAVITY if i == 2 else 0) for i in range(3)]
            self.p = [self.p[i] + self.v[i] * dt + a[i] * dt * dt / 2 for i in range(3)]
            self.v = [self.v[i] + a[i] * dt for i in range(3)]
            out += self.touch(now)
        a = [(self.v[i] - before[i]) / dt + (GRAVITY if i == 2 else 0) for i in range(3)]
        self.force = rotate(conjugate(self.q), a)
        self.energy_wh = max(0.0, self.energy_wh - (5.0 if self.standing else HOVER_W) * dt / 3600)
        return out + self.measure(now)

    def touch(self, now):
        """Floor and walls."""
        if self.p[2] <= STANDING_M and self.v[2] < 0:
            if self.v[2] < -1.5:
                return self.lose(now, "fell to the floor")
            self.p[2], self.v, self.standing = STANDING_M, [0.0, 0.0, 0.0], True
            self.q = (0.0, 0.0, *self.heading())
            return message(GROUND, struct.pack("<q", now))
        for i in range(3):
            low = STANDING_M if i == 2 else RADIUS_M
            if self.p[i] < ROOM_MIN[i] + low - 1e-9 or self.p[i] > ROOM_MAX[i] - RADIUS_M:
                return self.lose(now, "touched a wall")
        return b""

    def heading(self):
        """The rotation about the upright axis alone, as (z, w)."""
        n = math.hypot(self.q[2], self.q[3])
        return (self.q[2] / n, self.q[3] / n)

    def lose(self, now, reason):
        self.lost = True
        return message(LOST, struct.pack("<qB", now, 1) + text(reason))  # 1: contact

    def battery(self, now):
        power = 5.0 if self.standing else HOVER_W
        return message(BATTERY, struct.pack("<q4d", now, self.energy_wh, self.energy_wh / BATTERY_WH, power,
                                            3600 * self.energy_wh / HOVER_W))

    def measure(self, now):
        out = message(IMU, struct.pack("<q6d", now, *self.force, *self.rate))
        if now % (20 * MS) == 0:
            field = rotate(conjugate(self.q), (0.0, 20.0, -43.0))
            out += message(MAGNETOMETER, struct.pack("<q3d", now, *field))
            out += message(POSE, struct.pack("<q", now) + pose(self.p, self.q))
        if now % (40 * MS) == 0:
            out += message(BAROMETER, struct.pack("<qd", now, self.p[2] - STANDING_M))
        if now % (500 * MS) == 0:
            out += self.battery(now)
        if now % LIDAR_PERIOD == 0:
            out += self.scan(now)
        return out

    def scan(self, now):
        """All beams at once: a point mass is slow."""
        p, q = self.p, self.q
        x, y, z = rotate(q, (1, 0, 0)), rotate(q, (0, 1, 0)), rotate(q, (0, 0, 1))
        ranges = array("f", bytes(4 * len(BEAMS)))
        for n, (bx, by, bz) in enumerate(BEAMS):
            nearest = math.inf
            for i in range(3):
                d = bx * x[i] + by * y[i] + bz * z[i]
                if abs(d) > 1e-9:
                    nearest = min(nearest, ((ROOM_MAX[i] if d > 0 else ROOM_MIN[i]) - p[i]) / d)
            if nearest < LIDAR_MIN_M:
                ranges[n] = math.nan                          # no valid measurement
            else:
                ranges[n] = nearest if nearest <= LIDAR_MAX_M else math.inf
        return message(LIDAR, struct.pack("<q", now) + floats(ranges) + floats(array("f", [0.5]) * len(BEAMS))
                       + struct.pack("<II", 0, 0))          # fired evenly; directions as described


# -- the connection ---------------------------------------------------------------------------------------------------

class Gone(Exception):
    """The client is gone, or does not keep the protocol."""


def changes_of(data):
    """Of whole messages, those that tell a change of the vehicle's state."""
    while data:
        size, kind, _ = struct.unpack_from("<IHH", data)
        if kind >= GROUND or kind == DONE:
            yield data[:8 + size]
        data = data[8 + size:]


class Client:
    def __init__(self, connection):
        self.socket, self.bytes, self.unsent = connection, bytearray(), bytearray()
        self.flying = False  # it has started the vehicle

    def messages(self, wait_s):
        """What has come, after waiting for at most `wait_s` (None: for ever)."""
        if select.select([self.socket], [], [], wait_s)[0]:
            more = self.socket.recv(1 << 16)
            if not more:
                raise Gone("the client closed the connection")
            self.bytes += more
        while len(self.bytes) >= 8:
            size, kind, zero = struct.unpack_from("<IHH", self.bytes)
            if size > 65536 or zero != 0:
                raise Gone("what the client sends is no message")
            if len(self.bytes) < 8 + size:
                break
            body = bytes(self.bytes[8:8 + size])
            del self.bytes[:8 + size]
            yield kind, body

    def send(self, data):
        """Waits for the client: for what is no step of a vehicle that flies by itself."""
        self.socket.settimeout(60)
        self.socket.sendall(data)

    def offer(self, data):
        """Never waits. A client that is behind loses measurements and pongs, but no change of state."""
        if len(self.unsent) > MAX_WAITING:
            data = b"".join(changes_of(data))
        self.unsent += data
        self.socket.setblocking(False)
        try:
            while self.unsent:
                del self.unsent[:self.socket.send(self.unsent)]
        except BlockingIOError:
            pass


class Server:
    """Serves one client after another; a second one is refused meanwhile."""

    clocks = (1, 1)  # flies in lockstep, and in real time

    def __init__(self, address, make_vehicle):
        self.make_vehicle = make_vehicle
        if address.startswith("unix:"):
            self.socket = socket.socket(socket.AF_UNIX)
            self.socket.bind(address[5:])
        else:
            host, _, port = address[len("tcp:"):].rpartition(":")
            self.socket = socket.socket()
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            self.socket.bind((host or "127.0.0.1", int(port)))
        self.socket.listen(8)

    def run(self):
        while True:
            connection, _ = self.socket.accept()
            if connection.family == socket.AF_INET:
                connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            client = Client(connection)
            try:
                self.serve(client)
            except (Gone, OSError, struct.error) as why:
                print("client gone:", why, flush=True)
                try:
                    client.offer(message(BYE if client.flying else REFUSE, text(str(why))))
                except OSError:
                    pass
            connection.close()

    def refuse_others(self):
        while select.select([self.socket], [], [], 0)[0]:
            other, _ = self.socket.accept()
            try:
                Client(other).offer(message(REFUSE, text("another client flies this vehicle")))
            except OSError:
                pass
            other.close()

    def next_messages(self, client, wait_s=0.1):
        self.refuse_others()
        yield from client.messages(wait_s)

    def serve(self, client):
        vehicle, clock = self.make_vehicle(), None
        while True:
            for kind, body in self.next_messages(client):
                if clock is None:
                    if kind != HELLO or len(body) < 6 or struct.unpack_from("<I", body)[0] != MAGIC:
                        raise Gone("expected a greeting")
                    if struct.unpack_from("<H", body, 4)[0] != VERSION:
                        raise Gone("this vehicle speaks version 1 of the protocol")
                    clock = body[6]
                    client.send(message(WELCOME, struct.pack("<IHBB", MAGIC, VERSION, *self.clocks) + vehicle.description()))
                elif kind == START:
                    client.flying = True
                    return self.lockstep(client, vehicle) if clock == LOCKSTEP else self.real_time(client, vehicle)
                elif kind == PING:
                    client.send(message(PONG, body + struct.pack("<qq", 0, 0)))
                elif kind == BYE:
                    return None
                else:
                    raise Gone("a message that has no place here")

    def lockstep(self, client, vehicle):
        """Slot 0 is the beginning, slot 1 each step. The client says when."""
        client.send(message(SCHEDULE, struct.pack("<Iqq", 0, 0, 0)) +
                    message(SCHEDULE, struct.pack("<Iqq", 1, STEP, STEP)) + message(DONE, struct.pack("<q", 0)))
        now = 0
        while True:
            for kind, body in self.next_messages(client):
                if kind == COMMAND:
                    vehicle.obey(Command(body), now)
                elif kind == RUN:
                    slot, now = struct.unpack("<Iq", body)
                    out = vehicle.begin() if slot == 0 else vehicle.step(now)
                    client.send(out + message(DONE, struct.pack("<q", now)))
                elif kind == PING:
                    client.send(message(PONG, body + struct.pack("<qq", now, now)))
                elif kind == BYE:
                    return
                else:
                    raise Gone("a message that has no place here")

    def real_time(self, client, vehicle):
        """Steps by this machine's clock. A client that is gone leaves a vehicle that comes down by itself."""
        begin, now, heard, leaving = time.monotonic_ns(), 0, 0, ""
        client.offer(message(DONE, struct.pack("<q", 0)) + vehicle.begin())
        while not (leaving and (vehicle.standing or vehicle.lost)):
            while now + STEP <= time.monotonic_ns() - begin:
                now += STEP
                out = vehicle.step(now)
                if not leaving:
                    try:
                        client.offer(out)
                    except OSError as why:
                        leaving = str(why)
            wait_s = max(0.0, (now + STEP - (time.monotonic_ns() - begin)) / S)
            if leaving:
                self.refuse_others()
                time.sleep(wait_s)
                continue
            try:
                for kind, body in self.next_messages(client, wait_s):
                    heard = now
                    if kind == COMMAND:
                        vehicle.obey(Command(body), now)
                    elif kind == PING:
                        received = time.monotonic_ns() - begin
                        client.offer(message(PONG, body + struct.pack("<qq", received, time.monotonic_ns() - begin)))
                    else:
                        leaving = "the client left" if kind == BYE else "a message that has no place here"
                        break
            except (Gone, OSError, struct.error) as why:
                leaving = str(why)
            if not leaving and now - heard > 10 * S:
                leaving = "the client is silent"
        raise Gone(leaving)


if __name__ == "__main__":
    if len(sys.argv) != 2 or not sys.argv[1].startswith(("tcp:", "unix:")):
        sys.exit("usage: point_mass.py tcp:HOST:PORT | unix:PATH")
    server = Server(sys.argv[1], PointMass)
    print("listening at", sys.argv[1], flush=True)
    try:
        server.run()
    except KeyboardInterrupt:
        pass

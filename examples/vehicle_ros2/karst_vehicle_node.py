#!/usr/bin/env python3
"""A node for ROS 2 that puts a vehicle of ROS behind the vehicle protocol of karst (docs/vehicle_protocol.md).

NOT BUILT AND NOT RUN in karst's own tests, which have no ROS: read it, adapt it to your vehicle, and check it with
`karst vehicle check tcp:127.0.0.1:14660`. It needs rclpy, sensor_msgs, geometry_msgs, std_msgs and
mavros_msgs (for the attitude target), and point_mass.py of examples/vehicle_python beside it, whose encoding it uses.

    python3 karst_vehicle_node.py --ros-args -p address:=tcp:127.0.0.1:14660
    karst fly --real-time --set vehicle=socket --set socket.address=tcp:14660

It flies in real time only. Topics that it reads:

    ~/imu        sensor_msgs/Imu            body frame x forward, y left, z up (REP 103); specific force, rate
    ~/magnetic   sensor_msgs/MagneticField  tesla
    ~/scan       sensor_msgs/PointCloud2    organized: height = channels (highest first), width = columns, x y z float32,
                                            column 0 backwards, clockwise seen from above; stamp: end of the sweep
    ~/battery    sensor_msgs/BatteryState
    ~/on_ground  std_msgs/Bool
    ~/offboard   std_msgs/Bool              true while the autopilot takes our commands

and one that it writes: ~/attitude_target, mavros_msgs/AttitudeTarget, with thrust as a fraction of `max_thrust_n`.
"""
import math
import struct
import threading
import time
from array import array

import rclpy
from mavros_msgs.msg import AttitudeTarget
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState, Imu, MagneticField, PointCloud2
from std_msgs.msg import Bool

import point_mass as karst


MAX_WAITING = 1000  # messages of a moment: more are not taken while nobody fetches them


class RosVehicle(Node):
    """Keeps what the topics say since the last look, as messages of the protocol."""

    def __init__(self):
        super().__init__("karst_vehicle")
        get = lambda name, default: self.declare_parameter(name, default).value
        self.address = get("address", "tcp:127.0.0.1:14660")
        self.mass_kg, self.radius_m = get("mass_kg", 2.0), get("radius_m", 0.35)
        self.max_thrust_n, self.max_rate = get("max_thrust_n", 45.0), get("max_body_rate_radps", 6.0)
        self.columns = get("columns", 1024)
        self.elevation_deg = get("elevation_deg", [45.0 - 90.0 * i / 127 for i in range(128)])
        self.lidar_period_ns = get("lidar_period_ns", 100 * karst.MS)
        self.min_range_m, self.max_range_m = get("min_range_m", 0.3), get("max_range_m", 50.0)
        self.lidar_offset_m = get("lidar_offset_m", [0.0, 0.0, 0.1])
        self.lock, self.waiting, self.begun = threading.Lock(), [], None
        self.ground, self.offboard = True, False
        self.target = self.create_publisher(AttitudeTarget, "~/attitude_target", 10)
        listen = lambda kind, topic, call: self.create_subscription(kind, topic, call, qos_profile_sensor_data)
        listen(Imu, "~/imu", self.on_imu)
        listen(MagneticField, "~/magnetic", self.on_magnetic)
        listen(PointCloud2, "~/scan", self.on_scan)
        listen(BatteryState, "~/battery", self.on_battery)
        listen(Bool, "~/on_ground", self.on_ground)
        listen(Bool, "~/offboard", self.on_offboard)

    # Time of the mission: nanoseconds since the core's start, by the clock of ROS.
    def now(self):
        return self.get_clock().now().nanoseconds - (self.begun or 0)

    def stamp(self, header):
        return header.stamp.sec * karst.S + header.stamp.nanosec - (self.begun or 0)

    def tell(self, kind, body):
        with self.lock:
            if self.begun is not None and (len(self.waiting) < MAX_WAITING or kind >= karst.GROUND):
                self.waiting.append(karst.message(kind, body))

    def take(self):
        with self.lock:
            out, self.waiting = b"".join(self.waiting), []
        return out

    def on_imu(self, m):
        a, w = m.linear_acceleration, m.angular_velocity
        self.tell(karst.IMU, struct.pack("<q6d", self.stamp(m.header), a.x, a.y, a.z, w.x, w.y, w.z))

    def on_magnetic(self, m):
        b = m.magnetic_field
        self.tell(karst.MAGNETOMETER, struct.pack("<q3d", self.stamp(m.header), 1e6 * b.x, 1e6 * b.y, 1e6 * b.z))

    def on_scan(self, m):
        if m.height != len(self.elevation_deg) or m.width != self.columns:
            self.get_logger().error("the scan has another size than the parameters say", once=True)
            return
        ranges, intensity = array("f"), array("f", [0.5]) * (m.width * m.height)
        for row in range(m.height):
            for column in range(m.width):
                x, y, z = struct.unpack_from("<fff", m.data, row * m.row_step + column * m.point_step)
                r = math.sqrt(x * x + y * y + z * z)
                if not r >= self.min_range_m:
                    r = math.nan  # zero, NaN, too near: infinity would claim that all is free up to max_range_m
                ranges.append(r)
        self.tell(karst.LIDAR, struct.pack("<q", self.stamp(m.header)) + karst.floats(ranges) + karst.floats(intensity)
                  + struct.pack("<II", 0, 0))

    def on_battery(self, m):
        power_w = max(1.0, -m.voltage * m.current)
        left_wh = max(0.0, m.charge) * m.voltage
        self.tell(karst.BATTERY, struct.pack("<q4d", self.stamp(m.header), left_wh, min(max(m.percentage, 0.0), 1.0),
                                             power_w, 3600 * left_wh / power_w))

    def on_ground(self, m):
        if m.data != self.ground:
            self.ground = m.data
            self.tell(karst.GROUND if m.data else karst.LIFT_OFF, struct.pack("<q", self.now()))

    def on_offboard(self, m):
        if m.data != self.offboard:
            self.offboard = m.data
            self.tell(karst.AUTHORITY, struct.pack("<qB", self.now(), 0 if m.data else 1)
                      + karst.text("the autopilot takes our commands" if m.data else "the pilot steers"))

    # What point_mass.Server asks of a vehicle.
    def description(self):
        lidar = karst.text("ros scan") + struct.pack("<I", self.columns)
        lidar += karst.floats(array("f", [math.radians(e) for e in self.elevation_deg]))
        lidar += struct.pack("<ffq", self.min_range_m, self.max_range_m, self.lidar_period_ns)
        lidar += karst.pose(self.lidar_offset_m, (0, 0, 0, 1)) + struct.pack("<If", 0, 0.0)
        return (karst.text("ros vehicle")
                + struct.pack("<4d", self.radius_m, self.mass_kg, self.max_thrust_n, self.max_rate)
                + b"\x01" + lidar + struct.pack("<I", 0) + b"\x00\x00\x00"
                + (b"\x00" if self.offboard else b"\x01")     # steered by the core, or by the pilot
                + karst.pose((0, 0, 0), (0, 0, 0, 1)))

    def obey(self, command):
        """The autopilot arms, and comes down by itself when these stop: set its offboard timeout to 0.5 s."""
        t = AttitudeTarget()
        t.header.stamp = self.get_clock().now().to_msg()
        t.type_mask = AttitudeTarget.IGNORE_ATTITUDE
        t.body_rate.x, t.body_rate.y, t.body_rate.z = command.rate
        t.thrust = command.thrust_n / self.max_thrust_n if command.armed else 0.0
        self.target.publish(t)


class RealTimeServer(karst.Server):
    """Serves a vehicle whose messages come by themselves, in real time only."""

    clocks = (0, 1)

    def real_time(self, client, vehicle):
        with vehicle.lock:
            vehicle.begun, vehicle.waiting = vehicle.get_clock().now().nanoseconds, []
        client.offer(karst.message(karst.DONE, struct.pack("<q", 0)))
        client.offer(karst.message(karst.GROUND if vehicle.ground else karst.LIFT_OFF, struct.pack("<q", 0)))
        heard = time.monotonic()
        try:
            while time.monotonic() - heard < 10:
                client.offer(vehicle.take())
                for kind, body in self.next_messages(client, 0.002):
                    heard = time.monotonic()
                    if kind == karst.COMMAND:
                        vehicle.obey(karst.Command(body))
                    elif kind == karst.PING:
                        received = vehicle.now()
                        client.offer(karst.message(karst.PONG, body + struct.pack("<qq", received, vehicle.now())))
                    else:
                        return
        finally:
            vehicle.begun = None


def main():
    rclpy.init()
    vehicle = RosVehicle()
    threading.Thread(target=rclpy.spin, args=(vehicle,), daemon=True).start()
    RealTimeServer(vehicle.address, lambda: vehicle).run()


if __name__ == "__main__":
    main()

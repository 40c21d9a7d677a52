# SPDX-License-Identifier: GPL-3.0-or-later
"""ros_planner.py ROSBRIDGE ROBOT X,Y: the same over topics of ROS 2: straight to the goal, and it stands while the laser
sees something within 0.7 m ahead. The topics are /tf, /tf_static, /eye/scan and /ROBOT/cmd_vel, through rosbridge; a node
of ROS 2 uses them as they are (simrun --ros2).

    python3 share/benchmarks/social/run.py --only crossing --baselines none --clock real:4 \\
        --planner 'ros=python3 share/benchmarks/social/ros_planner.py {ros} {robot} {goal}'
"""

import base64
import json
import math
import os
import socket
import struct
import sys


class Bridge:
    """JSON in frames of a web socket."""

    def __init__(self, address):
        host, port = address.rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)), 10)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET / HTTP/1.1\r\nHost: {address}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode())
        self.file = self.socket.makefile("rb")
        if b"101" not in self.file.readline():
            raise SystemExit(f"{address} is no rosbridge")
        while self.file.readline().strip():
            pass

    def send(self, message):
        data, mask = json.dumps(message).encode(), os.urandom(4)
        head = struct.pack("!BBH", 0x81, 0xFE, len(data)) if len(data) > 125 else struct.pack("!BB", 0x81, 0x80 | len(data))
        self.socket.sendall(head + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)))

    def receive(self):
        """The next message; an EOFError at the end of the run."""
        head = self.file.read(2)
        if len(head) < 2 or head[0] & 0x0F == 8:
            raise EOFError
        size = head[1] & 0x7F
        if size > 125:
            (size,) = struct.unpack("!H" if size == 126 else "!Q", self.file.read(2 if size == 126 else 8))
        data = self.file.read(size)
        return json.loads(data) if head[0] & 0x0F == 1 else {}


def pose_of(transform):
    """x, y and heading of a transform on the floor."""
    place, turn = transform["translation"], transform["rotation"]
    return place["x"], place["y"], 2 * math.atan2(turn["z"], turn["w"])


def joined(a, b):
    """The pose b, given in the frame of the pose a."""
    c, s = math.cos(a[2]), math.sin(a[2])
    return a[0] + c * b[0] - s * b[1], a[1] + s * b[0] + c * b[1], a[2] + b[2]


def main(address, robot, goal_text):
    goal = tuple(map(float, goal_text.split(",")))
    bridge = Bridge(address)
    bridge.send({"op": "advertise", "topic": f"/{robot}/cmd_vel", "type": "geometry_msgs/Twist"})
    for topic in ("/tf", "/tf_static", "/eye/scan"):
        bridge.send({"op": "subscribe", "topic": topic})
    frames = {}
    try:
        while True:
            message = bridge.receive()
            if message.get("op") != "publish":
                continue
            content = message["msg"]
            for one in content.get("transforms", []):
                frames[one["child_frame_id"]] = pose_of(one["transform"])
            if message["topic"] != "/eye/scan" or robot not in frames or f"{robot}_odom" not in frames:
                continue
            x, y, heading = joined(frames[f"{robot}_odom"], frames[robot])
            left = math.dist((x, y), goal)
            off = math.remainder(math.atan2(goal[1] - y, goal[0] - x) - heading, 2 * math.pi)
            waits = any(
                reach is not None and reach < 0.7 and abs(content["angle_min"] + k * content["angle_increment"]) < 0.6
                for k, reach in enumerate(content["ranges"]))
            speed = 0.0 if left < 0.3 or waits or abs(off) > 0.5 else min(1.0, left)
            turn = 0.0 if left < 0.3 else max(-1.5, min(1.5, 3 * off))
            bridge.send({"op": "publish", "topic": f"/{robot}/cmd_vel", "msg": {
                "linear": {"x": speed, "y": 0, "z": 0}, "angular": {"x": 0, "y": 0, "z": turn}}})
            if left < 0.3:
                return 0
    except (EOFError, OSError):
        return 3  # the run has ended


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))

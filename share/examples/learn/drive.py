# SPDX-License-Identifier: GPL-3.0-or-later
"""Drives a robot of a running simrun to a point by a policy of ppo.py, over TCP or over topics of ROS.

    simrun room.env robot.3dm --clock step --listen 127.0.0.1:7001 &
    python3 drive.py policy.npz tcp 127.0.0.1:7001 r1 l1 3.5,-1

    simrun room.env robot.3dm --rosbridge 9090 &
    python3 drive.py policy.npz ros 127.0.0.1:9090 r1 l1 3.5,-1

Over ROS the goal is in the frame of the robot's odometry: metres ahead and to the left of its start. The laser is to be
that of the training: 181 beams over 180 degrees, 6 m. Needs numpy alone.
"""

import base64
import json
import math
import os
import socket
import struct
import sys
import time

import numpy as np
from policy import Policy

import ispace

INTERVAL = 0.1  # seconds of a step of the training
SPEED, TURN = 1.0, 120.0  # of an action of 1: m/s, degrees a second
RANGE = 6.0
REACHED = 0.3  # metres


def observation(ranges, pose, goal, speed, turn):
    """What ispace.VectorEnv observes. pose: x, y, heading (rad); speed m/s, turn rad/s."""
    x, y, heading = pose
    seen = np.minimum(np.nan_to_num(np.array(ranges, np.float32), nan=RANGE, posinf=RANGE), RANGE)
    bearing = math.remainder(math.atan2(goal[1] - y, goal[0] - x) - heading, 2 * math.pi)
    tail = [math.dist((x, y), goal), bearing, speed, turn]
    return np.concatenate([seen, np.array(tail, np.float32)])[None]


class Tcp:
    """The robot by the protocol of simrun; the program leads the clock."""

    def __init__(self, address, robot, laser):
        self.world, self.robot = ispace.World(address), ispace.Robot(address, robot)
        self.laser = ispace.LaserSensor(address, laser)
        self.steps = round(INTERVAL / self.world.dt)

    def observe(self, goal):
        status = self.robot.status()
        pose = status.pose.x, status.pose.y, math.radians(status.pose.heading)
        self.stalled = status.stall
        return observation(self.laser.scan().ranges, pose, goal, status.speed, math.radians(status.rotspeed))

    def act(self, speed, turn):
        self.robot.speed(speed)
        self.robot.rotspeed(turn)
        if self.world.clock == "step":
            self.world.step(self.steps)
        else:
            time.sleep(INTERVAL)

    def stop(self):
        self.robot.stop()


class Ros:
    """The robot by topics of ROS, through rosbridge: JSON in frames of a web socket."""

    stalled = False

    def __init__(self, address, robot, laser):
        host, port = address.rsplit(":", 1)
        self.socket = socket.create_connection((host, int(port)), 10)
        key = base64.b64encode(os.urandom(16)).decode()
        self.socket.sendall(
            f"GET / HTTP/1.1\r\nHost: {address}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: {key}\r\nSec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        self.file = self.socket.makefile("rb")
        if b"101" not in self.file.readline():
            raise SystemExit(f"{address} is no rosbridge")
        while self.file.readline().strip():
            pass
        self.command, self.odom, self.scan = f"/{robot}/cmd_vel", f"/{robot}/odom", f"/{laser}/scan"
        self.send({"op": "advertise", "topic": self.command, "type": "geometry_msgs/Twist"})
        for topic in (self.odom, self.scan):
            self.send({"op": "subscribe", "topic": topic, "queue_length": 1})
        self.last = {}

    def send(self, message):
        data, mask = json.dumps(message).encode(), os.urandom(4)
        size = struct.pack("!BBH", 0x81, 0xFE, len(data)) if len(data) > 125 else struct.pack("!BB", 0x81, 0x80 | len(data))
        self.socket.sendall(size + mask + bytes(byte ^ mask[i % 4] for i, byte in enumerate(data)))

    def receive(self):
        head, size = self.file.read(2)
        size &= 0x7F
        if size > 125:
            (size,) = struct.unpack("!H" if size == 126 else "!Q", self.file.read(2 if size == 126 else 8))
        data = self.file.read(size)
        return json.loads(data) if head & 0x0F == 1 else {}

    def observe(self, goal):
        self.last.pop(self.scan, None)
        while len(self.last) < 2:  # until the next scan
            message = self.receive()
            if message.get("op") == "publish":
                self.last[message["topic"]] = message["msg"]
        pose, motion = self.last[self.odom]["pose"]["pose"], self.last[self.odom]["twist"]["twist"]
        heading = 2 * math.atan2(pose["orientation"]["z"], pose["orientation"]["w"])
        ranges = [RANGE if one is None else one for one in self.last[self.scan]["ranges"]]
        place = pose["position"]["x"], pose["position"]["y"], heading
        return observation(ranges, place, goal, motion["linear"]["x"], motion["angular"]["z"])

    def act(self, speed, turn):
        twist = {"linear": {"x": speed, "y": 0, "z": 0}, "angular": {"x": 0, "y": 0, "z": math.radians(turn)}}
        self.send({"op": "publish", "topic": self.command, "msg": twist})

    def stop(self):
        self.act(0.0, 0.0)


def main(file, way, address, robot, laser, goal):
    goal = tuple(map(float, goal.split(",")))
    policy, body = Policy(file), {"tcp": Tcp, "ros": Ros}[way](address, robot, laser)
    for step in range(600):
        seen = body.observe(goal)
        left = float(seen[0, 181])
        if left < REACHED or body.stalled:
            break
        speed, turn = policy(seen)[0].tolist()
        body.act(speed * SPEED, turn * TURN)
    body.stop()
    print(f"{'ran into something' if body.stalled else 'reached' if left < REACHED else 'gave up'} "
          f"after {step * INTERVAL:.1f} s, {left:.2f} m from the goal")
    return 0 if left < REACHED else 1


if __name__ == "__main__":
    if len(sys.argv) != 7:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))

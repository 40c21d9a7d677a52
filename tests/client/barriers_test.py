# SPDX-License-Identifier: GPL-3.0-or-later
"""The thesis' robot experiment (section 5.2.2) by the Python module.

A robot goes from (0.5, 2) to (0.5, -2) round the barriers by a planner of twenty lines, which sees the
room through lasers alone; no collision.
"""

import heapq
import math
import os
import unittest
from pathlib import Path

import ispace

SCENES = Path(os.environ["ISPACE_SOURCE_DIR"]) / "share" / "scenes"
CELL = 0.1  # m
HALF_WIDTH, HALF_HEIGHT = 5.5, 4.5  # m: cell of the planner


def cell_of(x, y):
    return round(x / CELL), round(y / CELL)


def hits(scan, pose):
    """Where the beams of a laser at this pose end, in the room."""
    for k, distance in enumerate(scan.ranges):
        if math.isfinite(distance):
            angle = math.radians(pose.heading + scan.angle(k))
            yield pose.x + distance * math.cos(angle), pose.y + distance * math.sin(angle)


def plan(blocked, start, goal):
    """The shortest way between cells, as a list of cells."""
    best, came, queue = {start: 0.0}, {}, [(0.0, start)]
    while queue:
        _, at = heapq.heappop(queue)
        if at == goal:
            break
        for dx in (-1, 0, 1):
            for dy in (-1, 0, 1):
                to = at[0] + dx, at[1] + dy
                if abs(to[0]) * CELL > HALF_WIDTH or abs(to[1]) * CELL > HALF_HEIGHT or to in blocked:
                    continue
                cost = best[at] + math.hypot(dx, dy)
                if cost < best.get(to, math.inf):
                    best[to], came[to] = cost, at
                    heapq.heappush(queue, (cost + math.dist(to, goal), to))
    way = [goal]
    while way[-1] != start:
        way.append(came[way[-1]])
    return way[::-1]


def corners(way):
    """The cells where the way turns, and its end."""
    for before, at, after in zip(way, way[1:], way[2:]):
        if (at[0] - before[0], at[1] - before[1]) != (after[0] - at[0], after[1] - at[1]):
            yield at
    yield way[-1]


class Barriers(unittest.TestCase):
    def setUp(self):
        text = (SCENES / "ispace.3dm").read_text(encoding="utf-8")
        layout = ispace.Layout(text + "camera id=c1 at=0.5,-3.5,1.5 heading=90 pixels=80,60\n")
        self.run_ = ispace.simrun(SCENES / "ispace.env", layout, clock="step")
        self.addCleanup(self.run_.close)
        self.world = self.run_.world()
        self.addCleanup(self.world.close)

    def go(self, robot, motion):
        while not robot.ended(motion):
            self.world.advance(0.5)
        end = robot.wait(motion)
        self.assertTrue(end.done, f"{end.reason} at {robot.status().pose}")

    def blocked_cells(self, robot):
        """Cells too near to the points that three lasers see: one on the robot, two in the room."""
        seen = set(hits(robot.scan("l3"), robot.status().pose))
        for id, pose in (("l1", ispace.Pose(-1.3, 2.6, -70)), ("l2", ispace.Pose(-1.3, -2.6, 70))):
            with self.run_.laser(id) as laser:
                seen |= set(hits(laser.scan(), pose))
        own = robot.status().pose
        # The lasers of the room see this robot, too.
        seen = {point for point in seen if math.dist(point, own[:2]) > 0.45}
        near = math.ceil(0.4 / CELL)
        return {
            (column + dx, row + dy)
            for column, row in {cell_of(x, y) for x, y in seen}
            for dx in range(-near, near + 1)
            for dy in range(-near, near + 1)
            if math.hypot(dx, dy) * CELL <= 0.4
        }

    def test_round_the_barriers(self):
        with self.run_.robot("r1") as robot:
            target = (0.5, -2.0)
            for _ in range(40):
                pose = robot.status().pose
                if math.dist(pose[:2], target) < 0.15:
                    break
                start = cell_of(pose.x, pose.y)
                way = plan(self.blocked_cells(robot) - {start}, start, cell_of(*target))
                # One leg at a time, as the next scan may show hidden parts.
                x, y = (c * CELL for c in next(corners(way)))
                x, y = target if (x, y) == tuple(c * CELL for c in cell_of(*target)) else (x, y)
                turn = math.degrees(math.atan2(y - pose.y, x - pose.x)) - pose.heading
                turn = math.remainder(turn, 360)
                self.go(robot, robot.left(turn) if turn > 0 else robot.right(-turn))
                self.go(robot, robot.forward(min(1.0, math.dist(pose[:2], (x, y)))))
            pose = robot.status().pose
            self.assertLess(math.dist(pose[:2], target), 0.15, f"it is at {pose}")
        self.assertNotIn("ran into", self.run_.messages)

    def test_a_camera_sees_the_robot_come(self):
        with self.run_.camera("c1") as camera, self.run_.robot("r1") as robot:
            self.assertEqual(camera.info["kind"], "camera")
            camera.format("rgb")
            before = camera.scan()
            self.assertEqual((before.width, before.height, len(before.data)), (80, 60, 80 * 60 * 3))
            self.go(robot, robot.left(90))
            for metres in (1.2, 3.5, 1.2):
                self.go(robot, robot.forward(metres))
                self.go(robot, robot.right(90))
            after = camera.scan()
            self.assertGreater(after.time, before.time)
            changed = sum(a != b for a, b in zip(before.data, after.data))
            self.assertGreater(changed, 300, "the robot is not in the picture")
            camera.format("png")
            self.assertEqual(camera.scan().data[:8], b"\x89PNG\r\n\x1a\n")

if __name__ == "__main__":
    unittest.main()

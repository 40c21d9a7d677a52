# SPDX-License-Identifier: GPL-3.0-or-later
"""wait_for_people.py SERVER ROBOT X,Y: a planner of one's own, to begin with: straight to the goal, and it stands while a
person is within 1.2 m ahead.

    PYTHONPATH=lib/client/python python3 share/benchmarks/social/run.py --only crossing \\
        --planner 'waits=python3 share/benchmarks/social/wait_for_people.py {server} {robot} {goal}'
"""

import math
import sys

import ispace


def main(server, robot_id, goal_text):
    goal = tuple(map(float, goal_text.split(",")))
    world, robot = ispace.World(server), ispace.Robot(server, robot_id)
    steps = round(0.1 / world.dt)
    try:
        while True:
            pose = robot.status().pose
            left = math.dist((pose.x, pose.y), goal)
            if left < 0.3:
                return 0
            off = math.remainder(math.degrees(math.atan2(goal[1] - pose.y, goal[0] - pose.x)) - pose.heading, 360)
            waits = False
            for name, other in world.poses().items():
                bearing = math.degrees(math.atan2(other.y - pose.y, other.x - pose.x)) - pose.heading
                if name != robot_id and math.dist((other.x, other.y), (pose.x, pose.y)) < 1.2:
                    waits = waits or abs(math.remainder(bearing, 360)) < 60
            robot.speed(0.0 if waits or abs(off) > 30 else round(min(1.0, left), 3))
            robot.rotspeed(round(max(-90.0, min(90.0, 3 * off)), 2))
            if world.step(steps) < steps:
                return 3
    except ispace.ConnectionFailed:
        return 3  # the run has ended


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))

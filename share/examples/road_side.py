#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Finds the kerbs of a road by a laser that is tilted down, standing or on a robot that drives along it.

    simrun road.env road.3dm --clock step --listen 127.0.0.1:7001 &
    sleep 1
    road_side.py 127.0.0.1:7001 front --height 0.5 --tilt -30
    kill $!; wait

The beams meet the road on a line across it; where that bends up there is a kerb. Prints where both kerbs are,
fitted through all scans: how far to the side of the start, in which direction, how high. With --drive r1,6 the
robot r1, which carries the laser, goes 6 m meanwhile, and its odometry tells where each scan was taken. With
--clock step the program advances the world, and each run is the same. Standard library alone, and the module
ispace.
"""

import argparse
import dataclasses
import math
import statistics
import sys

import ispace

STEP = 0.05  # m: lower rises are road
LEAST = 8  # beams that must stay up there
WIDEST = 40  # beams in which a kerb has risen
MIDDLE = 15.0  # degrees to each side in which all is road


@dataclasses.dataclass
class Point:
    """Where a beam has ended, in the laser's frame, made level: ahead, left, and above the road."""

    bearing: float  # degrees
    x: float
    y: float
    z: float


@dataclasses.dataclass
class Kerb:
    """The face of a kerb."""

    x: float
    y: float
    height: float


def points_of(scan, height, tilt):
    """The points of a scan from a laser so high above the road, and tilted so."""
    points = []
    for k, distance in enumerate(scan.ranges):
        if not math.isfinite(distance):
            continue
        bearing, down = math.radians(scan.angle(k)), math.radians(tilt)
        ahead = distance * math.cos(bearing)
        points.append(Point(scan.angle(k), ahead * math.cos(down), distance * math.sin(bearing),
                            height + ahead * math.sin(down)))
    return points


def smooth(values, reach=2):
    """Medians of neighbours, which single wrong ranges do not move."""
    return [statistics.median(values[max(0, i - reach):i + reach + 1]) for i in range(len(values))]


def find_kerb(points):
    """Finds the kerb among the points of one side, from the middle outwards; None without one."""
    road = [point.z for point in points if abs(point.bearing) < MIDDLE]
    if not road:
        return None
    level = statistics.median(road)
    heights = smooth([point.z - level for point in points])
    for i in range(len(points) - LEAST):
        if min(heights[i:i + LEAST]) < STEP:
            continue
        # It has risen already: the face began a little before, and its top is a little farther.
        top = statistics.median(heights[i + LEAST:i + LEAST + WIDEST] or heights[i:])
        face = [point for point, height in zip(points[max(0, i - WIDEST):i + WIDEST],
                                               heights[max(0, i - WIDEST):i + WIDEST])
                if 0.2 * top < height < 0.8 * top]
        if not face:
            face = points[i - 1:i + 1]  # too steep for a beam to end on it
        return Kerb(statistics.fmean(point.x for point in face), statistics.fmean(point.y for point in face), top)
    return None


def find_kerbs(points):
    """Both kerbs, by the names of their sides."""
    left = [point for point in points if point.bearing >= 0]
    right = [point for point in reversed(points) if point.bearing <= 0]
    return {"left": find_kerb(left), "right": find_kerb(right)}


def fit(places):
    """Fits a line to points, least squares across it: returns its middle and its direction in radians."""
    x, y = (statistics.fmean(place[axis] for place in places) for axis in (0, 1))
    xx = sum((place[0] - x) ** 2 for place in places)
    yy = sum((place[1] - y) ** 2 for place in places)
    xy = sum((place[0] - x) * (place[1] - y) for place in places)
    return (x, y), math.atan2(2 * xy, xx - yy) / 2


def scans(address, laser_id, count, drive):
    """(pose by odometry, scan), `count` times or until the robot is there."""
    with ispace.World(address) as world, ispace.LaserSensor(address, laser_id) as laser:
        by_steps = world.clock == "step"
        if not by_steps:
            laser.stream()

        def next_scan():
            if not by_steps:
                return laser.next()
            world.advance(1 / laser.rate)
            return laser.scan()

        if not drive:
            for _ in range(count):
                yield ispace.Pose(0, 0, 0), next_scan()
            return
        with ispace.Robot(address, drive[0]) as robot:
            motion = robot.forward(drive[1])
            while not robot.ended(motion):
                scan = next_scan()
                yield robot.odometry().pose, scan


def collect(args, drive):
    """(side, x, y, height) of each kerb found, in the frame of the start; the number of scans."""
    found, count = [], 0
    for pose, scan in scans(args.address, args.laser, args.scans, drive):
        count += 1
        heading = math.radians(pose.heading)
        for side, kerb in find_kerbs(points_of(scan, args.height, args.tilt)).items():
            if kerb is None:
                continue
            x = pose.x + kerb.x * math.cos(heading) - kerb.y * math.sin(heading)
            y = pose.y + kerb.x * math.sin(heading) + kerb.y * math.cos(heading)
            found.append((side, x, y, kerb.height))
            if args.output:
                args.output.write(f"{scan.time:.3f},{side},{x:.4f},{y:.4f},{kerb.height:.4f}\n")
    return found, count


def report(found, count):
    """Prints the kerbs; returns whether both were found."""
    complete = True
    for side in ("left", "right"):
        mine = [kerb for kerb in found if kerb[0] == side]
        if not mine:
            print(f"{side}: none in {count} scans")
            complete = False
            continue
        (x, y), direction = fit([kerb[1:3] for kerb in mine])
        if max(kerb[1] for kerb in mine) - min(kerb[1] for kerb in mine) < 0.5:
            direction = 0.0  # seen at a single point
        beside = y - math.tan(direction) * x
        print(f"{side}: {abs(beside):.4f} m beside the start, direction {math.degrees(direction):.2f} degrees, "
              f"{statistics.median(kerb[3] for kerb in mine):.4f} m high, in {len(mine)} of {count} scans")
    return complete


def main():
    parser = argparse.ArgumentParser(description="finds the kerbs of a road by a laser that is tilted down")
    parser.add_argument("address", help="HOST:PORT of simrun, or a port of this machine")
    parser.add_argument("laser", help="id of the laser")
    parser.add_argument("--height", type=float, required=True, help="of the laser above the road, m")
    parser.add_argument("--tilt", type=float, required=True, help="of the laser, degrees; down is negative")
    parser.add_argument("--drive", metavar="ROBOT,M", help="drive this robot so far meanwhile")
    parser.add_argument("--scans", type=int, default=1, help="how many, without --drive")
    parser.add_argument("-o", "--output", type=argparse.FileType("w"), help="write all kerbs found, as CSV")
    args = parser.parse_args()
    if args.address.isdigit():
        args.address = f"127.0.0.1:{args.address}"
    drive = None
    if args.drive:
        robot, _, metres = args.drive.partition(",")
        try:
            drive = robot, float(metres)
        except ValueError:
            parser.error(f"--drive {args.drive}: not ROBOT,METRES, such as r1,6")
    if args.scans < 1:
        parser.error(f"--scans {args.scans}: at least 1")
    if args.output:
        args.output.write("t,side,x,y,height\n")
    try:
        found, count = collect(args, drive)
    except ispace.Error as error:
        print(f"road_side.py: {error}", file=sys.stderr)
        return 1
    return 0 if report(found, count) else 3


if __name__ == "__main__":
    sys.exit(main())

# SPDX-License-Identifier: GPL-3.0-or-later
"""From a drive to a map by other people's programs: a robot with noise on odometry and scans drives
through an office, its record becomes a CARMEN log, MRPT's icp-slam makes a map of that, and its
walls are those of the room."""
import csv
import json
import math
import os
import pathlib
import subprocess

from device_run import check, need, scratch, skip

START = (-11.95, 1, math.pi / 2)
# A round of 58 m, with slow turns: icp-slam takes a scan as of one moment, but its beams follow one
# another. Variances of the odometry as in simrun(1).
LAYOUT = """#3dm 1
robot id=r1 model=pioneer-2dx at=-11.95,1 heading=90 rotspeed=20 motion_noise=0,0,0,0 odometry_noise=0.001,0.0002,0.0005,0.0002 \
path=-11.85,3.2;-10.85,5.7;-11.65,14.6;-12.55,17.1;-19.95,16.4;-19.85,7.4;-19.25,-1.5;-18.75,-7.2;\
-15.85,-6.4;-12.25,-1.2;-11.95,0.4
laser id=l1 model=utm-30lx on=r1 at=0.1,0,0.3 rate=5
"""
HEIGHT = 0.3  # of the laser
INI = """[ICP]
maxIterations = 80
minAbsStep_trans = 1e-6
minAbsStep_rot = 1e-6
thresholdDist = 0.3
thresholdAng_DEG = 5
ALFA = 0.8
smallestThresholdDist = 0.05
onlyClosestCorrespondences = true
onlyUniqueRobust = true
ICP_algorithm = icpClassic
corresponding_points_decimation = 1
[MappingApplication]
rawlog_file = drive.rawlog
rawlog_offset = 0
logOutput_dir = map
LOG_FREQUENCY = 100000
SAVE_3D_SCENE = 0
SAVE_POSE_LOG = 0
CAMERA_3DSCENE_FOLLOWS_ROBOT = 0
SHOW_PROGRESS_3D_REAL_TIME = 0
localizationLinDistance = 0.05
localizationAngDistance = 1
insertionLinDistance = 0.8
insertionAngDistance = 30
minICPgoodnessToAccept = 0.4
matchAgainstTheGrid = 0
occupancyGrid_count = 0
gasGrid_count = 0
landmarksMap_count = 0
beaconMap_count = 0
pointsMap_count = 1
likelihoodMapSelection = -1
[MappingApplication_pointsMap_00_insertOpts]
minDistBetweenLaserPoints = 0.05
fuseWithExisting = false
isPlanarMap = 1
"""


def run(*command):
    done = subprocess.run([*map(str, command)], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT)
    check(done.returncode == 0, f"{command[0]}: {done.stdout[-2000:]}")


def drive(plan):
    pathlib.Path("drive.3dm").write_text(LAYOUT)
    run("simrun", "-q", plan, "drive.3dm", "--noise", "--seed", 3, "--clock", "fast", "--until", 320,
        "--record", "run")
    run("scan", "--run", "run", "--to", "carmen", "-o", "drive.log")


def make_map():
    # MRPT 2.5 reads times of these logs a million million times too short.
    with open("drive.log") as log, open("times.log", "w") as out:
        for line in log:
            words = line.split(" ")
            if words[0] == "ROBOTLASER1":
                words[-3] = f"{float(words[-3]) * 1e12:.0f}"
            out.write(" ".join(words))
    run("carmen2rawlog", "-q", "-w", "-i", "times.log", "-o", "drive.rawlog")
    pathlib.Path("icp.ini").write_text(INI)
    run("icp-slam", "icp.ini")


def end_of(file):
    words = pathlib.Path(file).read_text().split("\n")[-2].split()
    return float(words[-3]), float(words[-2])


def true_end():
    """In the frame of the start."""
    with open("run/robots.csv") as table:
        *_, last = csv.DictReader(table)
    x, y = float(last["x"]) - START[0], float(last["y"]) - START[1]
    c, s = math.cos(START[2]), math.sin(START[2])
    return c * x + s * y, c * y - s * x


def walls(plan):
    """The lines of the room's slice at the laser's height."""
    run("envc", plan, "--slice", HEIGHT, "-o", "slice.geojson")
    lines = []

    def add(coordinates):
        if isinstance(coordinates[0][0], (int, float)):
            lines.extend(zip(coordinates, coordinates[1:]))
        else:
            for part in coordinates:
                add(part)

    for feature in json.loads(pathlib.Path("slice.geojson").read_text())["features"]:
        if feature["geometry"]["type"] != "Point":
            add(feature["geometry"]["coordinates"])
    return [(a[0], a[1], b[0], b[1]) for a, b in lines]


def wall_cells(numpy):
    """Of the map, in the room's frame: the mean of the points in each cell of 0.1 m."""
    (file,) = pathlib.Path("map").glob("_finalmaps_*CSimplePointsMap_00.txt")
    points = numpy.loadtxt(file)[:, :2]
    c, s = math.cos(START[2]), math.sin(START[2])
    points = points @ numpy.array([[c, s], [-s, c]]) + START[:2]
    _, cells = numpy.unique(numpy.floor(points / 0.1).astype(int), axis=0, return_inverse=True)
    counts = numpy.bincount(cells.ravel())
    return numpy.stack([numpy.bincount(cells.ravel(), points[:, i]) / counts for i in (0, 1)], 1)


def distances(numpy, points, lines):
    best = numpy.full(len(points), numpy.inf)
    for ax, ay, bx, by in lines:
        begin, way = numpy.array([ax, ay]), numpy.array([bx - ax, by - ay])
        length = max(way @ way, 1e-12)
        at = numpy.clip((points - begin) @ way / length, 0, 1)
        numpy.minimum(best, numpy.hypot(*(points - begin - at[:, None] * way).T), out=best)
    return best


def main():
    need("carmen2rawlog", "icp-slam")
    plan = pathlib.Path(os.environ.get("ISPACE_TEST_DATA", "")) / "willow-full.yaml"
    if not plan.exists():
        skip("no willow-full.yaml in ISPACE_TEST_DATA")
    try:
        import numpy
    except ImportError:
        skip("no numpy here")
    plan = plan.resolve()
    with scratch() as folder:
        os.chdir(folder)
        drive(plan)
        make_map()
        astray = math.dist(end_of("map/log_odometry_path.txt"), true_end())
        off = math.dist(end_of("map/log_estimated_path.txt"), true_end())
        cells = wall_cells(numpy)
        away = distances(numpy, cells, walls(plan))
    share = (away <= 0.1).mean()
    print(f"{len(cells)} wall cells, {100 * share:.1f} % within 0.1 m of the room's walls, half of "
          f"them within {numpy.median(away):.3f} m; the end of the drive is {off:.2f} m off, by "
          f"odometry alone {astray:.2f} m")
    check(len(cells) > 3000, "a map of so little")
    check(astray > 0.5, "the odometry does not stray")
    check(off < 0.3, "icp-slam does not know where it is")
    check(share > 0.9, "the map is another one than the room")


if __name__ == "__main__":
    main()

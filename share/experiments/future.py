# SPDX-License-Identifier: GPL-3.0-or-later
"""Future work of the thesis: speed, noise, friction, several platforms."""

import csv
import json
import math
import statistics

from plot import BLUE, INK, ORANGE, Plot

TITLE = "What the thesis left to do"
SOURCE = "section 6.3"
SECONDS = 12

MODELS = (  # cruising speed and acceleration of forward(), from share/devices
    ("pioneer-2dx", 0.5, 0.3), ("pioneer-3at", 0.5, 0.3), ("turtlebot3-burger", 0.22, 2.0),
    ("turtlebot3-waffle-pi", 0.26, 2.0), ("create3", 0.306, 0.9))
SQUARE = "".join(f"{11 * k:g} r1 FORWARD 2\n{11 * k + 8:g} r1 LEFT 90\n" for k in range(4))


def arrival(way, speed, accel):
    """When a robot stands again that goes off from rest: speeding up, cruising, slowing down."""
    if way < speed * speed / accel:
        return 2 * math.sqrt(way / accel)
    return way / speed + speed / accel


def robots(lab, folder, which="robots.csv"):
    """The rows of each robot of a record."""
    found = {}
    with open(lab.path(f"{folder}/{which}"), encoding="utf-8", newline="") as table:
        for row in csv.DictReader(table):
            found.setdefault(row["id"], []).append(row)
    return found


def stands_again(rows):
    """When a robot last moved."""
    return max(float(row["t"]) for row in rows if float(row["speed"]) != 0)


def speed(lab):
    lab.text("Speed. The thesis measures one beam in each picture that it draws, some 330 a second (as we read table 4.1 and section 3.4.3 i). "
             "Here a UTM-30LX is moved through the room of table 4.1.")
    lab.scene("facilities.env")
    scans, beams = 1000, 1081
    lab.shell(f"seq 0 {scans - 1} | awk '{{ print $1 / 40, 2.9 * cos($1 / 99), 2.9 * sin($1 / 99), 0.15, 0, 0, 0, "
              "1 }' > way.txt")
    lab.tool("scan", "facilities.env", "--poses", "way.txt", "--model", "utm-30lx", "--to", "raw", "-q", "-o",
             "ranges.f32")
    seconds = lab.timings[-1][1]
    lab.row(f"Beams of {scans} scans", None, scans * beams)
    lab.row("They take at the thesis' 330 beams a second", None, scans * beams / 330, "s", digits=0,
            note="Here they took less than a hundredth of that (timings.csv).")
    lab.require(scans * beams / 330 > 100 * seconds, f"{scans} scans took {seconds:.1f} s")


def noise(lab):
    seeds = lab.seeds(100, 8)
    lab.text("Noise. Robots may stray and miscount their way (--noise). A Pioneer drives a square of 2 m, "
             "open loop, with the motion model of Probabilistic Robotics (section 5.4).")
    lab.write("yard.env", "#env 1\nispace size=12,12\n")
    lab.write("square.3dm", "#3dm 1\nrobot id=r1 model=pioneer-2dx at=-1,-1 motion_noise=0.001,0.001,0.001,0.001\n")
    lab.write("square.txt", SQUARE)
    run = ("simrun", "yard.env", "square.3dm", "--clock", "fast", "--script", "square.txt", "--until", "44", "-q")
    lab.tool(*run, "--record", "ideal")
    lab.command(f"for seed in $(seq 0 {seeds[-1]}); do {' '.join(run)} --noise --seed $seed --record noise-$seed; "
                "done")
    plot = Plot((-2.2, 2.2), (-2.2, 2.2), "A square driven blindly", "x in m", "y in m", width=560, equal=True)
    ends = []
    for seed in seeds:
        lab.tool(*run, "--noise", "--seed", seed, "--record", f"noise-{seed}", shown=False)
        way = [(float(row["x"]), float(row["y"])) for row in robots(lab, f"noise-{seed}")["r1"]]
        plot.line(way[::40] + way[-1:], ORANGE, 0.7, name="with noise")
        ends.append(math.dist(way[-1], (-1, -1)))
    ideal = [(float(row["x"]), float(row["y"])) for row in robots(lab, "ideal")["r1"]]
    plot.line(ideal[::40] + ideal[-1:], INK, 2, name="without")
    lab.row("Without noise: distance of start and end", 0, math.dist(ideal[-1], (-1, -1)), "m", digits=4,
            bound=(0, 0.001))
    lab.row(f"With noise: the same, mean of {len(ends)} seeds", None, statistics.fmean(ends), "m",
            bound=(0.02, 0.6), note="The thesis has no noise of motion, which it names as a reason why its real "
            "and its simulated robot went different ways (section 5.2.2).")
    lab.svg("square.svg", plot.svg(), "The same commands, with and without noise of motion.")


def friction(lab):
    lab.text("Friction. A floor takes a share of a robot's speed and acceleration; three robots drive 3 m on "
             "three floors.")
    shares = (0, 0.3, 0.6)
    lab.write("floors.env", "#env 1\nispace size=12,8\n" + "".join(
        f"floor at=0,{2 - 2 * k} size=12,2 friction={share}\n" for k, share in enumerate(shares)))
    lab.write("floors.3dm", "#3dm 1\n" + "".join(
        f"robot id=r{k} model=pioneer-2dx at=-2,{2 - 2 * k}\n" for k in range(3)))
    lab.write("floors.txt", "".join(f"0 r{k} FORWARD 3\n" for k in range(3)))
    lab.tool("simrun", "floors.env", "floors.3dm", "--clock", "fast", "--script", "floors.txt", "--until", "40", "-q",
             "--record", "floors")
    found = robots(lab, "floors")
    for k, share in enumerate(shares):
        expected = arrival(3, 0.5 * (1 - share), 0.3 * (1 - share))
        lab.row(f"Friction {share:g}: 3 m take", None, stands_again(found[f"r{k}"]), "s",
                bound=(expected - 0.05, expected + 0.05), note=f"By speed and acceleration: {expected:.2f} s.")


def platforms(lab):
    lab.text("Several platforms. The tools run without a display or a GPU. Robots of several makers drive 2 m side by "
             "side, by the limits of their models; and a program in Python reads by TCP what scan reads.")
    lab.write("makers.env", "#env 1\nispace size=10,10\n")
    lab.write("makers.3dm", "#3dm 1\n" + "".join(
        f"robot id={model} model={model} at=-3,{3 - 1.5 * k}\n" for k, (model, _, _) in enumerate(MODELS))
        + "laser id=l1 model=urg-04lx at=2,-4 heading=120\n")
    lab.write("makers.txt", "".join(f"0 {model} FORWARD 2\n" for model, _, _ in MODELS))
    lab.tool("simrun", "makers.env", "makers.3dm", "--clock", "fast", "--script", "makers.txt", "--until", "20", "-q",
             "--record", "makers")
    found = robots(lab, "makers")
    for model, most, accel in MODELS:
        expected = arrival(2, most, accel)
        lab.row(f"{model}: 2 m take", None, stands_again(found[model]), "s",
                bound=(expected - 0.05, expected + 0.05), note=f"By its limits: {expected:.2f} s.")
    lab.write("read.py", "import sys\nimport ispace\n\n"
              "with ispace.LaserSensor(\"127.0.0.1:\" + sys.argv[1], \"l1\") as laser:\n"
              "    print(*laser.scan().ranges)\n")
    with lab.serve("makers.env", "makers.3dm", "--clock", "step") as port:
        served = [float(word) for word in lab.tool("python3", "read.py", port).split()]
    lab.tool("scan", "makers.env", "makers.3dm", "-o", "makers.jsonl")
    ranges = json.loads(lab.read("makers.jsonl").splitlines()[1])["ranges"]
    pairs = [(a, b) for a, b in zip(served, ranges) if b is not None]
    lab.row("Beams that return, of 682", None, len(pairs), bound=(100, 682))
    lab.row("Greatest difference between what the client and what scan read", None,
            1000 * max(abs(a - b) for a, b in pairs), "mm", digits=4, bound=(0, 0.001),
            note="Both are float32; by text the protocol has millimetres.")
    lab.require(len(served) == len(ranges), "the client read another number of beams")


def run(lab):
    lab.text("Named as future work are computation performance and a convenient GUI, real attributes like noises and "
             "friction, and use on multiple platforms. Here are figures of speed, noise, friction and platforms.")
    lab.assumption("“Multiple platforms” is read as robots of several makers and use without a display. The GUI is left "
                   "out.")
    lab.given("faster sensor models; noise; friction; use on multiple platforms", "section 6.3")
    lab.given("330 frames a second on average", "table 4.1")
    lab.given("a beam is read from the middle of a frame while the view turns", "section 3.4.3 i")
    lab.assumption("One beam is one frame, so 330 frames are read as 330 beams a second.")
    lab.assumption("All rooms of this section; the amounts of noise and friction.")
    speed(lab)
    noise(lab)
    friction(lab)
    platforms(lab)

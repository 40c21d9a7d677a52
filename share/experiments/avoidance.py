# SPDX-License-Identifier: GPL-3.0-or-later
"""A robot drives around a barrier: plan, dynamic window, Kalman filter; also with the noise that the thesis omits."""

import math
import shutil
import statistics

from plot import BLUE, GREEN, ORANGE, RED, Plot
import ways

TITLE = "A robot avoids obstacles"
SOURCE = "section 5.2.2, fig. 5.4 to 5.9 a"
SECONDS = 60

START, GOAL, RADIUS = (0.5, 2), (0.5, -2), 0.25
FRONT = (0.5, 0.3)  # middle of the barrier in the way, of ispace.env
REACHED = 0.4  # m
CLIENT = ("avoid", "map.yaml", f"{START[0]},{START[1]},-90", f"{GOAL[0]},{GOAL[1]}")

# Standard deviations that are ours: see the assumptions.
ODOMETRY = "odometry_noise=0.004,0.001,0.001,0.0005"
SLIP = "motion_noise=0.004,0.001,0.001,0.0005"
STRAY = "start_noise=0.05,3"
CAUSES = {"noise": (ODOMETRY,), "friction": (SLIP,), "start": (STRAY,), "all": (ODOMETRY, SLIP, STRAY)}


class Trial:
    """One drive, and its errors against the true way."""

    def __init__(self, lab, env, layout, seed, obstacles, options=(), name="", shown=False):
        run = name or "trial"
        with lab.serve(env, layout, "--clock", "step", "--noise", "--seed", seed, "--record", run,
                       shown=shown) as port:
            said = lab.tool(*CLIENT, *options, "-rrtp", port, "-o", f"{run}.csv", shown=shown, statuses=(0, 3))
        self.gave_up = not said.startswith("reached")
        self.way = ways.way(lab, f"{run}/robots.csv", "r1")
        self.collisions = sum(1 for row in ways.rows(lab, f"{run}/events.csv") if row["kind"] == "collision")
        believed = ways.rows(lab, f"{run}.csv")
        self.odometry = [(float(row["odometry_x"]), float(row["odometry_y"])) for row in believed]
        self.estimate = [(float(row["x"]), float(row["y"])) for row in believed]
        self.seconds = float(believed[-1]["t"])
        self.length = ways.length(self.way)
        self.off = math.dist(self.way[-1][1:], GOAL)
        self.closest = min(ways.distance(place[1:], obstacles) for place in self.way) - RADIUS
        self.reached = not self.gave_up and self.off <= REACHED and self.collisions == 0
        # Where it believed to be at the end, against where it is.
        self.odometry_error = math.dist(self.odometry[-1], self.way[-1][1:])
        self.estimate_error = math.dist(self.estimate[-1], self.way[-1][1:])
        if not name:
            shutil.rmtree(lab.path(run))


def rooms_and_layouts(lab):
    lab.scene("ispace.env", "ispace.3dm")
    lab.given("start (0.5, 2), target (0.5, -2); the robot stops within 0.4 m of it", "section 5.2.2")
    lab.given("Pioneer 2DX; path planning, dynamic window and extended Kalman filter; ARIA's classes",
              "section 5.2, table 5.1")
    lab.given("what real and simulated drives may differ by: sensor noise, friction, the posture at the start",
              "section 5.2.2")
    lab.given("the robot stops by its own position by encoder data; the barrier at its side makes it go left; the "
              "other two barriers are on the left of its way", "section 5.2.2")
    lab.assumption("The thesis' z is taken to point down the page, so that its left is the mirror image of ours: the "
                   "robot passes at −x, which is its own right as it drives to −y, where the two barriers are. It stops "
                   "by the filter's position.")
    lab.assumption("The places of the barriers, which fig. 5.4 shows without figures: one across the way, one "
                   "beside it on the right as the map is drawn, two that keep off the rest of the room.")
    lab.assumption("“Robots are both at the start point” is read as the real and the simulated one: one robot drives.")
    lab.assumption("The filter corrects the odometry by the robot's 16 sonars and a map of the room with cells of "
                   "2 cm; the robot drives at 0.4 m/s at most.")
    lab.assumption("Noise: odometry that errs, after a turn of 180° and 4.5 m of way, by some 7° and 7 cm "
                   "(standard deviation). Friction: a floor that takes 30 % of all accelerations and speeds, and "
                   "wheels that slip by as much as the odometry errs. Start: off by 5 cm in x and in y, and by 3°. "
                   "Sonars measure exactly.")
    lab.tool("envc", "ispace.env", "--slice", "0.1", "--resolution", "0.02", "--to", "ros", "-o", "map.yaml")
    lab.tool("envc", "ispace.env", "--set", "blanket.friction=0.3", "--to", "env", "-o", "slippery.env")
    lab.tool("envc", "ispace.3dm", "--delete", "l*", "--set", "r1.motion_noise=0,0,0,0",
             "--set", "r1.odometry_noise=0,0,0,0", "--to", "3dm", "-o", "robot.3dm")
    for cause, keys in CAUSES.items():
        sets = [word for key in keys for word in ("--set", f"r1.{key}")]
        lab.tool("envc", "robot.3dm", *sets, "--to", "3dm", "-o", f"{cause}.3dm")


def draw(lab, name, trials, caption, beliefs=False):
    obstacles = ways.Obstacles(lab, "ispace.env", 0.1)
    plot = Plot((-2.6, 2.2), (-2.8, 2.8), "", "x in m", "y in m", width=440, equal=True)
    obstacles.draw(plot)
    circle = [(GOAL[0] + REACHED * math.cos(a / 20 * math.pi), GOAL[1] + REACHED * math.sin(a / 20 * math.pi))
              for a in range(41)]
    plot.line(circle, GREEN, 1.5, dash="4 3", name="0.4 m around the target")
    for k, trial in enumerate(trials):
        places = [place[1:] for place in trial.way]
        if beliefs:
            plot.line(trial.odometry, ORANGE, 2, dash="5 3", name="by odometry")
            plot.line(places, BLUE, 3, name="true")
            plot.line(trial.estimate, RED, 1, name="estimated")
        else:
            plot.line(places, BLUE if trial.reached else RED, 0.7, name="reached" if trial.reached else "missed")
    lab.svg(name, plot.svg(), caption)


def one(lab, obstacles):
    trial = Trial(lab, "ispace.env", "robot.3dm", 0, obstacles, name="run", shown=True)
    lab.tool("simrun", "--replay", "run", "-o", "run.png", "--width", "640")
    lab.row("Simulated as in the thesis: distance to the target at the end", "less than 0.4", trial.off, "m",
            bound=(0, REACHED), digits=3)
    lab.row("Collisions", 0, trial.collisions, bound=(0, 0))
    lab.row("Length of the way", None, trial.length, "m", bound=(3.6, 6), note="Straight it is 4 m.")
    lab.row("Time", None, trial.seconds, "s", bound=(9, 40), digits=1)
    lab.row("Closest distance of the robot's rim to anything", "more than 0", trial.closest, "m",
            bound=(0.02, 1), digits=3)
    draw(lab, "ideal.svg", [trial], "Fig. 5.9 a, the simulated robot: true, by odometry and as estimated. Without "
         "noise the three lie within a few centimetres.", beliefs=True)
    passing = min(trial.way, key=lambda place: abs(place[2] - FRONT[1]))
    lab.require(passing[1] < FRONT[0], "the robot passes the front barrier on the other side")
    lab.picture("run.png", "Fig. 5.6 and 5.8: the scene and the robot's way in it.")


def summary(lab, what, trials, least, thesis=None):
    count = len(trials)
    share = 100 * sum(t.reached for t in trials) / count
    bound = None if least is None else (least, 100)
    lab.row(f"{what}: reached, nothing touched, of {count} drives", thesis, share, "%", bound=bound, digits=0)
    lab.row(f"{what}: collisions", None, sum(t.collisions for t in trials),
            bound=None if least is None else (0, 0))
    lab.row(f"{what}: distance to the target at the end, median and greatest", None,
            f"{statistics.median(t.off for t in trials):.2f} and {max(t.off for t in trials):.2f} m")
    lab.row(f"{what}: length of the way, least to greatest", None,
            f"{min(t.length for t in trials):.2f} to {max(t.length for t in trials):.2f} m")
    lab.row(f"{what}: closest distance, median and least", None,
            f"{statistics.median(t.closest for t in trials):.2f} and {min(t.closest for t in trials):.2f} m")


def series(lab, obstacles, cause, count, options=(), few=2):
    env = "slippery.env" if cause in ("friction", "all") else "ispace.env"
    word = " --odometry" if options else ""
    seeds = [seed + 1 for seed in lab.seeds(count, few)]
    lab.command(f"for seed in $(seq {seeds[0]} {seeds[-1]}); do simrun {env} {cause}.3dm --clock step --noise --seed $seed "
                f"--record trial --listen 127.0.0.1:7001 & sleep 1; {' '.join(CLIENT)}{word} -rrtp 7001 -o trial.csv; "
                "kill $!; wait; done")
    return [Trial(lab, env, f"{cause}.3dm", seed, obstacles, options) for seed in seeds]


def run(lab):
    lab.text("A Pioneer drives around a barrier to its target with a program written for ARIA: share/examples/aria/"
             "avoid.cpp. In the thesis the real and the simulated robot both arrive and take different ways, of "
             "which three things are named as causes. Here each of the three is put into the simulation, "
             "from many seeds, and then all of them; the last series does without the Kalman filter.")
    rooms_and_layouts(lab)
    obstacles = ways.Obstacles(lab, "ispace.env", 0.1).within((-3, -3.4), (3, 3.4))
    one(lab, obstacles)
    singles = {cause: series(lab, obstacles, cause, 25) for cause in ("noise", "friction", "start")}
    for cause, what in (("noise", "Noise of the odometry"), ("friction", "Friction"), ("start", "Posture at the start")):
        summary(lab, what, singles[cause], 95)
    every = series(lab, obstacles, "all", 100, few=4)
    summary(lab, "All three", every, 95, "reached")
    blind = series(lab, obstacles, "all", 100, ("--odometry",), few=4)
    summary(lab, "All three, odometry alone", blind, None)
    for what, errors in (("odometry", [t.odometry_error for t in every]),
                         ("filter", [t.estimate_error for t in every])):
        lab.row(f"All three: error of the place by the {what} at the end, mean and 95th percentile", None,
                f"{statistics.fmean(errors):.3f} and {ways.percentile(errors, 0.95):.3f} m")
    better = statistics.fmean(t.estimate_error for t in every) < statistics.fmean(t.odometry_error for t in every)
    lab.require(better, "the filter knows the place no better than the odometry")
    shown = max(every[:20], key=lambda t: t.odometry_error)
    draw(lab, "one.svg", [shown], "One of the drives with all three causes: what the robot believes by its wheels "
         "and by the filter, and where it is.", beliefs=True)
    draw(lab, "all.svg", every, f"Fig. 5.9 a: {len(every)} drives with noise, friction and a posture that is off.")
    draw(lab, "blind.svg", blind, "The same without the filter: red ones miss the target or touch something.")

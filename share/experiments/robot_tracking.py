# SPDX-License-Identifier: GPL-3.0-or-later
"""Two lasers of the room track the robot that avoids obstacles."""

from judging import Outcome
from plot import BLUE, GREEN, ORANGE, PURPLE, Plot
import math
import ways

TITLE = "Tracking of the robot by distributed lasers"
SOURCE = "section 5.2.2, fig. 5.9 b"
SECONDS = 4

NAMES = {"l1": ("the upper sensor alone", ORANGE), "l2": ("the lower sensor alone", PURPLE),
         "joint": ("both, and the robot as a disc", GREEN)}


def draw(lab, outcome):
    plot = Plot((-2.6, 2.2), (-3, 3), "", "x in m", "y in m", width=440, equal=True)
    ways.Obstacles(lab, "ispace.env", 0.15).draw(plot)
    plot.line([outcome.truth[at]["r1"] for at in sorted(outcome.truth)], BLUE, 2.5, name="true")
    for source, (name, color) in NAMES.items():
        places = [place for at in sorted(outcome.tracks[source]) for place in outcome.tracks[source][at].values()]
        plot.dots(places, color, 1.7, name=name)
    for x, y, heading in lab.poses("lasers.3dm"):
        turn = math.radians(heading)
        plot.line([(x, y), (x + 0.35 * math.cos(turn), y + 0.35 * math.sin(turn))], "#b42318", 3)
        plot.dots([(x, y)], "#b42318", 5)
    lab.svg("tracks.svg", plot.svg(), "Fig. 5.9 b: the true way of the robot and what the two sensors (red) make of it.")


def run(lab):
    lab.text("The robot of the experiment before drives once more, as simrun replays its record to the tracker of share/"
             "examples/tracker. The thesis finds big biases in the tracks of both sensors, for which it expects two "
             "reasons: the error grows when the target does not move in a line, and the model of the robot in the "
             "tracker does not match. Of the second: whoever takes the middle of what is seen for the robot's place is too near to the "
             "sensor. The joint tracker knows it as a disc of 0.2 m and follows it with both sensors.")
    lab.scene("ispace.env", "ispace.3dm")
    lab.given("two lasers, drawn as red arrows, track the simulated robot", "section 5.2.2, fig. 5.6 and 5.9 b")
    lab.assumption("Where the lasers stand; their range of 8 m; that the thesis' tracker takes the middle of what a "
                   "sensor sees for the robot's place.")
    lab.assumption("Ranges have no noise; it is one drive.")
    lab.tool("envc", "ispace.env", "--slice", "0.1", "--resolution", "0.02", "--to", "ros", "-o", "map.yaml")
    with lab.serve("ispace.env", "ispace.3dm", "--clock", "step", "--record", "run") as port:
        lab.tool("avoid", "map.yaml", "0.5,2,-90", "0.5,-2", "-rrtp", port)
    lab.shell("grep -v 'on=r1' ispace.3dm > lasers.3dm")
    with lab.serve("--replay", "run", "ispace.env", "ispace.3dm", "--clock", "step", "--hold") as port:
        lab.tool("tracker", port, "lasers.3dm", "--until", 12, "-o", "tracks.csv")
    outcome = Outcome(lab, "tracks.csv", "run", begin=0)
    for source, (name, _) in NAMES.items():
        verdict = outcome.verdicts[source]
        lab.row(f"Mean error of the place, {name}", None if source == "joint" else "biased", verdict.mean, "m",
                digits=3, bound=(0, 0.1) if source == "joint" else (0.1, 0.4))
        lab.row(f"95th percentile of the errors, {name}", None, verdict.percentile95, "m", digits=3,
                bound=(0, 0.13) if source == "joint" else None)
        lab.row(f"Followed, {name}", None, 100 * verdict.followed, "% of the time", digits=0,
                bound=(98, 100) if source == "joint" else None)
    late = Outcome(lab, "tracks.csv", "run", begin=2).verdicts["joint"]
    lab.row("95th percentile of the errors, both, from 2 s on", None, late.percentile95, "m", digits=3, bound=(0, 0.1),
            note="Before, the robot still covers the place where it stood at first, which the tracker took for background.")
    lab.require(outcome.verdicts["joint"].switches == 0, "the robot has several joint tracks")
    draw(lab, outcome)

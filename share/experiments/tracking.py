# SPDX-License-Identifier: GPL-3.0-or-later
"""Two people walk across each other's way; two lasers track them, each on its own and together."""

import math
import random
import shutil

from lab import Port
from judging import Outcome, summary
from plot import BLUE, ORANGE, Plot
import ways

TITLE = "Tracking of two people by distributed lasers"
SOURCE = "section 5.3.2, fig. 5.14 and 5.15"
SECONDS = 20

PEOPLE = """#3dm 1
human id=left at=-1.1,1.1 heading=-90 path=-1.1,-0.9;-1.1,1.1 loop=yes
human id=right at=0.6,0.3 heading=180 path=-1.9,0.4;0.6,0.3 loop=yes
"""
UNTIL = 60
COLORS = {"left": BLUE, "right": ORANGE}
SOURCES = (("laser1", "Nearest neighbour, the right sensor alone"),
           ("laser2", "Nearest neighbour, the left sensor alone"),
           ("joint", "Global nearest neighbour, both sensors"))


def scene(lab):
    lab.scene("tracking.env")
    lab.given("two people; the left one walks up and down, the right one to and fro, across each other's way",
              "section 5.3.2, fig. 5.14")
    lab.given("two lasers of 180 degrees and 3 m, placed along the walls", "section 5.3.2, table 5.2")
    lab.assumption("Where exactly people walk; each walks for a minute at 0.6 to 1 m/s and pauses for 0.2 to 1 s at the "
                   "ends, drawn from the seed. They step aside for each other, as people of simrun do.")
    lab.assumption("Ranges have noise of 10 mm (standard deviation); 10 scans a second.")
    lab.assumption("The tracker of the thesis is described in another paper; ours for it takes the person nearest to "
                   "where each track expects its own, within 1 m, for each sensor apart.")
    lab.tool("arrange", "tracking.env", "--sensor", "laser,range=3,fov=180,sigma=0.01:2", "--strategy", "wall",
             "--dist", "0.05", "--times", "11", "-q", "-o", "lasers.3dm")
    lab.write("people.3dm", PEOPLE)
    lab.shell("cat lasers.3dm people.3dm > both.3dm")


def gaits(seed):
    """Speeds and pauses of both, as words."""
    draw = random.Random(seed)
    return {f"{who}.{key}": f"{draw.uniform(*span):.2f}"
            for who in ("left", "right") for key, span in (("speed", (0.6, 1)), ("pause", (0.2, 1)))}


def show_walks(lab, count, tracker_layout):
    """The commands of this many walks, with speeds and pauses from gaits.txt."""
    keys = list(gaits(0))
    names = [key.replace(".", "_") for key in keys]
    sets = " ".join(f"--set {key}=${name}" for key, name in zip(keys, names))
    lab.command(f"head -n {count} gaits.txt | while read seed {' '.join(names)}; do\n"
                f"  envc both.3dm {sets} --to 3dm -o walk.3dm\n"
                "  simrun tracking.env walk.3dm --clock step --noise --seed $seed --record run --listen "
                f"127.0.0.1:{Port.SHOWN} & sleep 1\n"
                f"  tracker {Port.SHOWN} {tracker_layout} --until {UNTIL} -o tracks.csv; kill $!; wait\n"
                "  python3 $ISPACE/share/examples/tracker/judge_tracks.py tracks.csv run\ndone")


def walk(lab, seed, shown, tracker_layout="both.3dm"):
    """Two people walk for a minute; the tracker follows them."""
    sets = [word for key, value in gaits(seed).items() for word in ("--set", f"{key}={value}")]
    lab.tool("envc", "both.3dm", *sets, "--to", "3dm", "-o", "walk.3dm", shown=shown)
    with lab.serve("tracking.env", "walk.3dm", "--clock", "step", "--noise", "--seed", seed, "--record", "run",
                   shown=shown) as port:
        lab.tool("tracker", port, tracker_layout, "--until", UNTIL, "-o", "tracks.csv", shown=shown)
    outcome = Outcome(lab, "tracks.csv", "run")
    if not shown:
        shutil.rmtree(lab.path("run"))
    return outcome


def owner(outcome, source, at, track):
    """The person that a track follows then: the nearest within a quarter of a metre."""
    place, people = outcome.tracks[source][at][track], outcome.truth[at]
    who = min(people, key=lambda one: math.dist(people[one], place))
    return who if math.dist(people[who], place) <= 0.25 else None


def lives(outcome, source, begin=3):
    """The tracks that follow `left` at first, each as [(owner, point)]."""
    found = {}
    for at in sorted(outcome.tracks[source]):
        for track, place in outcome.tracks[source][at].items():
            if at >= 1000 * begin and at in outcome.truth:
                found.setdefault(track, []).append((owner(outcome, source, at, track), place))
    return [life for life in found.values() if next((who for who, _ in life if who), None) == "left"]


def mixture(life):
    """The number of points of a track that belong to the person it follows less."""
    return min(sum(one == who for one, _ in life) for who in COLORS)


def room(lab, title):
    plot = Plot((-2.6, 1.1), (-1.5, 1.65), title, "x in m", "y in m", width=480, equal=True)
    ways.Obstacles(lab, "tracking.env", 0.15).draw(plot, fill="#d7c3ae")
    for k, (x, y, heading) in enumerate(lab.poses("lasers.3dm"), 1):
        plot.dots([(x, y)], "#b42318", 5)
        turn = math.radians(heading)
        plot.line([(x, y), (x + 0.25 * math.cos(turn), y + 0.25 * math.sin(turn))], "#b42318", 2)
        plot.words(x, y, f"laser {k}", "#b42318", size=11, dy=-8)
    return plot


def draw_paths(lab, outcome):
    plot = room(lab, "")
    for who, color in COLORS.items():
        places = [outcome.truth[at][who] for at in sorted(outcome.truth) if at % 100 == 0]
        plot.line(places, color, 1, name=f"{who} person")
    lab.svg("paths.svg", plot.svg(), "Fig. 5.14: where the two people walk in a minute; they step aside where they meet.")


def draw_track(lab, life, name, caption):
    plot = room(lab, "")
    for who, color in COLORS.items():
        plot.dots([place for one, place in life if one == who], color, 2, name=f"while it follows the {who} person")
    plot.dots([place for one, place in life if one is None], "#8b949e", 2, name="nobody is there")
    lab.svg(name, plot.svg(), caption)


def run(lab):
    lab.text("arrange places two lasers, simrun lets two people walk, and share/examples/tracker follows them over TCP. "
             "In the thesis a sensor's track of the left person takes up the right one where they meet: one hides "
             "the other, and the track goes on with whom it still sees. (That one hides the other is what ours does; the thesis says that the algorithm "
             "cannot tell who is who when two people meet.) Shared out among all tracks at once, "
             "the legs stay with their owners, even with one sensor; the second one halves the errors.")
    scene(lab)
    outcomes = [walk(lab, seed, shown=seed == 0) for seed in lab.seeds(20, 2)]
    lab.command("python3 $ISPACE/share/examples/tracker/judge_tracks.py tracks.csv run")
    lab.write("gaits.txt", "".join(f"{seed} {' '.join(gaits(seed).values())}\n" for seed in range(len(outcomes))))
    show_walks(lab, len(outcomes), "both.3dm")
    for source, what in SOURCES:
        joint = source == "joint"
        summary(lab, what, [outcome.verdicts[source] for outcome in outcomes],
                thesis_switches="“many times”" if source == "laser1" else None,
                switches=(0, 0) if joint else None, mean=(0, 0.05) if joint else None,
                followed=(98, 100) if joint else None, most=(0, 0.1) if joint else None)
    mixed = sum(outcome.verdicts["laser1"].switches for outcome in outcomes)
    lab.require(mixed >= len(outcomes), "the tracker of the thesis mixes nobody up")
    lab.shell("grep -v 'id=laser2' lasers.3dm > one.3dm")
    alone = [walk(lab, seed, False, "one.3dm").verdicts["joint"] for seed in lab.seeds(10, 1)]
    show_walks(lab, len(alone), "one.3dm")
    summary(lab, "Global nearest neighbour, the right sensor alone", alone)
    shown = max(outcomes, key=lambda outcome: max(map(mixture, lives(outcome, "laser1"))))
    draw_paths(lab, shown)
    mixed_life = max(lives(shown, "laser1"), key=mixture)
    draw_track(lab, mixed_life, "mixed.svg", "Fig. 5.15: one track of the right sensor, which began with the left "
               "person: it seems to walk down and across.")
    life = max(lives(shown, "joint"), key=len)
    draw_track(lab, life, "joint.svg", "The track of the left person with both sensors and joint association.")
    lab.require(mixture(mixed_life) > 5, "no track of the right sensor mixes the two up")
    lab.require(mixture(life) == 0, "the joint track goes over to the other person")

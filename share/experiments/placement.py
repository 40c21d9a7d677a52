# SPDX-License-Identifier: GPL-3.0-or-later
"""Lasers placed by area and by tracks: which lets the tracker lose people less, in runs that the search did not see."""

import random
import shutil
import statistics

from lab import Port

TITLE = "Lasers placed for area and for trackers"
SOURCE = "section 5.3.2, fig. 5.14, with the lasers of chapter 4"
SECONDS = 90

UNTIL = 120      # seconds of a run; a third of it in quick experiments
TRAINING = 1200  # seconds of the run that the search by tracks knows; a third of it in quick experiments
SEEDS = 12       # of the held-out runs
# Name, unit and decimals of a figure, and its value in the report of coverage --tracks.
FIGURES = (
    ("unseen", "%", 1, lambda judged: 100 * judged["by_sensors"][0]["truths"] / judged["truths"]),
    ("MOTA", "%", 1, lambda judged: 100 * judged["mota"]),
    ("IDF1", "%", 1, lambda judged: 100 * judged["idf1"]),
    ("HOTA", "%", 1, lambda judged: 100 * judged["hota"]),
    ("switches", "", 1, lambda judged: judged["switches"]),
)
KINDS = ("area", "track")


class Case:
    """A room, its people, and the lasers to place along its walls."""

    def __init__(self, name, title, room, sensors, people, places=None, walkers=None):
        self.name, self.title, self.room, self.sensors = name, title, room, sensors
        self.people = people    # records, without motion if there are errands
        self.places = places    # for errands: each person goes from one to another at random
        self.walkers = walkers  # for ways to and fro: speeds and pauses are drawn

    def motion(self, lab, seed, until):
        """Writes people.3dm, and script.txt for errands. The walkers' gait and the errands are drawn from the seed."""
        draw = random.Random(f"{self.name} {seed}")
        people = self.people
        if self.walkers:
            for one in self.walkers:
                people = people.replace(f"id={one}", f"id={one} speed={draw.uniform(0.6, 1.2):.2f} "
                                                     f"pause={draw.uniform(0.2, 2):.2f}")
        _write(lab, "people.3dm", people)
        lines = []
        for one in _ids(people) if self.places else ():
            at, here = draw.uniform(0, 3), None
            while at < until:
                here = draw.choice([place for place in self.places if place != here])
                lines.append((at, f"{at:.1f} {one} GOTO {here}"))
                at += draw.uniform(8, 16)
        _write(lab, "script.txt", "".join(line + "\n" for _, line in sorted(lines)))
        return ("--script", "script.txt") if self.places else ()


def _write(lab, name, text):
    with open(lab.path(name), "w", encoding="utf-8") as file:
        file.write(text)


def _ids(people):
    return [word[3:] for word in people.split() if word.startswith("id=")]


FOYER = """#env 1
ispace   id=foyer size=12,8,2.8
pillar   id=pillar1 at=-1.5,0.5 size=0.5,0.5
pillar   id=pillar2 at=2,-1.5 size=0.5,0.5
cube     id=counter at=4.4,2.6 size=2.4,0.8,1.1
cube     id=display at=0.6,3 size=0.4,1.6,2
"""

CASES = (
    Case("foyer", "two people to and fro, across each other's way", "foyer.env", "laser,range=5,fov=180,step=0.25:1",
         "#3dm 1\nhuman id=left at=-5,-2.5 path=1,-0.5;-5,-2.5 loop=yes\n"
         "human id=right at=-3,2.5 path=-2.5,-3.2;-3,2.5 loop=yes\n", walkers=("left", "right")),
    Case("office", "errands of three people", "office.yaml", "laser,range=4,fov=180,step=0.25:1",
         "#3dm 1\nhuman id=ann at=2.5,2 speed=1\nhuman id=bob at=5,0.8 speed=0.8\nhuman id=eve at=2.6,3.3 speed=1.1\n",
         places=("5,0.8", "2.4,3.7", "2.2,2.2", "0.8,3", "3.6,1.4", "3.4,3.4")),
    Case("open office", "errands of four people", "open-office.env", "laser,range=5,fov=180,step=0.25:3",
         "#3dm 1\nhuman id=ann at=-6,-3.2 speed=1\nhuman id=bob at=-4.1,4 speed=0.8\n"
         "human id=eve at=2.9,-1.8 speed=1.1\nhuman id=tom at=4.2,2 speed=0.9\n",
         places=("-6,-3.2", "-4.1,3.9", "2.9,-1.8", "4.2,2", "-2.4,-1.6", "5.8,-1.4")),
    Case("laboratory", "four wanderers", "ispace.env", "laser,range=5,fov=180,step=0.25:3",
         "#3dm 1\nhuman id=ann at=-3,-2.5 walk=wander speed=0.8\nhuman id=bob at=3,2.5 walk=wander speed=1\n"
         "human id=eve at=-3,2.5 walk=wander speed=0.9\nhuman id=tom at=3,-2.5 walk=wander speed=0.7\n"),
)


def seconds(lab, time):
    return time // 3 if lab.quick else time


def train(lab, case):
    """Records the run that the search by tracks knows, and places the lasers in two ways."""
    if case.room == "foyer.env":
        lab.write("foyer.env", FOYER)
    else:
        lab.scene(case.room)
    script = case.motion(lab, "training", seconds(lab, TRAINING))
    lab.tool("simrun", case.room, "people.3dm", *script, "--clock", "fast", "--until", seconds(lab, TRAINING), "--seed",
             1000, "--record", "train", "-q")
    common = (case.room, "--sensor", case.sensors.replace(":", ",sigma=0.01:"), "--mount", "wall", "--candidates",
              "0.25,0.25,24")
    lab.tool("arrange", *common, "-o", "area.3dm")
    lab.tool("arrange", *common, "--objective", "track", "--ways", "train", "-o", "track.3dm")
    finding = next(line for line in lab.talk.splitlines() if "people are lost" in line)
    shutil.rmtree(lab.path("train"))
    return finding.removeprefix("arrange: ")


def judge(lab, case, layout, seed, shown):
    """The figures of the tracker with a layout in a held-out run."""
    script = case.motion(lab, seed, seconds(lab, UNTIL))
    _write(lab, "both.3dm", lab.read(layout) + lab.read("people.3dm").split("\n", 1)[1])
    with lab.serve(case.room, "both.3dm", *script, "--clock", "step", "--noise", "--seed", seed, "--record", "run",
                   shown=shown) as port:
        lab.tool("tracker", port, "both.3dm", "--until", seconds(lab, UNTIL), "-o", "all.csv", shown=shown)
    with open(lab.path("all.csv"), encoding="utf-8") as file:
        rows = [line for k, line in enumerate(file) if k == 0 or line.split(",")[1] == "joint"]
    _write(lab, "tracks.csv", "".join(rows))
    figures = lab.json("coverage", "--run", "run", "--tracks", "tracks.csv", "--truths", "people", shown=shown)
    shutil.rmtree(lab.path("run"))
    return figures


def half_interval(values):
    """Half of the 95 % interval of the mean, by Student's distribution."""
    if len(values) < 2:
        return 0
    quantiles = {1: 12.71, 2: 4.30, 3: 3.18, 4: 2.78, 5: 2.57, 6: 2.45, 7: 2.36, 8: 2.31, 9: 2.26, 10: 2.23, 11: 2.20}
    quantile = quantiles.get(len(values) - 1, 1.96 + 2.6 / (len(values) - 1))
    return quantile * statistics.stdev(values) / len(values) ** 0.5


def spread(values, digits):
    return f"{statistics.fmean(values):.{digits}f} ± {half_interval(values):.{digits}f}"


def run(lab):
    lab.text("arrange places the same lasers twice along the walls of a room: so that they see most floor, and so that "
             "trackers lose least of the people of a recorded run (--objective track). The tracker of share/examples "
             "then follows people in other runs, of other seeds, and coverage --tracks judges it. Means over the runs, "
             "± half of the 95 % interval; that of a difference is of the pairs of runs of one seed. `unseen` is the "
             "share of people's time at which no laser sees their place, as if they did not hide each other.")
    lab.given("people cross each other's way, and a tracker of laser scans confuses them", "section 5.3.2, fig. 5.14")
    lab.given("lasers placed so that they cover most floor", "chapter 4")
    lab.assumption(f"Rooms, people and their errands; runs of {seconds(lab, UNTIL)} s, with noise of 10 mm; the search "
                   f"knows a run of {seconds(lab, TRAINING)} s with another seed.")
    table = ["| room, people | lasers placed by | " + " | ".join(name for name, *_ in FIGURES) + " |",
             "|---|---|" + "---|" * len(FIGURES)]
    for case in CASES:
        finding = train(lab, case)
        lab.text(f"{case.title[0].upper()}{case.title[1:]}, {case.room}, {case.sensors}: {finding}.")
        runs = {kind: [judge(lab, case, f"{kind}.3dm", seed, shown=seed == 0 and kind == "track" and case is CASES[0])
                       for seed in lab.seeds(SEEDS)] for kind in KINDS}
        cells = {kind: [] for kind in (*KINDS, "difference")}
        for name, unit, digits, value in FIGURES:
            values = {kind: [value(judged) for judged in runs[kind]] for kind in KINDS}
            values["difference"] = [b - a for a, b in zip(values["area"], values["track"])]
            for kind, found in values.items():
                what = f"by {kind}" if kind in KINDS else "by track less by area"
                lab.row(f"{case.name}, {what}: {name}", None, statistics.fmean(found), unit, digits=digits,
                        note=f"± {half_interval(found):.{digits}f}")
                cells[kind].append(spread(found, digits))
        for kind, words in cells.items():
            first = f"{case.name}, {case.title}" if kind == "area" else ""
            table.append(f"| {first} | {kind} | " + " | ".join(words) + " |")
        if case.name == "open office" and not lab.quick:  # three short runs say little
            gains = [b["mota"] - a["mota"] for a, b in zip(runs["area"], runs["track"])]
            lab.require(statistics.fmean(gains) > half_interval(gains),
                        "placed for trackers, lasers track no better than placed for area")
    _write(lab, "table.md", "\n".join(table) + "\n")

# SPDX-License-Identifier: GPL-3.0-or-later
"""Three strategies arrange three lasers; figures of the thesis for each."""

import statistics

from lab import FITTED, MISSED, REPRODUCED
from plot import BLUE, GREEN, INK, ORANGE, PURPLE, Plot

TITLE = "Three strategies place three lasers"
SOURCE = "section 4.6, table 4.1, fig. 4.15 and 4.16"
SECONDS = 30

SENSORS = "laser,range=4,fov=180:3"
GRID = ("--strategy", "grid", "-X", "11", "-Y", "11", "--deg", "8")
WALL = ("--strategy", "wall", "--dist", "0.05", "--times", "21")
RANDOM = ("--strategy", "random", "--r1", "20", "--r2", "5", "--deg", "8")
THESIS = {"grid": 80.8, "random": 73.9, "wall": 80.6}
BEAMS = 181  # of a scan over 180 degrees, a beam each degree


def place(lab, room, file, *options, sensors=SENSORS, shown=True):
    lab.tool("arrange", room, "--sensor", sensors, *options, "-q", "-o", file, shown=shown)
    return lab.result(file)


def random_runs(lab, room, seeds, sensors=SENSORS):
    """The results for each seed."""
    lab.command(f"for seed in $(seq {seeds[0]} {seeds[-1]}); do arrange {room} --sensor {sensors} "
                f"{' '.join(RANDOM)} --seed $seed -q -o random-$seed.3dm; done")
    return [place(lab, room, f"random-{seed}.3dm", *RANDOM, "--seed", seed, sensors=sensors,
                  shown=False) for seed in seeds]


def median(results):
    """Of their coverages."""
    return statistics.median(result["coverage"] for result in results)


def table(lab):
    grid = place(lab, "facilities.env", "grid.3dm", *GRID)
    wall = place(lab, "facilities.env", "wall.3dm", *WALL)
    seeds = lab.seeds(101, 11)
    shares = [run["coverage"] for run in random_runs(lab, "facilities.env", seeds)]
    middle = statistics.median(shares)
    best = place(lab, "facilities.env", "best.3dm", "--optimize", "exact")
    lab.row("Ordinary Grid, X = Y = 11, Deg = 8: coverage", THESIS["grid"], grid["coverage"], "%",
            bound=(78.8, 82.8), verdict=FITTED,
            note="The room is fitted to these three figures, its drawing being lost.")
    lab.row("Along Wall, dist = 0.05 m, times = 21: coverage", THESIS["wall"], wall["coverage"], "%",
            bound=(78.6, 82.6), verdict=FITTED,
            note="Of the rooms that were tried this one comes nearest to all three figures.")
    lab.row(f"Hierarchical Random, R1 = 20, R2 = 5, Deg = 8: coverage, the median of {len(seeds)} seeds",
            THESIS["random"], middle, "%", bound=(69.9, 77.9), verdict=FITTED,
            note=f"The thesis had one run. Ours are from {min(shares):.1f} to {max(shares):.1f} %, and "
            f"{sum(1 for share in shares if share <= THESIS['random'])} of {len(shares)} are not above its figure.")
    lab.row("Order", "grid ≥ wall > random",
            " > ".join(name for _, name in sorted([(-grid["coverage"], "grid"), (-middle, "random"),
                                                   (-wall["coverage"], "wall")])),
            verdict=FITTED)
    lab.require(grid["coverage"] >= wall["coverage"] > middle, "the order is not grid ≥ wall > random")
    lab.row(f"Our best of {int(best['candidates'])} poses (--optimize exact): coverage", None, best["coverage"], "%")
    lab.row("No choice among them covers more than", None, best["bound"], "%",
            note="The bound is met: the best is proven.")
    lab.require(best["bound"] <= best["coverage"] + 0.01, "the best is not proven")
    return grid, wall, shares, best


def times(lab, grid, wall):
    lab.text("One beam was measured in each picture that the thesis drew, so its elapsed times count beams. "
             "What our candidates would have taken so, 181 beams each (how long they take here is in "
             "timings.csv):")
    for name, scans, rate, thesis, verdict, note in (
            ("Ordinary Grid", int(grid["candidates"]), 330, 520, REPRODUCED,
             "121 places with 8 headings, less those that stand in things; the thesis' time is that of 948."),
            ("Along Wall", int(wall["candidates"]), 320, 110, FITTED,
             "Fits if the first and the last third of a wall's places are tried with three headings, and "
             "those in the middle with one: the thesis asks for more at the ends of a wall."),
            ("Hierarchical Random", (20 + 5) * 8 * 3, 320, 230, MISSED,
             "The thesis' time is that of 407 scans; 25 places with 8 headings for each of three sensors are "
             "600. It does not say what it saved.")):
        lab.row(f"{name}: {scans} scans at {rate} beams a second", thesis, scans * BEAMS / rate, "s",
                note=note, digits=0, verdict=verdict)


def seeds_plot(lab, grid, wall, shares, best):
    plot = Plot((0, len(shares) - 1), (60, 95), "Coverage by strategy", "seeds of Hierarchical Random, sorted",
                "coverage in %")
    for share, color, name in ((best["coverage"], INK, f"best, proven: {best['coverage']:.1f} %"),
                               (grid["coverage"], BLUE, f"Ordinary Grid: {grid['coverage']:.1f} %"),
                               (wall["coverage"], GREEN, f"Along Wall: {wall['coverage']:.1f} %")):
        plot.line([(0, share), (len(shares) - 1, share)], color, 2, name=name)
    plot.dots(list(enumerate(sorted(shares))), ORANGE, 3, name="Hierarchical Random")
    plot.line([(0, THESIS["random"]), (len(shares) - 1, THESIS["random"])], PURPLE, 1.5, "6 4",
              name="random in the thesis: 73.9 %")
    lab.svg("seeds.svg", plot.svg(), "Hierarchical Random depends on its seed; the other two do not.")


def maps(lab, middle_seed):
    for file, what in (("grid", "Fig. 4.16 a: Ordinary Grid."),
                       (f"random-{middle_seed}", "Fig. 4.16 b: Hierarchical Random, the seed in the middle."),
                       ("wall", "Fig. 4.16 c: Along Wall."), ("best", "The best there is, proven.")):
        lab.tool("coverage", "facilities.env", f"{file}.3dm", "--color", "sensor", "--width", "600",
                 "-o", f"{file}.png")
        lab.picture(f"{file}.png", what)


def cluttered_walls(lab):
    lab.text("Along Wall fails where things stand along the walls (section 4.6.2). In a room of 9.6 m by 9.6 m "
             "with desks and cupboards along its walls:")
    seeds = lab.seeds(21, 3)
    grid = place(lab, "crowded.env", "crowded-grid.3dm", *GRID)["coverage"]
    wall = place(lab, "crowded.env", "crowded-wall.3dm", *WALL)["coverage"]
    random = median(random_runs(lab, "crowded.env", seeds))
    lab.row("Cluttered walls: Ordinary Grid", "better", grid, "%")
    lab.row("Cluttered walls: Hierarchical Random, median", "better", random, "%")
    lab.row("Cluttered walls: Along Wall", "not well", wall, "%")
    lab.require(wall < min(grid, random), "Along Wall is not the worst where walls are cluttered")


def wide_views(lab):
    lab.text("Along Wall wastes a field of view beyond 180 degrees (section 4.6.2): its sensors face away from "
             "the wall, and arrange warns of it. In the room of table 4.1:")
    seeds = lab.seeds(21, 3)
    for fov in (240, 270):
        sensors = f"laser,range=4,fov={fov}:3"
        grid = place(lab, "facilities.env", f"grid-{fov}.3dm", *GRID, sensors=sensors)["coverage"]
        wall = place(lab, "facilities.env", f"wall-{fov}.3dm", *WALL, sensors=sensors)["coverage"]
        random = median(random_runs(lab, "facilities.env", seeds, sensors))
        lab.row(f"{fov}°: Ordinary Grid", "exceeds", grid, "%")
        lab.row(f"{fov}°: Hierarchical Random, median", "exceeds", random, "%")
        lab.row(f"{fov}°: Along Wall", "exceeded by both", wall, "%")
        lab.require(wall < min(grid, random), f"Along Wall is not the worst at {fov} degrees")


def wide_rooms(lab):
    lab.text("Hierarchical Random takes as long in any room, while the grid has places in proportion to the "
             "floor (section 4.6.2). In empty square rooms, with the default of eq. 4.1 and 4.2 for the grid:")
    seeds = lab.seeds(21, 3)
    for side in (8, 16, 32):
        room = f"room-{side}.env"
        lab.write(room, f"#env 1\nispace size={side},{side},2.5\n")
        grid = place(lab, room, f"grid-{side}.3dm", "--strategy", "grid")
        wall = place(lab, room, f"wall-{side}.3dm", *WALL)
        runs = random_runs(lab, room, seeds)
        random = median(runs)
        lab.row(f"{side} m: Ordinary Grid, {int(grid['candidates'])} scans", None, grid["coverage"], "%")
        lab.row(f"{side} m: Along Wall, {int(wall['candidates'])} scans", None, wall["coverage"], "%")
        wide = side > 8
        better = sum(random > other["coverage"] for other in (grid, wall))
        lab.row(f"{side} m: Hierarchical Random, {int(runs[0]['candidates'])} scans, median",
                "outperforms both" if wide else None, random, "%", verdict=REPRODUCED if better == 2 else MISSED,
                note="" if not wide else f"Better than {('neither', 'one', 'both')[better]} of the other two: in an "
                "empty wide room three sensors anywhere cover nearly the same. What random does not need there is "
                "more scans.")


def run(lab):
    lab.text("Three lasers are placed in a room with many facilities, by each strategy of the thesis with the "
             "parameters of its table, and by our exact search.")
    lab.scene("facilities.env", "crowded.env")
    lab.given("three lasers with an effective distance of 4 m and a range of 180 degrees", "section 4.6.1")
    lab.given("X = Y = 11, Deg = 8; R1 = 20, R2 = 5, Deg = 8; dist = 0.05 m, times = 21", "table 4.1")
    lab.given("100 x 100 cells, coverage by cells", "sections 4.5.2 and 4.5.3")
    lab.assumption("The cluttered room (crowded.env) and the empty wide rooms; that a disc of a fifth of the range "
                   "is the scope of R2; that random draws anew for each sensor; that walls "
                   "are mostly free in the room of the table, where Along Wall does well (section 4.6.2); that one beam is "
                   "one picture, as section 3.4.3 i has it: so we read the average FPS of table 4.1.")
    lab.fitted("The room facilities.env: 8 m by 8 m like the ZPS zone, things of kinds that the thesis has, at "
               "places found by search so that the three coverages and their order come out.")
    lab.fitted("That a third of a wall's places counts as its end: read off the thesis' times.")
    lab.tool("scan", "facilities.env", "--view", "orbit", "--size", "900,600", "-o", "room.png")
    lab.picture("room.png", "The room that stands for fig. 4.15.")
    grid, wall, shares, best = table(lab)
    middle = sorted(range(len(shares)), key=lambda seed: shares[seed])[len(shares) // 2]
    maps(lab, middle)
    seeds_plot(lab, grid, wall, shares, best)
    times(lab, grid, wall)
    cluttered_walls(lab)
    wide_views(lab)
    wide_rooms(lab)

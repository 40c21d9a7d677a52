# SPDX-License-Identifier: GPL-3.0-or-later
"""Two real lasers look at a desk between four barriers."""

import json
import statistics

TITLE = "Two laser range finders, four barriers and a desk"
SOURCE = "section 3.4.8 i and ii, fig. 3.23 to 3.25"
SECONDS = 4

CUT = 3.0  # metres, to which the thesis cuts its sensors


def ranges(lab, file):
    """Lists of ranges by sensor; None is no return."""
    found = {}
    for line in lab.read(file).splitlines()[1:]:
        reading = json.loads(line)
        found.setdefault(reading["sensor"], []).append(reading["ranges"])
    return found


def scene(lab):
    lab.scene("barriers.env", "barriers.3dm")
    lab.given("a range of 180 degrees; the left sensor, of up to 30 m, is cut to 3 m; both are turned "
              "by 45 degrees and scan at some 0.15 m", "section 3.4.8 i")
    lab.given("four barriers; a desk of 1.2 m by 0.8 m, with the same contour from bottom to top",
              "section 3.4.8 i")
    lab.given("the left sensor is a UTM-30LX, the right one a URG-04LX", "fig. 3.10, section 3.4.8 i")
    lab.assumption("Where barriers, desk and sensors stand: the thesis shows it in a photograph only.")
    lab.assumption("A room of 8 m by 8 m around it, the size of the ZPS zone (section 5.2.2), and nothing "
                   "else in it.")
    lab.assumption("The range is 3 m for both (the section says 4 m first, then 3 m for the left one, of "
                   "which its obstacle maps are).")
    lab.tool("scan", "barriers.env", "barriers.3dm", "--show", "beams", "--view",
             "central:0,0,-120,48,6.4", "--size", "900,600", "-o", "scene.png")
    lab.picture("scene.png", "The scene of fig. 3.23 with the beams of both sensors.")


def obstacle_maps(lab):
    lab.tool("scan", "barriers.env", "barriers.3dm", "-o", "ideal.jsonl")
    lab.tool("scan", "barriers.env", "barriers.3dm", "--to", "png", "--size", "600", "-o", "ideal/")
    lab.tool("scan", "barriers.env", "barriers.3dm", "--noise", "--to", "png", "--size", "600",
             "-o", "noise/")
    lab.tool("envc", "barriers.3dm", "--set", "left.range=0.1,30", "--to", "3dm", "-o", "uncut.3dm")
    lab.tool("scan", "barriers.env", "uncut.3dm", "--select", "left", "-o", "uncut.jsonl")
    lab.tool("scan", "barriers.env", "uncut.3dm", "--select", "left", "--noise", "--to", "png",
             "--size", "600", "-o", "uncut/")
    lab.picture("ideal/left-0000.png", "Fig. 3.24 a: the left sensor, cut at 3 m, without noise.")
    lab.picture("noise/left-0000.png", "The same with the noise of the device.")
    lab.picture("uncut/left-0000.png", "Fig. 3.24 b: the left sensor uncut, with noise. What the real one "
                "showed beyond the barriers is the room here.")
    lab.picture("ideal/right-0000.png", "Fig. 3.25 a: the right sensor, cut at 3 m, without noise.")
    lab.picture("noise/right-0000.png", "Fig. 3.25 b: the right sensor with the noise of the device.")


def returns(lab):
    ideal, uncut = ranges(lab, "ideal.jsonl"), ranges(lab, "uncut.jsonl")
    far = sum(1 for r in uncut["left"][0] if r is not None and r > CUT)
    lab.row("Left sensor, cut: beams that return from beyond 3 m", 0,
            sum(1 for r in ideal["left"][0] if r is not None and r > CUT), bound=(0, 0))
    lab.row("Left sensor, uncut: beams that return from beyond 3 m", "some", far,
            bound=(1, float("inf")),
            note="The real sensor was not cut, so its map has more on one side: the thesis finds the shape "
            "of a barrier and scattered points there, from what stood around.")
    near = [(a, b) for a, b in zip(ideal["left"][0], uncut["left"][0]) if a is not None]
    lab.row("Within 3 m the cut and the uncut sensor differ by", "almost the same",
            max(abs(a - b) for a, b in near), "m", bound=(0, 0), digits=3)


def noise(lab):
    """The spread over many scans, against the devices' data sheets."""
    frames = len(lab.seeds(400, 40))
    lab.tool("scan", "barriers.env", "barriers.3dm", "--noise", "--frames", frames, "-o", "many.jsonl")
    ideal, noisy = ranges(lab, "ideal.jsonl"), ranges(lab, "many.jsonl")
    for sensor, model, most in (("left", "UTM-30LX", 0.03), ("right", "URG-04LX", 0.03)):
        errors = [r - true for scan in noisy[sensor] for r, true in zip(scan, ideal[sensor][0])
                  if r is not None and true is not None]
        lab.row(f"{model}: standard deviation of a range over {frames} scans", None,
                1000 * statistics.pstdev(errors), "mm", bound=(1, 1000 * most), digits=1)
        lab.row(f"{model}: mean error of a range", None, 1000 * statistics.fmean(errors), "mm",
                bound=(-5, 5), digits=1)


def run(lab):
    lab.text("Two laser range finders look at a desk between four barriers. The thesis compares the maps "
             "of obstacles that the simulated and the real sensors made: nearly the same to scale, apart "
             "from what the real ones saw beyond the limit of the simulated ones.")
    scene(lab)
    obstacle_maps(lab)
    returns(lab)
    noise(lab)

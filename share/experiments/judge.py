# SPDX-License-Identifier: GPL-3.0-or-later
"""A search that may look at a room from outside."""

TITLE = "The Insider Judge, on and off"
SOURCE = "section 4.4.4, fig. 4.8 and 4.9"
SECONDS = 2


def run(lab):
    lab.text("One laser is placed in an L-shaped room by Ordinary Grid, with the Insider Judge and without. "
             "Without it a place outside of the room wins, because nothing stands there.")
    lab.scene("l-room.env")
    lab.given("an L-shaped room; a laser with an effective distance of 4 m; the outside wins without the judge",
              "section 4.4.4")
    lab.given("eight headings at each place", "section 4.4.2")
    lab.assumption("Both arms of the L are 8 m long and 2 m wide; the range is 180 degrees; 11 by 11 places.")
    area, inside = {}, {}
    for judge in ("no", "yes"):
        file = f"judge-{judge}.3dm"
        lab.tool("arrange", "l-room.env", "--sensor", "laser,range=4,fov=180", "--strategy", "grid", "-X", "11",
                 "-Y", "11", "--deg", "8", "--judge", judge, "-q", "-o", file)
        report = lab.json("coverage", "l-room.env", file, "-q", "-o", f"judge-{judge}.png", "--width", "600")
        area[judge] = report["sensors"][0]["exact_area"]
        x, y, _ = lab.poses(file)[0]
        inside[judge] = -1 < x < 7 and -1 < y < 7 and (x < 1 or y < 1)
        state = "on" if judge == "yes" else "off"
        lab.row(f"Judge {state}: the best place", "inside" if judge == "yes" else "outside",
                f"{'inside' if inside[judge] else 'outside'}, at ({x:.2f}, {y:.2f})".replace("-", "−"))
        lab.row(f"Judge {state}: area seen from there", None, area[judge], "m²")
        lab.row(f"Judge {state}: coverage of the room", None, 100 * report["coverage"]["exact"], "%",
                bound=(0, 0) if judge == "no" else (40, 100))
    lab.row("What is seen from outside is larger by", "larger", area["no"] - area["yes"], "m²",
            bound=(0.1, float("inf")))
    lab.require(inside["yes"] and not inside["no"], "a place is on the wrong side of the walls")
    lab.picture("judge-no.png", "Fig. 4.8: without the Insider Judge the laser stands outside.")
    lab.picture("judge-yes.png", "With it, at the same places and headings.")

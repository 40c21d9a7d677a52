# SPDX-License-Identifier: GPL-3.0-or-later
"""Distributed cameras and their pictures."""

TITLE = "Distributed cameras"
SOURCE = "section 3.4.3 ii, fig. 3.15"
SECONDS = 25

CAMERAS = ("c1", "c2", "c3", "c4")
SEEN = ("r1", "r2", "h1")


def pixels(lab, camera):
    """How many pixels of a picture show which record."""
    rows = lab.read(f"seen/{camera}-0000-labels.csv").splitlines()
    head = rows[0].split(",")
    table = [dict(zip(head, row.split(","))) for row in rows[1:]]
    return {row["id"]: int(row["pixels"]) for row in table}


def run(lab):
    lab.text("Four cameras look over the Intelligent Space from its corners. The thesis shows their view cubes and "
             "the picture of each; here are also the floor that each sees, and who is in which picture.")
    lab.scene("ispace.env", "distributed.3dm")
    lab.given("cameras distributed in the Intelligent Space, their view cubes and pictures", "fig. 3.15")
    lab.given("Canon VC-C4R cameras", "table 2.1")
    lab.assumption("How many cameras, where, how tilted; the robots and the person between them.")
    lab.tool("scan", "ispace.env", "distributed.3dm", "--show", "beams", "--view", "orbit", "--size", "900,675",
             "-o", "views.png")
    lab.tool("scan", "ispace.env", "distributed.3dm", "--to", "png", "--layers", "labels", "-o", "seen/")
    report = lab.json("coverage", "ispace.env", "distributed.3dm", "-q")
    areas = {sensor["id"]: sensor["exact_area"] for sensor in report["sensors"]}
    lab.row("Floor that any camera sees", None, 100 * report["coverage"]["exact"], "%", bound=(50, 100))
    for camera in CAMERAS:
        counts = pixels(lab, camera)
        who = [f"{one} ({counts[one]} pixels)" for one in SEEN if counts.get(one)]
        lab.row(f"{camera}: floor in view", None, areas[camera], "m²",
                note=f"In its picture: {', '.join(who) or 'nobody'}.")
        lab.require(areas[camera] > 10, f"{camera} sees hardly any floor")
    lab.require(all(any(pixels(lab, camera).get(one) for camera in CAMERAS) for one in SEEN),
                "somebody is in no picture")
    lab.picture("views.png", "Fig. 3.15 a: the cameras, what they see as translucent cubes.")
    for camera in CAMERAS:
        lab.picture(f"seen/{camera}-0000.png", f"Fig. 3.15 b: the picture of {camera}.")

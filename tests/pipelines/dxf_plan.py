#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a small flat with ezdxf, for tests of the DXF import: dxf_plan.py FILE.dxf [mm|cm|m|inch]

The flat is 8 m x 6 m: walls of single lines on layer A-WALL, the outer one with a bay (a bulged
polyline of radius 1 m, half a disc of pi/2 m2) and a rounded corner (an arc of radius 1 m, which
takes 1 - pi/4 m2); three rooms joined by doors (blocks with leaf and swing on A-DOOR, one mirrored),
two windows on A-GLAZ, and a round pillar of radius 0.25 m (a circle, no floor) on A-WALL. What is no
plan stands on other layers and in paper space, and a shed apart at (20, 0).

The floor is 48 + pi/2 - (1 - pi/4) - pi/16 = 49.1597 m2.
"""
import math
import sys

import ezdxf
from ezdxf import units

UNITS = {"mm": (units.MM, 1000), "cm": (units.CM, 100), "m": (units.M, 1), "inch": (units.IN, 1 / 0.0254)}


def door_block(doc, s):
    """Hinged at the origin, across a gap along +x, drawn open towards +y."""
    block = doc.blocks.new("DOOR")
    block.add_line((0, 0), (0, 0.9 * s))
    block.add_arc((0, 0), 0.9 * s, 0, 90)


def draw(doc, s):
    msp = doc.modelspace()
    for name in ("A-WALL", "A-DOOR", "A-GLAZ", "A-ANNO", "FURNITURE"):
        doc.layers.add(name)
    wall, door, glass = ({"layer": name} for name in ("A-WALL", "A-DOOR", "A-GLAZ"))

    def line(a, b, attribs):
        msp.add_line((a[0] * s, a[1] * s), (b[0] * s, b[1] * s), dxfattribs=attribs)

    # The outer wall: two windows, a bay to the right, a rounded corner.
    line((0, 0), (2, 0), wall)
    line((3.5, 0), (8, 0), wall)
    msp.add_lwpolyline([(8 * s, 0, 0), (8 * s, 2 * s, 1), (8 * s, 4 * s, 0), (8 * s, 5 * s, 0)],
                       format="xyb", dxfattribs=wall)
    msp.add_arc((7 * s, 5 * s), 1 * s, 0, 90, dxfattribs=wall)
    line((7, 6), (2, 6), wall)
    line((0.5, 6), (0, 6), wall)
    msp.add_polyline2d([(0, 6 * s), (0, 3 * s), (0, 0)], dxfattribs=wall)
    for a, b in (((2, 0), (3.5, 0)), ((0.5, 6), (2, 6))):
        line(a, b, glass)

    # Inner walls with the gaps of two doors.
    line((4, 0), (4, 1), wall)
    line((4, 1.9), (4, 6), wall)
    line((4, 3), (5, 3), wall)
    line((5.9, 3), (8, 3), wall)
    # ... but the bay is part of both rooms' side: the wall ends at its middle.
    line((8, 3), (9, 3), wall)
    msp.add_blockref("DOOR", (4 * s, 1 * s), dxfattribs={**door, "rotation": 90})
    msp.add_blockref("DOOR", (5.9 * s, 3 * s), dxfattribs={**door, "xscale": -1})
    msp.add_circle((2 * s, 3 * s), 0.25 * s, dxfattribs=wall)

    # Files that are no plan, and parts outside of it.
    text = msp.add_text("flat", dxfattribs={"layer": "A-ANNO", "height": 0.2 * s})
    # Of ezdxf until 1.0, and since.
    (text.set_pos if hasattr(text, "set_pos") else text.set_placement)((s, s))
    msp.add_linear_dim(base=(0, -s), p1=(0, 0), p2=(8 * s, 0), dxfattribs={"layer": "A-ANNO"}).render()
    hatch = msp.add_hatch(dxfattribs={"layer": "A-ANNO"})
    hatch.paths.add_polyline_path([(0, 0), (s, 0), (s, s)], is_closed=True)
    msp.add_lwpolyline([(s, s), (2 * s, s), (2 * s, 2 * s)], close=True,
                       dxfattribs={"layer": "FURNITURE"})
    for a, b in (((20, 0), (21, 0)), ((21, 0), (21, 1)), ((21, 1), (20, 1)), ((20, 1), (20, 0))):
        line(a, b, wall)
    doc.layout("Layout1").add_line((0, 0), (9, 9), dxfattribs=wall)


def main():
    path = sys.argv[1]
    insunits, per_metre = UNITS[sys.argv[2] if len(sys.argv) > 2 else "mm"]
    doc = ezdxf.new("R2010", setup=True)
    doc.units = insunits
    doc.header["$INSUNITS"] = insunits
    door_block(doc, per_metre)
    draw(doc, per_metre)
    doc.saveas(path)


if __name__ == "__main__":
    assert math.isclose(48 + math.pi / 2 - (1 - math.pi / 4) - math.pi / 16, 49.1597, abs_tol=1e-3)
    main()

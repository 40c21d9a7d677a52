#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Drawings as programs write them, each with the floor area that another reader measures.

Draws a flat in the manner of LibreCAD, QCAD, FreeCAD, AutoCAD, Revit, ArchiCAD, magicplan, Inkscape,
Illustrator and Sweet Home 3D: their layers, units, kinds of entities, blocks and line widths, as their
manuals describe them. The right area is that of the room's corners by the shoelace formula; ezdxf (for
SVG: a bounding box of the element's own numbers) must find a line of the drawing along each side of the
room, so that the corners are those of the file and not of this script.

Rooms in the other formats come from formats.py.

Runs envc on each file and prints a table, and one by format: right, warned (wrong, with a warning), refused, or silent
(wrong without a word). Status 1 if a drawing has another result than `expected` says; 77 without ezdxf.
"""
import json
import math
import os
import re
import subprocess
import sys
import xml.etree.ElementTree

import formats

RESULTS = ("right", "warned", "silent", "refused")
TOLERANCE = 0.012  # of the area: a threshold counts as floor or as wall

# The flat, in metres: outer walls of 0.3 m, a partition of 0.12 m, a door in each, three windows.
WALLS = [
    [(1.9, 0), (9, 0), (9, 2.5), (8.7, 2.5), (8.7, .3), (5.12, .3), (5.12, 2), (5, 2), (5, .3), (1.9, .3)],
    [(9, 4), (9, 6.5), (7.5, 6.5), (7.5, 6.2), (8.7, 6.2), (8.7, 4)],
    [(6, 6.5), (3, 6.5), (3, 6.2), (5, 6.2), (5, 2.8), (5.12, 2.8), (5.12, 6.2), (6, 6.2)],
    [(1.5, 6.5), (0, 6.5), (0, 0), (1, 0), (1, .3), (.3, .3), (.3, 6.2), (1.5, 6.2)],
]
DOORS = [((5, 2), 180, 90, .8), ((1, .3), 90, 0, .9)]  # hinge, leaf's and latch's direction, width
WINDOWS = [(1.5, 6.2, 3, 6.5), (6, 6.2, 7.5, 6.5), (8.7, 2.5, 9, 4)]
FLOOR = [(.3, .3), (5, .3), (5, 2), (5.12, 2), (5.12, .3), (8.7, .3), (8.7, 6.2), (5.12, 6.2),
         (5.12, 2.8), (5, 2.8), (5, 6.2), (.3, 6.2)]
# The same with walls of one line.
AXES = [[(0, 0), (1, 0)], [(1.9, 0), (9, 0), (9, 6.5), (0, 6.5), (0, 0)], [(5, 0), (5, 2)],
        [(5, 2.8), (5, 6.5)]]
AXES_FLOOR = [(0, 0), (9, 0), (9, 6.5), (0, 6.5)]

BED = [(.4, 4.1), (2, 4.1), (2, 6.1), (.4, 6.1)]
SOFA = [(2.5, .3), (4.5, .3), (4.5, 1.2), (2.5, 1.2)]
KITCHEN = [(5.12, 5.6), (8.7, 5.6)]
STAIR = [[(7.5, .3 + .25 * i), (8.7, .3 + .25 * i)] for i in range(1, 8)]
UNITS = {"mm": 1000, "cm": 100, "m": 1, "inch": 1 / .0254, "foot": 1 / .3048, "dm": 10}
CLASSES = {"LINE": "AcDbLine", "LWPOLYLINE": "AcDbPolyline", "POLYLINE": "AcDb2dPolyline", "ARC": "AcDbCircle",
           "VERTEX": "AcDbVertex\n100\nAcDb2dVertex", "CIRCLE": "AcDbCircle", "INSERT": "AcDbBlockReference",
           "HATCH": "AcDbHatch", "MLINE": "AcDbMline", "TEXT": "AcDbText", "SPLINE": "AcDbSpline"}
INSUNITS = {"inch": 1, "foot": 2, "mm": 4, "cm": 5, "m": 6, "dm": 14}


def ends(hinge, leaf, latch, width):
    def at(degrees):
        return (hinge[0] + width * round(math.cos(math.radians(degrees)), 12),
                hinge[1] + width * round(math.sin(math.radians(degrees)), 12))
    return at(leaf), at(latch)


class Dxf:
    """Builds a file. Coordinates of its calls are metres, `unit` is that of the file."""

    def __init__(self, unit="mm", insunits=None, version="AC1015", offset=(0, 0)):
        self.scale, self.offset, self.is_r12 = UNITS[unit], offset, version == "AC1009"
        self.head = "9\n$ACADVER\n1\n%s\n" % version
        code = INSUNITS[unit] if insunits is None else insunits
        if code >= 0:
            self.head += "9\n$INSUNITS\n70\n%d\n" % code
        self.layers, self.blocks, self.entities = {}, "", ""

    def x(self, p, code=10):
        return "%d\n%.6f\n%d\n%.6f\n" % (code, (p[0] + self.offset[0]) * self.scale, code + 10,
                                        (p[1] + self.offset[1]) * self.scale)

    def add(self, kind, layer, rest):
        self.layers.setdefault(layer, (0, 7))
        mark = "100\nAcDbEntity\n8\n%s\n100\n%s\n" if kind in CLASSES and not self.is_r12 else "8\n%s\n"
        names = (layer, CLASSES[kind]) if kind in CLASSES and not self.is_r12 else (layer,)
        self.entities += "0\n%s\n" % kind + mark % names + rest

    def line(self, layer, a, b):
        self.add("LINE", layer, self.x(a) + self.x(b, 11))

    def lines(self, layer, corners, closed=True):
        for a, b in zip(corners, corners[1:] + (corners[:1] if closed else [])):
            self.line(layer, a, b)

    def poly(self, layer, corners, closed=True, width=0, bulges=()):
        if self.is_r12:
            return self.old_poly(layer, corners, closed)
        text = "90\n%d\n70\n%d\n" % (len(corners), closed)
        if width:
            text += "43\n%g\n" % (width * self.scale)
        for i, p in enumerate(corners):
            text += self.x(p)
            if i < len(bulges) and bulges[i]:
                text += "42\n%.9f\n" % bulges[i]
        self.add("LWPOLYLINE", layer, text)

    def old_poly(self, layer, corners, closed=True):
        self.add("POLYLINE", layer, "66\n1\n10\n0\n20\n0\n30\n0\n70\n%d\n" % closed)
        for p in corners:
            self.add("VERTEX", layer, self.x(p))
        self.add("SEQEND", layer, "")

    def arc(self, layer, center, radius, a, b):
        self.add("ARC", layer, self.x(center) + "40\n%.6f\n" % (radius * self.scale) +
                 ("" if self.is_r12 else "100\nAcDbArc\n") + "50\n%g\n51\n%g\n" % (a, b))

    def circle(self, layer, center, radius):
        self.add("CIRCLE", layer, self.x(center) + "40\n%.6f\n" % (radius * self.scale))

    def text(self, layer, p, words):
        self.add("TEXT", layer, self.x(p) + "40\n%g\n1\n%s\n" % (.25 * self.scale, words))

    def insert(self, layer, block, p=(0, 0), turn=0):
        self.add("INSERT", layer, "2\n%s\n%s50\n%g\n" % (block, self.x(p), turn))

    def solid_hatch(self, layer, corners):
        rest = "10\n0\n20\n0\n30\n0\n210\n0\n220\n0\n230\n1\n2\nSOLID\n70\n1\n71\n0\n91\n1\n92\n7\n72\n0\n73\n1\n"
        rest += "93\n%d\n" % len(corners) + "".join(self.x(p) for p in corners)
        self.add("HATCH", layer, rest + "97\n0\n75\n1\n76\n1\n98\n0\n")

    def block(self, name, draw, flags=0, path=""):
        """Adds a block of the entities that `draw` adds; an external reference if `path` is given."""
        outside, self.entities = self.entities, ""
        offset, self.offset = self.offset, (0, 0)
        draw()
        self.blocks += "0\nBLOCK\n8\n0\n2\n%s\n70\n%d\n10\n0\n20\n0\n30\n0\n3\n%s\n1\n%s\n%s0\nENDBLK\n8\n0\n" % (
            name, flags, name, path, self.entities)
        self.entities, self.offset = outside, offset

    def hide(self, layer, flags=0, color=7, plot=1):
        self.layers[layer] = (flags, color) + ((0,) if plot == 0 else ())

    def __str__(self):
        table = ""
        for name, state in self.layers.items():
            table += "0\nLAYER\n2\n%s\n70\n%d\n62\n%d\n6\nCONTINUOUS\n" % (name, state[0], state[1])
            table += "290\n0\n" if len(state) > 2 else ""
        section = "0\nSECTION\n2\n%s\n%s0\nENDSEC\n"
        text = section % ("HEADER", self.head)
        text += section % ("TABLES", "0\nTABLE\n2\nLAYER\n70\n%d\n%s0\nENDTAB\n" % (len(self.layers), table))
        return text + section % ("BLOCKS", self.blocks) + section % ("ENTITIES", self.entities) + "0\nEOF\n"


def flat(dxf, wall="0", door=None, window=None, style="lines", doors="lines"):
    """Draws the flat's walls, doors and windows; a layer that is None is that of the walls."""
    for corners in WALLS:
        {"lines": dxf.lines, "poly": dxf.poly, "old": dxf.old_poly}[style](wall, corners)
    for i, (hinge, leaf, latch, width) in enumerate(DOORS):
        open_end, _ = ends(hinge, leaf, latch, width)
        if doors == "blocks":
            turn, mirror = (leaf, latch - leaf)
            name = "Single-Flush-0%d00 x 2134mm-%d-Level 1" % (round(width * 10), 1000 + i)
            end, _ = ends((0, 0), 0, mirror, width)
            start, stop = (0, 90) if mirror > 0 else (270, 360)
            dxf.block(name, lambda: (dxf.line("0", (0, 0), end), dxf.arc("0", (0, 0), width, start, stop)))
            dxf.insert(door or wall, name, hinge, turn)
        elif doors == "lines":
            dxf.line(door or wall, hinge, open_end)
            dxf.arc(door or wall, hinge, width, min(leaf, latch), max(leaf, latch))
        elif doors == "leaf":  # a thin box, and the swing
            across = (.04, 0) if leaf == 90 else (0, .04)
            dxf.poly(door or wall, [hinge, open_end, (open_end[0] + across[0], open_end[1] + across[1]),
                                    (hinge[0] + across[0], hinge[1] + across[1])])
            dxf.arc(door or wall, hinge, width, min(leaf, latch), max(leaf, latch))
        elif doors == "boxes":  # the opening as a box in the wall, as of sliding doors
            box = [(5, 2), (5.12, 2), (5.12, 2.8), (5, 2.8)] if i == 0 else [(1, 0), (1.9, 0), (1.9, .3), (1, .3)]
            dxf.poly(door or wall, box)
    for x0, y0, x1, y1 in WINDOWS:
        dxf.poly(window or wall, [(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
        if x1 - x0 > y1 - y0:
            dxf.line(window or wall, (x0, (y0 + y1) / 2), (x1, (y0 + y1) / 2))
        else:
            dxf.line(window or wall, ((x0 + x1) / 2, y0), ((x0 + x1) / 2, y1))
    return dxf


def furniture(dxf, layer):
    dxf.poly(layer, BED)
    dxf.poly(layer, SOFA)
    dxf.line(layer, *KITCHEN)
    dxf.circle(layer, (7, 3), .6)


def dimensions(dxf, layer):
    """Lines across the rooms from wall to wall, and outside of them."""
    dxf.line(layer, (.3, 3.4), (5, 3.4))
    dxf.line(layer, (5.12, 3.6), (8.7, 3.6))
    dxf.line(layer, (3.6, .3), (3.6, 6.2))
    dxf.line(layer, (0, -1), (9, -1))
    dxf.line(layer, (0, 0), (0, -1.2))
    dxf.line(layer, (9, 0), (9, -1.2))


def axes(dxf, layer):
    for x in (.15, 5.06, 8.85):
        dxf.line(layer, (x, -2), (x, 8))
        dxf.circle(layer, (x, 8.3), .3)
    for y in (.15, 3.2, 6.35):
        dxf.line(layer, (-2, y), (11, y))


def frame(dxf, layer):
    dxf.poly(layer, [(-3, -4), (15, -4), (15, 9), (-3, 9)])
    dxf.poly(layer, [(10, -4), (15, -4), (15, -2), (10, -2)])


def librecad(unit="mm", insunits=None, **more):
    d = flat(Dxf(unit, insunits, "AC1021"), "Walls", "Doors", "Windows", **more)
    furniture(d, "Furniture")
    dimensions(d, "Dimensions")
    return d


def qcad():
    d = flat(Dxf("mm", None, "AC1021"), "Wände", "Türen", "Fenster", "poly")
    furniture(d, "Möbel")
    dimensions(d, "Bemaßung")
    for corners in WALLS:
        d.solid_hatch("Schraffur", corners)
    return d


def qcad_plain():
    d = flat(Dxf("m"), "0")
    d.text("0", (2, 2), "Bedroom")
    return d


def freecad():
    """The legacy exporter writes R12 without a unit; all is in millimetres."""
    return flat(Dxf("mm", -1, "AC1009"), "Wall", "Door", "Window", "old")


def freecad_axes():
    d = freecad()
    axes(d, "Axis")
    return d


def autocad_imperial(unit):
    """The default template says inches, whatever is drawn in it."""
    d = flat(Dxf(unit, 1, "AC1032"), "walls", "doors", "windows")
    d.text("text", (2, 2), "LIVING")
    return d


def revit(unit="mm"):
    d = flat(Dxf(unit, None, "AC1032"), "A-WALL", "A-DOOR", "A-GLAZ", "lines", "blocks")
    d.block("M_Bed-Standard", lambda: d.poly("0", BED))
    d.insert("I-FURN", "M_Bed-Standard")
    d.lines("A-FLOR-CASE", KITCHEN, False)
    axes(d, "S-GRID")
    dimensions(d, "A-ANNO-DIMS")
    d.text("A-AREA-IDEN", (2, 2), "Room 1")
    d.circle("E-LITE-EQPM", (7, 3), .4)
    d.poly("P-SANR-FIXT", SOFA)
    return d


def revit_stairs():
    d = revit()
    for a, b in STAIR:
        d.line("A-FLOR-STRS", a, b)
    d.line("A-FLOR-STRS", (7.5, .3), (7.5, 2.05))
    d.line("A-FLOR-OVHD", (.3, 3), (5, 3))
    return d


def iso13567():
    """Agent, element of the CI/SfB tables, presentation."""
    d = flat(Dxf("mm"), "A-21----E-", "A-32----E-", "A-31----E-")
    furniture(d, "A-82----E-")
    dimensions(d, "A-21----D-")
    axes(d, "A-------G-")
    d.circle("E-63----E-", (7, 4.4), .4)
    d.lines("P-74----E-", SOFA)
    return d


def archicad():
    d = flat(Dxf("m", None, "AC1027"), "Structural - Bearing", "Structural - Bearing", None, "poly", "leaf")
    furniture(d, "Interior - Furniture")
    dimensions(d, "Dimensioning - General")
    d.text("Marker - Room", (2, 2), "01")
    return d


def archicad_german():
    d = flat(Dxf("cm", None, "AC1027"), "Konstruktion - Tragend", None, None, "poly")
    furniture(d, "Innenausbau - Einrichtung")
    dimensions(d, "Bemaßung - Allgemein")
    axes(d, "Raster - Achsen")
    return d


def planners(wall, door, window, things, dims):
    d = flat(Dxf("cm"), wall, door, window)
    furniture(d, things)
    dimensions(d, dims)
    return d


def magicplan():
    d = flat(Dxf("m", None, "AC1015"), "WALLS", "DOORS", "WINDOWS", "poly", "leaf")
    furniture(d, "FURNITURE")
    dimensions(d, "DIMENSIONS")
    d.text("LABELS", (2, 2), "Bedroom")
    return d


def blocks_of_things():
    """Furniture as blocks on the layer 0, which names nothing."""
    d = flat(Dxf("mm"), "0")
    for name, corners in (("Bed-Double", BED), ("SOFA_3_SEATS", SOFA)):
        d.block(name, lambda: d.poly("0", corners))
        d.insert("0", name)
    return d


def sliding():
    d = flat(Dxf("mm"), "Muros", "Puertas", "Ventanas", "lines", "boxes")
    furniture(d, "Mobiliario")
    return d


def sheet():
    d = flat(Dxf("mm"), "MURS", "PORTES", "FENETRES")
    frame(d, "CADRE")
    d.text("CARTOUCHE", (11, -3), "PLAN")
    return d


def sheet_plain():
    d = flat(Dxf("mm"), "0")
    frame(d, "0")
    return d


def polyline_widths():
    d = Dxf("mm")
    d.poly("Walls", [(.15, .15), (8.85, .15), (8.85, 6.35), (.15, 6.35)], width=.3)
    return d


def mline():
    d = Dxf("mm")
    corners = [(0, 0), (9, 0), (9, 6.5), (0, 6.5)]
    text = "2\nSTANDARD\n40\n300\n70\n0\n71\n3\n72\n4\n73\n2\n" + d.x((0, 0))
    text += "30\n0\n210\n0\n220\n0\n230\n1\n"
    for i, p in enumerate(corners):
        along = [(1, 0), (0, 1), (-1, 0), (0, -1)][i]
        # The miter joins both walls: its length is the diagonal's share.
        before = [(0, -1), (1, 0), (0, 1), (-1, 0)][i]
        miter = (-(along[0] - before[0]) / math.sqrt(2), -(along[1] - before[1]) / math.sqrt(2))
        text += d.x(p, 11) + "31\n0\n12\n%g\n22\n%g\n32\n0\n13\n%.9f\n23\n%.9f\n33\n0\n" % (along + miter)
        text += "74\n2\n41\n0\n41\n0\n75\n0\n74\n2\n41\n%.6f\n41\n0\n75\n0\n" % (-300 * math.sqrt(2))
    d.add("MLINE", "WALL", text)
    return d


def curved():
    """A bay: half a circle of radius 1.5 m outside of the room's east wall."""
    d = Dxf("m")
    corners = [(0, 0), (6, 0), (6, 1), (6, 4), (6, 5), (0, 5)]
    d.poly("A-WALL", corners, bulges=[0, 0, 1, 0, 0, 0])
    d.poly("A-WALL", [(-.3, -.3), (6.3, -.3), (6.3, .7), (6.3, 4.3), (6.3, 5.3), (-.3, 5.3)],
           bulges=[0, 0, 1, 0, 0, 0])
    return d


def hatched_ellipse():
    """A wall drawn by its filling alone: a quarter of a ring of ellipses."""
    d = Dxf("m")
    d.poly("W", [(0, 0), (8, 0), (8, 6), (0, 6)])
    edges = "92\n1\n93\n4\n"
    edges += "72\n3\n10\n0\n20\n0\n11\n4\n21\n0\n40\n0.75\n50\n0\n51\n90\n73\n1\n"
    edges += "72\n1\n10\n0\n20\n3\n11\n0\n21\n2.8\n"
    edges += "72\n3\n10\n0\n20\n0\n11\n3.8\n21\n0\n40\n%.12f\n50\n270\n51\n360\n73\n0\n" % (2.8 / 3.8)
    edges += "72\n1\n10\n3.8\n20\n0\n11\n4\n21\n0\n"
    d.add("HATCH", "W", "10\n0\n20\n0\n30\n0\n210\n0\n220\n0\n230\n1\n2\nSOLID\n70\n1\n71\n0\n91\n1\n" + edges +
          "97\n0\n75\n1\n76\n1\n98\n0\n")
    return d


def frozen():
    d = librecad()
    dimensions(d, "old plan")
    d.hide("old plan", flags=1)
    d.lines("demolished", [(2, .3), (2, 6.2)], False)
    d.hide("demolished", color=-7)
    d.lines("help", [(4, .3), (4, 6.2)], False)
    d.hide("help", plot=0)
    return d


def external():
    d = Dxf("mm")
    d.poly("A-WALL", AXES_FLOOR)
    d.block("shell-2", lambda: None, 4, "shell-2.dwg")
    d.insert("A-WALL", "shell-2")
    return d


def solids():
    d = Dxf("mm")
    d.poly("A-WALL", AXES_FLOOR)
    d.add("3DSOLID", "A-WALL", "100\nAcDbModelerGeometry\n70\n1\n1\nbody\n")
    return d


def single_lines(insunits=None, unit="m"):
    d = Dxf(unit, insunits)
    for corners in AXES:
        d.lines("Pareti", corners, False)
    for hinge, leaf, latch, width in [((5, 2), 180, 90, .8), ((1, 0), 90, 0, .9)]:
        d.line("Porte", hinge, ends(hinge, leaf, latch, width)[0])
        d.arc("Porte", hinge, width, min(leaf, latch), max(leaf, latch))
    return d


def survey():
    d = flat(Dxf("m", offset=(448262, 5428611)), "WALL")
    d.lines("0", [(-448262, -5428611), (-448261, -5428611)], False)
    return d


def chinese():
    d = flat(Dxf("mm", None, "AC1027"), "墙", "门", "窗")
    furniture(d, "家具")
    dimensions(d, "标注")
    axes(d, "轴线")
    return d


def bs1192():
    """Revit's and AutoCAD Architecture's BS1192 (AUG 2): an author, three digits of CI/SfB, a graphic,
    a pen (help.autodesk.com, AutoCAD Architecture 2023, "BS1192 - AUG Version 2 Layer Standard")."""
    d = flat(Dxf("mm", None, "AC1027"), "A210G701_WALL_L1", "A315G3", "A314G3")
    furniture(d, "A760G3")
    dimensions(d, "A210D2")
    axes(d, "A000G2_GRID")
    return d


def bs1192_descriptive():
    """The same by words: A-Wall-G (help.autodesk.com, "BS1192 - Descriptive Layer Standard")."""
    d = flat(Dxf("mm", None, "AC1027"), "A-Wall-G", "A-Door-G", "A-Window-G")
    furniture(d, "A-Furniture-G")
    dimensions(d, "A-Wall-D")
    return d


def aia_mixed_case():
    """Architectural Desktop's AIA layers in mixed case: A-Wall, A-Flor-Case, A-Anno-Dims, A-Eqpm."""
    d = flat(Dxf("inch", None, "AC1015"), "A-Wall", "A-Door", "A-Glaz", "poly", "leaf")
    furniture(d, "A-Flor-Appl")
    d.lines("A-Eqpm", SOFA)
    dimensions(d, "A-Anno-Dims")
    d.lines("A-Clng-Grid", [(.3, 2), (5, 2)], False)
    return d


def revit_xdata():
    """Revit adds xdata of the application REVIT to each entity (adndevblog.typepad.com, "Revit DWG/DXF
    export: specification of the extended data"); its integers are no counts of vertices."""
    d = revit("foot")
    tail = "1001\nREVIT\n1070\n1\n1071\n118392\n1070\n2\n1071\n-2000011\n"
    parts = d.entities.split("0\nLINE\n")
    d.entities = ("0\nLINE\n").join([parts[0]] + [p if p.startswith("~") else p + tail for p in parts[1:-1]] +
                                    parts[-1:])
    return d


def inkscape_dxf():
    """Inkscape's DXF R14 writes curves as SPLINE of degree 3, layers by name, and pixels of 1/90 inch
    before 0.92 (tim.cexx.org, "Better Better DXF Output"); an arc is one cubic for each quarter."""
    d = Dxf("mm", 0, "AC1014")
    for corners in WALLS:
        d.lines("Walls", corners)
    for hinge, leaf, latch, width in DOORS:
        start, end = ends(hinge, leaf, latch, width)
        d.line("Doors", hinge, start)
        k = 4 / 3 * math.tan(math.pi / 8) * width
        turn = 1 if (latch - leaf) % 360 == 90 else -1
        a, b = (math.radians(x + turn * y) for x, y in ((leaf, 90), (latch, -90)))
        controls = [start, (start[0] + k * math.cos(a), start[1] + k * math.sin(a)),
                    (end[0] + k * math.cos(b), end[1] + k * math.sin(b)), end]
        d.add("SPLINE", "Doors", "70\n8\n71\n3\n72\n8\n73\n4\n74\n0\n" + "".join("40\n%d\n" % v for v in (
            0, 0, 0, 0, 1, 1, 1, 1)) + "".join(d.x(p) for p in controls))
    for x0, y0, x1, y1 in WINDOWS:
        d.lines("Windows", [(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    return d


def plan_pilot():
    """Layers of a FreeCAD workflow: murs, cloisons, ouvertures, cotations, textes (PlanPilot's export)."""
    d = Dxf("mm", None, "AC1032")
    for i, corners in enumerate(WALLS):
        d.lines("cloisons" if i == 2 else "murs", corners)
    for hinge, leaf, latch, width in DOORS:
        d.line("ouvertures", hinge, ends(hinge, leaf, latch, width)[0])
        d.arc("ouvertures", hinge, width, min(leaf, latch), max(leaf, latch))
    for x0, y0, x1, y1 in WINDOWS:
        d.poly("ouvertures", [(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    dimensions(d, "cotations")
    furniture(d, "mobilier")
    return d


def on_a_plot(wall="Mauerwerk", plot="Grundstück"):
    """A house on its plot: the boundary is the largest outline."""
    d = flat(Dxf("m", None, "AC1027"), wall, "Türen", "Fenster", "poly", "leaf")
    d.poly(plot, [(-8, -6), (22, -6), (22, 16), (-8, 16)])
    return d


def arabic():
    d = flat(Dxf("cm", None, "AC1027"), "جدران", "أبواب", "نوافذ")
    furniture(d, "أثاث")
    dimensions(d, "أبعاد")
    return d


def upright_face():
    """An AutoCAD 3D model: a wall's face stands upright, with its own plane as coordinates."""
    d = Dxf("m")
    d.poly("A-WALL", AXES_FLOOR)
    d.add("LWPOLYLINE", "A-WALL", "90\n4\n70\n1\n38\n5\n10\n0\n20\n0\n10\n6.5\n20\n0\n10\n6.5\n20\n2.5\n10\n0\n20\n"
          "2.5\n210\n1\n220\n0\n230\n0\n")
    return d


def dashed(d, layer, a, b, kind):
    """A line of another type than that of its layer."""
    before = len(d.entities)
    d.line(layer, a, b)
    line = d.entities[before:].replace("8\n%s\n" % layer, "8\n%s\n6\n%s\n" % (layer, kind), 1)
    d.entities = d.entities[:before] + line


def overhead():
    """AutoCAD's linetypes acad.lin: edges above the cut are HIDDEN, axes CENTER, on the layer of all."""
    d = flat(Dxf("mm", None, "AC1032"), "0")
    dashed(d, "0", (.3, 3.4), (5, 3.4), "HIDDEN")
    dashed(d, "0", (-1, 3.2), (10, 3.2), "CENTER2")
    return d


def thresholds():
    """The floor changes at a door: a line on each face of the wall, besides leaf and swing."""
    d = flat(Dxf("mm", None, "AC1032"), "0")
    for a, b in [((1, 0), (1.9, 0)), ((1, .3), (1.9, .3)), ((5, 2), (5, 2.8)), ((5.12, 2), (5.12, 2.8))]:
        d.line("0", a, b)
    return d


def roof():
    d = flat(Dxf("mm", None, "AC1032"), "0")
    d.poly("0", [(-.6, -.6), (9.6, -.6), (9.6, 7.1), (-.6, 7.1)])
    return d


def tiles():
    d = flat(Dxf("mm", None, "AC1032"), "0")
    for i in range(1, 15):
        d.line("0", (5.12, .3 + i * .4), (8.7, .3 + i * .4))
    for i in range(1, 9):
        d.line("0", (5.12 + i * .4, .3), (5.12 + i * .4, 6.2))
    return d


def mirrored():
    """A whole plan as one block, inserted seen from below (AutoCAD's MIRROR)."""
    d = Dxf("mm", None, "AC1032")
    d.block("PLAN", lambda: flat(d, "WALL", "DOOR", "WINDOW"))
    d.add("INSERT", "0", "2\nPLAN\n10\n0\n20\n0\n41\n-1\n42\n1\n")
    return d


def pieces_of_walls():
    """FreeCAD's Draft rectangles: each wall is one, and they overlap at corners."""
    d = Dxf("mm", None, "AC1021")
    for x0, y0, x1, y1 in [(0, 0, 1, .3), (1.9, 0, 9, .3), (8.7, 0, 9, 2.5), (8.7, 4, 9, 6.5), (0, 6.2, 1.5, 6.5),
                           (3, 6.2, 6, 6.5), (7.5, 6.2, 9, 6.5), (0, 0, .3, 6.5), (5, .3, 5.12, 2),
                           (5, 2.8, 5.12, 6.2)]:
        d.poly("Wall", [(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    for hinge, leaf, latch, width in DOORS:
        d.line("Door", hinge, ends(hinge, leaf, latch, width)[0])
        d.arc("Door", hinge, width, min(leaf, latch), max(leaf, latch))
    for x0, y0, x1, y1 in WINDOWS:
        d.poly("Window", [(x0, y0), (x1, y0), (x1, y1), (x0, y1)])
    return d


def paper_space():
    d = librecad()
    before = len(d.entities)
    frame(d, "0")
    d.entities = d.entities[:before] + d.entities[before:].replace("\n8\n0\n", "\n67\n1\n8\n0\n")
    return d


def outlines_of_areas():
    """Revit's areas, and rooms as polygons of their net floor."""
    d = revit()
    for layer in ("A-AREA", "Raumpolygone"):
        d.poly(layer, [(.3, .3), (5, .3), (5, 6.2), (.3, 6.2)])
        d.poly(layer, [(5.12, .3), (8.7, .3), (8.7, 6.2), (5.12, 6.2)])
    return d


def coloured_pier():
    """A pier that is only filled: wider than walls."""
    d = flat(Dxf("mm", None, "AC1032"), "0")
    d.solid_hatch("0", [(6, 4), (7.8, 4), (7.8, 5.8), (6, 5.8)])
    return d


OUTSIDE_BAY = [(0, 0), (6, 0), (6, 1)] + [
    (6 + 1.5 * math.cos(math.pi * (i / 400 - .5)), 2.5 + 1.5 * math.sin(math.pi * (i / 400 - .5)))
    for i in range(1, 400)] + [(6, 4), (6, 5), (0, 5)]
ROUND_CORNER = [(4, 0), (8, 0), (8, 6), (0, 6), (0, 3)] + [
    (4 * math.sin(math.pi * i / 800), 3 * math.cos(math.pi * i / 800)) for i in range(1, 400)]
MIDDLE = [(.15, .15), (8.85, .15), (8.85, 6.35), (.15, 6.35)]
INNER = [(.3, .3), (8.7, .3), (8.7, 6.2), (.3, 6.2)]

# Name: drawing, metres a unit, corners of the floor, result.
DXF = {
    "librecad-mm": (librecad, "mm", FLOOR, "right"),
    "librecad-none": (lambda: librecad("mm", 0), "mm", FLOOR, "right"),
    "librecad-none-cm": (lambda: librecad("cm", 0), "cm", FLOOR, "right"),
    "librecad-none-inch": (lambda: librecad("inch", 0), "inch", FLOOR, "right"),
    "qcad-german": (qcad, "mm", FLOOR, "right"),
    "qcad-layer-0": (qcad_plain, "m", FLOOR, "right"),
    "freecad-r12": (freecad, "mm", FLOOR, "right"),
    "freecad-axes": (freecad_axes, "mm", FLOOR, "right"),
    "autocad-inch": (lambda: autocad_imperial("inch"), "inch", FLOOR, "right"),
    "autocad-inch-is-mm": (lambda: autocad_imperial("mm"), "mm", FLOOR, "right"),
    "autocad-inch-is-cm": (lambda: autocad_imperial("cm"), "cm", FLOOR, "right"),
    "autocad-inch-is-m": (lambda: autocad_imperial("m"), "m", FLOOR, "right"),
    "mm-is-m": (lambda: librecad("m", 4), "m", FLOOR, "right"),
    "m-is-mm": (lambda: single_lines(6, "mm"), "mm", AXES_FLOOR, "right"),
    "revit-mm": (revit, "mm", FLOOR, "right"),
    "revit-feet": (lambda: revit("foot"), "foot", FLOOR, "right"),
    "revit-stairs": (revit_stairs, "mm", FLOOR, "right"),
    "iso13567": (iso13567, "mm", FLOOR, "right"),
    "archicad": (archicad, "m", FLOOR, "right"),
    "archicad-german": (archicad_german, "cm", FLOOR, "right"),
    "planner-polish": (lambda: planners("ściany", "drzwi", "okna", "meble", "wymiary"), "cm", FLOOR, "right"),
    "planner-portuguese": (lambda: planners("PAREDES", "PORTAS", "JANELAS", "MOBILIARIO", "COTAS"), "cm", FLOOR,
                           "right"),
    "planner-dutch": (lambda: planners("muren", "deuren", "ramen", "meubels", "maatvoering"), "cm", FLOOR, "right"),
    "planner-unnamed": (lambda: planners("L1", "L1", "L1", "arredo", "quote"), "cm", FLOOR, "right"),
    "chinese": (chinese, "mm", FLOOR, "right"),
    "magicplan": (magicplan, "m", FLOOR, "right"),
    "blocks-of-furniture": (blocks_of_things, "mm", FLOOR, "right"),
    "sliding-doors": (sliding, "mm", FLOOR, "right"),
    "sheet": (sheet, "mm", FLOOR, "right"),
    "sheet-layer-0": (sheet_plain, "mm", FLOOR, "warned"),
    # Walls with a width are lines of that thickness: the floor ends at the line.
    "polyline-widths": (polyline_widths, "mm", MIDDLE, "right"),
    "mline": (mline, "mm", INNER, "right"),
    "curved": (curved, "m", OUTSIDE_BAY, "right"),
    "hatched-ellipse": (hatched_ellipse, "m", ROUND_CORNER, "right"),
    "frozen": (frozen, "mm", FLOOR, "right"),
    "external": (external, "mm", None, "warned"),
    "solids": (solids, "mm", None, "warned"),
    "bs1192": (bs1192, "mm", FLOOR, "right"),
    "bs1192-descriptive": (bs1192_descriptive, "mm", FLOOR, "right"),
    "aia-mixed-case": (aia_mixed_case, "inch", FLOOR, "right"),
    "revit-xdata": (revit_xdata, "foot", FLOOR, "right"),
    "inkscape-r14": (inkscape_dxf, "mm", FLOOR, "right"),
    "freecad-french": (plan_pilot, "mm", FLOOR, "right"),
    "on-a-plot": (on_a_plot, "m", FLOOR, "right"),
    "on-a-plot-unnamed": (lambda: on_a_plot("L1", "L2"), "m", FLOOR, "warned"),
    "arabic": (arabic, "cm", FLOOR, "right"),
    "upright-face": (upright_face, "m", None, "warned"),
    "single-lines": (single_lines, "m", AXES_FLOOR, "right"),
    "survey": (survey, "m", FLOOR, "right"),
    "overhead": (overhead, "mm", FLOOR, "right"),
    "thresholds": (thresholds, "mm", FLOOR, "right"),
    "roof": (roof, "mm", FLOOR, "warned"),
    "tiles": (tiles, "mm", FLOOR, "warned"),
    "mirrored": (mirrored, "mm", [(-x, y) for x, y in FLOOR], "right"),
    "pieces-of-walls": (pieces_of_walls, "mm", FLOOR, "right"),
    "paper-space": (paper_space, "mm", FLOOR, "right"),
    "outlines-of-areas": (outlines_of_areas, "mm", FLOOR, "right"),
    "coloured-pier": (coloured_pier, "mm", None, "warned"),
    "vietnamese": (lambda: planners("Tường", "Cửa đi", "Cửa sổ", "Nội thất", "Kích thước"), "cm", FLOOR, "right"),
    "hindi": (lambda: planners("दीवार", "दरवाजा", "खिड़की", "फर्नीचर", "माप"), "cm", FLOOR, "right"),
    "latvian": (lambda: planners("SIENAS", "DURVIS", "LOGI", "MĒBELES", "IZMĒRI"), "cm", FLOOR, "right"),
    "russian": (lambda: planners("Стены", "Двери", "Окна", "Мебель", "Размеры"), "cm", FLOOR, "right"),
}



class Svg:
    """Builds a page. Coordinates of its calls are metres with y up; `scale` makes them user units."""

    def __init__(self, scale=100, head='width="%(w)gmm" height="%(h)gmm" viewBox="0 0 %(x)g %(y)g"'):
        self.scale, self.body = scale, ""
        x, y = 12 * scale, 8 * scale
        self.head = head % {"w": 12000, "h": 8000, "x": x, "y": y}

    def at(self, p):
        return "%.6g,%.6g" % ((p[0] + 1) * self.scale, (7.2 - p[1]) * self.scale)

    def open(self, attributes):
        self.body += "<g %s>" % attributes

    def close(self):
        self.body += "</g>\n"

    def path(self, corners, closed=True, more=""):
        self.body += '<path d="M %s%s" %s/>' % (" L ".join(self.at(p) for p in corners), " Z" if closed else "", more)

    def polygon(self, corners, more=""):
        self.body += '<polygon points="%s" %s/>' % (" ".join(self.at(p) for p in corners), more)

    def line(self, a, b, more=""):
        (x1, y1), (x2, y2) = (self.at(p).split(",") for p in (a, b))
        self.body += '<line x1="%s" y1="%s" x2="%s" y2="%s" %s/>' % (x1, y1, x2, y2, more)

    def swing(self, start, end, radius, more=""):
        self.body += '<path d="M %s A %g %g 0 0 1 %s" %s/>' % (
            self.at(start), radius * self.scale, radius * self.scale, self.at(end), more)

    def __str__(self):
        return ('<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
                'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" %s>\n%s</svg>\n' % (self.head, self.body))


def svg_flat(svg, group, wall="Walls", door="Doors", window="Windows", more=""):
    """Draws the flat; `group` makes a group's attributes of its name."""
    svg.open(group(wall))
    for piece in WALLS:
        svg.path(piece, True, more)
    svg.close()
    svg.open(group(door))
    for hinge, leaf, latch, width in DOORS:
        open_end, shut_end = ends(hinge, leaf, latch, width)
        svg.line(hinge, open_end, more)
        # Clockwise on the page, whose y points down: from the larger angle.
        start, end = (open_end, shut_end) if leaf > latch else (shut_end, open_end)
        svg.swing(start, end, width, more)
    svg.close()
    svg.open(group(window))
    for x0, y0, x1, y1 in WINDOWS:
        svg.path([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], True, more)
    svg.close()
    return svg


def inkscape_group(name):
    return 'inkscape:groupmode="layer" id="layer%d" inkscape:label="%s" style="display:inline"' % (len(name), name)


def id_group(name):
    return 'id="%s"' % name


def svg_things(svg, attributes):
    svg.open(attributes)
    svg.polygon(BED)
    svg.polygon(SOFA)
    svg.line(*KITCHEN)
    svg.close()
    return svg


THIN = 'style="fill:none;stroke:#000000;stroke-width:1;stroke-linecap:butt"'
PIXELS = 'version="1.1" x="0px" y="0px" viewBox="0 0 %(x)g %(y)g" style="enable-background:new 0 0 1200 800;"'
SIZED = 'width="%(x)gpx" height="%(y)gpx" viewBox="0 0 %(x)g %(y)g"'


def inkscape(things="Furniture", **more):
    return svg_things(svg_flat(Svg(), inkscape_group, more=THIN, **more), inkscape_group(things))


def svg_page():
    d = inkscape()
    d.body = '<rect width="100%" height="100%" fill="white"/>' + d.body
    return d


def illustrator(scale=100, head=PIXELS):
    d = Svg(scale, head)
    d.body = ('<style type="text/css">\n.st0{fill:none;stroke:#000000;stroke-miterlimit:10;}\n'
              '.st1{display:none;}\n</style>')
    svg_flat(d, id_group, more='class="st0"')
    d.path([(3, .3), (3, 6.2)], False, 'class="st1"')
    return svg_things(d, 'id="Furniture_1_"')


def nested():
    """An inner page as large as the outer one, in which the coordinates are twice as large."""
    d = Svg(200, 'width="12000mm" height="8000mm" viewBox="0 0 1200 800"')
    svg_flat(d, inkscape_group, more=THIN)
    d.body = '<svg width="100%%" height="100%%" viewBox="0 0 2400 1600">%s</svg>' % d.body
    return d


def turned():
    d = svg_flat(Svg(), inkscape_group, more=THIN)
    d.body = '<g style="transform:rotate(90deg);transform-origin:600px 400px">%s</g>' % d.body
    return d


def clear():
    d = inkscape()
    for attributes in ('id="old" opacity="0"', 'id="hidden" style="visibility:hidden"',
                       'id="none" style="opacity:0%"'):
        d.open(attributes)
        d.path([(2, .3), (2, 6.2)], False)
        d.close()
    return d


def style_order():
    d = Svg()
    svg_flat(d, id_group, more='class="w"')
    d.open('id="plan"')
    d.path([(3, .3), (3, 6.2)], False, 'class="aid"')
    d.close()
    d.body = "<style>#plan .aid{display:none} .aid{display:inline} path.aid{display:inline}</style>" + d.body
    return d


def odd_rules():
    d = svg_flat(Svg(), id_group, more=THIN)
    d.body = "<style>path:nth-of-type(7) {display:none}</style>" + d.body
    d.path([(3, .3), (3, 6.2)], False)
    return d


def uses():
    d = Svg()
    d.body = '<defs><symbol id="bed"><rect width="160" height="200"/></symbol></defs>'
    svg_flat(d, id_group, more=THIN)
    d.open('id="furniture"')
    d.body += '<use xlink:href="#bed" x="140" y="110"/>'
    d.close()
    return d


def sweethome():
    """Exported by a library of graphics: matrices, and filled walls without names."""
    d = svg_flat(Svg(100, 'width="1200cm" height="800cm" viewBox="0 0 1200 800"'), lambda name: 'fill="#808080"')
    d.body = '<g transform="matrix(0.5,0,0,0.5,0,0)"><g transform="matrix(2,0,0,2,0,0)">%s</g></g>' % d.body
    return d


def meaning_by_group():
    """Groups of walls and furniture inside of one group for all."""
    d = Svg()
    d.open('id="Model"')
    d.open('id="Floor-1"')
    svg_flat(d, lambda name: 'id="%s" class="%s External"' % (name[:-1], name[:-1]))
    d.open('id="FixedFurniture" class="FixedFurniture Sink"')
    d.polygon(SOFA)
    d.close()
    d.open('id="bed-3"')
    d.polygon(BED)
    d.close()
    d.close()
    d.close()
    return d


def wide_strokes():
    d = Svg()
    d.path(MIDDLE, True, 'style="fill:none;stroke:#000;stroke-width:30;stroke-linejoin:miter"')
    return d


def wide_lines():
    """Each wall is one wide line, with gaps at doors; symbols of doors begin at its faces."""
    d = Svg(100, 'width="12000mm" height="8000mm" viewBox="0 0 1200 800"')
    for corners, width in [([(1.9, .15), (8.85, .15), (8.85, 6.35), (.15, 6.35), (.15, .15), (1, .15)], 30),
                           ([(5.06, .15), (5.06, 2)], 12), ([(5.06, 2.8), (5.06, 6.35)], 12)]:
        d.path(corners, False, 'style="fill:none;stroke:#000;stroke-width:%d"' % width)
    for hinge, leaf, latch, width in DOORS:
        open_end, shut_end = ends(hinge, leaf, latch, width)
        d.line(hinge, open_end, 'stroke="black"')
        d.swing(*((open_end, shut_end) if leaf > latch else (shut_end, open_end)), width, 'stroke="black" fill="none"')
    return d


def on_paper(scale, head):
    """A plan at a scale on a page in millimetres, as Inkscape's default page has it (its user unit is a
    millimetre since 0.92: wiki.inkscape.org, "Units In Inkscape")."""
    d = Svg(1000 / scale, head)
    svg_flat(d, inkscape_group, more='style="fill:none;stroke:#000000;stroke-width:0.25"')
    return svg_things(d, inkscape_group("Furniture"))


def paper(scale):
    return 'width="%gmm" height="%gmm" viewBox="0 0 %%(x)g %%(y)g"' % (12000 / scale, 8000 / scale)


def clipped():
    """Converters from PDF clip each element by a path, here hatching by the outline of a wall."""
    d = svg_flat(Svg(), id_group, more=THIN)
    d.body = '<defs><clipPath id="c"><path d="M %s Z"/></clipPath></defs>' % " L ".join(
        d.at(p) for p in WALLS[1]) + d.body
    for i in range(12):
        d.path([(2 + i, -1), (9 + i, 6)], False, 'clip-path="url(#c)" ' + THIN)
    return d


def dashes():
    """Illustrator and Inkscape dash edges above the cut (stroke-dasharray)."""
    d = svg_flat(Svg(), id_group, more=THIN)
    d.path([(.3, 3.4), (5, 3.4)], False, 'style="fill:none;stroke:#000;stroke-dasharray:8, 4"')
    return d


def masked_furniture():
    """Figma clips what it exports by masks: those of furniture hide no wall."""
    d = svg_flat(Svg(), id_group, more=THIN)
    d.body = '<mask id="m"><rect width="1200" height="800"/></mask>' + d.body
    return svg_things(d, 'id="furniture" mask="url(#m)"')


def figma():
    """Figma exports each wall as a filled rectangle, without names."""
    d = Svg(100, 'width="12000mm" height="8000mm" viewBox="0 0 1200 800"')
    for x0, y0, x1, y1 in [(0, 0, 1, .3), (1.9, 0, 9, .3), (8.7, 0, 9, 2.5), (8.7, 4, 9, 6.5), (0, 6.2, 1.5, 6.5),
                           (3, 6.2, 6, 6.5), (7.5, 6.2, 9, 6.5), (0, 0, .3, 6.5), (5, .3, 5.12, 2),
                           (5, 2.8, 5.12, 6.2)] + WINDOWS:
        d.path([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], True, 'fill="#333333"')
    for hinge, leaf, latch, width in DOORS:
        open_end, shut_end = ends(hinge, leaf, latch, width)
        d.line(hinge, open_end, 'stroke="black"')
        d.swing(*((open_end, shut_end) if leaf > latch else (shut_end, open_end)), width, 'stroke="black" fill="none"')
    return d


def painted_over():
    """Black walls without gaps, and doors as white boxes above them: the boxes close the doors."""
    d = Svg()
    for x0, y0, x1, y1 in [(0, 0, 9, .3), (8.7, 0, 9, 6.5), (0, 6.2, 9, 6.5), (0, 0, .3, 6.5), (5, .3, 5.12, 6.2)]:
        d.path([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], True, 'fill="#000"')
    for x0, y0, x1, y1 in [(1, 0, 1.9, .3), (5, 2, 5.12, 2.8)] + WINDOWS:
        d.path([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], True, 'fill="#fff"')
    return d


def named_rooms():
    """Rooms as filled outlines in a group, a name drawn as paths, furniture by a label."""
    d = Svg()
    d.open('id="rooms"')
    d.polygon([(.3, .3), (5, .3), (5, 6.2), (.3, 6.2)], 'fill="#eee"')
    d.polygon([(5.12, .3), (8.7, .3), (8.7, 6.2), (5.12, 6.2)], 'fill="#eee"')
    d.close()
    svg_flat(d, id_group, more=THIN)
    d.body += '<g aria-label="Bedroom" id="text12"><path d="M 300,300 h 60 v 80 h -60 Z"/></g>'
    d.body += '<g id="g12" inkscape:label="Sofa 3"><rect x="140" y="110" width="160" height="200"/></g>'
    return d


def by_percent():
    d = Svg(100, 'width="12000mm" height="8000mm" viewBox="0 0 1200 800"')
    svg_flat(d, id_group, more=THIN)
    d.body += '<g id="Furniture"><rect x="20%" y="30%" width="10%" height="10%"/></g>'
    d.body += '<rect width="100%" height="100%" fill="#ffffff00"/>'
    return d


SVG = {
    "inkscape": (inkscape, FLOOR, "right"),
    "inkscape-german": (lambda: inkscape("Möbel", wall="Wände", door="Türen", window="Fenster"), FLOOR, "right"),
    "inkscape-page": (svg_page, FLOOR, "right"),
    "illustrator-cm": (illustrator, FLOOR, "right"),
    "illustrator-px": (lambda: illustrator(100, SIZED), FLOOR, "right"),
    "illustrator-mm": (lambda: illustrator(1000), FLOOR, "right"),
    "illustrator-inch": (lambda: illustrator(1 / .0254), FLOOR, "right"),
    "nested": (nested, FLOOR, "right"),
    "transform-origin": (turned, FLOOR, "right"),
    "clear": (clear, FLOOR, "right"),
    "style-order": (style_order, FLOOR, "right"),
    "odd-rules": (odd_rules, None, "warned"),
    "uses": (uses, FLOOR, "right"),
    "sweethome3d": (sweethome, FLOOR, "right"),
    "meaning-by-group": (meaning_by_group, FLOOR, "right"),
    "paper-50": (lambda: on_paper(50, paper(50)), FLOOR, "right"),
    "paper-100": (lambda: on_paper(100, paper(100)), FLOOR, "right"),
    "clipped": (clipped, FLOOR, "right"),
    "by-percent": (by_percent, FLOOR, "right"),
    "wide-strokes": (wide_strokes, MIDDLE, "right"),
    "wide-lines": (wide_lines, MIDDLE, "right"),
    "dashes": (dashes, FLOOR, "right"),
    "figma": (figma, FLOOR, "right"),
    "painted-over": (painted_over, FLOOR, "warned"),
    "named-rooms": (named_rooms, FLOOR, "right"),
    "masked-furniture": (masked_furniture, FLOOR, "right"),
}


def svg_pieces(path):
    """The straight pieces of paths and polygons by their own numbers; transforms must cancel out."""
    pieces = []
    for node in xml.etree.ElementTree.parse(path).iter():
        data = node.get("d") or node.get("points") or ""
        if "A" in data:
            continue
        points = [(float(x), float(y)) for x, y in re.findall(r"(-?[\d.]+),(-?[\d.]+)", data)]
        pieces.extend(zip(points, points[1:] + points[:1]))
    return pieces


def shoelace(corners):
    return abs(sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(corners, corners[1:] + corners[:1]))) / 2


def pieces_by_ezdxf(path, scale):
    """All straight pieces that ezdxf reads from a drawing, those of blocks in place."""
    import ezdxf
    from ezdxf import path as paths
    pieces = []

    def walk(entity):
        kind = entity.dxftype()
        if kind in ("INSERT", "MLINE"):
            try:
                for part in entity.virtual_entities():
                    walk(part)
            except Exception:  # an external reference has no entities
                pass
            return
        made = []
        try:
            if kind == "HATCH":
                made = list(paths.from_hatch(entity))
            elif kind in ("LINE", "ARC", "CIRCLE", "LWPOLYLINE", "POLYLINE", "SPLINE", "ELLIPSE"):
                made = [paths.make_path(entity)]
        except (TypeError, ValueError):
            return
        for p in made:
            points = list(p.flattening(.0005 * scale))
            pieces.extend((tuple(a)[:2], tuple(b)[:2]) for a, b in zip(points, points[1:]))

    for entity in ezdxf.readfile(path).modelspace():
        walk(entity)
    return pieces


def distance(p, piece):
    (ax, ay), (bx, by) = piece
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    t = 0 if square == 0 else max(0, min(1, ((p[0] - ax) * dx + (p[1] - ay) * dy) / square))
    return math.hypot(p[0] - ax - t * dx, p[1] - ay - t * dy)


OPENINGS = WINDOWS + [(1, -.01, 1.9, .31), (4.99, 2, 5.13, 2.8)]


def undrawn(corners, pieces, scale, offset, openings):
    """Points of the room's sides, besides its openings, that lie on no line of the drawing."""
    missing = []
    for a, b in zip(corners, corners[1:] + corners[:1]):
        for share in (.001, .25, .5, .75, .999):
            p = (a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]))
            if any(x0 <= p[0] <= x1 and y0 <= p[1] <= y1 for x0, y0, x1, y1 in openings):
                continue
            q = ((p[0] + offset[0]) * scale, (p[1] + offset[1]) * scale)
            if min(distance(q, piece) for piece in pieces) > .004 * scale:
                missing.append(p)
    return missing


def measured(path, options=(), key="indoor_area"):
    """The floor area that envc reads, whether it warned, and its messages."""
    run = subprocess.run(["envc", path, *options, "--info", "--json"], capture_output=True, text=True)
    area = json.loads(run.stdout)[key] if run.returncode == 0 else None
    return area, " warning: " in run.stderr, run.stderr


def result(path, right, options=(), key="indoor_area", tolerance=TOLERANCE):
    area, warned, messages = measured(path, options, key)
    if area is None:
        return "refused", area, messages
    if right is not None and abs(area - right) <= tolerance * right:
        return "right", area, messages
    return ("warned" if warned else "silent"), area, messages


def run_dxf(folder, only, rows):
    for name, (draw, unit, corners, expected) in DXF.items():
        if only and only not in name:
            continue
        drawing = draw()
        path = os.path.join(folder, name + ".dxf")
        with open(path, "w", encoding="utf-8") as file:
            file.write(str(drawing))
        right, fault = None, ""
        if corners is not None:
            right = shoelace(corners)
            openings = OPENINGS
            if corners[0][0] < 0:  # seen from below
                openings = [(-x1, y0, -x0, y1) for x0, y0, x1, y1 in OPENINGS]
            missing = undrawn(corners, pieces_by_ezdxf(path, UNITS[unit]), UNITS[unit], drawing.offset, openings)
            if missing:
                fault = "ezdxf finds no line at %s" % missing[:3]
        rows.append((name + ".dxf", expected, right, fault) + result(path, right))


def run_svg(folder, only, rows):
    for name, (draw, corners, expected) in SVG.items():
        if only and only not in name:
            continue
        drawing = draw()
        path = os.path.join(folder, name + ".svg")
        with open(path, "w", encoding="utf-8") as file:
            file.write(str(drawing))
        right, fault = None, ""
        if corners is not None:
            right = shoelace(corners)
            on_page = [(x + 1, 7.2 - y) for x, y in corners]
            openings = [(x0 + 1, 7.2 - y1, x1 + 1, 7.2 - y0) for x0, y0, x1, y1 in OPENINGS]
            missing = undrawn(on_page, svg_pieces(path), drawing.scale, (0, 0), openings)
            if missing:
                fault = "no element has a line at %s" % missing[:3]
        rows.append((name + ".svg", expected, right, fault) + result(path, right))


def main():
    try:
        import ezdxf  # noqa: F401
    except ImportError:
        print("skipped: python3-ezdxf is not installed")
        return 77
    folder = sys.argv[1]
    only = sys.argv[2] if len(sys.argv) > 2 else ""
    os.makedirs(folder, exist_ok=True)
    rows = []
    run_dxf(folder, only, rows)
    run_svg(folder, only, rows)
    formats.run(folder, only, rows, result)
    counts, faults = {}, 0
    for name, expected, right, fault, found, area, messages in rows:
        for kind in (formats.format_of(name), "all"):
            counts.setdefault(kind, dict.fromkeys(RESULTS, 0))[found] += 1
        is_fault = found != expected or fault
        faults += bool(is_fault)
        print("%-28s %-8s %10s %10s %s" % (name, found, "-" if right is None else "%.3f" % right,
                                          "-" if area is None else "%.3f" % area,
                                          "EXPECTED " + expected + " " + fault if is_fault else ""))
        if is_fault or only:
            print("    " + messages.replace("\n", "\n    ").rstrip())
    print("\n%-8s" % "" + "".join("%9s" % found for found in RESULTS))
    for kind in sorted(counts, key=lambda kind: (kind == "all", kind)):
        print("%-8s" % kind + "".join("%9d" % counts[kind][found] for found in RESULTS))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

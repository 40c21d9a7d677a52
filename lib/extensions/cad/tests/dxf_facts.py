#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints what ezdxf sees in a drawing, a line each: dxf_facts.py FILE.dxf

`unit N`, `errors N` (of its audit), `LAYER TYPE COUNT`, of objects `solid TYPE BOTTOM HEIGHT`, and for
fillings `area LAYER M2`. Fillings have straight edges; holes run clockwise.
"""
import sys
from collections import Counter, defaultdict

import ezdxf


def signed_area(corners):
    pairs = zip(corners, corners[1:] + corners[:1])
    return sum(a[0] * b[1] - b[0] * a[1] for a, b in pairs) / 2


def main():
    doc = ezdxf.readfile(sys.argv[1])
    print("unit", doc.units)
    print("errors", len(doc.audit().errors))
    counts, areas = Counter(), defaultdict(float)
    for entity in doc.modelspace():
        assert entity.dxf.layer in doc.layers, f"no layer {entity.dxf.layer}"
        counts[entity.dxf.layer, entity.dxftype()] += 1
        if entity.dxftype() == "HATCH":
            for path in entity.paths:
                areas[entity.dxf.layer] += signed_area([edge.start for edge in path.edges])
    for (layer, kind), count in sorted(counts.items()):
        print(layer, kind, count)
    for layer, area in sorted(areas.items()):
        print("area", layer, f"{area:.6f}")
    for entity in doc.modelspace().query('LWPOLYLINE[layer=="walls"]'):
        print("wall", entity.closed, f"{entity.dxf.const_width:.3f}", len(entity))
    for entity in doc.modelspace().query('*[layer=="objects"]'):
        bottom = entity.dxf.elevation if entity.dxftype() == "LWPOLYLINE" else entity.dxf.center.z
        print("solid", entity.dxftype(), f"{bottom:.3f} {entity.dxf.thickness:.3f}")
    for entity in doc.modelspace().query("TEXT"):
        print("text", entity.dxf.layer, entity.dxf.text)


main()

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that require far more work than their size suggests, for every reader that repeats.

A family is a function of a size in bytes that returns the files of one input, the operand first.
"""
import argparse
import base64
import json
import math
import os
import re
import resource
import struct
import subprocess
import sys
import tempfile

import layouts
import verbs


def dxf(blocks, entities):
    """A drawing in metres. blocks: {name: entities}"""
    parts = ["0", "SECTION", "2", "HEADER", "9", "$INSUNITS", "70", "6", "0", "ENDSEC", "0", "SECTION", "2", "BLOCKS"]
    for name, body in blocks.items():
        parts += ["0", "BLOCK", "8", "0", "2", name, "10", "0", "20", "0", "70", "0", *body, "0", "ENDBLK"]
    parts += ["0", "ENDSEC", "0", "SECTION", "2", "ENTITIES", *entities, "0", "ENDSEC", "0", "EOF", ""]
    return {"plan.dxf": "\n".join(parts)}


def insert(name, x=0.0, columns=1, rows=1):
    text = ["0", "INSERT", "8", "0", "2", name, "10", f"{x:g}", "20", "0"]
    if columns > 1 or rows > 1:
        text += ["70", str(columns), "71", str(rows), "44", "0.01", "45", "0.01"]
    return text


def line(a, b):
    return ["0", "LINE", "8", "0", "10", f"{a[0]:g}", "20", f"{a[1]:g}", "11", f"{b[0]:g}", "21", f"{b[1]:g}"]


ROOM_OF_LINES = line((0, 0), (8, 0)) + line((8, 0), (8, 6)) + line((8, 6), (0, 6)) + line((0, 6), (0, 0))


def repeated(make, size):
    """As many as fit the size; make(i) gives the groups of one."""
    count = max(1, size // (len("\n".join(make(1000))) + 1))
    return [group for i in range(count) for group in make(i)]


def dxf_missing(size):
    """Inserts of a block that the file lacks, in a grid of a block of them."""
    return dxf({"B": repeated(lambda i: insert("MISSING"), size)},
               ROOM_OF_LINES + insert("B", 0, 1400, 1400))


def dxf_missing_nested(size):
    return dxf({"B": repeated(lambda i: insert("MISSING", 0, 1400, 1400), size // 2)},
               ROOM_OF_LINES + repeated(lambda i: insert("B"), size // 2))


def dxf_empty_block(size):
    return dxf({"E": [], "B": repeated(lambda i: insert("E"), size)}, ROOM_OF_LINES + insert("B", 0, 1400, 1400))


def dxf_empty_polylines(size):
    return dxf({"B": repeated(lambda i: ["0", "LWPOLYLINE", "8", "0", "90", "0", "70", "0"], size)},
               ROOM_OF_LINES + insert("B", 0, 1400, 1400))


def dxf_circles_of_nothing(size):
    return dxf({"B": repeated(lambda i: ["0", "CIRCLE", "8", "0", "10", "0", "20", "0", "40", "0"], size)},
               ROOM_OF_LINES + insert("B", 0, 1400, 1400))


def dxf_lines(size):
    """Repetitions draw separate walls: millions of them."""
    return dxf({"B": repeated(lambda i: line((0, i), (5, i)), size)},
               ROOM_OF_LINES + insert("B", 0, 1400, 1400))


def dxf_coincident(size):
    return dxf({}, ROOM_OF_LINES + repeated(lambda i: line((1, 1), (2, 1)), size))


def circle(i):
    return ["0", "CIRCLE", "8", "0", "10", str(10 + i % 97 / 97), "20", str(10 + i % 89 / 89), "40", str(1 + i % 83 / 10)]


def dxf_crossing(size):
    """Each circle of dozens of chords crosses most of the others."""
    return dxf({}, ROOM_OF_LINES + repeated(circle, size))


def dxf_crossing_blocks(size):
    """Lines that cross in a block, inserted upon each other."""
    return dxf({"B": repeated(circle, size)}, ROOM_OF_LINES + insert("B", 0, 20, 20))


def drawn_room(entities):
    """A drawing with the layers of those that envc writes."""
    layers = [part for name in ("walls", "doors", "windows", "objects") for part in ("0", "LAYER", "2", name, "70", "0", "62", "7")]
    plan = dxf({}, entities)["plan.dxf"]
    tables = "\n".join(["0", "SECTION", "2", "TABLES", "0", "TABLE", "2", "LAYER", *layers, "0", "ENDTAB", "0", "ENDSEC", ""])
    return {"plan.dxf": plan.replace("0\nSECTION\n2\nBLOCKS", tables + "0\nSECTION\n2\nBLOCKS", 1)}


def on_layer(entity, name):
    return [*entity[:3], name, *entity[4:]]


WALLS_OF_ROOM = [part for i in range(0, len(ROOM_OF_LINES), 12) for part in on_layer(ROOM_OF_LINES[i:i + 12], "walls")]


def dxf_drawn_crossing(size):
    return drawn_room(WALLS_OF_ROOM + repeated(lambda i: on_layer(circle(i), "walls"), size))


def dxf_drawn_outline(size):
    """A footprint with very many corners."""
    count = size // 32
    corners = [part for i in range(count) for part in
               ("10", f"{4 + math.cos(6.2 * i / count):.6f}", "20", f"{3 + math.sin(6.2 * i / count) / 2:.6f}")]
    return drawn_room(WALLS_OF_ROOM + ["0", "LWPOLYLINE", "8", "floors", "90", str(count), "70", "1", *corners])


def svg(body, style=""):
    return {"plan.svg": '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
                        'width="8000mm" height="6000mm" viewBox="0 0 800 600">\n' + style + '<g id="walls">\n'
                        '<path d="M 0 0 H 800 V 600 H 0 Z" fill="none" stroke="black"/>\n</g>\n' + body + "</svg>\n"}


def use_tree(leaf, size, fan):
    """Groups that use the one before `fan` times each."""
    each = len('<use href="#g00"/>') * fan + 30
    levels = max(2, min(90, (size - len(leaf)) // each))
    body = f'<defs><g id="g0">{leaf}</g>\n'
    for i in range(1, levels):
        body += f'<g id="g{i}">' + f'<use href="#g{i - 1}"/>' * fan + "</g>\n"
    return svg(body + f'</defs><use href="#g{levels - 1}"/>\n')


def svg_use_text(size):
    leaf = "<text>a</text>\n" * (size // 2 // 15)
    return use_tree(leaf, size, 10)


def svg_use_hidden(size):
    leaf = '<path d="M0 0h1" display="none"/>\n' * (size // 2 // 33)
    return use_tree(leaf, size, 10)


def svg_use_unknown(size):
    leaf = "<b/>" * (size // 2 // 4)
    return use_tree(leaf, size, 10)


def svg_use_empty(size):
    leaf = '<path d=""/>\n' * (size // 2 // 13)
    return use_tree(leaf, size, 10)


def svg_style(size):
    """An element with a long style, used as often as fits."""
    style = "a:b;" * (size // 2 // 4)
    uses = '<use href="#a"/>\n' * (size // 2 // 17)
    return svg(f'<defs><path id="a" d="M1 1h1" style="{style}fill:none"/></defs>{uses}')


def svg_transform(size):
    text = "scale(1)" * (size // 2 // 8)
    uses = '<use href="#a"/>\n' * (size // 2 // 17)
    return svg(f'<defs><path id="a" d="M1 1h1" transform="{text}"/></defs>{uses}')


def svg_classes(size):
    names = " ".join(f"c{i}" for i in range(size // 2 // 6))
    uses = '<use href="#a"/>\n' * (size // 2 // 17)
    return svg(f'<defs><path id="a" d="M1 1h1" class="{names}"/></defs>{uses}', "<style>.x{fill:none}</style>\n")


def svg_rules(size):
    """One class of a long rule, asked for by every element."""
    rules = ".a{" + "a:b;" * 900 + "fill:none}\n"
    uses = '<path class="a" d="M1 1"/>\n' * ((size - len(rules)) // 26)
    return svg(uses, f"<style>{rules}</style>\n")


def svg_css_comments(size):
    return svg("", "<style>" + "/**/" * (size // 4) + "</style>\n")


def svg_css_selectors(size):
    return svg("", "<style>" + ",".join(f"a{i}" for i in range(size // 7)) + "{a:b}</style>\n")


def svg_css_rules(size):
    """Rules that apply, each to no element."""
    return svg("", "<style>" + ",".join(f".a{i}" for i in range(size // 8)) + "{fill:none}</style>\n")


def svg_css_classes(size):
    """A rule for the class of each element."""
    count = size // 2 // 34
    return svg("".join(f'<path class="a{i}" d="M1 1"/>\n' for i in range(count)),
               "<style>" + "".join(f".a{i}{{fill:none}}" for i in range(count)) + "</style>\n")


def svg_depth(size):
    deep = 150
    group = "<g>" * deep + '<path d="M1 1h1"/>' + "</g>" * deep
    return svg(group * (size // len(group)))


def svg_coincident(size):
    return svg('<path d="M100 100h50"/>\n' * (size // 24))


def svg_long_ids(size):
    """Elements in groups with long names."""
    name = "n" * (size // 2)
    return svg(f'<g id="{name}">' + '<path d="M100 100h50"/>' * (size // 2 // 23) + "</g>")


def sdf_box(i, pose):
    return (f'<link name="l{i}"><pose>{pose}</pose><collision name="c"><geometry><box><size>2 0.1 1</size></box>'
            "</geometry></collision></link>\n")


def sdf_includes(size, place):
    boxes = "".join(sdf_box(i, f"{i % 7} {i // 7} 0.5 0 0 {i}") for i in range(50))
    model = f'<sdf version="1.7"><model name="m">{boxes}</model></sdf>\n'
    include = [f"<include><uri>model://m</uri>{place(i)}</include>\n" for i in range(1000)]
    count = size // len(include[0])
    return {"world.sdf": '<sdf version="1.7"><world name="w">\n' + "".join(include[i % 1000] for i in range(count)) +
                         "</world></sdf>\n",
            "m/model.sdf": model,
            "m/model.config": '<model><name>m</name><sdf version="1.7">model.sdf</sdf></model>\n'}


def sdf_same(size):
    """One model, included where it stands already."""
    return sdf_includes(size, lambda i: "")


def sdf_apart(size):
    return sdf_includes(size, lambda i: f"<pose>{i % 32 * 20} {i // 32 * 20} 0 0 0 0</pose>")


def sdf_nested(size):
    files = {"world.sdf": '<sdf version="1.7"><world name="w"><include><uri>model://m8</uri></include></world></sdf>\n'}
    fan = max(2, size // 9 // 60)
    for i in range(9):
        body = sdf_box(0, "0 0 0.5 0 0 0") if i == 0 else "".join(
            f"<include><uri>model://m{i - 1}</uri><name>n{k}</name></include>\n" for k in range(fan))
        files[f"m{i}/model.sdf"] = f'<sdf version="1.7"><model name="m{i}">{body}</model></sdf>\n'
        files[f"m{i}/model.config"] = f'<model><name>m{i}</name><sdf version="1.7">model.sdf</sdf></model>\n'
    return files


def sdf_frames(size):
    """Poses relative to the one before."""
    links = "".join(f'<link name="l{i}"><pose relative_to="l{i - 1}">0 0 0 0 0 0</pose></link>\n' if i else
                    '<link name="l0"/>\n' for i in range(size // 65))
    return {"world.sdf": f'<sdf version="1.7"><model name="m">{links}{sdf_box("x", "0 0 0.5 0 0 0")}</model></sdf>\n'}


def env_coincident(size):
    walls = "wall from=1,1 to=5,1\n"
    return {"room.env": "#env 1\nfence path=0,0;8,0;8,6;0,6 closed=yes\n" + walls * (size // len(walls))}


def env_coincident_things(size):
    things = "cube at=2,2 size=0.5\n"
    return {"room.env": "#env 1\nfence path=0,0;8,0;8,6;0,6 closed=yes\n" + things * (size // len(things))}


def env_calibrations(size):
    """Cameras that name one large calibration."""
    camera = "camera at=1,1,2 calibration=c.yaml\n"
    return {"room.env": "#env 1\nispace size=8,6\n" + camera * (size // 2 // len(camera)),
            "c.yaml": "image_width: 640\nimage_height: 480\n"
                      "camera_matrix: {data: [430.5, 0, 320.25, 0, 431.5, 240.75, 0, 0, 1]}\n"
                      "corners: [" + "1.5, " * (size // 2 // 5) + "1]\n"}


def env_bad_meshes(size):
    """Records that name one bad mesh."""
    mesh = "mesh file=m.obj\n"
    return {"room.env": "#env 1\nispace size=8,6\n" + mesh * (size // 2 // len(mesh)),
            "m.obj": "v 1 2 3\n" * (size // 2 // 8) + "f 1 2 999999999\n"}


def env_collinear(size):
    """Walls on one line that overlap."""
    count = size // 26
    return {"room.env": "#env 1\nfence path=0,0;80,0;80,6;0,6 closed=yes\n" +
                        "".join(f"wall from={1 + i * 10 / count:.5f},1 to={30 + i * 10 / count:.5f},1\n"
                                for i in range(count))}


def yaml_parts(size):
    parts = "parts:\n  p0: [" + ", ".join(["cube: {at: [1, 1]}"] * (size // 2 // 20)) + "]\n"
    levels = max(2, min(30, size // 2 // 230))
    for i in range(1, levels):
        parts += f"  p{i}: [" + ", ".join([f"place: {{part: p{i - 1}}}"] * 10) + "]\n"
    return {"room.yaml": "ispace: {size: [8, 6]}\n" + parts + f"place: {{part: p{levels - 1}}}\n"}


def yaml_empty_parts(size):
    """The same without a record at the end."""
    levels = 8
    fan = max(2, size // levels // 20)
    parts = "parts:\n  p0: []\n"
    for i in range(1, levels):
        parts += f"  p{i}: [" + ", ".join([f"place: {{part: p{i - 1}}}"] * fan) + "]\n"
    return {"room.yaml": "ispace: {size: [8, 6]}\n" + parts + f"place: {{part: p{levels - 1}}}\n"}


def yaml_repeats(size):
    each = "cube: {at: [1, 1], size: 0.1, repeat: {count: 1000000, step: [0, 0]}}\n"
    return {"room.yaml": "- ispace: {size: [8, 6]}\n" + ("- " + each) * max(1, size // (len(each) + 2))}


def yaml_long_ids(size):
    """Parts in each other, each of which lengthens the ids of all records in it."""
    name = "n" * 200
    parts = "parts:\n  p0: [" + ", ".join(f"cube: {{id: c{i}, at: [1, 1]}}" for i in range(size // 2 // 30)) + "]\n"
    for i in range(1, 30):
        parts += f"  p{i}: [place: {{part: p{i - 1}, id: {name}}}]\n"
    return {"room.yaml": "ispace: {size: [8, 6]}\n" + parts + "place: {part: p29, id: x}\n"}


def yaml_aliases(size):
    levels = 12
    fan = max(2, size // levels // 5)
    text = "x0: &a0 [1, 1]\n" + "".join(f"x{i}: &a{i} [" + ", ".join([f"*a{i - 1}"] * fan) + "]\n"
                                         for i in range(1, levels))
    return {"room.yaml": text}


def yaml_includes(size):
    files = {"room.yaml": "- ispace: {size: [8, 6]}\n" + "- include: b.yaml\n" * (size // 2 // 18),
             "b.yaml": "- cube: {at: [1, 1]}\n" * (size // 2 // 21)}
    return files


def gltf(nodes, meshes, buffer_uri, accessors, views):
    return {"mesh.gltf": json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                                     "nodes": nodes, "meshes": meshes, "accessors": accessors,
                                     "bufferViews": views, "buffers": [buffer_uri]}, separators=(",", ":"))}


def gltf_mesh(nodes, triangles):
    points = b"".join(struct.pack("<9f", 0, 0, i, 1, 0, i, 0, 1, i) for i in range(triangles))
    return gltf(nodes, [{"primitives": [{"attributes": {"POSITION": 0}}]}],
                {"byteLength": len(points), "uri": "data:application/octet-stream;base64," +
                 base64.b64encode(points).decode()},
                [{"bufferView": 0, "componentType": 5126, "count": 3 * triangles, "type": "VEC3",
                  "min": [0, 0, 0], "max": [1, 1, triangles - 1]}],
                [{"buffer": 0, "byteOffset": 0, "byteLength": len(points)}])


def gltf_instances(size):
    """One mesh on as many nodes as fit."""
    nodes = [{"children": list(range(1, max(2, size // 2 // 18)))}]
    nodes += [{"mesh": 0} for _ in range(len(nodes[0]["children"]))]
    return gltf_mesh(nodes, max(1, size // 2 // 48))


def gltf_tree(size):
    """Nodes that hold the next one ten times each."""
    nodes = [{"children": [i + 1] * 10} for i in range(max(3, min(40, size // 2 // 40)))]
    nodes.append({"mesh": 0})
    return gltf_mesh(nodes, max(1, size // 2 // 48))


def ifc(body):
    return {"house.ifc": "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
                         "FILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n"
                         "#1=IFCPROJECT('0',$,'p',$,$,$,$,$,#2);\n#2=IFCUNITASSIGNMENT((#3));\n"
                         "#3=IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.);\n#4=IFCCARTESIANPOINT((0.,0.,0.));\n"
                         "#5=IFCAXIS2PLACEMENT3D(#4,$,$);\n#6=IFCLOCALPLACEMENT($,#5);\n"
                         "#7=IFCBUILDING('1',$,'b',$,$,#6,$,$,$,$,$,$);\n"
                         "#8=IFCBUILDINGSTOREY('2',$,'s',$,$,#6,$,$,$,0.);\n"
                         "#9=IFCRELAGGREGATES('3',$,$,$,#1,(#7));\n#10=IFCRELAGGREGATES('4',$,$,$,#7,(#8));\n" + body +
                         "ENDSEC;\nEND-ISO-10303-21;\n"}


def ifc_box():
    return ("#20=IFCRECTANGLEPROFILEDEF(.AREA.,$,#21,4.,0.2);\n#21=IFCAXIS2PLACEMENT2D(#22,$);\n"
            "#22=IFCCARTESIANPOINT((0.,0.));\n#23=IFCDIRECTION((0.,0.,1.));\n"
            "#24=IFCEXTRUDEDAREASOLID(#20,#5,#23,3.);\n#25=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#24));\n"
            "#26=IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#4,$,$);\n")


def ifc_mappings(size):
    """Shapes that map the one before many times each."""
    body, previous, levels = ifc_box(), 25, 12
    fan = max(2, size // levels // 50)
    for level in range(levels):
        base = 1_000_000 * (level + 1)
        body += f"#{base}=IFCREPRESENTATIONMAP(#5,#{previous});\n"
        body += "".join(f"#{base + 1 + k}=IFCMAPPEDITEM(#{base},#26);\n" for k in range(fan))
        previous = base + fan + 1
        body += (f"#{previous}=IFCSHAPEREPRESENTATION($,'Body','MappedRepresentation',(" +
                 ",".join(f"#{base + 1 + k}" for k in range(fan)) + "));\n")
    body += (f"#30=IFCPRODUCTDEFINITIONSHAPE($,$,(#{previous}));\n#31=IFCWALL('w',$,'w',$,$,#6,#30,$,$);\n"
             "#32=IFCRELCONTAINEDINSPATIALSTRUCTURE('c',$,$,$,(#31),#8);\n")
    return ifc(body)


def ifc_walls_of(size, last):
    """One large shape, #40, and walls of the shape #30 that `last` makes of it."""
    half = size // 2
    boxes = max(1, half // 40)
    body = ifc_box()
    body += "".join(f"#{1000 + i}=IFCEXTRUDEDAREASOLID(#20,#5,#23,3.);\n" for i in range(boxes))
    body += ("#40=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(" +
             ",".join(f"#{1000 + i}" for i in range(boxes)) + "));\n" + last)
    walls = max(1, half // 50)
    body += "".join(f"#{9000000 + i}=IFCWALL('w',$,'w',$,$,#6,#30,$,$);\n" for i in range(walls))
    body += ("#32=IFCRELCONTAINEDINSPATIALSTRUCTURE('c',$,$,$,(" +
             ",".join(f"#{9000000 + i}" for i in range(walls)) + "),#8);\n")
    return ifc(body)


def ifc_mapped_walls(size):
    """All walls map the shape."""
    return ifc_walls_of(size, "#41=IFCREPRESENTATIONMAP(#5,#40);\n#42=IFCMAPPEDITEM(#41,#26);\n"
                        "#43=IFCSHAPEREPRESENTATION($,'Body','MappedRepresentation',(#42));\n"
                        "#30=IFCPRODUCTDEFINITIONSHAPE($,$,(#43));\n")


def ifc_shared_walls(size):
    """All walls have the same shape, without a map."""
    return ifc_walls_of(size, "#30=IFCPRODUCTDEFINITIONSHAPE($,$,(#40));\n")


def teeth(size, row):
    """Points of a comb with teeth over its whole width; row(x, y) writes one."""
    count = max(2, size // 2 // len(row(1.2345, 5.4321)))
    points = [(0, 0)]
    for i in range(count):
        points += [(9, 7 * i / count), (1, 7 * (i + 0.5) / count)]
    return [row(x, y) for x, y in [*points, (0, 8)]]


def ifc_elements(size, head, row, more=""):
    """A box #24 of shape #30, `head`, as many rows as fit, and a relation of all of them to the storey."""
    body = ifc_box() + "#30=IFCPRODUCTDEFINITIONSHAPE($,$,(#25));\n" + head
    count = max(1, size // (len(row(100_000)) + 8))
    body += "".join(row(100_000 + i) for i in range(count))
    return ifc(body + "#32=IFCRELCONTAINEDINSPATIALSTRUCTURE('c',$,$,$,(" +
               ",".join(f"#{100_000 + i}" for i in range(count)) + f"{more}),#8);\n")


def ifc_openings(size):
    """Openings of one wall, on each other."""
    return ifc_elements(size, "#31=IFCWALL('w',$,'w',$,$,#6,#30,$,$);\n",
                        lambda i: f"#{i}=IFCOPENINGELEMENT('o',$,$,$,$,#6,#30,$,$);\n"
                                  f"#{i + 5_000_000}=IFCRELVOIDSELEMENT('v',$,$,$,#31,#{i});\n", ",#31")


def ifc_doors(size):
    """Doors of one opening."""
    return ifc_elements(size, "#31=IFCWALL('w',$,'w',$,$,#6,#30,$,$);\n#33=IFCOPENINGELEMENT('o',$,$,$,$,#6,#30,$,$);\n"
                        "#34=IFCRELVOIDSELEMENT('v',$,$,$,#31,#33);\n",
                        lambda i: f"#{i}=IFCDOOR('d',$,$,$,$,#6,#30,$,2.,1.,$,$,$);\n"
                                  f"#{i + 5_000_000}=IFCRELFILLSELEMENT('f',$,$,$,#33,#{i});\n", ",#31")


def ifc_flights(size):
    """Flights of stairs and lifts on each other."""
    return ifc_elements(size, "#31=IFCWALL('w',$,'w',$,$,#6,#30,$,$);\n",
                        lambda i: f"#{i}=IFC{'STAIR' if i % 2 else 'TRANSPORTELEMENT'}('s',$,$,$,$,#6,#30,$,$);\n", ",#31")


def ifc_clips(size):
    """Walls of a solid from which half spaces are cut, one after the other, as often as readers follow."""
    head = "#27=IFCPLANE(#5);\n#28=IFCHALFSPACESOLID(#27,.T.);\n"
    head += "".join(f"#{1000 + i}=IFCBOOLEANCLIPPINGRESULT(.DIFFERENCE.,#{999 + i if i else 24},#28);\n" for i in range(250))
    head += "#35=IFCSHAPEREPRESENTATION($,'Body','Clipping',(#1249));\n#36=IFCPRODUCTDEFINITIONSHAPE($,$,(#35));\n"
    return ifc_elements(size, head, lambda i: f"#{i}=IFCWALL('w',$,'w',$,$,#6,#36,$,$);\n")


def ifc_repeated(size, first, rows, item):
    """Walls of shapes that use one twice that uses one twice, and so on, as deep as readers follow. rows(id, id of the
    one below) is a level, item(id) what makes a product's shape #45000000 of the topmost."""
    levels = max(1, min(250, size // 200))
    body, previous = first, 900
    for i in range(levels):
        body += rows(2000 + 10 * i, previous)
        previous = 2000 + 10 * i
    head = body + item(previous) + "#36=IFCPRODUCTDEFINITIONSHAPE($,$,(#45000000));\n"
    return ifc_elements(size, head, lambda i: f"#{i}=IFCWALL('w',$,'w',$,$,#6,#36,$,$);\n")


def extrusion_of(profile):
    return (f"#40000000=IFCEXTRUDEDAREASOLID(#{profile},#5,#23,3.);\n"
            "#45000000=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#40000000));\n")


def ifc_curves(size):
    """Curves of curves, down to one without points."""
    return ifc_repeated(size, "#900=IFCPOLYLINE(());\n",
                        lambda i, below: f"#{i + 1}=IFCCOMPOSITECURVESEGMENT(.CONTINUOUS.,.T.,#{below});\n"
                                         f"#{i}=IFCCOMPOSITECURVE((#{i + 1},#{i + 1}),.F.);\n",
                        lambda top: f"#40000001=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#{top});\n" + extrusion_of(40000001))


def ifc_profiles(size):
    """Profiles of profiles."""
    return ifc_repeated(size, "#900=IFCRECTANGLEPROFILEDEF(.AREA.,$,$,4.,2.);\n",
                        lambda i, below: f"#{i}=IFCCOMPOSITEPROFILEDEF(.AREA.,$,(#{below},#{below}),$);\n", extrusion_of)


def ifc_maps(size):
    """Maps of maps, down to one without shapes, and in a loop."""
    return ifc_repeated(size, "#901=IFCSHAPEREPRESENTATION($,'Body','x',(#2002));\n#900=IFCREPRESENTATIONMAP(#5,#901);\n",
                        lambda i, below: f"#{i + 2}=IFCMAPPEDITEM(#{below},#910);\n"
                                         f"#{i + 1}=IFCSHAPEREPRESENTATION($,'Body','x',(#{i + 2},#{i + 2}));\n"
                                         f"#{i}=IFCREPRESENTATIONMAP(#5,#{i + 1});\n",
                        lambda top: "#910=IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#4,$,$);\n"
                                    f"#40000000=IFCMAPPEDITEM(#{top},#910);\n"
                                    "#45000000=IFCSHAPEREPRESENTATION($,'Body','x',(#40000000));\n")


def ifc_booleans(size):
    """Unions of a union with itself, down to a missing solid."""
    return ifc_repeated(size, "#900=IFCCSGSOLID(#901);\n#901=IFCBOOLEANRESULT(.UNION.,#24,#24);\n",
                        lambda i, below: f"#{i}=IFCBOOLEANRESULT(.UNION.,#{below},#{below});\n",
                        lambda top: f"#45000000=IFCSHAPEREPRESENTATION($,'Body','x',(#{top}));\n")


def ifc_point_lists(size):
    """Curves of two points each of one long list."""
    points = ",".join(f"({i}.,0.)" for i in range(max(2, size // 20)))
    return ifc_elements(size // 2, f"#40=IFCCARTESIANPOINTLIST2D(({points}));\n",
                        lambda i: f"#{i}=IFCWALL('w',$,'w',$,$,#6,#{i + 5_000_000},$,$);\n"
                                  f"#{i + 5_000_000}=IFCPRODUCTDEFINITIONSHAPE($,$,(#{i + 6_000_000}));\n"
                                  f"#{i + 6_000_000}=IFCSHAPEREPRESENTATION($,'FootPrint','x',(#{i + 7_000_000}));\n"
                                  f"#{i + 7_000_000}=IFCGEOMETRICCURVESET((#{i + 8_000_000}));\n"
                                  f"#{i + 8_000_000}=IFCINDEXEDPOLYCURVE(#40,(IFCLINEINDEX((1,2))),$);\n")


def ifc_shells(size):
    """Surfaces of one shell, again and again."""
    uses = ",".join(["#40"] * max(1, size // 10))
    faces = ",".join(["#41"] * max(1, size // 10))
    return ifc_elements(400, f"#40=IFCOPENSHELL(({faces}));\n#41=IFCFACE((#42));\n#42=IFCFACEOUTERBOUND(#43,.T.);\n"
                             f"#43=IFCPOLYLOOP((#4,#4,#4));\n#44=IFCSHELLBASEDSURFACEMODEL(({uses}));\n"
                             "#35=IFCSHAPEREPRESENTATION($,'Body','x',(#44));\n#36=IFCPRODUCTDEFINITIONSHAPE($,$,(#35));\n",
                        lambda i: f"#{i}=IFCWALL('w',$,'w',$,$,#6,#36,$,$);\n")


def ifc_long_points(size):
    """A point with a long tail, read by all corners of a line."""
    corners = ",".join(["#41"] * max(3, size // 10))
    return ifc_elements(400, f"#40=IFCPOLYLINE(({corners}));\n#41=IFCCARTESIANPOINT((1.,2.),'{'x' * (size // 2)}');\n" +
                        "#42=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#40);\n" + extrusion_of(42) +
                        "#36=IFCPRODUCTDEFINITIONSHAPE($,$,(#45000000));\n",
                        lambda i: f"#{i}=IFCWALL('w',$,'w',$,$,#6,#36,$,$);\n")


def ifc_of_storeys(size, step):
    """Storeys with this much between their heights, each with a wall."""
    def row(i):
        return (f"#{i}=IFCBUILDINGSTOREY('2',$,'s',$,$,$,$,$,$,{(i - 100_000) * step:.4f});\n"
                f"#{i + 2_000_000}=IFCWALL('w',$,'w',$,$,#6,#30,$,$);\n"
                f"#{i + 4_000_000}=IFCRELCONTAINEDINSPATIALSTRUCTURE('c',$,$,$,(#{i + 2_000_000}),#{i});\n")
    count = max(1, size // (len(row(100_000)) + 8))
    return ifc(ifc_box() + "#30=IFCPRODUCTDEFINITIONSHAPE($,$,(#25));\n" + "".join(row(100_000 + i) for i in range(count)) +
               "#11=IFCRELAGGREGATES('9',$,$,$,#7,(" + ",".join(f"#{100_000 + i}" for i in range(count)) + "));\n")


def ifc_storeys(size):
    """Level storeys."""
    return ifc_of_storeys(size, 0)


def ifc_levels(size):
    """Walls through all storeys."""
    return ifc_of_storeys(size, 0.0003)


def ifc_placements(size):
    """Placements relative to one another, a wall on each."""
    def row(i):
        return (f"#{i}=IFCWALL('w',$,'w',$,$,#{i + 5_000_000},#30,$,$);\n"
                f"#{i + 5_000_000}=IFCLOCALPLACEMENT(#{i + 4_999_999},#5);\n")
    return ifc_elements(size, "#5099999=IFCLOCALPLACEMENT($,#5);\n", row)


def ifc_spans(size):
    """A profile whose outline crosses itself with each edge."""
    points = ",".join(f"({9 * (i % 2)}.,{7 * i % 1000 / 100:.2f})" for i in range(size // 14))
    return ifc(ifc_box() + f"#40=IFCCARTESIANPOINTLIST2D(({points}));\n#41=IFCINDEXEDPOLYCURVE(#40,$,$);\n"
               "#42=IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#41);\n#43=IFCEXTRUDEDAREASOLID(#42,#5,#23,3.);\n"
               "#44=IFCSHAPEREPRESENTATION($,'Body','SweptSolid',(#43));\n#30=IFCPRODUCTDEFINITIONSHAPE($,$,(#44));\n"
               "#31=IFCWALL('w',$,'w',$,$,#6,#30,$,$);\n#32=IFCRELCONTAINEDINSPATIALSTRUCTURE('c',$,$,$,(#31),#8);\n")


def prism(number, x, y, size, height=2.5):
    """Twelve triangles of an upright box, as text of OBJ; its vertices begin after 8 * number others."""
    corners = [(x, y), (x + size[0], y), (x + size[0], y + size[1]), (x, y + size[1])]
    text = "".join(f"v {cx:g} {cy:g} {z:g}\n" for z in (0, height) for cx, cy in corners)
    first = 8 * number + 1
    for a, b, c, d in ((0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)):
        text += f"f {first + a} {first + b} {first + c} {first + d}\n"
    return text


def obj_crossing(size):
    """Long boxes that all cross each other."""
    count = max(2, size // 200)
    return {"mesh.obj": "".join(prism(i, 0, 20 * i / count, (20, 0.001)) if i % 2 else
                                prism(i, 20 * i / count, 0, (0.001, 20)) for i in range(count))}


def obj_nested(size):
    """Boxes in each other, which do not touch."""
    count = max(2, size // 200)
    return {"mesh.obj": "".join(prism(i, 9 * i / count, 9 * i / count, (20 - 18 * i / count, 20 - 18 * i / count))
                                for i in range(count))}


def obj_fan(size):
    """A face of thousands of corners."""
    count = size // 40
    return {"mesh.obj": prism(0, 0, 0, (8, 6)) +
            "".join(f"v {4 + math.cos(i / count * 6):.5f} {3 + math.sin(i / count * 6):.5f} {i % 2 * 2}\n" for i in range(count)) +
            "f " + " ".join(str(9 + i) for i in range(count)) + "\n"}


def sdf_cuts(size):
    """Meshes that make an outline with as many corners, cut in a world whose boxes enclose no room."""
    tooth = ("<link name='l{0}'><pose>{1:g} {2:g} 0 0 0 {3:g}</pose><collision name='c'><geometry><mesh><uri>wall.obj</uri>"
             "</mesh></geometry></collision></link>")
    count = max(4, size // len(tooth))
    radius = 0.015 * count / (2 * math.pi)  # as many walls a metre, each longer than the welding of corners
    links = [tooth.format(i, radius * math.cos(2 * math.pi * i / count), radius * math.sin(2 * math.pi * i / count),
                          2 * math.pi * i / count) for i in range(count)]
    return {"world.sdf": "<sdf version='1.7'><world name='w'><model name='m'><static>true</static>" + "".join(links) +
            "</model></world></sdf>\n",
            "wall.obj": prism(0, 0, -0.018, (0.05, 0.036))}


def aria_lines(size):
    """Lines of a map that all cross."""
    count = max(2, size // 26)
    lines = "".join(f"0 {9000 * i // count} 9000 {9000 * (count - i) // count}\n" for i in range(count))
    return {"room.map": f"2D-Map\nLineMinPos: 0 0\nLineMaxPos: 9000 9000\nNumLines: {count}\nLINES\n{lines}DATA\n"}


def aria_cairns(size):
    return {"room.map": "2D-Map\nLineMinPos: 0 0\nLineMaxPos: 9000 9000\nNumLines: 4\n" +
            'Cairn: Goal 100 100 0 "" ICON "g"\n' * (size // 33) +
            "LINES\n0 0 9000 0\n9000 0 9000 9000\n9000 9000 0 9000\n0 9000 0 0\nDATA\n"}


def expo(more):
    return {"house.json": json.dumps({"id": "h", "verts": more, "bbox": {"min": [0, 0], "max": [9, 9]}, "room_category": {}})}


def expo_comb(size):
    return expo(teeth(size, lambda x, y: [x, round(y, 4)]))


def yaml_alias_paths(size):
    """Fences along one long line."""
    path = ", ".join(f"[{1 + i % 2 * 6}, {1 + i % 997 / 200:.3f}]" for i in range(size // 2 // 12))
    return {"room.yaml": f"- ispace: {{size: [8, 6]}}\n- fence: {{path: &p [{path}]}}\n" +
            "- fence: {path: *p}\n" * (size // 2 // 20)}


def env_comb(size):
    return {"room.env": "#env 1\nfence closed=yes path=" + ";".join(teeth(size, lambda x, y: f"{x:g},{y:.4f}")) + "\n"}


def env_comb_zone(size):
    return {"room.env": "#env 1\nispace size=20,20\nzone id=z path=" +
                        ";".join(teeth(size, lambda x, y: f"{x:g},{y:.4f}")) + "\n"}


def fractions(points):
    return f"{len(points)} " + " ".join(points)


def pol_comb(size):
    return {"gallery.pol": fractions(teeth(size, lambda x, y: f"{x}/1 {y * 10000:.0f}/10000")) + "\n"}


def pol_star(size):
    """A polygon that crosses itself with each edge."""
    count = size // 26 | 1
    turns = [2 * math.pi * i * (count // 2) / count for i in range(count)]
    return {"gallery.pol": fractions([f"{5000 * math.cos(t):.0f}/1000 {5000 * math.sin(t):.0f}/1000" for t in turns]) + "\n"}


def pol_holes(size):
    """Holes that lie on each other."""
    hole = "3 1/1 1/1 2/1 1/1 1/1 2/1 "
    return {"gallery.pol": "4 0/1 0/1 9/1 0/1 9/1 9/1 0/1 9/1 " + f"{size // len(hole)} " + hole * (size // len(hole)) + "\n"}


STOREYS = 200  # of a building, at most


def house_rooms(size):
    """Storeys whose rooms repeat, each in a file."""
    cube = "- cube: {at: [1, 1], size: 0.1, repeat: {count: 60000, step: [0, 0]}}\n"
    room = "- ispace: {size: [8, 6]}\n"
    count = min(STOREYS, size // 150)
    files = {"house.env": "#env 1\n" + "".join(f"storey id=s{i} file=r{i}.yaml z={i * 3}\n" for i in range(count))}
    files.update({f"r{i}.yaml": room + cube * max(1, (size - 35 * count) // count // len(cube)) for i in range(count)})
    return files


def house_inline(size):
    """The same in one file."""
    cube = "{cube: {at: [1, 1], size: 0.1, repeat: {count: 60000, step: [0, 0]}}}, "
    count = min(STOREYS, size // 150)
    cubes = cube * max(1, size // count // len(cube))
    return {"house.yaml": "".join(f"- storey: {{id: s{i}, z: {3 * i}, records: [{cubes}ispace: {{size: [8, 6]}}]}}\n"
                                  for i in range(count))}


def house_aliases(size):
    """One large room of all storeys."""
    cube = "{cube: {at: [1, 1], size: 0.1}}, "
    return {"house.yaml": "- storey: {id: s, records: &r [" + cube * (size // len(cube)) + "{ispace: {size: [8, 6]}}]}\n" +
                          "".join(f"- storey: {{id: s{i}, z: {3 * i + 3}, records: *r}}\n" for i in range(STOREYS - 1))}


def house_of_storeys(more):
    return {"house.env": "#env 1\n" + "".join(f"storey id=s{i} file=r.env z={i * 3}\n" for i in range(STOREYS)) + more,
            "r.env": "#env 1\nispace size=8,6\n"}


def house_passages(size):
    """Stairs through all storeys."""
    stairs = f"stairs storeys={','.join(f's{i}' for i in range(STOREYS))} at=1,1 size=1.2,3\n"
    return house_of_storeys(stairs * max(1, size // len(stairs)))


def house_lifts(size):
    """Lifts through all storeys on each other."""
    lift = f"lift storeys={','.join(f's{i}' for i in range(STOREYS))} at=2,2 size=1.2,1.2\n"
    return house_of_storeys(lift * max(1, size // len(lift)))


def house_shafts(size):
    """Openings between two storeys on each other."""
    shaft = "shaft storeys=s1,s2 path=1,1;2,1;2,2\n"
    return house_of_storeys(shaft * (size // len(shaft)))


def house_unknown(size):
    """Passages between storeys that the building lacks."""
    shaft = f"shaft storeys=s1,t{'b' * 40} path=1,1;2,1;2,2\n"
    return house_of_storeys(shaft * (size // len(shaft)))


def rmf(levels):
    return {"house.building.yaml": "name: b\ncoordinate_system: cartesian_meters\nlevels:\n" + levels + "lifts: {}\n"}


def rmf_aliases(size):
    """A grid of walls in all levels, and vertices to the size."""
    vertices, walls = [[0, 0], [80, 0], [80, 60], [0, 60]], [[0, 1], [1, 2], [2, 3], [3, 0]]
    for i in range(min(120, size // 150)):
        vertices += [[i / 2, 1], [i / 2, 59]] if i % 2 else [[1, i / 2], [79, i / 2]]
        walls.append([len(vertices) - 2, len(vertices) - 1])
    vertices += [[1, 1]] * max(0, (size - 18_000) // 8)
    return rmf("".join(f"  L{i}:\n    elevation: {3 * i}\n    vertices: " +
                       (f"&v {vertices}\n    walls: &w {walls}\n" if i == 0 else "*v\n    walls: *w\n")
                       for i in range(min(STOREYS, size // 150))))


def rmf_of_walls(count, doors):
    """A level with walls between two rows of vertices, and `doors` as text."""
    vertices = [[0, 0], [80, 0], [80, 60], [0, 60]] + [[i % 800 / 10, y] for i in range(count) for y in (1, 59)]
    walls = [[0, 1], [1, 2], [2, 3], [3, 0]] + [[4 + 2 * i, 5 + 2 * i] for i in range(count)]
    return rmf(f"  L:\n    elevation: 0\n    vertices: {vertices}\n    walls: {walls}\n    doors: {doors}\n")


def rmf_doors(size):
    """Doors on one edge, and walls."""
    return rmf_of_walls(min(500, size // 60), [[0, 1, {"type": [1, "hinged"]}]] * max(1, (size - 30_000) // 31))


def rmf_fiducials(size):
    """Levels that are laid on each other by thousands of points."""
    points = "[" + ", ".join(f"[{i}, {i}, f{i}]" for i in range(size // 22)) + "]"
    return rmf("".join(f"  L{i}:\n    elevation: {3 * i}\n    vertices: [[0, 0], [8, 0], [8, 6], [0, 6]]\n"
                       "    walls: [[0, 1], [1, 2], [2, 3], [3, 0]]\n"
                       f"    fiducials: {'&f ' + points if i == 0 else '*f'}\n" for i in range(min(STOREYS, size // 150))))


def batch_jobs(size):
    """Jobs that fail, each with its message."""
    return {"list": "none.env none.3dm\n" * (size // 18)}


def batch_words(size):
    return {"list": "a " * (size // 2) + "\n"}


def batch_quotes(size):
    return {"list": ('"' + "\\" * 60 + '" "b"\n') * (size // 67)}


PREFIXES = ("dxf_", "svg_", "sdf_", "env_", "pol_", "house_", "rmf_", "yaml_", "gltf_", "ifc_", "obj_", "aria_", "expo_",
            "batch_")
FAMILIES = {name: make for name, make in globals().items()
            if callable(make) and name.startswith(PREFIXES) and name not in
            ("sdf_box", "sdf_includes", "ifc_box", "ifc_walls_of", "ifc_elements", "ifc_of_storeys", "ifc_repeated", "gltf_mesh", "house_of_storeys",
                                                                             "rmf_of_walls")}


def all_families():
    return [*FAMILIES, *layouts.FAMILIES, *verbs.FAMILIES]


def lists_of(family):
    """The module of a family of lists, else None."""
    return next((one for one in (layouts, verbs) if family in one.FAMILIES), None)


# Readers that refuse a file of 60 kB: a budget ends its work, or it is no room. All others read theirs.
REFUSED = frozenset("""
    dxf_missing dxf_missing_nested dxf_empty_block dxf_empty_polylines dxf_circles_of_nothing dxf_lines dxf_crossing_blocks
    svg_use_text svg_use_hidden svg_use_unknown svg_use_empty sdf_same sdf_apart sdf_nested sdf_frames
    env_bad_meshes env_collinear yaml_parts yaml_empty_parts yaml_repeats yaml_long_ids yaml_aliases yaml_includes
    gltf_instances gltf_tree ifc_mappings ifc_mapped_walls ifc_shared_walls ifc_clips ifc_curves ifc_profiles
    ifc_maps ifc_booleans ifc_point_lists ifc_shells ifc_long_points obj_crossing aria_lines yaml_alias_paths
    pol_star house_rooms house_inline house_unknown rmf_aliases rmf_fiducials batch_jobs batch_words batch_quotes
""".split())


def expected_of(family):
    lists = lists_of(family)
    return "refusal" if (lists.is_refused(family) if lists else family in REFUSED) else "result"


def outcome(status, said):
    """How a command ended: "result" (also an unmet requirement, or findings), "refusal" or "failure"."""
    if status == 1 and re.match(r"\w+Error\b", said):
        return "failure"  # of a program in Python
    if status == 1:
        return "refusal" if ": error: " in said else "result"
    return "result" if status in (0, 3) else "failure"


def files_of(family, size):
    lists = lists_of(family)
    return lists.files(family, size) if lists else FAMILIES[family](size)


def command(envc, family, operand):
    """The command that reads such a file."""
    if lists := lists_of(family):
        return lists.command(os.path.dirname(envc), family, operand)
    if family.startswith("batch_"):
        return [os.path.join(os.path.dirname(envc), "coverage"), "--batch", operand]
    return [envc, "--info", operand, *(["--slice-walls", "1"] if family.startswith("obj_") else [])]


def write(name, size, folder):
    """Returns the operand and the size of all files."""
    total, operand = 0, ""
    for file, text in files_of(name, size).items():
        path = os.path.join(folder, file)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        with open(path, "w", encoding="utf-8") as out:
            out.write(text)
        total += os.path.getsize(path)
        operand = operand or path
    return operand, total


# Runs its arguments and prints exit status, processor time in seconds and peak memory in KiB. A process of its own: a
# child counts the memory of its parent until it executes a program, and a whole run of torture is larger than envc.
LAUNCHER = """
import os, sys
silence = [(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)]
child = os.posix_spawn(sys.argv[1], sys.argv[1:], os.environ, file_actions=silence)
_, status, usage = os.wait4(child, 0)
print(os.waitstatus_to_exitcode(status), usage.ru_utime, usage.ru_maxrss)
"""


def run(command, seconds):
    """Exit status, processor time of the program itself in seconds, peak memory in bytes and the last line on stderr.

    Without the system's time for it: that is for pages above all, which memory counts, and differs from run to run.
    """
    def bound():
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    done = subprocess.run([sys.executable, "-IS", "-c", LAUNCHER, *command], capture_output=True, check=True,
                          preexec_fn=bound, text=True, errors="replace")
    status, spent, memory = done.stdout.split()
    return int(status), float(spent), int(memory) * 1024, (done.stderr.splitlines() or [""])[-1]


# The cost of an input beyond one of START_BYTES counts as this much at least: less is noise. Families with a cheaper
# largest file continue with larger sizes, up to MOST_BYTES. Where even that one takes less than CHEAP_SECONDS, as where
# a budget ends the work, the time of the smallest is noise and no exponent is judged.
START_BYTES, LEAST_SECONDS, LEAST_BYTES, MOST_BYTES = 400, 0.02, 16e6, 16_000_000
CHEAP_SECONDS = 25 * LEAST_SECONDS
STEEPEST, REPEATS = 1.2, 2


def slope(points):
    """The exponent b of y = a x^b by least squares of the logarithms."""
    x, y = [math.log(p[0]) for p in points], [math.log(p[1]) for p in points]
    middle_x, middle_y = sum(x) / len(x), sum(y) / len(y)
    return (sum((u - middle_x) * (v - middle_y) for u, v in zip(x, y)) / sum((u - middle_x) ** 2 for u in x))


class Growth:
    """Time and memory of a family over files of some sizes, beyond those of a small one, as exponents of the size."""

    def __init__(self, envc, family, sizes, seconds, most=None):
        self.rows, self.wrong, self.said = [], "", ""
        lists = lists_of(family)
        most = most or (lists.MOST_BYTES if lists else MOST_BYTES)
        self.steepest = lists.steepest(family) if lists else STEEPEST
        _, *start = self.measure(envc, family, START_BYTES, seconds)
        expected = expected_of(family)
        is_first = True
        while True:
            self.rows = []
            for i, size in enumerate(sizes):
                # Readers are judged by their smallest file: a budget refuses larger ones of many.
                is_judged = lists or (is_first and i == 0)
                self.rows.append(self.measure(envc, family, size, seconds, expected if is_judged else ""))
            self.seconds = max(row[1] for row in self.rows) - start[0]
            # What every size takes, as the first suggestion does, hides how the rest grows.
            is_hidden = family.startswith("suggest_") and self.rows[0][1] <= 2 * start[0]
            is_judged = self.seconds > CHEAP_SECONDS and not is_hidden
            if is_judged or 4 * sizes[-1] > (2 * most if is_hidden else most) or self.wrong:
                break
            sizes, is_first = [4 * size for size in sizes], False
        self.sizes, self.start = sizes, start
        self.fit()
        bound = lists.memory_bound(family) if lists else None
        if bound and not self.wrong:
            total, _, memory = self.measure(envc, family, bound[0], seconds)
            if memory > bound[1]:
                self.wrong = f"{memory / 1e6:.0f} MB for {total / 1000:.0f} kB"

    def fit(self):
        least = max(LEAST_SECONDS, self.start[0] / 4)
        self.time = slope([(n, max(spent - self.start[0], least)) for n, spent, _ in self.rows])
        self.space = slope([(n, max(memory - self.start[1], LEAST_BYTES)) for n, _, memory in self.rows])

    def repeat(self, envc, family, seconds):
        """Measures each size again and keeps the least."""
        _, *start = self.measure(envc, family, START_BYTES, seconds)
        self.start = list(map(min, self.start, start))
        again = [self.measure(envc, family, size, seconds) for size in self.sizes]
        self.rows = [tuple(map(min, old, new)) for old, new in zip(self.rows, again)]
        self.fit()

    def measure(self, envc, family, size, seconds, expected=""):
        """expected: "result" or "refusal"; either without it."""
        with tempfile.TemporaryDirectory() as folder:
            operand, total = write(family, size, folder)
            status, spent, memory, said = run(command(envc, family, operand), seconds)
        ended = outcome(status, said)
        if not self.wrong:
            self.said = said
            if ended == "failure":
                self.wrong = f"status {status} of {total} bytes"
            elif expected and ended != expected:
                self.wrong = f"a {ended} of {total} bytes instead of a {expected}"
        return total, spent, memory

    def is_steep(self):
        is_slow = self.time > self.steepest and self.seconds > CHEAP_SECONDS
        return is_slow or self.space > self.steepest

    def is_violated(self):
        return self.is_steep() or bool(self.wrong)

    def text(self, family):
        rows = "".join(f"{n / 1000:7.0f}{spent:7.2f}{memory / 1e6:6.0f}" for n, spent, memory in self.rows)
        return (f"{family:24}{rows}  {self.time:5.2f} {self.space:5.2f}" +
                ("  TOO STEEP" if self.is_steep() else "") + ("  " + self.wrong if self.wrong else ""))


def smallest_of(family):
    lists = lists_of(family)
    return lists.SMALLEST if lists else SMALLEST


def growth_of(envc, family, smallest, seconds, most=None):
    """Measured again where it is too steep: a busy machine takes time from some sizes and not from others."""
    sizes = [smallest * 2 ** i for i in range(SIZES)]
    growth = Growth(envc, family, sizes, seconds, most)
    for _ in range(REPEATS):
        if growth.is_steep() and not growth.wrong:
            growth.repeat(envc, family, seconds)
    return growth


SIZES, SMALLEST = 4, 60_000
HEAD = f"{'family':24}{'     kB      s    MB' * SIZES}  exponents of time and memory"


def measure(options):
    """Prints the growth of each family. Returns how many grow too fast."""
    steep = 0
    print(HEAD)
    for family in options.family:
        lists = lists_of(family)
        most = lists.LONG_BYTES if options.long and lists else None
        growth = growth_of(options.envc, family, options.bytes or smallest_of(family), options.seconds, most)
        print(growth.text(family), flush=True)
        steep += growth.is_violated()
    return steep


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("list", help="print the families")
    one = commands.add_parser("write", help="write a family's files and print the operand")
    one.add_argument("family", choices=all_families())
    one.add_argument("bytes", type=int)
    one.add_argument("folder")
    all_ = commands.add_parser("measure", help="print time and memory against size as exponents; over 1.2 fails, over 1.3 of lists")
    all_.add_argument("envc")
    all_.add_argument("family", nargs="*", default=all_families())
    all_.add_argument("--bytes", type=int, default=None, help="the smallest of four sizes, each twice the one before")
    all_.add_argument("--long", action="store_true", help="lists of layouts up to 256 kB instead of 32 kB")
    all_.add_argument("--seconds", type=int, default=60, help="of processor time, at most, for each")
    options = parser.parse_args()
    if options.command == "list":
        print("\n".join(all_families()))
    elif options.command == "write":
        print(write(options.family, options.bytes, options.folder)[0])
    else:
        sys.exit(1 if measure(options) else 0)


if __name__ == "__main__":
    main()

# SPDX-License-Identifier: GPL-3.0-or-later
"""Rooms in the other formats, for the table of drawings.py: buildings, worlds, maps, meshes and clouds.

The room is 8 m x 6 m between walls of 0.2 m, in each format as its programs write it. With
ISPACE_TEST_DATA, buildings and maps that strangers drew follow, with the areas that their sources state.
"""
import math
import os
import zipfile

LENGTH, WIDTH, THICK, HIGH = 8, 6, .2, 2.5
ROOM = LENGTH * WIDTH
# Walls as boxes: x, y, length, width.
BOXES = [(-THICK, -THICK, LENGTH + 2 * THICK, THICK), (-THICK, WIDTH, LENGTH + 2 * THICK, THICK),
         (-THICK, 0, THICK, WIDTH), (LENGTH, 0, THICK, WIDTH)]
ACROSS = (3, 0, THICK, WIDTH)  # a wall through the room


class Ifc:
    """Builds a file of IFC4 with one storey, or two."""

    def __init__(self, unit=1, before=""):
        self.unit, self.before, self.lines, self.next, self.products = unit, before, [], 100, {10: [], 11: []}
        self.lines += [
            "#1=IFCCARTESIANPOINT((0.,0.,0.));", "#2=IFCAXIS2PLACEMENT3D(#1,$,$);",
            "#3=IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-05,#2,$);",
            "#4=IFCSIUNIT(*,.LENGTHUNIT.,%s,.METRE.);" % (".MILLI." if unit == 1000 else "$"),
            "#5=IFCUNITASSIGNMENT((#4));", "#6=IFCPROJECT('p',$,'p',$,$,$,$,(#3),#5);",
            "#7=IFCLOCALPLACEMENT($,#2);", "#8=IFCBUILDING('b',$,'b',$,$,#7,$,$,.ELEMENT.,$,$,$);",
            "#9=IFCRELAGGREGATES('r0',$,$,$,#6,(#8));",
            "#10=IFCBUILDINGSTOREY('s0',$,'Ground',$,$,#7,$,$,.ELEMENT.,0.);",
            "#11=IFCBUILDINGSTOREY('s1',$,'Upper',$,$,#7,$,$,.ELEMENT.,%.1f);" % (3 * unit),
        ]

    def add(self, text):
        self.next += 1
        self.lines.append("#%d=%s;" % (self.next, text))
        return self.next

    def numbers(self, *values):
        return ",".join("%.6f" % (v * self.unit) for v in values)

    def product(self, kind, item, shape="SweptSolid", storey=10, name="w", more=",$"):
        body = "$"
        if item is not None:
            body = "#%d" % self.add("IFCPRODUCTDEFINITIONSHAPE($,$,(#%d))" % self.add(
                "IFCSHAPEREPRESENTATION(#3,'Body','%s',(#%d))" % (shape, item)))
        made = self.add("%s('g%d',$,'%s',$,$,#7,%s,$%s)" % (kind, self.next, name, body, more))
        if storey:
            self.products[storey].append(made)
        return made

    def extrusion(self, box, low=0., high=HIGH):
        x, y, length, width = box
        centre = self.add("IFCCARTESIANPOINT((%s))" % self.numbers(x + length / 2, y + width / 2))
        profile = self.add("IFCRECTANGLEPROFILEDEF(.AREA.,$,#%d,%s)" % (
            self.add("IFCAXIS2PLACEMENT2D(#%d,$)" % centre), self.numbers(length, width)))
        place = self.add("IFCAXIS2PLACEMENT3D(#%d,$,$)" % self.add("IFCCARTESIANPOINT((%s))" % self.numbers(0, 0, low)))
        return self.add("IFCEXTRUDEDAREASOLID(#%d,#%d,#%d,%s)" % (
            profile, place, self.add("IFCDIRECTION((0.,0.,1.))"), self.numbers(high - low)))

    def tessellation(self, box):
        x, y, length, width = box
        corners = [(x + i * length, y + j * width, k * HIGH) for k in (0, 1) for j in (0, 1) for i in (0, 1)]
        points = self.add("IFCCARTESIANPOINTLIST3D((%s))" % ",".join("(%s)" % self.numbers(*p) for p in corners))
        faces = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3), (2, 4, 8, 6)]
        triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
        return self.add("IFCTRIANGULATEDFACESET(#%d,$,.T.,(%s),$)" % (
            points, ",".join("(%d,%d,%d)" % t for t in triangles)))

    def walls(self, boxes=None, **more):
        for box in boxes or BOXES:
            self.product("IFCWALL", self.extrusion(box), **more)
        return self

    def __str__(self):
        tail = ["#20=IFCRELAGGREGATES('r1',$,$,$,#8,(#10,#11));"]
        for i, (storey, products) in enumerate(self.products.items()):
            if products:
                tail.append("#%d=IFCRELCONTAINEDINSPATIALSTRUCTURE('c%d',$,$,$,(%s),#%d);" % (
                    30 + i, i, ",".join("#%d" % p for p in products), storey))
        return (self.before + "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n"
                "FILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n" +
                "\n".join(self.lines + tail) + "\nENDSEC;\nEND-ISO-10303-21;\n")


def ifc_tessellated():
    d = Ifc()
    for box in BOXES:
        d.product("IFCWALL", d.tessellation(box), "Tessellation")
    return d


def ifc_mapped():
    """Walls of one type share a shape (IfcMappedItem), as of Revit."""
    d = Ifc()
    for x, y, length, width in BOXES:
        shape = d.add("IFCSHAPEREPRESENTATION(#3,'Body','SweptSolid',(#%d))" % d.extrusion((0, 0, length, width)))
        source = d.add("IFCREPRESENTATIONMAP(#2,#%d)" % shape)
        target = d.add("IFCCARTESIANTRANSFORMATIONOPERATOR3D($,$,#%d,1.,$)" % d.add(
            "IFCCARTESIANPOINT((%s))" % d.numbers(x, y, 0)))
        d.product("IFCWALL", d.add("IFCMAPPEDITEM(#%d,#%d)" % (source, target)), "MappedRepresentation")
    return d


def ifc_parts(kind):
    """A wall across the room that consists of parts, and has no shape of its own."""
    d = Ifc().walls()
    whole = d.product("IFCWALL", None)
    x, y, length, width = ACROSS
    parts = [d.product(kind, d.extrusion((x, y + i * width / 3, length, width / 3)), storey=None) for i in range(3)]
    d.add("IFCRELAGGREGATES('ra',$,$,$,#%d,(%s))" % (whole, ",".join("#%d" % p for p in parts)))
    return d


def ifc_unread(storey=10):
    """A wall by a boundary of curved surfaces, as Rhino writes it."""
    d = Ifc().walls()
    if storey == 11:
        d.walls(storey=11)
    d.product("IFCWALL", d.add("IFCADVANCEDBREP($)"), "AdvancedBrep", storey, "free form")
    return d


def ifc_no_body():
    d = Ifc()
    for _ in BOXES:
        d.product("IFCWALL", None)
    return d


def sdf_box(name, box, lean=0):
    x, y, length, width = box
    return ("<model name='%s'><static>1</static><pose>%g %g %g 0 %g 0</pose><link name='l'><collision name='c'><geometry>"
            "<box><size>%g %g %g</size></box></geometry></collision></link></model>\n" % (
                name, x + length / 2, y + width / 2, HIGH / 2, lean, length, width, HIGH))


def sdf_shape(geometry, pose="4 3 0 0 0 0"):
    return ("<model name='thing'><pose>%s</pose><link name='l'><collision name='c'><geometry>%s</geometry></collision>"
            "</link></model>\n" % (pose, geometry))


def sdf(*more):
    walls = "".join(sdf_box("wall%d" % i, box) for i, box in enumerate(BOXES))
    return "<?xml version='1.0'?>\n<sdf version='1.9'><world name='w'>\n%s%s</world></sdf>\n" % (walls, "".join(more))


def mesh_of(boxes, y_up=False):
    vertices, faces = [], []
    for x, y, length, width in boxes:
        first = len(vertices)
        for k in (0, 1):
            for j in (0, 1):
                for i in (0, 1):
                    vertices.append((x + i * length, y + j * width, k * HIGH))
        for a, b, c, d in ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)):
            faces += [(first + a, first + b, first + c), (first + a, first + c, first + d)]
    if y_up:
        vertices = [(x, z, -y) for x, y, z in vertices]
    return vertices, faces


def obj(y_up):
    vertices, faces = mesh_of(BOXES, y_up)
    return ("".join("v %g %g %g\n" % v for v in vertices) +
            "".join("f %d %d %d\n" % tuple(i + 1 for i in f) for f in faces))


def stl():
    vertices, faces = mesh_of(BOXES)
    text = "SOLID room\n"
    for face in faces:
        text += "FACET NORMAL 0 0 0\nOUTER LOOP\n" + "".join("VERTEX %g %g %g\n" % vertices[i] for i in face)
        text += "ENDLOOP\nENDFACET\n"
    return text + "ENDSOLID room\n"


def cloud(stray=False):
    points = []
    for i in range(0, 401):
        for z in range(1, 25):
            points += [(i * .02, 0, z / 10), (i * .02, WIDTH, z / 10)]
            if i <= 300:
                points += [(0, i * .02, z / 10), (LENGTH, i * .02, z / 10)]
    if stray:
        points.append((5000, 5000, 1))
    return ("# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH %d\nHEIGHT 1\n"
            "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA ascii\n" % (len(points), len(points)) +
            "".join("%g %g %g\n" % p for p in points))


def grid(free, wall, unknown):
    """A map of 0.05 m a pixel: the room, its walls, and what the robot did not see."""
    rows = []
    for y in range(-10, 130):
        row = []
        for x in range(-10, 170):
            inside, near = 0 <= x < 160 and 0 <= y < 120, -4 <= x < 164 and -4 <= y < 124
            row.append(free if inside else wall if near else unknown)
        rows.append(" ".join(map(str, row)))
    return "P2\n180 140\n255\n" + "\n".join(rows) + "\n"


def ros(origin=(0, 0), shades=(254, 0, 205), more="negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"):
    return {".yaml": "image: NAME.pgm\nresolution: 0.05\norigin: [%g, %g, 0]\n%s" % (origin + (more,)),
            ".pgm": grid(*shades)}


def moving_ai():
    rows = ["@" * 10] + ["@" + "." * 8 + "@"] * 6 + ["@" * 10]
    return "type octile\nheight 8\nwidth 10\nmap\n" + "\n".join(rows) + "\n"


def zipped(path):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("room.ifc", str(Ifc().walls()))


CUT = ("--slice-walls", "1.2")
# Name: writer of the file (or of files by suffix), options, right area, result.
MADE = {
    "ifc-extruded.ifc": (lambda: Ifc().walls(), (), ROOM, "right"),
    "ifc-millimetres.ifc": (lambda: Ifc(1000).walls(), (), ROOM, "right"),
    "ifc-comment-first.ifc": (lambda: Ifc(1, "/* exported */\n\n").walls(), (), ROOM, "right"),
    "ifc-tessellated.ifc": (ifc_tessellated, (), ROOM, "right"),
    "ifc-mapped.ifc": (ifc_mapped, (), ROOM, "right"),
    "ifc-parts.ifc": (lambda: ifc_parts("IFCBUILDINGELEMENTPART"), (), (LENGTH - 3 - THICK) * WIDTH, "right"),
    "ifc-members.ifc": (lambda: ifc_parts("IFCMEMBER"), (), (LENGTH - 3 - THICK) * WIDTH, "right"),
    "ifc-unread-wall.ifc": (ifc_unread, (), None, "warned"),
    "ifc-unread-upstairs.ifc": (lambda: ifc_unread(11), (), ROOM, "right"),
    "ifc-no-body.ifc": (ifc_no_body, (), None, "refused"),
    "ifc-zip.ifczip": (zipped, (), ROOM, "right"),
    "sdf-boxes.sdf": (sdf, (), ROOM, "right"),
    "sdf-capsule.sdf": (lambda: sdf(sdf_shape("<capsule><radius>.3</radius><length>1</length></capsule>")), (),
                        ROOM - math.pi * .3 ** 2, "right"),
    "sdf-leaning-wall.sdf": (lambda: sdf(sdf_box("lean", ACROSS, .2)), (), None, "warned"),
    "sdf-leaning-far-off.sdf": (lambda: sdf(sdf_box("lean", (30, 0, .2, 6), .2)), (), ROOM, "right"),
    "sdf-wall-across.sdf": (lambda: sdf(sdf_box("across", ACROSS)), (), (LENGTH - 3 - THICK) * WIDTH, "right"),
    "ros-trinary.yaml": (ros, (), ROOM, "right"),
    "ros-survey.yaml": (lambda: ros((448262, 5428611)), (), ROOM, "right"),
    "ros-negated.yaml": (lambda: ros((0, 0), (0, 255, 128), "negate: 1\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"),
                         (), ROOM, "right"),
    "moving-ai.map": (moving_ai, (), ROOM, "right"),
    "mesh-y-up.obj": (lambda: obj(True), CUT, ROOM, "right"),
    "mesh-z-up.obj": (lambda: obj(False), CUT + ("--up", "z"), ROOM, "right"),
    "mesh-upper-case.stl": (stl, CUT, ROOM, "right"),
    "mesh-not-cut.stl": (stl, (), None, "refused"),
    "cloud.pcd": (cloud, ("--slice-walls", "0.5..1.8"), ROOM, "right"),
    "cloud-stray.pcd": (lambda: cloud(True), ("--slice-walls", "0.5..1.8"), ROOM, "right"),
}

# Path below ISPACE_TEST_DATA: options, right area by its source, result. Areas of buildings without
# niches of windows and doorways are 5 % less.
FOUND = {
    "strangers/ifc/openhouse.ifc": ((), 45, "right"),
    "strangers/ifc/duplex.ifc": (("--storey", "level-1"), 129.6, "right"),
    "strangers/ifc/fzk-haus.ifc": (("--storey", "Erdgeschoss"), 104.6, "right"),
    "strangers/nav2/garage.yaml": ((), 54.1, "right"),
    "strangers/nav2/map.yaml": ((), 72.9, "right"),
    "strangers/nav2/office.yaml": ((), 37.9, "right"),
    "strangers/gazebo/turtlebot3_gazebo/worlds/turtlebot3_house.world": ((), 90.5, "right"),
    "strangers/gazebo/turtlebot3_gazebo/worlds/turtlebot3_dqn_stage4.world": ((), 23.5, "right"),
    "strangers/gazebo/small_warehouse/worlds/no_roof_small_warehouse.world": ((), 283, "right"),
    "strangers/dxf/hal9k.dxf": ((), 166, "right"),
    "strangers/dxf/ml3.dxf": ((), 4383, "right"),
    "strangers/svg/oodavid.svg": ((), None, "refused"),
    "strangers/grids/arena.map": ((), 2054, "right"),
    "strangers/grids/random-32-32-20.map": ((), 819, "right"),
    "strangers/mesh/room-y-up.obj": (CUT, 16, "right"),
}
FOUND_TOLERANCE = .05


def made(folder, name):
    """Writes the file, and those beside it. Returns its path."""
    path, writer = os.path.join(folder, name), MADE[name][0]
    if writer is zipped:
        writer(path)
        return path
    content = writer()
    stem = os.path.splitext(path)[0]
    files = content if isinstance(content, dict) else {os.path.splitext(name)[1]: str(content)}
    for suffix, text in files.items():
        with open(stem + suffix, "w", encoding="utf-8") as file:
            file.write(text.replace("NAME", os.path.basename(stem)))
    return path


def format_of(name):
    suffix = os.path.splitext(name)[1]
    return {".ifczip": "IFC", ".yaml": "ROS", ".world": "SDF", ".obj": "meshes", ".stl": "meshes", ".pcd": "clouds",
            ".map": "grids"}.get(suffix, suffix[1:].upper())


def run(folder, only, rows, result):
    """Adds rows as drawings.py has them, by its function `result`. Lines of a world's walls lie in their
    middle: the area between their faces is the free floor."""
    for name, (_, options, right, expected) in MADE.items():
        if only in name:
            key = "free_area" if name.endswith(".sdf") else "indoor_area"
            rows.append((name, expected, right, "") + result(made(folder, name), right, options, key=key))
    data = os.environ.get("ISPACE_TEST_DATA", "")
    for name, (options, right, expected) in FOUND.items():
        path = os.path.join(data, name)
        if data and only in name and os.path.exists(path):
            rows.append((os.path.basename(name), expected, right, "") + result(path, right, options,
                                                                               tolerance=FOUND_TOLERANCE))

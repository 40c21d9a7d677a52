# SPDX-License-Identifier: GPL-3.0-or-later
"""Triangles of a room, how far points are from them, and pictures of clouds of points."""

import io
import math
import struct

from matplotlib import pyplot

from plot import PIXELS


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def read_stl(path):
    """The triangles of a binary STL."""
    with open(path, "rb") as file:
        data = file.read()
    count = struct.unpack_from("<I", data, 80)[0]
    rows = (struct.unpack_from("<9f", data, 84 + 50 * k + 12) for k in range(count))
    return [(row[0:3], row[3:6], row[6:9]) for row in rows]


def nearest(p, triangle):
    """The point of a triangle that is nearest to p (Ericson, Real-Time Collision Detection, 5.1.5)."""
    a, b, c = triangle
    ab, ac, ap = sub(b, a), sub(c, a), sub(p, a)
    d1, d2 = dot(ab, ap), dot(ac, ap)
    if d1 <= 0 and d2 <= 0:
        return a
    bp = sub(p, b)
    d3, d4 = dot(ab, bp), dot(ac, bp)
    if d3 >= 0 and d4 <= d3:
        return b
    cp = sub(p, c)
    d5, d6 = dot(ab, cp), dot(ac, cp)
    if d6 >= 0 and d5 <= d6:
        return c
    vc, vb, va = d1 * d4 - d3 * d2, d5 * d2 - d1 * d6, d3 * d6 - d5 * d4
    if vc <= 0 and d1 >= 0 and d3 <= 0:
        return _along(a, ab, d1 / (d1 - d3)) if d1 != d3 else a
    if vb <= 0 and d2 >= 0 and d6 <= 0:
        return _along(a, ac, d2 / (d2 - d6)) if d2 != d6 else a
    if va <= 0 and d4 >= d3 and d5 >= d6:
        return _along(b, sub(c, b), (d4 - d3) / ((d4 - d3) + (d5 - d6)))
    whole = va + vb + vc
    if whole == 0:
        return a
    return _along(_along(a, ab, vb / whole), ac, vc / whole)


def _along(a, way, share):
    return (a[0] + share * way[0], a[1] + share * way[1], a[2] + share * way[2])


class Surfaces:
    """Triangles in boxes of space, for points that are near them."""

    BOX = 0.25   # metres
    REACH = 0.1  # farther points count as this far

    def __init__(self, triangles):
        self.boxes = {}
        for triangle in triangles:
            low, high = ([self._box(pick(p[axis] for p in triangle) + slack) for axis in range(3)]
                         for pick, slack in ((min, -self.REACH), (max, self.REACH)))
            for x in range(low[0], high[0] + 1):
                for y in range(low[1], high[1] + 1):
                    for z in range(low[2], high[2] + 1):
                        self.boxes.setdefault((x, y, z), []).append(triangle)

    def _box(self, value):
        return math.floor(value / self.BOX)

    def distance(self, p):
        near = self.REACH
        for triangle in self.boxes.get(tuple(self._box(value) for value in p), ()):
            near = min(near, math.dist(p, nearest(p, triangle)))
        return near


def cloud_png(points, width, height, low, high):
    """Points from above and aside, heights from low to high in colours."""
    figure = pyplot.figure(figsize=(width / PIXELS, height / PIXELS), dpi=PIXELS)
    axes = figure.add_axes((-0.2, -0.22, 1.4, 1.42), projection="3d", computed_zorder=False)
    x, y, z = zip(*points)
    axes.scatter(x, y, z, c=z, s=1.5, marker="s", linewidths=0, cmap="viridis", vmin=low, vmax=high,
                 depthshade=False)
    axes.set_box_aspect((max(x) - min(x), max(y) - min(y), max(z) - min(z)))
    axes.view_init(elev=38, azim=-120)
    axes.set_axis_off()
    out = io.BytesIO()
    figure.savefig(out, format="png", metadata={"Software": None})
    pyplot.close(figure)
    return out.getvalue()

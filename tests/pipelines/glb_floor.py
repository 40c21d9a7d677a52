#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds the picture on a model's floor against the cells of coverage: glb_floor.py MODEL.glb
MODEL.obj CELLS.csv [flip]

MODEL.obj is what assimp made of the model: its texture coordinates count from the lower left corner.
In the middle of each indoor cell, the picture, looked up through the floor's triangles, must have the
colour of the number of sensors that see it. With `flip` the picture is turned upside down before.
Exit status: 0 if all colours are right, 1 if not.
"""
import csv
import json
import struct
import sys

import cv2
import numpy


def picture_of(path):
    data = open(path, "rb").read()
    size = struct.unpack_from("<I", data, 12)[0]
    model = json.loads(data[20 : 20 + size])
    binary = data[20 + size + 8 :]
    view = model["bufferViews"][model["images"][0]["bufferView"]]
    start = view.get("byteOffset", 0)
    png = numpy.frombuffer(binary[start : start + view["byteLength"]], numpy.uint8)
    return cv2.imdecode(png, cv2.IMREAD_COLOR)


def floor_of(path):
    """Triangles of the object that has texture coordinates, as (x, y, u, v) of corners."""
    places, points, triangles = [], [], []
    for line in open(path):
        word, *values = line.split() or [""]
        if word == "v":
            points.append([float(value) for value in values[:3]])
        elif word == "vt":
            places.append([float(value) for value in values[:2]])
        elif word == "f":
            corners = [value.split("/") for value in values]
            if all(len(corner) > 1 and corner[1] for corner in corners):
                triangles.append(
                    [
                        (points[int(p) - 1][0], -points[int(p) - 1][2], *places[int(t) - 1])
                        for p, t, *_ in corners
                    ]
                )
    return numpy.array(triangles)


def main():
    picture, triangles = picture_of(sys.argv[1]), floor_of(sys.argv[2])
    if sys.argv[4:] == ["flip"]:
        picture = picture[::-1]
    assert len(triangles) > 0, "no triangle has texture coordinates"
    a, ab, ac = triangles[:, 0, :2], *(triangles[:, i, :2] - triangles[:, 0, :2] for i in (1, 2))
    areas = ab[:, 0] * ac[:, 1] - ab[:, 1] * ac[:, 0]
    height, width, _ = picture.shape
    colors, cells = {}, 0
    for row in csv.DictReader(open(sys.argv[3])):
        if row["indoor"] == "0":
            continue
        way = numpy.array([float(row["x"]), float(row["y"])]) - a
        s = (way[:, 0] * ac[:, 1] - way[:, 1] * ac[:, 0]) / areas
        t = (ab[:, 0] * way[:, 1] - ab[:, 1] * way[:, 0]) / areas
        inside = numpy.flatnonzero((s >= -1e-6) & (t >= -1e-6) & (s + t <= 1 + 1e-6))
        if len(inside) == 0:
            return f"no floor at {row['x']}, {row['y']}"
        i = inside[0]
        corners = triangles[i, :, 2:]
        u, v = corners[0] + s[i] * (corners[1] - corners[0]) + t[i] * (corners[2] - corners[0])
        pixel = picture[int((1 - v) * height), int(u * width)]
        colors.setdefault(row["seen"], set()).add(tuple(pixel.tolist()))
        cells += 1
    print(cells, "cells", colors)
    if cells < 1000 or len(colors) < 3:
        return "too little to compare"
    if any(len(each) != 1 for each in colors.values()):
        return "several colours for one number of sensors"
    if len(set().union(*colors.values())) != len(colors):
        return "one colour for several numbers of sensors"
    return None


if __name__ == "__main__":
    problem = main()
    if problem:
        print(problem)
        sys.exit(1)

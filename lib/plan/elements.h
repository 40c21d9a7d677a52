// SPDX-License-Identifier: GPL-3.0-or-later
// What drawings, GeoJSON and maps need to know of an element: its colour, its lines, its area.
#pragma once

#include <cstddef>
#include <vector>

#include "draw/color.h"
#include "env/body.h"
#include "env/environment.h"
#include "env/mesh.h"
#include "geom/polygon.h"

namespace ispace {

/// A part of a body, seen from above.
struct PartAbove {
    std::vector<Polygon> curves;  ///< by the even-odd rule
    double bottom = 0, top = 0;
    Material material = Material::Wood;
    bool hidden = false;  ///< another part of the body is above all of it
};

/// Prisms and meshes of a body, lower ones first; no sheets, no plates. Parts hidden below one
/// other convex part are told, within a micrometre.
std::vector<PartAbove> partsFromAbove(const Body& body);

/// What triangles cover of the floor, by the even-odd rule. Exact (see unite) for the few triangles
/// of simple bodies; of larger meshes the outline of cells of a 500th of the longer side, smoothed
/// by half a cell. O(triangles + cells).
std::vector<Polygon> silhouette(const Mesh& mesh);

/// What prisms and meshes of a body cover of the floor: disjoint pieces. Where several parts count,
/// none of them above all others, holes of meshes are dropped: what a mesh encloses is covered,
/// too. A single part keeps its holes.
std::vector<Region> footprintOf(const Body& body);

/// Disjoint pieces of the area that curves bound, outlines counter-clockwise and holes clockwise,
/// that touch at points only. O(curves^2).
std::vector<Region> regionsOf(std::vector<Polygon> curves);

/// The colour of a material as screens and paper have it: sRGB of its linear RGB, with its opacity.
Color displayColor(Material material);

/// What a plan draws of an element as lines: mid-lines of walls, and where doors and windows are.
struct ElementLines {
    std::vector<std::vector<Point2>> chains;  ///< closed ones end where they begin; none: no lines
    double thickness = 0;                     ///< of the wall, or through it, in metres
    double bottom = 0, top = 0;               ///< of a door or window
};

/// Of each element. O(n log n).
std::vector<ElementLines> elementLinesOf(const Environment& environment);

/// Area of a `floor` record.
Polygon floorOutline(const Record& record);

/// Segments joined where one begins at the end of the one before.
std::vector<std::vector<Point2>> chained(const std::vector<Segment2>& segments);

/// The solids of a slice, round ones inscribed in their curves, as in bands and meshes.
std::vector<Polygon> inscribedSolids(const Slice& slice);

}  // namespace ispace

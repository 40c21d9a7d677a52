// SPDX-License-Identifier: GPL-3.0-or-later
// Elements as drawings, GeoJSON and maps show them: colours, lines, areas and footprints.
#pragma once

#include <cstddef>
#include <vector>

#include "drawing/color.h"
#include "env/body.h"
#include "env/environment.h"
#include "env/mesh.h"
#include "geom/polygon.h"

namespace ispace {

/// A part of a body, seen from above.
struct OverheadPart {
    std::vector<Polygon> curves;  ///< by the even-odd rule
    double bottom = 0, top = 0;
    Material material = Material::Wood;
    bool hidden = false;  ///< another part of the body is above all of it
};

/// Prisms and meshes of a body, lower ones first; no sheets, no plates. Parts below one convex part
/// are marked hidden, within a micrometre.
std::vector<OverheadPart> partsFromAbove(const Body& body);

/// The floor that triangles cover, by the even-odd rule. Exact (see unite) for few triangles; for
/// larger meshes the outline of cells, a 500th of the longer side, smoothed by half a cell.
/// O(triangles + cells).
std::vector<Polygon> silhouette(const Mesh& mesh);

/// The floor that prisms and meshes of a body cover, in disjoint pieces. A single part keeps its
/// holes; if several parts count, none above all others, holes of meshes are dropped. Round prisms
/// have the area of their curve.
std::vector<Region> footprintOf(const Body& body);

/// Disjoint pieces of the area that curves bound, outlines counter-clockwise and holes clockwise,
/// that touch at points only. O(curves^2).
std::vector<Region> regionsOf(std::vector<Polygon> curves);

/// The colour of a material in sRGB, with its opacity.
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

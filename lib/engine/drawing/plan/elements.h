// SPDX-License-Identifier: GPL-3.0-or-later
// Colours, lines, areas and footprints of elements, for drawings, GeoJSON and maps. Metres, as seen
// from above. Pure functions.
//
//     for (const Element& element : environment.elements())
//         for (const Region& piece : footprintOf(element.body)) fill(piece);
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
    bool hidden = false;  ///< another part of the body covers it from above
};

/// Returns the prisms and meshes of a body, sorted by height, lower ones first; skips sheets and
/// plates. Marks parts below a convex part as hidden, within a micrometre.
std::vector<OverheadPart> partsFromAbove(const Body& body);

/// Computes the floor area below triangles, by the even-odd rule. Exact (see unite) for few
/// triangles; for larger meshes the outline of cells, a 500th of the longer side, smoothed by half
/// a cell. O(triangles + cells).
std::vector<Polygon> silhouette(const Mesh& mesh);

/// Computes the floor area below prisms and meshes of a body, in disjoint pieces. A single part
/// keeps its holes; with several visible parts, holes of meshes are dropped. Round prisms have the
/// area of their curve.
std::vector<Region> footprintOf(const Body& body);

/// Returns disjoint pieces of the area that curves bound, outlines counter-clockwise and holes
/// clockwise, that touch at points only. O(curves^2).
std::vector<Region> regionsOf(std::vector<Polygon> curves);

/// Returns the colour of a material in sRGB, with its opacity.
Color displayColor(Material material);

/// The lines of an element on a plan, if it has any: mid-lines of walls, doors and windows.
struct ElementLines {
    std::vector<std::vector<Point2>> chains;  ///< closed ones repeat the first point
    double thickness = 0;                     ///< of the wall that it is or lies in, in metres
    double bottom = 0, top = 0;
};

/// Computes the lines of each element. O(n log n).
std::vector<ElementLines> elementLinesOf(const Environment& environment);

/// Returns the area of a `floor` record.
Polygon floorOutline(const Record& record);

/// Joins segments into chains if one begins at the end of another.
std::vector<std::vector<Point2>> chained(const std::vector<Segment2>& segments);

/// Returns the solids of a slice, round ones inscribed in their curves, as in bands and meshes.
std::vector<Polygon> inscribedSolids(const Slice& slice);

}  // namespace ispace

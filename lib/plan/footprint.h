// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "env/body.h"
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

}  // namespace ispace

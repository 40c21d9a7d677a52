// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// The pieces of `region` outside all closed `solids` (simple polygons, any orientation, which may
/// overlap and touch). Exact constructions inside (CGAL), rounded to doubles at the end.
/// \throws FormatError (without a place) for outlines that cross each other by the million
std::vector<Region> difference(const Region& region, std::span<const Polygon> solids);

/// The same of each part.
std::vector<Region> difference(const Regions& regions, std::span<const Polygon> solids);

/// The pieces of all closed `solids` together (simple polygons, any orientation, which may overlap
/// and touch). As exact as difference().
std::vector<Region> unite(std::span<const Polygon> solids);

/// Sum of the areas of disjoint regions.
double totalArea(std::span<const Region> regions);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/ifc/reader: the plan of shapes, by level cuts and boxes. Metres, in the
// frame of the shape.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "extensions/ifc/reader/building.h"
#include "extensions/ifc/reader/ifc_shapes.h"

namespace ispace::ifc {

/// Lowest and highest corner of a shape, ignoring its cuts; low above high if it has no corners.
struct IfcHeights {
    double low = 0, high = -1;
    [[nodiscard]] bool empty() const { return low > high; }
};
IfcHeights heightsOf(const IfcShape& shape);

/// Computes the cut through a shape at a height: curves that close within 2 cm are areas, others
/// sheets.
/// O(corners + k log k) for k edges that are cut.
BuildingSection sectionOf(const IfcShape& shape, double height);

/// Computes the height up to which a shape that has a section at `from` reaches, cuts included,
/// within a millimetre: the sections up to there are assumed to have an area.
/// \param pay is called before each further section
double topAbove(const IfcShape& shape, double from, const std::function<void()>& pay);

/// Computes the upright box around a shape with the smallest floor area, or along `preferred` if
/// its floor is at most 2 % larger. std::nullopt for a shape without extent.
std::optional<BuildingBox> boxAround(const IfcShape& shape, Vec2 preferred);

}  // namespace ispace::ifc

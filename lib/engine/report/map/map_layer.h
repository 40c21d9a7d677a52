// SPDX-License-Identifier: GPL-3.0-or-later
// Layers that sections of a report add to its map, see ReportSection::mapLayer().
#pragma once

#include <optional>
#include <string_view>

#include "drawing/drawing.h"
#include "report/map/map_parts.h"

namespace ispace {

/// What a section of a report draws on the plan of a map, below the marks of the sensors.
class MapLayer {
  public:
    MapLayer() = default;
    MapLayer(const MapLayer&) = delete;
    MapLayer& operator=(const MapLayer&) = delete;
    virtual ~MapLayer() = default;
    [[nodiscard]] virtual std::string_view name() const = 0;  ///< of the picture's layer
    virtual void draw(Picture& picture, const MapPicture& map) const = 0;
    /// Returns its block of the legend, before that of unseen spots; empty for none.
    [[nodiscard]] virtual std::optional<LegendBlock> legend() const = 0;
};

}  // namespace ispace

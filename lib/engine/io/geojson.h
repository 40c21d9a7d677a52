// SPDX-License-Identifier: GPL-3.0-or-later
// GeoJSON of plans and coverage, in metres: not the degrees that RFC 7946 asks for, which two
// members say to the programs that know them. Rings follow the right-hand rule of section 3.1.6.
// Equal shapes give equal bytes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/json_writer.h"
#include "geom/polygon.h"

namespace ispace {

/// Writes a GeoJSON FeatureCollection (RFC 7946) in metres of the plan, as its foreign member
/// `"coordinate_system": "local-metres"` says, and `crs` of GeoJSON 2008 to GDAL and QGIS. Each
/// feature is written by begin(), more properties through json(), and a geometry. Outlines
/// counter-clockwise, holes clockwise.
class FeatureWriter {
  public:
    FeatureWriter();
    /// Writer of foreign members before beginFeatures(), and of properties after begin().
    JsonWriter& json() { return json_; }
    void beginFeatures() { json_.key("features").beginArray(); }

    /// Begins a feature and writes its properties id, keyword and type.
    JsonWriter& begin(std::string_view id, std::string_view keyword, std::string_view type);
    void endAsPoint(Point2 p);
    /// Writes one chain, or several.
    void endAsLines(const std::vector<std::vector<Point2>>& chains);
    /// Writes one piece, or several.
    void endAsArea(const std::vector<Region>& pieces);
    void endAsNothing();

    /// Returns the file's text.
    std::string finish();

  private:
    void beginGeometry(std::string_view type);
    void end() { json_.endObject().endObject(); }
    void add(Point2 p) { json_.beginArray().value(p.x).value(p.y).endArray(); }
    void addRing(const Polygon& ring, bool counter_clockwise);

    JsonWriter json_;
};

}  // namespace ispace

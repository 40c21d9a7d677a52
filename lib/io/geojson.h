// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "layout/scene.h"

namespace ispace {

/// The plan as a GeoJSON FeatureCollection (RFC 7946) in metres of the plan, as its foreign member
/// `"coordinate_system": "local-metres"` says; outlines counter-clockwise, holes clockwise, doubles
/// in shortest form.
///
/// Features, each with `id`, `keyword`, `type` and the values of its record: the indoor region and
/// the free floor at kScanHeight (Polygons), then every element: walls, doors and windows as lines
/// (with `height`, `thickness`), zones and floors as Polygons, things as what they cover of the
/// floor, with `bottom` and `top`; inside points, sensors, tags, robots and people as Points with
/// `heading`, mats as Polygons, gates as lines.
///
/// With a height, only what the slice has there: free floor, lines of walls without thickness, and
/// solids as Polygons, each with the `id` of its element.
std::string writeGeoJson(const Scene& scene, std::optional<double> slice_height);

}  // namespace ispace

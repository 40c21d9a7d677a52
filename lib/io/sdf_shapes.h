// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "geom/polygon.h"
#include "geom/rotation.h"

namespace ispace {

/// Shapes of SDF, in their own frames: middle in the origin, z along a cylinder and out of a
/// polyline's plane.
struct SdfBox {
    std::array<double, 3> size{};  ///< along x, y and z
};
struct SdfCylinder {
    double radius = 0, length = 0;
};
struct SdfPolyline {
    Polygon points;
    double height = 0;  ///< from the origin up
};
struct SdfMesh {
    std::string uri;
    std::array<double, 3> scale{1, 1, 1};
};

struct SdfShape {
    std::variant<SdfBox, SdfCylinder, SdfPolyline, SdfMesh> shape;
    Eigen::Isometry3d world_from_shape;
    std::string model;  ///< name of the outermost model
    int line = 0;
};

/// The shapes of a world, or of a model without one.
struct SdfWorld {
    std::vector<SdfShape> shapes;
    std::map<std::string, std::size_t> left_out;  ///< by what they are
    std::map<std::string, std::size_t> includes;  ///< that are not resolved, by their URI
};

/// Reads the collision shapes of all links, or where a link has none its visuals that every sensor
/// sees (without `visibility_flags`), with the poses of SDF 1.0 to 1.11: nested models, frames,
/// `relative_to`, `attached_to` and `placement_frame`. Neither includes nor entities are resolved.
/// \param most shapes and points of polylines
/// \throws FormatError with the line: bad XML, no world and no model, numbers that are none, frames
///         that are not there or depend on each other, models nested too deep, more than `most`
SdfWorld readSdfShapes(std::string_view bytes, const std::string& name, std::size_t most);

}  // namespace ispace

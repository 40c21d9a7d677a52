// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/budget.h"
#include "base/error.h"
#include "geom/polygon.h"
#include "geom/rotation.h"
#include "io/unread.h"

namespace ispace {

/// Shapes of SDF, in their own frames: centre in the origin, z along a cylinder and out of a
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
    std::optional<std::string> file;  ///< relative to the world's folder; empty if it is missing
    std::array<double, 3> scale{1, 1, 1};
    bool is_part = false;  ///< a submesh: the rest of the file does not count
};

struct SdfShape {
    std::variant<SdfBox, SdfCylinder, SdfPolyline, SdfMesh> shape;
    Eigen::Isometry3d world_from_shape;
    std::string model;  ///< name of the outermost model
    int line = 0;       ///< of the world; for included shapes, that of the `include`
};

/// The shapes of a world, or of a model without one.
struct SdfWorld {
    std::vector<SdfShape> shapes;
    std::map<std::string, std::size_t> left_out;  ///< by type or reason
    std::vector<std::string> sources;             ///< other files read, as opened
    std::optional<Diagnostic> missing = {};       ///< included files that were not found
    std::vector<UnreadThing> unread = {};         ///< of what is left out, those that may be walls
};

/// Reads the collision shapes of all links, or the visuals of links without any that every sensor
/// sees (without `visibility_flags`); spheres, capsules, cones and ellipsoids become the upright
/// cylinders or boxes around them. Reads them in the world and in the models that it includes, with
/// the poses of SdfFrames. Entities are not resolved. \param name the world's file \param
/// model_folders see SdfFiles \param work of the world; files that it includes raise its bound
/// \throws FormatError with the line: bad XML, no world and no model, malformed numbers, frames
/// that are missing or depend on each other, models nested too deep, includes that include
/// themselves, more work than the budget has
SdfWorld readSdfShapes(std::string_view bytes, const std::string& name,
                       std::span<const std::string> model_folders, Budget& work);

}  // namespace ispace

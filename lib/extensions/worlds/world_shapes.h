// SPDX-License-Identifier: GPL-3.0-or-later
// The solids of a simulator's world, whatever its file format.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/error.h"
#include "geom/polygon.h"
#include "geom/rotation.h"
#include "io/unread.h"

namespace ispace::worlds {

// Shapes of a world, in their own frames: centre in the origin, z along a cylinder and out of a
// polyline's plane. Metres; scales of meshes are as the world writes them.

/// A door or window in the middle of a wall.
struct WorldOpening {
    double width = 0, sill = 0, height = 0;
    bool is_window = false;
    bool is_open = true;  ///< of a door
};
struct WorldBox {
    std::array<double, 3> size{};              ///< along x, y and z
    std::optional<WorldOpening> opening = {};  ///< in it, if it is a wall
    bool is_wall = false;                      ///< by its name, whatever its form
};
struct WorldCylinder {
    double radius = 0, length = 0;
};
/// A prism over a polygon in its plane.
struct WorldPolyline {
    Polygon points;
    double height = 0;  ///< from the origin up
};
/// A mesh in another file, which is read later.
struct WorldMesh {
    std::string uri;
    std::optional<std::string> file;  ///< relative to the world's folder; empty if it is missing
    std::array<double, 3> scale{1, 1, 1};
    bool is_part = false;  ///< a submesh: the rest of the file does not count
};

/// A shape and its pose: joints, includes and nested models are applied.
struct WorldShape {
    std::variant<WorldBox, WorldCylinder, WorldPolyline, WorldMesh> shape;
    Eigen::Isometry3d world_from_shape;
    std::string model;  ///< name of the outermost model
    int line = 0;       ///< of the world; for included shapes, that of the `include`
};

/// The shapes of a world, or of a model without one.
struct WorldShapes {
    std::vector<WorldShape> shapes;
    std::map<std::string, std::size_t> left_out;  ///< by type or reason
    std::vector<std::string> sources;             ///< other files read, as opened
    std::optional<Diagnostic> missing = {};       ///< included files that were not found
    std::vector<UnreadThing> unread = {};         ///< of what is left out, those that may be walls
};

}  // namespace ispace::worlds

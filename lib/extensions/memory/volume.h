// SPDX-License-Identifier: GPL-3.0-or-later
// The record `volume`: a part of a room, a ball or a box, that holds a content.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geom/point.h"
#include "record/schema.h"
#include "scene/scene.h"

namespace ispace::memory {

/// A part of a room, in the frame of its room.
struct Volume {
    std::string id;                 ///< with the id of the room before it, "ground/news"
    std::size_t room = 0;           ///< index among the rooms of the run
    Point3 at = {};                 ///< centre, metres
    double radius = 0.2;            ///< of a ball, metres
    std::optional<Vec3> size = {};  ///< of a box, metres; empty: a ball
    double heading = 0;             ///< of a box, degrees from +x
    double dwell = 1;               ///< seconds after which a touch is a stay
    std::string content = {};

    /// Includes the boundary.
    [[nodiscard]] bool contains(Point3 point) const;
    /// Returns the greatest distance on the floor between the centre and a point of it.
    [[nodiscard]] double reach() const;
};

/// Limits of sizes, metres.
constexpr double kLeastVolume = 0.001, kMostVolume = 100;
/// Height of the centre if two coordinates are given: a hand in front of the chest.
constexpr double kVolumeHeight = 1.2;

/// Returns the schema of the record.
std::vector<Schema> volumeSchemas();

/// Reads the volumes of a scene, in order. \param prefix of a room, "ground/", put before ids
/// \throws FormatError at a record that is neither a ball nor a box
std::vector<Volume> volumesOf(const Scene& scene, const std::string& prefix, std::size_t room);

}  // namespace ispace::memory

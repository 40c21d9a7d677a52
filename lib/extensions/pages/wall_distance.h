// SPDX-License-Identifier: GPL-3.0-or-later
// Distances of sensors to two walls, by which a person mounts them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/polygon.h"
#include "scene/scene.h"

namespace ispace::pages {

/// A measure between a sensor and the face of a wall, seen from above.
struct WallDistance {
    std::string wall;  ///< id of the wall or fence; with a number if several of its faces are used
    Segment2 face;     ///< to the corners that a person sees
    double distance = 0;
    Point2 foot;  ///< of the perpendicular from the sensor, on the face or its extension
    /// The corner from which `distance` counts, along the face, to the foot: an end of the face, or
    /// a corner of other faces. Empty: it counts from the foot to the sensor.
    std::optional<Point2> end = {};

    /// Returns the direction along the face from the end to the foot, of unit length.
    [[nodiscard]] Vec2 along() const {
        const Vec2 way = face.b - face.a, to = foot - *end;
        return (dot(way, to) < 0 ? -1 : 1) / length(way) * way;
    }
    /// True if the distance is too short to be measured.
    [[nodiscard]] bool isOnWall() const { return !end && distance < 0.005; }
};

/// The measures by which a person mounts a sensor.
struct Installation {
    std::size_t sensor = 0;           ///< index in Scene::sensors
    std::vector<WallDistance> walls;  ///< two, across each other; none without a wall
};

/// Finds the measures of all sensors that stand still, in the order of the scene: to the nearest
/// face of a wall, and to the nearest one at 45 degrees or more to it, else at 25. If that is more
/// than 5 m away and a visible corner is nearer, the second one counts along the first face from
/// that corner; if there is none, from the face's nearer end. Walls count at the height of the
/// sensor, or below it if all end there, if no other wall hides them from the sensor.
/// O(sensors * walls^2).
std::vector<Installation> installationsOf(const Scene& scene);

}  // namespace ispace::pages

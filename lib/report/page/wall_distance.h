// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geom/polygon.h"
#include "scene/scene.h"

namespace ispace {

/// A measure between a sensor and the face of a wall, seen from above.
struct WallDistance {
    std::string wall;  ///< id of the wall or fence; with a number if several of its faces are used
    Segment2 face;
    double distance = 0;
    Point2 foot;  ///< of the perpendicular from the sensor, on the face or its extension
    /// The end of the face from which `distance` counts, along the face, to the foot; empty: it
    /// counts from the foot to the sensor.
    std::optional<Point2> end = {};

    /// True if the distance is too short to be measured.
    [[nodiscard]] bool isOnWall() const { return !end && distance < 0.005; }
};

/// The measures by which a person mounts a sensor.
struct Installation {
    std::size_t sensor = 0;           ///< index in Scene::sensors
    std::vector<WallDistance> walls;  ///< two, across each other; none without a wall
};

/// Finds the measures of all sensors that stand still, in the order of the scene: to the nearest
/// face of a wall, and to the nearest one at 45 degrees or more to it, else at 25; where there is
/// none, along the first face from its nearer end. Walls count at the height of the sensor, or
/// below it if all end there, if no other wall hides them from the sensor. O(sensors * walls^2).
std::vector<Installation> installationsOf(const Scene& scene);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// The shut doors of a room, and ways as if some of them were open. Tells why there is no way:
// "d1 is locked".
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "env/environment.h"
#include "geom/point.h"
#include "record/record.h"
#include "scene/scene.h"

namespace ispace {

/// A shut door of a scene.
struct ShutDoor {
    std::string id;
    Record record;
    Segment2 line;         ///< of its opening, in the middle of the wall
    double thickness = 0;  ///< of the wall
};

/// Returns the shut doors of a scene, in the order of their records. O(n log n) for n walls and
/// openings, unless the scene has no shut door.
std::vector<ShutDoor> shutDoorsOf(const Scene& scene);

/// Returns the environment of a scene in which these doors are open.
Environment withOpen(const Scene& scene, std::span<const ShutDoor> doors);

/// Where a way crosses a door.
struct DoorCrossing {
    std::size_t door = 0;   ///< index in the doors
    std::size_t point = 0;  ///< of the way, with which the crossing leg ends
};

/// Returns the doors that a way crosses, one after another. \param from its start \param way its
/// further points
std::vector<DoorCrossing> crossings(Point2 from, std::span<const Point2> way,
                                    std::span<const ShutDoor> doors);

/// Tells the state of a shut door: "d1 is locked", or "d1 is shut".
std::string barrierText(const ShutDoor& door);
/// Tells the states of the shut doors that a way crosses, or "".
std::string barriersText(Point2 from, std::span<const Point2> way, std::span<const ShutDoor> doors);

}  // namespace ispace

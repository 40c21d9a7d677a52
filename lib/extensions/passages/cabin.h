// SPDX-License-Identifier: GPL-3.0-or-later
// Room in a lift's cabin: where riders stand, and which of them can get out.
//
// Riders are circles on a raster of 5 cm, from the back to the door. A slot leaves riders for other
// stops a straight way out: of those that leave at a stop one always can, unless a rider has turned
// back to another stop.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"

namespace ispace::passages {

/// The floor of a lift's cabin, in its frame: origin in the middle, x out of the door.
struct Cabin {
    double width = 1, length = 1;                               ///< across x and along it
    double door = 0.9;                                          ///< width
    double capacity = std::numeric_limits<double>::infinity();  ///< greatest load in kilograms
};

/// A rider in a cabin.
struct Rider {
    std::string id;
    Point2 at;  ///< where it stands, in the frame of the cabin
    double radius = 0, mass = 0;
    std::size_t stop = 0;  ///< at which it leaves
};

/// Returns the point inside of the door through which a circle comes and goes.
Point2 thresholdOf(const Cabin& cabin, double radius);

/// Finds where a new rider stands: as far from the door as possible, with a straight way to it past
/// the others, and not in the way of those that leave elsewhere. Empty if it is too heavy besides
/// them, or does not fit. \param rider without `at`
std::optional<Point2> slotIn(const Cabin& cabin, const std::vector<Rider>& riders,
                             const Rider& rider);

/// Returns true if a rider can leave now: its straight way to the door is clear of all others. Of
/// riders for one stop at least one can, as the last to enter came past the others.
bool canLeave(const Cabin& cabin, const std::vector<Rider>& riders, const Rider& rider);

/// Returns the room of a cabin and of the lane before its door, in the building.
/// \param lane its length
Document cabinRoom(const Cabin& cabin, const Pose2& building_from_cabin, double lane);
/// Returns the room of a flight of stairs in the building, a little longer at both ends than the
/// flight, which begins at the frame's origin and leads along its x axis.
Document flightRoom(double width, double length, const Pose2& building_from_flight);

/// Returns a pose of the inner frame in the outer one.
Pose2 placedIn(const Pose2& outer, const Pose2& inner);
/// Returns a pose of the outer frame in the inner one.
Pose2 seenFrom(const Pose2& inner, const Pose2& outer);

}  // namespace ispace::passages

// SPDX-License-Identifier: GPL-3.0-or-later
// What people do with their bodies in plans of days: the verbs of this extension.
#pragma once

#include <optional>
#include <string>

#include "env/environment.h"
#include "extensions/days/person_verbs.h"
#include "extensions/postures/posture.h"
#include "geom/point.h"
#include "geom/pose.h"
#include "sim/world.h"

namespace ispace::postures {

/// Where a person sits or lies: the pose of its trunk, and the height of the thing below it.
struct RestingPlace {
    Pose2 pose;
    double support = 0;
};

/// Returns true for walls and what is in them.
bool partsRooms(const Element& element);

/// Returns the highest top of the boxes and prisms of an element at a point, empty outside.
std::optional<double> topAt(const Element& element, Point2 point);

/// Returns where a person sits down that comes from `from`: on a chair with its back to the rest;
/// on another thing 0.2 m within the edge that is nearest, facing out. Empty if the thing is higher
/// than 1.1 m there, or has no top.
std::optional<RestingPlace> seatOn(const Element& element, Point2 from, double height);

/// Returns where a person lies down: along the longer side of the thing, the head towards its
/// heading (for a width above the length: towards its left), `aside` of the middle. Empty if the
/// thing is higher than 1.5 m, shorter than 0.6 of the person, or has no top there.
std::optional<RestingPlace> bedOn(const Element& element, double height, double aside = 0);

/// Returns the spot nearest to `from` where a standing person has room, up to 1.5 m away and with
/// no wall or door between; else empty. \param mover the person, which others must not
/// overlap there
std::optional<Point2> roomToStand(const World& world, std::size_t mover, Point2 from);

/// Returns the heading in which a person falls: its own, or the nearest one in steps of 30 degrees
/// in which the fallen body meets no thing; else its own.
Angle headingOfFall(const World& world, const Pose2& pose, double height);

/// Returns the point at which people point or for which they reach: the middle of an element or a
/// sensor, the chest of a person, the middle of a robot or of a zone's floor. Empty for other ids.
std::optional<Point3> pointOf(const World& world, const std::string& id);

/// Adds the verbs, for the program.
void addDeeds();

}  // namespace ispace::postures

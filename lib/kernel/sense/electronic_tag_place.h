// SPDX-License-Identifier: GPL-3.0-or-later
// Tags on movers: the bodies that they are on, and the points of those on things in hands.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/sensor/electronic_tag.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// Returns the owner of the bodies of the mover with a tag, of a thing in its hand, too.
std::uint32_t ownerOf(const ElectronicTag& tag);

/// Returns where the tag of a thing in a person's hand is: above the middle of its top. Empty
/// without a body of the person. \pre tag.is_in_hand
std::optional<Point3> placeInHand(const ElectronicTag& tag, const MovingBodies& bodies);

}  // namespace ispace

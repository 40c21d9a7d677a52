// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/electronic_tag_place.h"

#include "sense/selection.h"

namespace ispace {

std::uint32_t ownerOf(const ElectronicTag& tag) {
    const auto mover = static_cast<std::uint32_t>(tag.mover);
    return tag.carrier == ElectronicTag::Carrier::Robot ? mover : kFirstPerson + mover;
}

std::optional<Point3> placeInHand(const ElectronicTag& tag, const MovingBodies& bodies) {
    constexpr double kAbove = 0.01;  // as on a thing that stands
    // A thing in the hand is the last body of a person.
    const MovingBody* thing = nullptr;
    for (const MovingBody& body : bodies.bodies())
        if (body.owner == ownerOf(tag)) thing = &body;
    if (thing == nullptr) return std::nullopt;
    const Point2 middle = thing->pose.position;
    return Point3{middle.x, middle.y, thing->top + kAbove};
}

}  // namespace ispace

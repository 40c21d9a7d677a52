// SPDX-License-Identifier: GPL-3.0-or-later
// The movers that a sensor with a field of view sees.
//
// A ray for each body in view, by the bodies near the sensor: O(bodies in range) rays. Sightings
// depend on bodies and observer alone, and come in the order of the bodies. Thread-safe.
//
//     const auto all = [](std::uint32_t) { return true; };
//     for (const Sighting& one : sightingsOf(observer, worlds.mesh(), bodies, all))
//         nearest = std::min(nearest, one.range);
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "scene/sensor/field_of_view.h"
#include "trace/moving_bodies.h"
#include "trace/ray_world.h"

namespace ispace {

/// The line of sight from a sensor to a mover.
struct Sighting {
    double range = 0;
    Vec3 direction;  ///< unit vector in the room
    const MovingBody* body = nullptr;
    std::size_t number = 0;  ///< of the mover, among those in the bodies
};

/// A sensor that sees movers.
struct Observer {
    FieldOfView view;
    double min_range = 0;
    std::uint32_t carrier = MovingBodies::kNoOwner;  ///< whose bodies it neither sees nor meets
};

/// Returns the sightings of the movers that `is_meant` selects by owner, in the order of the
/// bodies.
///
/// A mover is seen where the ray towards the centre of one of its bodies meets that body, in the
/// field of view and in range (ends included, as float32), if neither `mesh` nor a body of another
/// mover is before it; of its bodies the nearest so seen counts. Sightings refer to `bodies`.
/// \param mesh surfaces that stop its rays; not a slice
std::vector<Sighting> sightingsOf(const Observer& observer, const RayWorld& mesh,
                                  const MovingBodies& bodies,
                                  const std::function<bool(std::uint32_t owner)>& is_meant);

}  // namespace ispace

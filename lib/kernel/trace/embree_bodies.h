// SPDX-License-Identifier: GPL-3.0-or-later
// Moving bodies in Embree. Private to lib/kernel/trace and lib/kernel/trace/render.
//
// For rays of any direction among many bodies, as of pictures; scans use body_scan.h. Boxes are
// enlarged by more than the rounding of float32 (setBounds), so that no body is missed. A hit is
// that of BodyFrame in doubles, for the ray in float32 that Embree has, and is rounded to float32.
#pragma once

#include <span>
#include <vector>

#include "trace/body_scan.h"
#include "trace/embree_device.h"
#include "trace/embree_query.h"

namespace ispace {

/// A body with the axes of its heading, for Embree's callbacks.
struct TracedBody {
    MovingBody body;
    CosSin axes;

    explicit TracedBody(const MovingBody& moving)
        : body(moving), axes(cosSin(moving.pose.heading)) {}
    /// As BodyFrame::meet(), with identical results.
    [[nodiscard]] RayHit meet(Point3 origin, Vec3 direction, double least) const {
        return BodyFrame(body, axes, origin).meet(direction, least);
    }
};

/// A query that ignores bodies with a `hidden` owner. \pre `owners` outlives it
struct BodyQuery : EmbreeQuery {
    const std::vector<bool>& hidden;  ///< by owner; may be shorter than the list of owners

    explicit BodyQuery(const std::vector<bool>& owners) : hidden(owners) {}
};

/// Builds a scene of bodies; hits hold this geometry id and the body's index. Embree searches
/// bounding boxes; intersections are computed in doubles. Requires a BodyQuery.
/// \pre the bodies stay at the same address while the scene lives
/// \throws as throwIfEmbreeFailed()
EmbreeSceneHandle buildBodies(RTCDeviceTy* device, std::span<const TracedBody> bodies,
                              unsigned geometry_id);

}  // namespace ispace

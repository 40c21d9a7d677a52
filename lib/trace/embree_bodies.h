// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/trace and lib/trace/render: moving bodies in Embree.
#pragma once

#include <span>
#include <vector>

#include "trace/body_scan.h"
#include "trace/embree_device.h"
#include "trace/embree_query.h"

namespace ispace {

/// A body with the axes of its heading, as Embree's rays meet it.
struct TracedBody {
    MovingBody body;
    CosSin axes;

    explicit TracedBody(const MovingBody& moving)
        : body(moving), axes(cosSin(moving.pose.heading)) {}
    /// See BodyFrame::meet(): the same numbers as all other sensors get.
    [[nodiscard]] BodyMeeting meet(Point3 origin, Vec3 direction, double least) const {
        return BodyFrame(body, axes, origin).meet(direction, least);
    }
};

/// A query of bodies that passes those whose owner is `hidden`. \pre `owners` outlives it
struct BodyQuery : EmbreeQuery {
    const std::vector<bool>& hidden;  ///< by owner; may be shorter

    explicit BodyQuery(const std::vector<bool>& owners) : hidden(owners) {}
};

/// A scene of bodies, hits of which have this geometry id and the body's index. Embree has their
/// boxes; rays are met in doubles. Queries must be a BodyQuery.
/// \pre the bodies stay where they are as long as the scene lives
/// \throws as throwIfEmbreeFailed()
EmbreeSceneHandle buildBodies(RTCDeviceTy* device, std::span<const TracedBody> bodies,
                              unsigned geometry_id);

}  // namespace ispace

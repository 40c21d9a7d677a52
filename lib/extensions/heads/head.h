// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/heads: joints that pan and tilt the sensors on them, on robots, objects or by
// themselves. Uses record, scene, server.
#pragma once

#include <optional>
#include <vector>

#include "geom/pose.h"
#include "record/record.h"
#include "record/schema.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"

namespace ispace::heads {

/// Height of the axes without `at`, metres.
constexpr double kHeadHeight = 0.4;

/// A `head` record: its axes cross at one point, about which sensors with `on=ID` turn.
struct Head {
    /// The least and the greatest of an angle, in degrees.
    struct Range {
        double least = 0, most = 0;
        [[nodiscard]] bool contains(double angle) const { return angle >= least && angle <= most; }
    };
    double pan = 0, tilt = 0;  ///< degrees: to the left of its heading, and upwards
    Range pan_range, tilt_range;
    std::optional<double> speed = {};  ///< degrees a second, of both axes; empty: at once
};

/// \pre the record is a `head` \throws FormatError for a range that ends before it begins, and for
/// angles beyond their ranges
Head headOf(const Record& record);

/// Returns the frame in which it carries sensors, relative to its carrier or the room.
Pose3 headMount(const Record& record);

/// Warns of a head that carries no sensor.
std::optional<Finding> checkHead(const Scene& scene, std::size_t record);

/// Returns the schema of `head`, a placement with the states `pan` and `tilt`.
std::vector<Schema> headSchemas();

/// Adds the kind of heads, for the program.
void addHeads();

}  // namespace ispace::heads

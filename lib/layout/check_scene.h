// SPDX-License-Identifier: GPL-3.0-or-later
// The checks of a scene: one list, which every tool asks, so that all print the same sentences.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "layout/scene.h"

namespace ispace {

/// A mistake in a scene that can be compiled all the same. Elements of the room that other uses
/// accept are warnings; records that cannot work at their position are errors.
struct Finding {
    Severity severity = Severity::Warning;
    std::string element = {};  ///< its id; "" for the scene as a whole
    Point2 at = {};  ///< in the world frame; of no meaning where `message` names no position
    std::string message = {};  ///< "laser l stands outside the room at (9.0, 3.0)"
    std::string hint = {};     ///< "move it in"
    Place source = {};         ///< of the element's record

    /// Message and hint in one sentence.
    [[nodiscard]] std::string text() const { return message + "; " + hint; }
    /// The sentence with its file, line and column.
    [[nodiscard]] Diagnostic diagnostic() const;
};

struct CheckContext;

/// A row of the list.
struct SceneCheck {
    std::string_view name;
    /// Adds the findings about the record with this index in Scene::records; the index past the
    /// last record stands for the scene as a whole.
    void (*run)(CheckContext&, std::size_t record, std::vector<Finding>&);
};

/// All checks, in the order in which they look at a record:
///
/// - walls: walls that cross or lie on each other; open doors that lead into a wall close behind.
/// - objects: furniture, pillars, ceiling frames and meshes that share space with each other or
///   with a wall, in 3-D, by more than 1 um, or lie outside the room. Pillars, ceiling frames and
///   walls may share space. Meshes are compared at some heights that both sides share.
/// - zones: zones without a point in the room.
/// - unplaced: sensors without a position.
/// - outside: sensors, tags, mats, gates, robots and people outside the room or below its floor;
///   not the sensors of a robot, as the robot is named.
/// - buried: sensors and tags inside solids.
/// - collisions: robots and people (as circles) that stand in objects or in each other.
/// - paths: paths of robots and people that leave the room.
/// - loose ends: ends of walls in the room less than 0.2 m before another wall.
std::span<const SceneCheck> sceneChecks();

/// The findings to look for; by default all.
struct FindingFilter {
    /// Names of the checks to run; empty: all.
    std::vector<std::string_view> checks = {};
    /// True for the ids of the records to check; unset: all.
    std::function<bool(const std::string& id)> ids = {};
};

/// Checks the scene, record by record: findings in the order of the records, one for each pair of
/// elements. Ends with the record that brings them to Diagnostics::kMax. O(n log n) for n elements
/// that stand beside each other.
std::vector<Finding> checkScene(const Scene& scene, const FindingFilter& filter = {});

/// The findings that a tool prints before it goes on, as warnings, at most Diagnostics::kMax.
std::vector<Diagnostic> sceneWarnings(const Scene& scene, const FindingFilter& filter);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/days: ways of people to zones and things.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "env/environment.h"
#include "geom/point.h"
#include "scene/scene.h"
#include "sim/collision.h"
#include "sim/path_finder.h"

namespace ispace::days {

/// Finds short ways of a person to zones and elements of a room. It prefers ways with room to spare
/// at both sides.
class GoalPaths {
  public:
    /// \param radius,height of the person
    GoalPaths(const Scene& scene, double radius, double height)
        : GoalPaths(scene, scene.environment, radius, height) {}
    /// \param environment for ways, instead of the scene's: of the same records, but for doors that
    /// are open. isAt() looks at the scene.
    GoalPaths(const Scene& scene, Environment environment, double radius, double height);
    GoalPaths(const GoalPaths&) = delete;
    GoalPaths& operator=(const GoalPaths&) = delete;

    using Spot = PathFinder::Spot;
    /// Returns the points of a way to the zone or element `id`, without the start: to the free
    /// point of a zone that is nearest to the middle of its limits; to the free point beside an
    /// element, see isAt(), that is nearest to its middle. Points that are too near to others are
    /// not free, and the way leads round them if it can. Empty if the id is unknown or no way leads
    /// there.
    /// Not thread-safe. \param work grows by the cells looked at, which is the same on any machine;
    /// may be null
    [[nodiscard]] std::vector<Point2> way(Point2 from, const std::string& id,
                                          std::span<const Spot> others = {},
                                          std::size_t* work = nullptr) const;
    /// Returns true if a point is in the zone `id`, or beside the element: at most kReach from its
    /// outline, as seen from above, with no wall or shut door between them.
    [[nodiscard]] bool isAt(Point2 p, const std::string& id) const;
    static constexpr double kReach = 0.6;  ///< metres

  private:
    /// Returns the zones and things with this id.
    [[nodiscard]] std::vector<const Element*> named(const std::string& id) const;

    double radius_;
    Environment environment_;
    Obstacles obstacles_;
    Obstacles walls_;                                  // with doors and windows
    std::vector<Element> things_;                      // of extensions
    mutable std::optional<PathFinder> wide_, narrow_;  // once a way is wanted
};

/// Returns the ids of the zones, elements and things of extensions to which people may go.
std::vector<std::string> goalIds(const Scene& scene);

}  // namespace ispace::days

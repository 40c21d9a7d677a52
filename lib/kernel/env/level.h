// SPDX-License-Identifier: GPL-3.0-or-later
// The room as a level sensor meets it: lines, solids and free floor at one height above the floor,
// and the views there.
//
//     const std::shared_ptr<const Level> level = room.level(0.3);
//     VisibleRegion view;
//     if (level->isFree({2, 1})) level->query({2, 1}, 8, view);
#pragma once

#include <limits>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "base/parallel.h"
#include "env/environment.h"
#include "env/point_location.h"
#include "env/sheet_index.h"
#include "geom/visibility/visibility.h"

namespace ispace {

/// The environment at one height; Environment::level() returns it. Each derived part below is
/// computed at the first call and shared by all threads, and by all levels with the same slice:
/// between the tops of furniture and the walls' heights are equal.
///
/// Point queries take O(log n), typically; sides are exact, distances round. Views are those of
/// VisibilityMap. All members are thread-safe, and results do not depend on which thread computed a
/// part.
class Level {
  public:
    [[nodiscard]] double height() const { return height_; }
    /// Returns the slice at this height, with owners.
    [[nodiscard]] const Slice& slice() const;
    /// Returns the indoor region less the solids.
    [[nodiscard]] const std::vector<Region>& freeFloor() const;

    /// Returns true strictly indoors, outside all solids and off the lines of the slice; exact.
    [[nodiscard]] bool isFree(Point2 p) const;
    /// Returns true deeper in a solid than kRayEpsilon, where a sensor is blind.
    [[nodiscard]] bool isInsideSolid(Point2 p) const;
    /// Returns the solids with p on their surface (within kRayEpsilon): rays enter them there
    /// without a hit.
    [[nodiscard]] std::vector<Polygon> solidsTouching(Point2 p) const;
    /// Computes the visible region of a level sensor up to max_range, as VisibilityMap::query does
    /// for the lines and round bodies of the slice; empty if isInsideSolid().
    void query(Point2 viewpoint, double max_range, VisibleRegion& region) const;

    /// Builds the index that query() reads; this takes longer than many queries.
    void prepareSight() const;

    /// Returns the number of lines of the slice; 0 before it is computed.
    [[nodiscard]] std::size_t linesMade() const;

  private:
    friend class Environment;
    friend class LevelViews;
    /// The slice and its derived parts.
    struct Cut {
        explicit Cut(Slice cut) : slice(std::move(cut)) {}
        Slice slice;
        Lazy<std::vector<Region>> free_floor;
        Lazy<PolygonIndex> solids;
        Lazy<SheetIndex> sheets;
        Lazy<VisibilityMap> sight;
    };
    /// The cuts of an environment that levels hold. Thread-safe.
    class Cuts {
      public:
        /// Returns the cut with this slice.
        std::shared_ptr<const Cut> find(Slice slice);

      private:
        std::mutex mutex_;
        std::vector<std::weak_ptr<const Cut>> cuts_;
    };
    Level(std::shared_ptr<const Environment::Data> room, double height, std::shared_ptr<Cuts> cuts);

    [[nodiscard]] const Cut& cut() const;
    [[nodiscard]] const PolygonIndex& solids() const;
    [[nodiscard]] const VisibilityMap& sight() const;

    std::shared_ptr<const Environment::Data> room_;
    double height_;
    std::shared_ptr<Cuts> cuts_;
    Lazy<std::shared_ptr<const Cut>> cut_;
};

/// The views of a set of level sensors.
class LevelViews {
  public:
    /// Stores the reference. \param reach of the farthest view, see VisibilityMap::query
    LevelViews(const Level& level,  // NOLINT(google-explicit-constructor): a level has views
               double reach = std::numeric_limits<double>::infinity())
        : level_(level), reach_(reach) {}

    [[nodiscard]] const Level& level() const { return level_; }
    /// As Level::query.
    void query(Point2 viewpoint, double max_range, VisibleRegion& region) const;

  private:
    const Level& level_;
    double reach_;
};

}  // namespace ispace

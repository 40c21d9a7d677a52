// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/parallel.h"
#include "env/environment.h"
#include "env/point_location.h"
#include "geom/visibility/visibility.h"

namespace ispace {

/// The environment at one height; Environment::level() returns it. Each derived part below is
/// computed at the first call and shared by all threads.
class Level {
  public:
    /// Creates a level of a slice alone, without a room and so without a free floor.
    explicit Level(Slice slice);

    [[nodiscard]] double height() const { return height_; }
    /// Returns the slice at this height, with owners.
    [[nodiscard]] const Slice& slice() const;
    /// Returns the indoor region less the solids. \pre the level belongs to an environment
    [[nodiscard]] const std::vector<Region>& freeFloor() const;

    /// Returns true strictly indoors, outside all solids and off the lines of the slice; exact.
    /// \pre the level belongs to an environment
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
    Level(std::shared_ptr<const Environment::Data> room, double height);

    [[nodiscard]] const PolygonIndex& solids() const;
    [[nodiscard]] const VisibilityMap& sight() const;

    std::shared_ptr<const Environment::Data> room_;
    double height_;
    Lazy<Slice> slice_;
    Lazy<std::vector<Region>> free_floor_;
    Lazy<PolygonIndex> solids_;
    Lazy<SegmentTree> sheets_;
    Lazy<VisibilityMap> sight_;
};

}  // namespace ispace

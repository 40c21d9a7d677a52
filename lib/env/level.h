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

/// The environment at one height. Get one from Environment::level(). Each part below is made when
/// it is first asked for, and shared by all threads from then on.
class Level {
  public:
    /// Of a slice alone, in no room: it has no free floor.
    explicit Level(Slice slice);

    [[nodiscard]] double height() const { return height_; }
    /// Returns the slice at this height, with owners.
    [[nodiscard]] const Slice& slice() const;
    /// Indoor less the solids. \pre it is of an environment
    [[nodiscard]] const std::vector<Region>& freeFloor() const;

    /// True strictly indoors, in no solid and on no line of the slice; exact.
    /// \pre it is of an environment
    [[nodiscard]] bool isFree(Point2 p) const;
    /// Returns true deeper in a solid than kRayEpsilon, where a sensor is blind.
    [[nodiscard]] bool isInsideSolid(Point2 p) const;
    /// Returns the solids whose surface p touches (within kRayEpsilon): rays enter them there
    /// without a hit.
    [[nodiscard]] std::vector<Polygon> solidsTouching(Point2 p) const;
    /// Computes the visible region of a level sensor up to max_range: as VisibilityMap::query among
    /// the lines and round bodies of the slice; empty where isInsideSolid().
    void query(Point2 viewpoint, double max_range, VisibleRegion& region) const;

    /// Builds the index that query() reads, which takes longer than many queries.
    void prepareSight() const;

    /// How many lines the slice has; 0 until it is made.
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

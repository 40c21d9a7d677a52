// SPDX-License-Identifier: GPL-3.0-or-later
// Private to MovingBodies: where level scans meet bodies.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "trace/body_rays.h"
#include "trace/moving_bodies.h"

namespace ispace {

/// A level scan of equal steps whose ranges bodies shorten. Bodies are collected in growing
/// squares about it and met from the nearest on. Bodies whose beams all end nearer, at walls or
/// other bodies, are passed over: in rooms and crowds nearly all.
class BodyArc {
  public:
    /// \pre directions.arc, with a step above 0
    BodyArc(Point3 origin, const Directions& directions, double max_range,
            std::span<const MovingBody> bodies, std::span<const BodyExtent> extents,
            const ShortenedRanges& ranges);

    /// Meets all bodies but those of `own`, cells near to the scan before those that are farther
    /// away.
    void meetFrom(const FloorGrid& grid, std::uint32_t own);

  private:
    static constexpr std::size_t kBlock = 8, kMost = 256;

    /// A body, how near it is at least, and the beams that may point at it: those from first to
    /// last, and from other_first to other_last if the scan's ends are near to each other.
    struct Waiting {
        double nearest;
        std::uint32_t body;
        std::int32_t first, last, other_first, other_last;
    };
    /// The part of the floor where bodies still matter.
    [[nodiscard]] Box2 view() const;
    /// Collects those of these bodies that may shorten a beam.
    void look(std::span<const std::uint32_t> bodies, std::uint32_t own);
    void meetCollected();
    [[nodiscard]] bool isSeen(const Waiting& waiting) const;
    [[nodiscard]] bool isSeen(std::int32_t first, std::int32_t last, double nearest) const;
    void meetBeams(const BodyFrom& body, std::int32_t first, std::int32_t last, double nearest);
    void findFarthest(std::size_t block);

    Point3 origin_;
    const Directions& directions_;
    std::span<const MovingBody> bodies_;
    std::span<const BodyExtent> extents_;
    double far_;
    float most_;  // that and a little more
    ShortenedRanges ranges_;
    CosSin middle_;                 // of the arc
    double rate_ = 0;               // beams a radian
    double count_ = 0;              // of beams
    std::vector<float>& farthest_;  // the greatest range of each block of beams
    std::array<Waiting, kMost> waiting_;
    std::size_t size_ = 0;
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// lib/extensions/proofs: sight from points over the triangles of a floor, for the check of guards.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "extensions/proofs/poses/box_sides.h"
#include "extensions/proofs/poses/outer_bound.h"

namespace ispace::proofs {

/// The part of a triangle that an apex sees, between the lines through two points.
struct GuardCone {
    std::uint32_t of = 0;  ///< index of the apex
    bool is_whole = false;
    Point2 apex, right, left;
    [[nodiscard]] poses::Side2 rightSide() const { return {apex, -perpendicular(unit(right))}; }
    [[nodiscard]] poses::Side2 leftSide() const { return {apex, perpendicular(unit(left))}; }
    [[nodiscard]] Vec2 unit(Point2 end) const { return (1 / length(end - apex)) * (end - apex); }
};

/// Cones by triangle.
using GuardCones = std::vector<std::vector<GuardCone>>;

/// A floor of triangles, over which points see.
class GuardFloor {
  public:
    /// \param name of the certificate, for errors
    GuardFloor(std::span<const Region> floor, std::string name);

    [[nodiscard]] std::size_t triangles() const { return floor_.triangles().size(); }
    /// Returns a triangle.
    [[nodiscard]] poses::Convex outlineOf(std::size_t triangle) const;
    /// Bounds the error of the distance of a point from a line of a cone. \param end of the line
    [[nodiscard]] double blurAt(const GuardCone& cone, Point2 end, Point2 p) const;
    /// Returns the cones through which points see the floor. \param must_be_on the floor
    /// \throws FormatError for points off the floor, and for too many points or cones
    [[nodiscard]] GuardCones conesFrom(std::span<const Point2> points, bool must_be_on) const;
    /// Returns the area that no cone sees, m2.
    [[nodiscard]] double missedBy(const GuardCones& cones) const;
    /// \throws FormatError with the name of the certificate
    [[noreturn]] void refuse(const std::string& message) const;

  private:
    /// Cones of an apex, with their triangles.
    using Sight = std::vector<std::pair<std::size_t, GuardCone>>;
    void follow(const GuardCone& first, std::size_t triangle, std::size_t edge,
                const std::vector<char>& is_start, std::atomic<std::size_t>& cones,
                Sight& sight) const;

    poses::PoseFloor floor_;
    std::string name_;
    double extent_ = 1;
};

}  // namespace ispace::proofs

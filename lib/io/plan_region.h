// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace {

/// The part of a plan that is imported: one face of its lines, or several that doors join.
struct PlanRegion {
    std::vector<Region> rooms;  ///< the largest first
    Point2 inside;              ///< a point of the first, clear of its walls

    [[nodiscard]] double area() const;
};

/// The faces of the lines, without those that open doors join being told apart.
class PlanFaces {
  public:
    /// \param doors lines across which one can pass: among the walls, or on them
    explicit PlanFaces(std::span<const Segment2> walls, std::span<const Segment2> doors = {});

    [[nodiscard]] const std::vector<Region>& faces() const { return faces_; }
    /// The rooms joined to the face that holds `preferred` strictly inside, else those that are
    /// largest together; nothing where nothing is enclosed.
    [[nodiscard]] std::optional<PlanRegion> region(std::optional<Point2> preferred = {}) const;

  private:
    [[nodiscard]] std::optional<std::size_t> faceAt(Point2 p) const;

    std::vector<Segment2> walls_;
    std::vector<Region> faces_;
    std::vector<Box2> boxes_;
    std::vector<std::size_t> group_;  // of each face; the lowest index of a group names it
};

/// For each line, whether it bounds one of the rooms or lies in it, with its middle or an end.
std::vector<bool> belongsTo(const PlanRegion& region, std::span<const Segment2> lines);

/// True if the lines cross each other so often that their faces would take hours: no plan does.
/// Judged by a sample, the same one at every call.
bool crossTooOften(std::span<const Segment2> lines);

}  // namespace ispace

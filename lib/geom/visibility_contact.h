// SPDX-License-Identifier: GPL-3.0-or-later
// Private to VisibilityMap.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_set>
#include <vector>

#include "geom/visibility.h"
#include "geom/visibility_mesh.h"

namespace ispace {

/// The edges of lines around a viewpoint, and where it moves because of them.
class ContactFinder {
  public:
    explicit ContactFinder(const SightMesh& mesh) : mesh_(mesh) {}

    /// Finds the edges of lines within kSightContact of p. \pre p lies in the triangle
    void gather(Point2 p, std::uint32_t triangle);
    [[nodiscard]] bool found() const { return !lines_.empty(); }
    /// The nearest vertex of those lines that is near enough, else the nearest point of a line.
    [[nodiscard]] Point2 moved(Point2 p) const;
    /// Both sides of all edges that were found, ascending.
    [[nodiscard]] std::span<const std::uint32_t> bothSides();

  private:
    [[nodiscard]] Segment2 wallOf(std::uint32_t edge) const;
    [[nodiscard]] double squaredDistance(Point2 p, std::uint32_t edge) const;
    void add(std::uint32_t triangle);

    const SightMesh& mesh_;
    std::vector<std::uint32_t> lines_;        // edges, one or both sides of each
    std::vector<std::uint32_t> triangles_;    // that come as near
    std::unordered_set<std::uint32_t> many_;  // the same once they are many
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Private to VisibilityMap: the triangulation that a view expands through.
//
// Lines are cut by noded() (arrangement.h), triangulated with a box around them by CGAL's
// constrained Delaunay triangulation, and stored as 96 bytes a triangle along a Morton curve, so
// that a view reads memory in order. Built in O(n log n + crossings), in part by several threads;
// immutable and thread-safe after that.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_set>
#include <vector>

#include "geom/arrangement.h"
#include "geom/point.h"
#include "geom/predicates.h"
#include "geom/visibility/visibility.h"

namespace ispace {

/// Corner and edge i of triangle t, at index 3 t + i: the edge lies opposite to the corner, corners
/// are counter-clockwise. Also the portal through which a view enters the triangle across that
/// edge: the corner is then straight ahead, corner i + 2 on the right and corner i + 1 on the left.
///
/// 32 bytes and aligned: one step of a query reads half a cache line.
struct alignas(32) Portal {
    Point2 corner;
    /// Targets beyond the edges right (i + 1) and left (i + 2) of the corner: a portal, or that
    /// edge with kBlocked set if it is on a line, or kFree.
    std::uint32_t right = 0, left = 0;
    /// The portal on the other side of edge i, whether or not it is on a line, or kFree.
    std::uint32_t behind = 0;
    /// The line of edge i, if it is on one.
    std::uint32_t line = 0;

    static constexpr std::uint32_t kBlocked = 1U << 31;
    static constexpr std::uint32_t kFree = std::numeric_limits<std::uint32_t>::max();
};

/// Lines, viewpoints and ranges are clamped to this, in metres, so that products of four lengths
/// are finite.
constexpr double kMaxSight = 1e75;

inline Point2 withinSight(Point2 p) {
    return {std::clamp(p.x, -kMaxSight, kMaxSight), std::clamp(p.y, -kMaxSight, kMaxSight)};
}

/// The next and the previous portal of the same triangle, counter-clockwise. Branch-free.
inline std::uint32_t nextOf(std::uint32_t portal) {
    return portal + 1 - 3 * static_cast<std::uint32_t>(portal % 3 == 2);
}
inline std::uint32_t beforeOf(std::uint32_t portal) {
    return portal - 1 + 3 * static_cast<std::uint32_t>(portal % 3 == 0);
}

/// Cuts lines, clamped to kMaxSight, where they meet.
/// \throws FormatError (without a line number) for lines that cross by the million
std::vector<LinePiece> sightPieces(std::span<const Segment2> lines);

/// Triangulation of lines and a box around them; the box is not a line, and the view beyond it is
/// free.
struct ExpansionMesh {
    std::vector<Portal> portals;
    Box2 box;                         ///< of all triangles; lines lie strictly inside
    std::array<std::uint32_t, 4> in;  ///< portals through its lower, right, upper and left side

    // A triangle near each of these cells over the lines.
    Box2 cells_box;
    std::uint32_t columns = 1, rows = 1;
    double columns_per_metre = 0, rows_per_metre = 0;
    std::vector<std::uint32_t> cells;

    /// \param pieces as of sightPieces()
    explicit ExpansionMesh(std::span<const LinePiece> pieces);

    /// Returns the line that blocks the view at an edge, seen from inside, or the portal behind it.
    [[nodiscard]] std::uint32_t targetOf(std::uint32_t edge) const {
        return portals[beforeOf(edge)].right;
    }
    [[nodiscard]] bool isLine(std::uint32_t edge) const {
        const std::uint32_t target = targetOf(edge);
        return target >= Portal::kBlocked && target != Portal::kFree;
    }
    /// Finds a triangle with p inside or on its boundary. \pre p strictly inside the box
    [[nodiscard]] std::uint32_t locate(Point2 p) const { return locateFrom(p, cells[cellOf(p)]); }
    [[nodiscard]] std::uint32_t locateFrom(Point2 p, std::uint32_t triangle) const;

  private:
    [[nodiscard]] std::size_t cellOf(Point2 p) const;
    /// Builds the mesh of lines that meet at common ends only. \param names the line of each piece
    void makeTriangles(const std::vector<Segment2>& lines, const std::vector<std::uint32_t>& names);
    void makeCells(std::size_t count);
};

/// Maximum error of cross(a, b) for rounded vectors a = A - o and b = B - o, relative to the sum of
/// the magnitudes of its two products; and for underflow (Shewchuk, 1997).
constexpr double kTurnError =
    (3 + 8 * std::numeric_limits<double>::epsilon()) * (std::numeric_limits<double>::epsilon() / 2);
constexpr double kTurnUnderflow = 1e-300;

/// cross(a, b) if its sign is certainly that of the turn o, A, B, else 0.
inline double surelyTurns(Vec2 a, Vec2 b) {
    const double left = a.x * b.y, right = a.y * b.x;
    const double turn = left - right;
    const double error = kTurnError * (std::abs(left) + std::abs(right)) + kTurnUnderflow;
    return std::abs(turn) > error ? turn : 0;
}

/// Bound of that error for vectors up to this length.
inline double errorOfTurns(double length) {
    return 2 * kTurnError * (length * length) + kTurnUnderflow;
}

/// Finds the edges on lines close to a viewpoint, and the point to which they move it.
class TouchedLines {
  public:
    explicit TouchedLines(const ExpansionMesh& mesh) : mesh_(mesh) {}

    /// Finds the edges of lines within kRayEpsilon of p. \pre p lies in the triangle
    void gather(Point2 p, std::uint32_t triangle);
    [[nodiscard]] bool found() const { return !lines_.empty(); }
    /// Returns the nearest vertex of those lines within kRayEpsilon, else the nearest point of a
    /// line.
    [[nodiscard]] Point2 moved(Point2 p) const;
    /// Both sides of all edges that were found, ascending.
    [[nodiscard]] std::span<const std::uint32_t> bothSides();

  private:
    [[nodiscard]] Segment2 wallOf(std::uint32_t edge) const;
    [[nodiscard]] double squaredDistance(Point2 p, std::uint32_t edge) const;
    void add(std::uint32_t triangle);

    const ExpansionMesh& mesh_;
    std::vector<std::uint32_t> lines_;        // edges, one or both sides of each
    std::vector<std::uint32_t> triangles_;    // that come as near
    std::unordered_set<std::uint32_t> many_;  // the same once they are many
};

}  // namespace ispace

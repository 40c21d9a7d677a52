// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/arrange/poses: the floor in cells, and the points that some pose of a box may see.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geom/polygon.h"

namespace ispace::poses {

/// Fractions of a cell are counted in these parts: two of them add up within a byte.
constexpr int kParts = 127;
/// A box is widened by this much on all sides, metres: more than all errors of rounding, and than
/// kRayEpsilon, within which walls do not block the view.
constexpr double kWiden = 2 * 1e-4;
/// Points this close are one, metres: far less than the distance within which walls are ignored.
constexpr double kAtCorner = 1e-9;
/// A cone this close to a half-plane may round to more than one, radians.
constexpr double kStraight = 1e-6;
/// Smaller shares of a cell count as errors of rounding.
constexpr double kNoShare = 1e-9;

/// A sensor that scans a level sector.
struct Sector {
    double range = 0;  ///< metres
    double field = 0;  ///< radians; 2 pi or more: all around, so that headings do not matter
    double first = 0;  ///< of the sector, from the heading, radians
    double near = 0;   ///< closer points are not seen, metres
    [[nodiscard]] bool isRound() const;
    /// Area in a room without walls.
    [[nodiscard]] double area() const;
};

/// Poses: positions in a rectangle, and headings from `from`, counter-clockwise over `span`.
struct PoseBox {
    Box2 at;
    double from = 0, span = 0;  ///< radians
};

/// A floor as triangles, and as square cells of known area.
class PoseFloor {
  public:
    /// \param most number of cells that the box around the floor is divided into, at most
    PoseFloor(std::span<const Region> regions, std::size_t most);

    using Corners = std::array<Point2, 3>;
    struct Triangle {
        std::array<std::uint32_t, 3> corners{};  ///< counter-clockwise
        std::array<std::int32_t, 3> beyond{};  ///< triangle behind edge i, from corner i; -1: wall
    };
    [[nodiscard]] std::span<const Triangle> triangles() const { return triangles_; }
    [[nodiscard]] Point2 at(std::uint32_t corner) const { return points_[corner]; }
    [[nodiscard]] Corners cornersOf(std::size_t triangle) const;
    [[nodiscard]] const Box2& box() const { return box_; }
    [[nodiscard]] double area() const { return area_; }

    /// Area of one part of a cell, m2.
    [[nodiscard]] double partArea() const { return side_ * side_ / kParts; }
    /// Parts of each cell that are floor, rounded up; cells row by row.
    [[nodiscard]] const std::vector<std::uint8_t>& parts() const { return parts_; }
    [[nodiscard]] std::size_t columns() const { return columns_; }
    [[nodiscard]] std::size_t rows() const { return rows_; }

    /// Sums of signed areas, by cell: adding an outline's edges and summing up along each row gives
    /// the area in each cell.
    class Tally {
      public:
        explicit Tally(const PoseFloor& floor);
        void clear();
        /// Adds a counter-clockwise convex polygon within the floor's box.
        void add(std::span<const Point2> polygon);
        /// Converts to parts of cells, rounded up, and at most those that are floor.
        void round(std::vector<std::uint8_t>& parts) const;
        /// Converts to parts of cells, rounded down but for kNoShare of a cell.
        void roundDown(std::vector<std::uint8_t>& parts) const;

      private:
        void addEdge(Point2 a, Point2 b);
        template <typename Share>
        void convert(std::vector<std::uint8_t>& parts, Share share) const;
        const PoseFloor& floor_;
        std::vector<double> sums_;
    };

  private:
    std::vector<Point2> points_;
    std::vector<Triangle> triangles_;
    Box2 box_;
    double side_ = 1, area_ = 0;
    std::size_t columns_ = 1, rows_ = 1;
    std::vector<std::uint8_t> parts_;
};

/// Bounds of the floor that single poses of a box see.
struct FatView {
    double area = 0;  ///< m2: an upper bound of the area that any pose of the box sees
    std::vector<std::uint8_t> parts;  ///< of cells; every point seen by some pose lies in them
    [[nodiscard]] bool empty() const { return parts.empty(); }
};

/// Computes a superset of the points that some pose of the box sees, on the floor: those in weak
/// visibility of the rectangle through the portals of the triangulation, within range of it, and in
/// its field of view at some heading. Empty if the box holds no floor.
FatView fatViewOf(const PoseFloor& floor, const Sector& sector, const PoseBox& box);
/// Returns the area of that superset, or a little more, in less time; 0 if the box holds no floor.
double fatAreaOf(const PoseFloor& floor, const Sector& sector, const PoseBox& box);

}  // namespace ispace::poses

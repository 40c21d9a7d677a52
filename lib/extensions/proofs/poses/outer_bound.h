// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: the floor in cells, and the points that some pose of a box
// may see.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "extensions/proofs/poses/convex.h"
#include "geom/polygon.h"

namespace ispace::proofs::poses {

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

/// The weight of each part of a floor.
struct FloorWeighting {
    double elsewhere = 1;  ///< outside of all pieces
    struct Piece {
        Outline outline;  ///< convex, counter-clockwise; the interiors of pieces are disjoint
        double weight = 1;
    };
    std::vector<Piece> pieces = {};  ///< may reach beyond the floor
};

/// Sizes of cells: large ones are as large as 4 x 4 of the fine ones, and take a fifteenth of the
/// time.
enum class Grain { Fine, Large };

/// A floor as triangles, and as square cells of known area.
///
/// With weights each cell is divided by them: a layer of cells has floor of one weight.
class PoseFloor {
  public:
    /// \param most number of cells that the box around the floor is divided into, at most
    PoseFloor(std::span<const Region> regions, std::size_t most,
              const FloorWeighting& weighting = {}, Grain grain = Grain::Fine);

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
    /// Returns the area times weight of a counter-clockwise convex polygon on the floor.
    [[nodiscard]] double weigh(const Outline& polygon) const;
    [[nodiscard]] double mostWeight() const { return most_weight_; }

    /// Side of a cell, m.
    [[nodiscard]] double side() const { return side_; }
    /// Area of one part of a cell, m2.
    [[nodiscard]] double partArea() const { return side_ * side_ / kParts; }
    /// Parts of each cell that are floor, rounded up; cells row by row, layer by layer.
    [[nodiscard]] const std::vector<std::uint8_t>& parts() const { return parts_; }
    /// Calls visit(weight, first, count) for the cells of each weight.
    template <typename Visit>
    void forEachLayer(Visit visit) const {
        for (const Layer& layer : layers_) visit(layer.weight, layer.begin, layer.rows * columns_);
    }
    /// Computes the area times weight of parts of all cells.
    /// \param sum (first, count) returns the number of parts in these cells
    template <typename Sum>
    [[nodiscard]] double weightOf(Sum sum) const {
        double weight = 0;
        for (const Layer& layer : layers_)
            weight += layer.weight * static_cast<double>(sum(layer.begin, layer.rows * columns_));
        return weight * partArea();
    }
    /// The same floor in cells of this size. \pre it is of fine cells
    [[nodiscard]] const PoseFloor& in(Grain grain) const {
        return grain == Grain::Large ? *large_ : *this;
    }
    [[nodiscard]] std::size_t columns() const { return columns_; }
    [[nodiscard]] std::size_t rows() const { return rows_; }

    /// Sums of signed areas, by cell: adding an outline's edges and summing up along each row gives
    /// the area in each cell.
    class Tally {
      public:
        explicit Tally(const PoseFloor& floor);
        void clear();
        /// Adds a counter-clockwise convex polygon within the floor's box.
        void add(const Outline& polygon);
        /// Converts to parts of cells, rounded up, and at most those that are floor.
        void round(std::vector<std::uint8_t>& parts) const;
        /// Converts to parts of cells, rounded down but for kNoShare of a cell.
        void roundDown(std::vector<std::uint8_t>& parts) const;

      private:
        void addTo(std::size_t layer, const Outline& polygon, double sign);
        void addEdge(std::size_t layer, Point2 a, Point2 b, double sign);
        template <typename Share>
        void convert(std::vector<std::uint8_t>& parts, Share share) const;
        const PoseFloor& floor_;
        std::vector<std::vector<double>> sums_;  // of layers
        Outline clipped_, spare_;
    };

  private:
    /// Cells of some rows.
    struct Layer {
        double weight = 1;
        std::size_t first_row = 0, rows = 0;
        std::size_t begin = 0;  // of parts
    };
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    /// A piece of other weight than elsewhere.
    struct Piece {
        std::vector<HalfPlane> sides;
        Box2 box;
        double weight = 1;
        std::size_t layer = kNone;  // none: its floor does not count
    };
    void addLayers(const FloorWeighting& weighting);
    /// Clips a polygon to a piece; returns false if they share no area.
    static bool clipTo(const Piece& piece, const Outline& polygon, Outline& clipped,
                       Outline& spare);

    std::vector<Point2> points_;
    std::vector<Triangle> triangles_;
    Box2 box_;
    double side_ = 1, area_ = 0, elsewhere_ = 1, most_weight_ = 1;
    std::size_t columns_ = 1, rows_ = 1;
    std::vector<Piece> pieces_;
    std::vector<Layer> layers_;
    std::size_t rest_ = 0;  // layer of the floor outside of all pieces, or kNone
    std::vector<std::uint8_t> parts_;
    std::shared_ptr<const PoseFloor> large_;
};

/// Bounds of the floor that single poses of a box see.
struct OuterBound {
    double area = 0;  ///< m2, times weight: an upper bound of what any pose of the box sees
    std::vector<std::uint8_t> parts;  ///< of cells; every point seen by some pose lies in them
    [[nodiscard]] bool empty() const { return parts.empty(); }
};

/// Computes a superset of the points that some pose of the box sees, on the floor: those in weak
/// visibility of the rectangle through the portals of the triangulation, within range of it, and in
/// its field of view at some heading. Empty if the box holds no floor.
OuterBound outerBoundOf(const PoseFloor& floor, const Sector& sector, const PoseBox& box);
/// Returns the weighted area of that superset, or a little more, in less time; 0 if the box holds
/// no floor.
double fatAreaOf(const PoseFloor& floor, const Sector& sector, const PoseBox& box);

}  // namespace ispace::proofs::poses

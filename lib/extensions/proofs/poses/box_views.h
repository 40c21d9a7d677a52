// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: views of boxes for the check of certificates, by other code
// than those of the search.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "extensions/proofs/poses/box_sides.h"
#include "extensions/proofs/poses/outer_bound.h"

namespace ispace::proofs::poses {

/// All that some pose of a box sees, as parts of cells.
struct BoxView {
    double area = 0;                   ///< m2: bounds the area that any single pose of the box sees
    std::size_t first = 0;             ///< cell of parts[0]
    std::vector<std::uint16_t> parts;  ///< none: no pose on the floor sees any
};

/// Parts of cells that all poses of a box see.
struct BoxCore {
    std::size_t first = 0;             ///< cell of parts[0]
    std::vector<std::uint16_t> parts;  ///< rounded down
};

/// A floor as triangles and square cells, and views of boxes of poses on it. With weights each
/// layer of cells has floor of one weight.
///
/// A sight line from the box crosses a sequence of edges between triangles, each from its near side
/// to its far side. Beyond an edge it passes to the right of all left ends of edges, and to the
/// left of all right ends. So a point beyond lies to the right of the line from some point of the
/// box, and of those from all right ends on the near side, through each left end; and so mirrored.
/// Parts of the box on the far side of an edge are hidden by it.
class BoxViews {
  public:
    /// Parts of a cell; two of them add up within 16 bits.
    static constexpr int kParts = 32'767;

    /// \param most number of cells that the box around the floor is divided into, at most
    BoxViews(std::span<const Region> regions, std::size_t most, const Sector& sector,
             const FloorWeighting& weighting = {});

    [[nodiscard]] const Box2& box() const { return box_; }
    /// Returns the area of the floor by weight, or a little more, m2.
    [[nodiscard]] double floorArea() const;
    [[nodiscard]] BoxView viewOf(const PoseBox& box) const;
    /// Returns what all poses see from the same faces through the same edges, or less.
    [[nodiscard]] BoxCore coreOf(const PoseBox& box) const;

    /// A sensor that sees a known area at most, in a box of this core.
    struct Known {
        double area = 0;  ///< m2
        const BoxCore* core = nullptr;
    };
    /// Bounds what sensors see together: known areas, and in each cell the views of the others, or
    /// the floor less all cores of known ones, which the known areas hold already.
    [[nodiscard]] double unionOf(std::span<const Known> known,
                                 std::span<const BoxView* const> views) const;

    /// A sensor in a box.
    struct Placed {
        double most = 0;  ///< m2: bounds the area that it sees
        const BoxView* view = nullptr;
        const BoxCore* core = nullptr;
    };
    /// Bounds the area that at least `times` of some sensors see, as MultipleBound says.
    /// \param enough a bound that need not be lowered \pre times <= sensors.size() <= 4
    [[nodiscard]] double sharedBy(std::span<const Placed> sensors, std::size_t times,
                                  double enough) const;

  private:
    friend class BoxSight;
    friend class BoxSums;
    friend class CommonSight;
    struct Face {
        std::array<Point2, 3> at;                        // counter-clockwise
        std::array<std::int32_t, 3> beyond{-1, -1, -1};  // face behind the edge from corner i
    };
    /// Cells of floor of one weight, in some rows.
    struct Layer {
        double weight = 1;
        std::size_t first_row = 0, rows = 0, begin = 0;
    };
    /// Floor of another weight than the rest.
    struct Zone {
        std::vector<Side2> sides;
        Box2 box;
        double weight = 1;
        std::size_t layer = kNone;  // none: it does not count
    };
    static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

    std::size_t addLayer(double weight, std::size_t first_row, std::size_t rows);
    void addZones(const FloorWeighting& weighting);
    /// Adds the areas of a convex polygon to the layers, in cells.
    void addArea(std::span<const Point2> polygon, double sign, std::vector<double>& areas) const;
    /// Cuts a convex polygon along the lines of cells, and adds the areas of its pieces.
    void addTo(const Layer& layer, std::span<const Point2> polygon, double sign,
               std::vector<double>& areas) const;
    /// Sums areas or parts of all cells by weight. \param sum (first, count) of cells
    template <typename Sum>
    [[nodiscard]] double weigh(Sum sum) const {
        double weight = 0;
        for (const Layer& layer : layers_)
            weight += layer.weight * static_cast<double>(sum(layer.begin, layer.rows * columns_));
        return weight * side_ * side_;
    }
    /// Converts to parts, rounded up, or down but for the least share of a cell.
    [[nodiscard]] std::vector<std::uint16_t> partsOf(const std::vector<double>& areas,
                                                     bool is_up = true) const;

    Sector sector_;
    std::vector<Face> faces_;
    Box2 box_;
    double side_ = 1;
    std::size_t columns_ = 1, rows_ = 1;
    std::vector<Layer> layers_;
    std::vector<Zone> zones_;
    std::size_t rest_ = kNone;  // layer of the floor outside of all zones
    double most_weight_ = 1;
    std::vector<std::uint16_t> most_;  // parts that are floor, layer by layer
};

}  // namespace ispace::proofs::poses

// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: bounds of the floor that sensors see by sums over the
// sensors.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "extensions/proofs/poses/pose_boxes.h"

namespace ispace::proofs::poses {

/// Bounds the area that at least `times` of the sensors see, at any poses in their boxes, by a
/// maximum for each sensor by itself. Subdivisions of the boxes then cost the sum of their parts,
/// where tuples of the parts would cost the product.
///
/// Let A be any set of cells. In A the area is at most the floor; outside of A it is at most the
/// sum of the areas that the sensors see there, divided by `times`. The largest of these, for each
/// sensor, is bounded by the parts of its box: a pose in a part sees at most its fat view outside
/// of A, and at most the largest single view less the core within A.
///
/// Any A is valid. A subgradient method looks for the best one: the cells that mean views fill
/// `times` times. The mean is over the fat views and cores of the boxes, at first, and of the parts
/// that see most outside of each A.
class SumBound {
  public:
    /// Stores the references.
    SumBound(const PoseFloor& floor, PoseBoxes& boxes, std::size_t times)
        : floor_(floor.in(Grain::Large)), boxes_(boxes), times_(times) {}

    /// A tuple of boxes, and a bound.
    struct Bounded {
        std::span<const BoxId> boxes;
        double bound = 0;
    };
    /// Lowers bounds that exceed `enough`, and halves parts that decided them, for later tuples.
    void lower(std::vector<Bounded>& tuples, double enough);

  private:
    /// Boxes without halves, and those whose halves lack the views that they had in an earlier run.
    struct Wanted {
        std::vector<BoxId> whole, bare;
    };
    [[nodiscard]] double boundOf(const Bounded& tuple, double enough, Wanted& wanted) const;
    /// Bounds the area outside of A that a pose in a box sees. \param outside 255 for these cells
    [[nodiscard]] double seenBy(BoxId box, const std::vector<std::uint8_t>& outside) const;
    /// Bounds it by parts of the box, and returns also the part that may see most.
    [[nodiscard]] std::pair<double, BoxId> mostSeenBy(BoxId box,
                                                      const std::vector<std::uint8_t>& outside,
                                                      Wanted& wanted) const;

    const PoseFloor& floor_;
    PoseBoxes& boxes_;
    std::size_t times_;
};

}  // namespace ispace::proofs::poses

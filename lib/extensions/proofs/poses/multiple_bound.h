// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: bounds of the floor that several sensors see at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "extensions/proofs/poses/pose_boxes.h"

namespace ispace::proofs::poses {

/// Largest number of sensors of a tuple.
constexpr std::size_t kMaxBoxes = 4;

/// Bounds the area that at least `times` of the sensors see together, at any poses in their boxes.
///
/// Let x be 1 where `times` sensors see the floor, else 0, and a_i where sensor i sees it. Its area
/// is known to be at most S_i. For any prices p_i >= 0 the area of x is at most
///     sum p_i S_i + area(x - sum p_i a_i),
/// since the second term takes away no more than the first adds. The second term is bounded in each
/// cell by itself. There a_i has an area of at least c_i, that of the core, and at most f_i, that
/// of the fat view; m is floor. For any q_i >= 0,
///     x - sum p_i a_i = (x - sum q_i a_i) + sum (q_i - p_i) a_i.
/// Where x is 1, `times` of the a_i are, so the bracket is at most r = max(0, 1 - the sum of the
/// `times` least q_i), and nowhere more. So the cell adds at most
///     r m + sum max(0, q_i - p_i) f_i - sum max(0, p_i - q_i) c_i.
/// Each choice of p bounds the whole, each choice of q a cell; the least counts. Here q is 0
/// everywhere (r = 1), or 0 for j < times sensors and 1 / (times - j) for the others (r = 0): all
/// but the j largest views, counted `times - j` times. p is 0, or 1 / t for some sensors and a t of
/// at most `times`, and 0 for the others.
class MultipleBound {
  public:
    /// Stores the references. \pre sensors <= kMaxBoxes, 1 <= times <= sensors
    MultipleBound(const PoseFloor& floor, const PoseBoxes& boxes, std::size_t sensors,
                  std::size_t times);

    /// Returns the bound; it may be a larger one that does not exceed `enough`.
    [[nodiscard]] double of(std::span<const BoxId> boxes, double enough) const;
    /// Bounds it by the areas of single views alone.
    [[nodiscard]] double ofSingles(std::span<const BoxId> boxes) const;
    /// Estimates the area that `times` views from centres share.
    [[nodiscard]] double ofCentres(std::span<const BoxId> boxes) const;

  private:
    /// In units of 1 / kUnit, so that shares of 1 / times are whole.
    using Prices = std::array<std::int16_t, kMaxBoxes>;
    static constexpr std::int16_t kUnit = 12;

    struct Dense;  // views of boxes in all cells
    [[nodiscard]] double boundFor(const Prices& prices, std::span<const BoxId> boxes, Grain grain,
                                  Dense& views) const;
    [[nodiscard]] double boundIn(Grain grain, std::span<const BoxId> boxes, double enough) const;

    const PoseFloor& floor_;
    const PoseBoxes& boxes_;
    std::size_t sensors_, times_;
    std::vector<Prices> prices_;       // p
    std::vector<Prices> cell_prices_;  // q with r = 0
};

}  // namespace ispace::proofs::poses

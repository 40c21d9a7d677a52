// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/extensions/proofs/poses: sums over sensors for the check of certificates, by other
// code than those of the search.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "extensions/proofs/poses/box_views.h"

namespace ispace::proofs::poses {

/// A box of a certificate's tree, in pre-order; its second half follows the subtree of the first,
/// which is the next box.
struct CheckedBox {
    PoseBox box;
    std::uint32_t second = 0;  // 0: whole
    std::uint32_t end = 0;     // of its subtree
    double most = 0;           // bounds the area that a single pose of it sees
    bool is_used = false;      // by a tuple
    bool is_part = false;      // of a box that is used
    BoxView view = {}, large_view = {};
    BoxCore core = {}, large_core = {};
};

/// Bounds the area that at least `times` of some sensors see, as SumBound says: by the floor in
/// some cells, and the sum over the sensors in the others.
class BoxSums {
  public:
    /// Stores the references. \param floor in the cells of large_view and large_core
    BoxSums(const BoxViews& floor, const std::vector<CheckedBox>& boxes, std::size_t times)
        : floor_(floor), boxes_(boxes), times_(static_cast<double>(times)) {}

    /// The cells that count as floor are those of the search but for rounding, which may turn out
    /// worse. If the bound is not enough, it is the larger one of two tuples with halves.
    /// \param enough a bound that need not be lowered
    /// \param halvings how deep tuples are halved, at most
    /// \pre the boxes and all parts of them have views
    [[nodiscard]] double boundOf(std::span<const std::uint32_t> boxes, double enough,
                                 int halvings) const;

  private:
    [[nodiscard]] double sumOf(std::span<const std::uint32_t> boxes, double enough) const;
    using Marks = std::vector<char>;  // of cells that count as floor
    struct Most {
        double area = -1;
        std::uint32_t part = 0;
    };
    [[nodiscard]] double outside(std::uint32_t box, const Marks& marks) const;
    /// Raises `most` to that of the parts of a box.
    void search(std::uint32_t box, double area, int depth, const Marks& marks, Most& most) const;
    void addTo(std::vector<double>& mean, std::uint32_t box, double share) const;

    const BoxViews& floor_;
    const std::vector<CheckedBox>& boxes_;
    double times_;
};

}  // namespace ispace::proofs::poses

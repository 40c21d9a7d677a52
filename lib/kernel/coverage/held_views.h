// SPDX-License-Identifier: GPL-3.0-or-later
// Tests points and rectangles against up to 64 views from one position at once: candidates of
// arrange(1) look from one site in many directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "coverage/distorted_picture.h"
#include "coverage/picture_table.h"
#include "scene/sensor/field_of_view.h"

namespace ispace {

/// Fields of view of one sensor at one position, tested together: bit k of a word stands for view
/// k. Answers are those of FieldOfView::holds() for each, always: tables and interval bounds only
/// decide sure cases, the rest asks the lens model. Const members are thread-safe.
///
///     const HeldViews held(views);
///     const std::uint64_t in_view = held.holding(place, held.all());
class HeldViews {
  public:
    static constexpr std::size_t kMax = 64;  ///< views, one for each bit

    /// Refers to the views. \pre 1 to kMax views
    explicit HeldViews(std::span<const FieldOfView> views);

    /// Returns the word of all views.
    [[nodiscard]] std::uint64_t all() const { return ~std::uint64_t{0} >> (kMax - views_.size()); }
    /// Returns those of the views `among` that hold a point: bit k equals views[k].holds().
    [[nodiscard]] std::uint64_t holding(Point3 place, std::uint64_t among) const;

    /// The views that hold all points of a rectangle, and those that may hold some.
    struct Verdict {
        std::uint64_t held = 0, unsure = 0;
    };
    /// Tests the points of a level rectangle at once, `half` being half its sides along x and y.
    [[nodiscard]] Verdict decide(Point3 center, Vec2 half, std::uint64_t among) const;

  private:
    [[nodiscard]] bool isHeld(const FieldOfView& view, Point3 place) const;

    std::span<const FieldOfView> views_;
    std::optional<PictureTable> table_;        // of a fisheye or a mirror
    std::optional<DistortedPicture> picture_;  // of a pinhole
};

}  // namespace ispace

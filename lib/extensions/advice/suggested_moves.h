// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/extensions/advice: the floor that sensors gain by moves of furniture, from the
// shadows of the pieces alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/cell_set.h"
#include "coverage/coverage.h"
#include "coverage/target.h"
#include "coverage/visible_area.h"
#include "extensions/advice/suggestion.h"
#include "scene/scene.h"

namespace ispace::advice {

/// Computes by how much more indoor floor the sensors of a scene see in rooms that differ from its
/// own in some pieces: views change only in the shadows of these, before and after. Counts the
/// cells of the coverage, and casts rays to those in shadows: O(sensors + cells in shadows) each,
/// where a whole measure takes O(sensors * cells). Lasers that scan a slice in which a piece stands
/// in reach are computed whole.
class MoveTrials {
  public:
    /// Stores the references. \pre areKnown()
    MoveTrials(const Scene& scene, const Coverage& coverage, const SuggestOptions& options);

    /// Returns false with requirements or rules, which count other floor, for cells by beams, and
    /// for views from other scenes.
    static bool areKnown(const Scene& scene, const Coverage& coverage,
                         const SuggestOptions& options);

    /// Returns the indoor floor gained with the sensors in this room, m2; below 0 if it is less.
    /// Empty if the rooms differ in more than some pieces.
    [[nodiscard]] std::optional<double> gainIn(const Environment& changed);

    /// Returns by how much a gain may differ from a measured one, m2: 0 if figures are those of
    /// cells.
    [[nodiscard]] double error() const { return error_; }

  private:
    struct View {
        Sensor sensor;
        Box2 reach;  ///< holds all rays, on the plan
        bool is_partial, is_buried;
        const CellSet* cells;
    };
    void addView(const Sensor& sensor, const VisibleArea& sight, const CellSet& cells);
    [[nodiscard]] bool isCovered(std::size_t cell) const;

    const Scene& scene_;
    double plane_;
    Target target_;
    double cell_ = 0, error_ = 0;  // m2
    std::vector<View> views_;
    std::vector<std::int32_t> times_, heard_;  // by cell: lasers and so on; receivers
};

}  // namespace ispace::advice

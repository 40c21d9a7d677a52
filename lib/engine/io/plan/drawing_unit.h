// SPDX-License-Identifier: GPL-3.0-or-later
// The unit of a drawing by its contents: leaves of doors are 0.6 m to 1.2 m wide, walls 0.08 m to
// 0.5 m thick, and plans 2 m to 500 m wide in the right unit.
//
//     const auto ranking = rankedUnits(read, work, nullptr, usualUnits());
//     const UnitEvidence* const unit = decidedUnit(ranking, nullptr);
//     if (unit == nullptr) throw FormatError({name, 0, 0, "no unit" + scaleHint(ranking)});
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "base/budget.h"
#include "io/import_records.h"
#include "io/plan/line_plan.h"

namespace ispace {

/// Measures of a drawing in one unit, in metres.
struct UnitEvidence {
    const LengthUnit* unit = nullptr;
    std::size_t doors = 0;      ///< leaves with swings, as wide as doors
    double door_width = 0;      ///< their median
    double walls = 0;           ///< share of the length of lines with a parallel as far as a wall
    double wall_thickness = 0;  ///< median of that distance, by length
    double extent = 0;          ///< of all lines, the larger side
    double width = 0;           ///< of all lines, along x
    bool is_large = false;      ///< of too many lines to compare
    double score = 0;           ///< doors count 2, walls 1, the extent 1
};

/// Ranks units, the most likely first, without those in which the drawing has no plan's size.
///
/// The drawing is read at one scale, at which it is some 20 m wide: curves and doors are found as
/// well whatever its unit, and the directions of its lines are sorted once. Drawings of very many
/// lines, or of more work than is left, have extents alone. O(n log n) a unit
/// \param read returns walls and doors at metres a unit; called twice at most
/// \param work for all units
/// \param stated the unit that the drawing states, or null; if it has doors, or walls and a usual
/// size, the others are not tried
/// \param candidates outlive the result; usualUnits(): m, mm, cm, inch and foot
std::vector<UnitEvidence> rankedUnits(
    const std::function<LayerSorter::Sorted(double metres_per_unit)>& read, Budget work,
    const LengthUnit* stated, std::span<const LengthUnit> candidates);
std::span<const LengthUnit> usualUnits();

/// Returns the first of the ranking if doors or walls make it much more likely than the others,
/// else null. \param stated as above: it is believed unless its plan has an impossible size, or no
/// door while another unit has two or more
const UnitEvidence* decidedUnit(const std::vector<UnitEvidence>& ranking, const LengthUnit* stated);

/// Returns "doors are 0.81 m wide, walls 0.3 m thick and the plan 9.0 m wide".
std::string evidenceText(const UnitEvidence& evidence);

/// Returns the options that read a drawing in this unit: "--units mm", "--width-is 8.00" for scales
/// of paper.
std::string optionOf(const UnitEvidence& evidence);

/// The advice for a drawing without a unit, or in a wrong one, by its ranking: "; most likely is
/// mm, in which doors are 0.81 m wide and the plan 9.0 m wide, then inch, in which …: say its unit,
/// for example with --units mm, or how wide it is, with --width-is 9.00".
std::string scaleHint(const std::vector<UnitEvidence>& ranking);

}  // namespace ispace

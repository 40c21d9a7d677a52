// SPDX-License-Identifier: GPL-3.0-or-later
// arrange --objective localise: layouts by the errors of positions, see localisation.h.
//
//     options.objective = std::make_shared<const LocaliseObjective>(0.5);      // metres
//     const Arrangement found = arrange(site, groups, options, progress);
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "arrange/layout_objective.h"

namespace ispace::goals {

/// Value of a cell of weight 1 without an error; one at the limit, or above, has none.
constexpr std::uint64_t kNoError = std::uint64_t{1} << 20U;

/// Values of layouts are sums over all cells of the weight times kNoError (1 - error / limit),
/// rounded down; with standing sensors.
///
/// The search starts with greedy search, and with the layout found for coverage; Swap and Exact
/// then move single sensors while the value grows. The bound is the lower of two. The errors of a
/// cell are at least 2 / sqrt(t), t the sum of the traces of all information; the least concave
/// function above 1 - error / limit of t is submodular over the sensors, and no layout exceeds its
/// value for the layout found by more than the largest gains of so many sensors (Nemhauser, Wolsey,
/// Fisher 1978). And no cell has a value without cover, nor more than the best candidate gives it
/// if all sensors stand there, which is a problem of coverage. A gap remains in general.
/// \pre no budget, target or multiplicity is required
class LocaliseObjective final : public LayoutObjective {
  public:
    /// \param within metres: larger errors, and no position, count as this
    explicit LocaliseObjective(double within) : within_(within) {}

    [[nodiscard]] std::string_view name() const override { return "localise"; }
    [[nodiscard]] bool joinsRooms() const override { return false; }
    [[nodiscard]] std::unique_ptr<ObjectiveSearch> searchIn(
        const CoverageModel& model) const override;
    [[nodiscard]] std::string finding(const Arrangement& found) const override;

  private:
    double within_;
};

}  // namespace ispace::goals

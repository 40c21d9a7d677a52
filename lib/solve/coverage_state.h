// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solve/problem.h"

namespace ispace {

/// What one more sensor is counted for.
enum class Measure {
    Met,   ///< weights of the cells whose demand it meets at last
    Parts  ///< of each cell it sees, weight * (min(load, demand) after - before), scaled
};

/// Weights for Measure::Parts: those of the problem, halved so often that a sensor's parts are
/// below 2^32 (only where shares are above 1 and weights are large), but nothing above 0 becomes 0
/// unless the cells are too many for that.
std::vector<std::uint32_t> weightsOfParts(const Problem& problem);

/// True if there is a kind of which it takes several sensors to meet the demand.
bool takesSteps(const Problem& problem);

/// Sensors chosen and what each cell has of them. Choices that are repeated count once.
class CoverageState {
  public:
    /// \param parts weightsOfParts(problem); it and problem must outlive this
    CoverageState(const Problem& problem, const std::vector<std::uint32_t>& parts);

    /// Appends a choice or puts it at a position. O(cells it sees + chosen)
    void add(const Choice& choice) { insert(chosen_.size(), choice); }
    void insert(std::size_t position, const Choice& choice);
    void removeAt(std::size_t position);
    void clear();

    [[nodiscard]] const Problem& problem() const { return *problem_; }
    [[nodiscard]] const std::vector<Choice>& chosen() const { return chosen_; }
    [[nodiscard]] bool holds(const Choice& choice) const;
    /// The same as valueOf(problem, chosen()).
    [[nodiscard]] std::uint64_t value() const { return value_; }
    /// Sum of part weight * min(load, demand).
    [[nodiscard]] std::uint64_t parts() const { return parts_; }
    [[nodiscard]] double cost() const;
    /// How many of a kind are chosen.
    [[nodiscard]] int count(std::size_t kind) const { return counts_[kind]; }

    /// True if one more of this kind is within `limit` and the budget.
    [[nodiscard]] bool canTake(std::size_t kind, int limit) const;
    /// What each cell adds if one more sensor of this kind sees it.
    void price(std::size_t kind, Measure measure, std::vector<std::uint32_t>& prices) const;
    /// What each cell is worth to one more sensor of this kind that sees it where more may follow,
    /// with shares of at most `to_come` together: nothing if it is met, or cannot be met by these
    /// any more; else its weight, shared out among the sensors of this kind that it lacks. So what
    /// meets a demand at last counts whole. Weights are times the most with which their sum is
    /// below 2^32: those of a sensor's cells are, too.
    void priceSteps(std::size_t kind, std::uint64_t to_come,
                    std::vector<std::uint32_t>& prices) const;

  private:
    template <bool kAdds>
    void change(const Choice& choice);

    const Problem* problem_;
    const std::vector<std::uint32_t>* part_weights_;
    std::uint32_t demand_, step_scale_;
    std::vector<std::uint32_t> shares_;  // per kind, at most the demand
    std::vector<std::uint32_t> loads_;   // per cell; what stood is at most the demand
    std::vector<Choice> chosen_;
    std::vector<int> counts_;
    std::uint64_t value_ = 0, parts_ = 0;
};

/// How many sensors of each kind are to be placed: `most`, with an order as many as that holds, and
/// none where there is no candidate.
std::vector<int> limitsOf(const Problem& problem);

}  // namespace ispace

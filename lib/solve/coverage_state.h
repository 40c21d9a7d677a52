// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "solve/problem.h"

namespace ispace {

/// How the marginal gain of a sensor is measured.
enum class Measure {
    Full,    ///< weights of the cells that become covered
    Partial  ///< weight * (min(multiplicity, required) after - before) of each cell, scaled
};

/// Weights for Measure::Partial: those of the problem, halved until the partial value of a sensor
/// stays below 2^32 (needed only for multiplicities above 1 and large weights). Positive weights
/// stay positive unless there are too many cells.
std::vector<std::uint32_t> partialWeights(const Problem& problem);

/// True if some kind takes several sensors to cover a cell.
bool takesSteps(const Problem& problem);

/// Chosen sensors and the multiplicity that each cell achieves. Repeated choices count once.
class CoverageState {
  public:
    /// \param partial partialWeights(problem); it and problem must outlive this
    CoverageState(const Problem& problem, const std::vector<std::uint32_t>& partial);

    /// Appends a choice or inserts it at a position. O(cells it sees + chosen)
    void add(const Choice& choice) { insert(chosen_.size(), choice); }
    void insert(std::size_t position, const Choice& choice);
    void removeAt(std::size_t position);
    void clear();

    [[nodiscard]] const Problem& problem() const { return *problem_; }
    [[nodiscard]] const std::vector<Choice>& chosen() const { return chosen_; }
    [[nodiscard]] bool holds(const Choice& choice) const;
    /// The same as valueOf(problem, chosen()).
    [[nodiscard]] std::uint64_t value() const { return value_; }
    /// Sum of partial weight * min(multiplicity, required).
    [[nodiscard]] std::uint64_t partialValue() const { return partial_value_; }
    [[nodiscard]] double cost() const;
    /// How many of a kind are chosen.
    [[nodiscard]] int count(std::size_t kind) const { return counts_[kind]; }

    /// True if one more of this kind is within `limit` and the budget.
    [[nodiscard]] bool canTake(std::size_t kind, int limit) const;
    /// Gain of each cell if one more sensor of this kind sees it.
    void marginalGains(std::size_t kind, Measure measure, std::vector<std::uint32_t>& gains) const;
    /// Gain of each cell if one more sensor of this kind sees it and others with a multiplicity of
    /// at most `to_come` together may follow: 0 if it is covered already or can no longer be, else
    /// its weight divided by the number of sensors of this kind that it still lacks. The sensor
    /// that completes a cell so gains all of it. Weights are scaled up as far as their sum stays
    /// below 2^32.
    void stepGains(std::size_t kind, std::uint64_t to_come,
                   std::vector<std::uint32_t>& gains) const;

  private:
    template <bool kAdds>
    void change(const Choice& choice);

    const Problem* problem_;
    const std::vector<std::uint32_t>* partial_weights_;
    std::uint32_t required_, step_scale_;
    std::vector<std::uint32_t> multiplicities_;  // per kind, at most required_
    std::vector<std::uint32_t> loads_;  // achieved by each cell, at first at most required_
    std::vector<Choice> chosen_;
    std::vector<int> counts_;
    std::uint64_t value_ = 0, partial_value_ = 0;
};

/// How many sensors of each kind may be placed: Kind::most, at most as many as the order lists, and
/// none of a kind without candidates.
std::vector<int> limitsOf(const Problem& problem);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "solve/candidate_set.h"

namespace ispace {

/// Sensors that are alike: they choose from the same candidates.
struct Kind {
    const CandidateSet* candidates = nullptr;
    int most = 1;     ///< how many may be placed
    double cost = 1;  ///< of one; above 0
    int share = 1;    ///< of the demand of a cell that one sensor meets
};

/// What a search is to choose: sensors whose cells are worth most.
///
/// A cell counts, with its weight, if the shares of the sensors that see it, with what is met
/// already, reach the demand. One sensor of share 1 and a demand of 1 is the plain union; K-fold
/// coverage is a demand of K; where ultrasound takes part, four receivers of share 1 do what a
/// laser of share 4 does, and the demand is 4 K.
///
/// What is chosen is a set: a candidate that is chosen twice (there may be fewer candidates than
/// sensors) counts once. So 0 and 1 are enough for a candidate in any model of the problem.
struct Problem {
    /// Worth of each cell in whole units, 0 for cells that do not count. Their sum is below 2^32.
    std::vector<std::uint32_t> weights;
    int demand = 1;
    /// Shares that sensors which stand already meet, per cell; empty: none.
    std::vector<std::uint16_t> met;
    std::vector<Kind> kinds;  ///< all candidate sets are of weights.size() cells
    /// What the sensors may cost together; nothing: as many as `most` says.
    std::optional<double> budget;
    /// The kinds of the sensors in the order in which they are to be placed one after another;
    /// empty: any order, the best first.
    std::vector<std::size_t> order;
    /// If true, the views of all sensors hang together: from each one leads a way to each other one
    /// over sensors that see a common cell of weight above 0. Those that stand are one part: they
    /// see `standing`; they are no part if that holds no cell of weight above 0.
    bool is_connected = false;
    CellSet standing = CellSet();

    [[nodiscard]] std::size_t cells() const { return weights.size(); }
    [[nodiscard]] std::uint64_t totalWeight() const;
};

/// A sensor at its place.
struct Choice {
    std::size_t kind = 0;
    std::size_t candidate = 0;  ///< of the kind's set
    friend auto operator<=>(const Choice&, const Choice&) = default;
};

/// Sensors chosen, in the order in which they were placed, and what they are worth with what stood
/// before.
struct Solution {
    std::vector<Choice> chosen;
    std::uint64_t value = 0;
};

/// What a set of choices is worth: the sum of the weights of cells whose demand is met. Choices
/// that are repeated count once. O(cells + runs)
std::uint64_t valueOf(const Problem& problem, const std::vector<Choice>& chosen);
/// Of all, also of those that are repeated. Does not depend on their order.
double costOf(const Problem& problem, const std::vector<Choice>& chosen);
/// True if a cost is below another by more than rounding explains. All comparisons of costs are
/// this one: those within 1e-13 of each other (a fraction, and more than the rounding errors of a
/// sum over some hundred kinds) are the same, as 0.1 + 0.2 and 0.3 are; 1e9 and 1e9 + 0.001 are
/// not.
bool isCheaper(double cost, double than);
/// True if so much is within the budget.
bool isAffordable(const Problem& problem, double cost);
/// How many of this cost a budget buys beside what is spent already, up to `most`. O(log most)
std::size_t affordableCount(double budget, double spent, double cost, std::size_t most);
/// The decimal number that a cost, a sum of decimal numbers, stands for: rounded to 12 significant
/// digits, or to as many as the same cost takes (isCheaper). 0.1 + 0.2 becomes 0.3.
double tidyCost(double cost);
/// Within `most`, `budget` and, if it is asked for, connected.
bool isFeasible(const Problem& problem, const std::vector<Choice>& chosen);
/// True if the views hang together, see Problem::is_connected.
bool isConnected(const Problem& problem, const std::vector<Choice>& chosen);

/// How the views of sensors hang together, see Problem::is_connected.
class Connection {
  public:
    /// O(cells + cells that the chosen see)
    Connection(const Problem& problem, const std::vector<Choice>& chosen);

    /// Sets of views that see no common cell of weight above 0.
    [[nodiscard]] std::size_t parts() const { return parts_; }
    /// True if with this one all hangs together. O(parts * runs); the first call: O(parts * cells)
    [[nodiscard]] bool isJoinedBy(const Choice& choice) const;

  private:
    const Problem* problem_;
    std::size_t parts_ = 0;
    std::vector<std::size_t> part_of_cell_;          // kNobody: of none
    mutable std::vector<CellPrices> cells_of_part_;  // 1 for its cells; made when first asked for
};

/// Weights in whole units, as a Problem has them, with a sum below 2^32: times the least power of
/// ten that makes all of them whole, to within a billionth of the largest weight (or of 1, if that
/// is larger: decimals are as written, not as stored). Where none does, times as large a power as
/// the sum allows, up to six decimals and six digits of the largest weight; where the sum is too
/// large as it is, all are made smaller in proportion. Rounded then, but what is above 0 is at
/// least one unit. O(n) for each power tried
/// \pre none is below 0, all are finite, and there are at most 2^28
std::vector<std::uint32_t> wholeUnits(const std::vector<double>& worth);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// The problem that arranging sensors comes down to: maximum coverage with weights, kinds, a budget,
// multiple coverage and connection. NP-hard already for one kind (R. M. Karp, Reducibility among
// combinatorial problems, 1972, for set cover); search.h has the methods and their guarantees.
//
// Functions here define the values that searches maximise; problem_test compares them with a loop
// over cells. Pure functions, thread-safe. cover_sets.h has an example.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "arrange/search/cover_sets.h"

namespace ispace {

/// Interchangeable sensors: they share one set of candidates.
struct SensorType {
    const CandidateSet* candidates = nullptr;
    int most = 1;          ///< maximum number of sensors
    double cost = 1;       ///< of each; above 0
    int multiplicity = 1;  ///< that one sensor adds to the cells that it sees
};

/// A weighted coverage problem: find sensors that maximise the weight of the covered cells.
///
/// A cell is covered if the multiplicities of the sensors that see it, plus its achieved
/// multiplicity, reach `required`. With 1 and 1 that is the plain union; K-fold coverage requires
/// K. With ultrasound, four receivers of multiplicity 1 equal a laser of multiplicity 4, and 4 K is
/// required.
///
/// A solution is a set: a candidate chosen twice (there may be fewer candidates than sensors)
/// counts once, so a binary variable per candidate models it.
struct Problem {
    /// Integer weight of each cell, 0 if it does not count. The sum is below 2^32.
    std::vector<std::uint32_t> weights;
    int required = 1;
    /// Multiplicity of each cell from standing sensors; empty: all 0.
    std::vector<std::uint16_t> achieved;
    std::vector<SensorType> kinds;  ///< all candidate sets are of weights.size() cells
    /// Upper limit of the total cost; without it only SensorType::most limits the choice.
    std::optional<double> budget;
    /// Kinds in the order in which greedy search adds them; empty: the best first.
    std::vector<std::size_t> order;
    /// Requires connected coverage: the graph with sensors as nodes, and with edges that join
    /// sensors that share a cell of positive weight must be connected. Standing sensors are one
    /// node, which sees `standing`; the node is absent if no cell of that has positive weight.
    bool is_connected = false;
    CellSet standing = CellSet();
    /// Of connected coverage, the region of each cell, from 0 on: rooms that no sensor joins.
    /// Coverage is then connected in each region by itself. Empty: all cells are one region.
    std::vector<std::uint32_t> regions = {};
    /// A hint for bounds: the block of each cell, from 0 on. Cells of one block lie together, so
    /// that a sensor sees all of most blocks or none. Empty: blocks are of consecutive cells.
    std::vector<std::uint32_t> blocks = {};

    [[nodiscard]] std::size_t cells() const { return weights.size(); }
    [[nodiscard]] std::uint64_t totalWeight() const;
};

/// One sensor on one candidate.
struct Choice {
    std::size_t kind = 0;
    std::size_t candidate = 0;  ///< of the kind's set
    friend auto operator<=>(const Choice&, const Choice&) = default;
};

/// Chosen sensors in the order of placement, and their value together with standing sensors.
struct Solution {
    std::vector<Choice> chosen;
    std::uint64_t value = 0;
};

/// Computes the weight of all covered cells. Repeated choices count once. O(cells + runs)
std::uint64_t valueOf(const Problem& problem, const std::vector<Choice>& chosen);
/// Computes the total cost; repeated choices count each time. Independent of their order.
double costOf(const Problem& problem, const std::vector<Choice>& chosen);
/// Returns true if `cost` is less than `than` beyond rounding. Every comparison of costs uses this
/// function: costs within a relative 1e-13 (above the rounding errors of a sum over some hundred
/// kinds) are equal, as 0.1 + 0.2 and 0.3 are; 1e9 and 1e9 + 0.001 are not.
bool isCheaper(double cost, double than);
/// Returns true if this cost is within the budget, or there is no budget.
bool isAffordable(const Problem& problem, double cost);
/// Computes the number of sensors of this cost that the rest of a budget buys, at most `most`.
/// O(log most)
std::size_t affordableCount(double budget, double spent, double cost, std::size_t most);
/// Rounds a sum of decimal costs to 12 significant digits, or to as many as isCheaper() tells
/// apart: 0.1 + 0.2 becomes 0.3.
double normaliseCost(double cost);
/// Returns true for choices within SensorType::most and the budget.
bool isWithinLimits(const Problem& problem, const std::vector<Choice>& chosen);
/// Returns true for choices within these limits and, if required, connected.
bool isFeasible(const Problem& problem, const std::vector<Choice>& chosen);
/// Returns true if the coverage is connected, see Problem::is_connected.
bool isConnected(const Problem& problem, const std::vector<Choice>& chosen);

/// Connected components of the coverage, see Problem::is_connected.
class Connection {
  public:
    /// O(cells + cells that the chosen see)
    Connection(const Problem& problem, const std::vector<Choice>& chosen);
    /// The same for sensors that see these cells.
    Connection(const Problem& problem, std::span<const CellSet* const> views);

    /// Returns true if the coverage is connected: no region has cells of two components, and a
    /// sensor that sees no cell of positive weight is the only one.
    [[nodiscard]] bool isWhole() const;
    /// Returns true if the coverage is connected with this sensor. O(parts * runs); the first call
    /// O(parts * cells)
    [[nodiscard]] bool isJoinedBy(const Choice& choice) const;

  private:
    /// Calls visit(run) for the cells that a sensor sees.
    using Visit = std::function<void(const CellRun&)>;
    void join(std::size_t sensors, const std::function<void(std::size_t, const Visit&)>& see);

    const Problem* problem_;
    std::size_t parts_ = 0;                                    // components
    std::vector<std::size_t> part_of_cell_;                    // kNoOwner: of no part
    std::vector<std::vector<std::uint32_t>> regions_of_part_;  // ascending; of several regions
    std::vector<std::size_t> parts_in_region_;
    // 1 for the cells of a part, and for those of positive weight in a region; built on demand.
    mutable std::vector<WeightSums> cells_of_part_, cells_of_region_;
};

/// Scales weights to the integers of a Problem, with a sum below 2^32. The factor is the smallest
/// power of ten that makes all of them integers to within 1e-9 of min(1, the largest weight), which
/// absorbs decimals that binary cannot store. If there is no such power, the factor is the largest
/// that the sum allows, up to six decimals and six digits of the largest weight; weights with
/// too large a sum are scaled down. The results are rounded, positive weights to at least 1. O(n)
/// per power \pre all are finite and not negative, and there are at most 2^28
std::vector<std::uint32_t> integerWeights(const std::vector<double>& weights);

/// Computes the costs that sets of sensors can have, each sensor on a different candidate:
/// ascending from level 0, cost 0, up to some cost. Sums equal up to rounding (isCheaper) are one
/// level. If there are more than 4000, the levels are even steps instead, rounded down to a few
/// digits.
class CostLevels {
  public:
    /// O(4000 * kinds * log of how many of each)
    CostLevels(const std::vector<SensorType>& kinds, double most);

    [[nodiscard]] std::size_t size() const { return levels_.size(); }
    [[nodiscard]] bool isEven() const { return is_even_; }
    /// Returns the budget that buys level i but not level i + 1.
    [[nodiscard]] double at(std::size_t i) const { return levels_[i].most; }
    /// Finds the highest level that is cheaper; 0 if all are dearer.
    [[nodiscard]] std::size_t below(double cost) const;
    /// Returns the lowest cost that at(i) does not buy; infinite if level i is the last.
    [[nodiscard]] double above(std::size_t i) const;

  private:
    /// Sums equal up to rounding.
    struct Level {
        double least = 0, most = 0;
    };
    /// Adds the sums with `count` more sensors of this cost.
    void mayAdd(std::size_t count, double cost, double most);
    void setEven(double most);

    std::vector<Level> levels_ = {Level()};
    bool is_even_ = false;
};

/// Writes the problem as a maximum-coverage model in free MPS, for any solver of mixed-integer
/// programs (glpsol, cbc, HiGHS, SCIP): maximise the weights of covered cells. Columns x_KIND_INDEX
/// (binary, 1: a sensor of that kind stands on that candidate) and y_CELL (at most 1); rows
/// cell_CELL (y <= sensors that see it; binary if more than 1 is required), most_KIND and budget.
/// As all MPS readers minimise, the objective is minus the value gained; a comment explains this,
/// and others describe each candidate. Skips cells that no candidate sees or that are covered
/// already.
/// \param kinds names of the kinds, without spaces
/// \param legend names the figures that `describe` returns for the comment of a candidate
void writeMps(const Problem& problem, const std::vector<std::string>& kinds,
              const std::string& legend, const std::function<std::string(const Choice&)>& describe,
              std::ostream& out);

}  // namespace ispace

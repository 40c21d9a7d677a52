// SPDX-License-Identifier: GPL-3.0-or-later
// Values, costs, connection and levels of cost of coverage problems, and their text as MPS.
//
// A value takes two writes for a run and a pass over the cells. Costs are doubles, as users write
// them: sums kind by kind round little, and comparisons allow 1e-13 of the cost. Connection merges
// sensors that share a cell of weight by union-find (R. E. Tarjan, Efficiency of a good but not
// linear set union algorithm, 1975). Sums of costs are listed by binary counts of each kind, as
// levels; beyond 4000 levels even steps stand for them.
#include "arrange/search/problem.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

#include "base/number.h"

namespace ispace {

namespace {

/// Removes duplicate choices.
std::vector<Choice> distinct(std::vector<Choice> chosen) {
    std::sort(chosen.begin(), chosen.end());
    chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
    return chosen;
}

}  // namespace

std::uint64_t Problem::totalWeight() const {
    return std::accumulate(weights.begin(), weights.end(), std::uint64_t{0});
}

std::uint64_t valueOf(const Problem& problem, const std::vector<Choice>& chosen) {
    // Stores differences of the multiplicity from cell to cell, so that a run costs two writes.
    std::vector<std::int64_t> steps(problem.cells() + 1, 0);
    for (const Choice& choice : distinct(chosen)) {
        const SensorType& kind = problem.kinds[choice.kind];
        kind.candidates->forEachRun(choice.candidate, [&](const CellRun& run) {
            steps[run.first] += kind.multiplicity;
            steps[run.end] -= kind.multiplicity;
        });
    }
    std::uint64_t value = 0;
    std::int64_t multiplicities = 0;
    for (std::size_t i = 0; i < problem.cells(); ++i) {
        multiplicities += steps[i];
        const std::int64_t achieved = problem.achieved.empty() ? 0 : problem.achieved[i];
        if (achieved + multiplicities >= problem.required) value += problem.weights[i];
    }
    return value;
}

double costOf(const Problem& problem, const std::vector<Choice>& chosen) {
    // Few sums, and few roundings, kind by kind.
    double cost = 0;
    for (std::size_t k = 0; k < problem.kinds.size(); ++k) {
        const auto count = std::count_if(chosen.begin(), chosen.end(),
                                         [k](const Choice& choice) { return choice.kind == k; });
        cost += static_cast<double>(count) * problem.kinds[k].cost;
    }
    return cost;
}

bool isWithinLimits(const Problem& problem, const std::vector<Choice>& chosen) {
    std::vector<int> counts(problem.kinds.size(), 0);
    for (const Choice& choice : chosen)
        if (++counts[choice.kind] > problem.kinds[choice.kind].most) return false;
    return !problem.budget || isAffordable(problem, costOf(problem, chosen));
}

bool isFeasible(const Problem& problem, const std::vector<Choice>& chosen) {
    return isWithinLimits(problem, chosen) &&
           (!problem.is_connected || isConnected(problem, chosen));
}

bool isCheaper(double cost, double than) {
    constexpr double kSlack = 1e-13;
    return cost < than * (1 - kSlack);
}

bool isAffordable(const Problem& problem, double cost) {
    return !problem.budget || !isCheaper(*problem.budget, cost);
}

std::size_t affordableCount(double budget, double spent, double cost, std::size_t most) {
    std::size_t least = 0;
    while (least < most) {
        const std::size_t middle = most - (most - least) / 2;
        if (isCheaper(budget, spent + static_cast<double>(middle) * cost))
            most = middle - 1;
        else
            least = middle;
    }
    return least;
}

double normaliseCost(double cost) {
    constexpr int kFewDigits = 12, kAllDigits = 17;
    for (int digits = kFewDigits; digits < kAllDigits; ++digits) {
        std::array<char, 32> text;
        const auto end = std::to_chars(text.data(), text.data() + text.size(), cost,
                                       std::chars_format::scientific, digits - 1)
                             .ptr;
        double rounded = cost;
        std::from_chars(text.data(), end, rounded);
        if (!isCheaper(rounded, cost) && !isCheaper(cost, rounded)) return rounded;
    }
    return cost;
}

bool isConnected(const Problem& problem, const std::vector<Choice>& chosen) {
    return Connection(problem, chosen).isWhole();
}

namespace {

/// Merges sets; the root of a set is its least member.
class UnionFind {
  public:
    explicit UnionFind(std::size_t count) : parents_(count) {
        std::iota(parents_.begin(), parents_.end(), std::size_t{0});
    }
    std::size_t rootOf(std::size_t i) {
        while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
        return i;
    }
    void join(std::size_t a, std::size_t b) {
        const auto [low, high] = std::minmax({rootOf(a), rootOf(b)});
        parents_[high] = low;
    }

  private:
    std::vector<std::size_t> parents_;
};

constexpr std::size_t kNoOwner = static_cast<std::size_t>(-1);

}  // namespace

Connection::Connection(const Problem& problem, const std::vector<Choice>& chosen)
    : problem_(&problem), part_of_cell_(problem.cells(), kNoOwner) {
    join(chosen.size(), [&](std::size_t i, const Visit& visit) {
        problem.kinds[chosen[i].kind].candidates->forEachRun(chosen[i].candidate, visit);
    });
}

Connection::Connection(const Problem& problem, std::span<const CellSet* const> views)
    : problem_(&problem), part_of_cell_(problem.cells(), kNoOwner) {
    join(views.size(), [&](std::size_t i, const Visit& visit) {
        views[i]->forEach([&](std::size_t cell) {
            const auto at = static_cast<std::uint32_t>(cell);
            visit({at, at + 1});
        });
    });
}

void Connection::join(std::size_t sensors,
                      const std::function<void(std::size_t, const Visit&)>& see) {
    // A cell is first owned by a sensor that sees it. Sensor i is member 1 + i. Member 0 stands for
    // the standing sensors; those of further regions follow the sensors.
    const Problem& problem = *problem_;
    const std::size_t regions =
        problem.regions.empty()
            ? 1
            : *std::max_element(problem.regions.begin(), problem.regions.end()) + std::size_t{1};
    UnionFind members(sensors + regions);
    std::vector<bool> is_member(sensors + regions, false);
    std::fill_n(is_member.begin() + 1, sensors, true);
    problem.standing.forEach([&](std::size_t cell) {
        if (problem.weights[cell] == 0) return;
        const std::size_t region = problem.regions.empty() ? 0 : problem.regions[cell];
        const std::size_t member = region == 0 ? 0 : sensors + region;
        part_of_cell_[cell] = member;
        is_member[member] = true;
    });
    for (std::size_t i = 0; i < sensors; ++i)
        see(i, [&](const CellRun& run) {
            for (std::uint32_t cell = run.first; cell < run.end; ++cell) {
                if (problem.weights[cell] == 0) continue;
                if (part_of_cell_[cell] == kNoOwner)
                    part_of_cell_[cell] = i + 1;
                else
                    members.join(part_of_cell_[cell], i + 1);
            }
        });
    std::vector<std::size_t> part_of_member(is_member.size(), kNoOwner);
    for (std::size_t i = 0; i < is_member.size(); ++i) {
        if (!is_member[i]) continue;
        std::size_t& part = part_of_member[members.rootOf(i)];
        if (part == kNoOwner) part = parts_++;
    }
    for (std::size_t& member : part_of_cell_)
        if (member != kNoOwner) member = part_of_member[members.rootOf(member)];
    if (regions == 1) return;
    parts_in_region_.resize(regions);
    std::vector<std::set<std::uint32_t>> regions_of(parts_);
    for (std::size_t cell = 0; cell < part_of_cell_.size(); ++cell)
        if (part_of_cell_[cell] != kNoOwner)
            regions_of[part_of_cell_[cell]].insert(problem.regions[cell]);
    for (const std::set<std::uint32_t>& of : regions_of) {
        regions_of_part_.emplace_back(of.begin(), of.end());
        for (const std::uint32_t region : of) ++parts_in_region_[region];
    }
}

bool Connection::isWhole() const {
    if (parts_ <= 1) return true;
    if (regions_of_part_.empty()) return false;
    return std::all_of(parts_in_region_.begin(), parts_in_region_.end(),
                       [](std::size_t parts) { return parts <= 1; }) &&
           std::none_of(regions_of_part_.begin(), regions_of_part_.end(),
                        [](const std::vector<std::uint32_t>& of) { return of.empty(); });
}

bool Connection::isJoinedBy(const Choice& choice) const {
    const std::size_t cells = part_of_cell_.size();
    if (parts_ > 0 && cells_of_part_.empty()) {
        std::vector<std::uint32_t> is_of(cells);
        cells_of_part_.reserve(parts_);
        for (std::size_t part = 0; part < parts_; ++part) {
            for (std::size_t i = 0; i < cells; ++i) is_of[i] = part_of_cell_[i] == part;
            cells_of_part_.emplace_back(is_of);
        }
        for (std::size_t region = 0; region < parts_in_region_.size(); ++region) {
            for (std::size_t i = 0; i < cells; ++i)
                is_of[i] = problem_->weights[i] > 0 && problem_->regions[i] == region;
            cells_of_region_.emplace_back(is_of);
        }
    }
    const CandidateSet& candidates = *problem_->kinds[choice.kind].candidates;
    const auto sees = [&](const WeightSums& of) {
        return candidates.weigh(choice.candidate, of) > 0;
    };
    if (parts_in_region_.empty())
        return std::all_of(cells_of_part_.begin(), cells_of_part_.end(), sees);
    std::vector<bool> sees_region(cells_of_region_.size());
    std::transform(cells_of_region_.begin(), cells_of_region_.end(), sees_region.begin(), sees);
    if (std::find(sees_region.begin(), sees_region.end(), true) == sees_region.end())
        return parts_ == 0;
    for (std::size_t part = 0; part < parts_; ++part) {
        if (sees(cells_of_part_[part])) continue;
        const std::vector<std::uint32_t>& of = regions_of_part_[part];
        const bool is_apart =
            !of.empty() && std::all_of(of.begin(), of.end(), [&](std::uint32_t r) {
                return !sees_region[r] && parts_in_region_[r] == 1;
            });
        if (!is_apart) return false;
    }
    return true;
}

namespace {

constexpr double kMaxUnits = 4e9;

/// Returns true if each is a whole number of units, and more than 0 if it is positive.
bool areWhole(const std::vector<double>& weights, double scale, double slack) {
    return std::all_of(weights.begin(), weights.end(), [scale, slack](double w) {
        const double units = std::round(w * scale);
        return std::abs(w * scale - units) < slack * scale && (units > 0 || w == 0);
    });
}

double scaleOf(const std::vector<double>& weights) {
    constexpr double kDecimals = 1e6, kDigits = 1e5;
    constexpr double kMaxScale = 1e300;  // for weights close to 0
    double sum = 0, largest = 0;
    for (const double w : weights) {
        sum += w;
        largest = std::max(largest, w);
    }
    if (largest == 0) return 1;
    if (sum > kMaxUnits) return kMaxUnits / sum;
    const double slack = 1e-9 * std::min(1.0, largest);
    double scale = 1;
    while ((scale < kDecimals || largest * scale < kDigits) && scale < kMaxScale &&
           sum * scale * 10 < kMaxUnits && !areWhole(weights, scale, slack))
        scale *= 10;
    return scale;
}

}  // namespace

std::vector<std::uint32_t> integerWeights(const std::vector<double>& weights) {
    const double scale = scaleOf(weights);
    std::vector<std::uint32_t> units;
    units.reserve(weights.size());
    for (const double w : weights)
        units.push_back(
            w == 0 ? 0U : static_cast<std::uint32_t>(std::max(1LL, std::llround(w * scale))));
    return units;
}

namespace {

constexpr std::size_t kMaxLevels = 4'000;

}  // namespace

CostLevels::CostLevels(const std::vector<SensorType>& kinds, double most) {
    for (const SensorType& kind : kinds) {
        // 1, 2, 4, ... and the rest: they make up any number, and equal sums never pile up.
        auto left =
            std::min(static_cast<std::size_t>(std::max(kind.most, 0)), kind.candidates->size());
        for (std::size_t count = 1; left > 0; count *= 2) {
            count = std::min(count, left);
            left -= count;
            mayAdd(count, kind.cost, most);
            if (levels_.size() > kMaxLevels) {
                setEven(most);
                return;
            }
        }
    }
}

void CostLevels::mayAdd(std::size_t count, double cost, double most) {
    const double more = static_cast<double>(count) * cost;
    std::vector<Level> dearer;
    dearer.reserve(levels_.size());
    for (const Level& level : levels_) {
        if (isCheaper(most, level.least + more)) break;
        dearer.push_back({level.least + more, level.most + more});
    }
    std::vector<Level> both;
    both.reserve(levels_.size() + dearer.size());
    std::merge(levels_.begin(), levels_.end(), dearer.begin(), dearer.end(),
               std::back_inserter(both),
               [](const Level& a, const Level& b) { return a.least < b.least; });
    levels_.clear();
    for (const Level& level : both) {
        if (levels_.empty() || isCheaper(levels_.back().most, level.least))
            levels_.push_back(level);
        else
            levels_.back().most = std::max(levels_.back().most, level.most);
    }
}

void CostLevels::setEven(double most) {
    is_even_ = true;
    const double unit = std::pow(10, std::floor(std::log10(most)) - 5);
    levels_.resize(kMaxLevels + 1);
    for (std::size_t i = 0; i < levels_.size(); ++i) {
        const double multiplicity = static_cast<double>(i) / static_cast<double>(kMaxLevels);
        const double cost = normaliseCost(std::floor(most * multiplicity / unit) * unit);
        levels_[i] = {cost, cost};
    }
}

std::size_t CostLevels::below(double cost) const {
    const auto end =
        std::partition_point(levels_.begin() + 1, levels_.end(),
                             [cost](const Level& level) { return isCheaper(level.most, cost); });
    return static_cast<std::size_t>(end - levels_.begin()) - 1;
}

double CostLevels::above(std::size_t i) const {
    if (is_even_) return levels_[i].most;
    if (i + 1 < levels_.size()) return levels_[i + 1].least;
    return std::numeric_limits<double>::infinity();
}

namespace {

/// Writes one problem. Lines are collected in one string, as there are many.
class MpsWriter {
  public:
    MpsWriter(const Problem& problem, const std::vector<std::string>& kinds, std::ostream& out)
        : problem_(problem), names_(kinds), out_(out), lacks_(problem.cells(), 0) {
        std::vector<char> is_seen(problem.cells(), 0);
        for (const SensorType& kind : problem.kinds)
            for (std::size_t i = 0; i < kind.candidates->size(); ++i)
                kind.candidates->forEachRun(i, [&is_seen](const CellRun& run) {
                    std::fill(is_seen.begin() + run.first, is_seen.begin() + run.end, char{1});
                });
        for (std::size_t cell = 0; cell < lacks_.size(); ++cell) {
            const int achieved = problem.achieved.empty() ? 0 : problem.achieved[cell];
            if (achieved >= problem.required)
                achieved_already_ += problem.weights[cell];
            else if (is_seen[cell] != 0 && problem.weights[cell] > 0)
                lacks_[cell] = problem.required - achieved;
        }
    }
    void write(const std::string& legend,
               const std::function<std::string(const Choice&)>& describe) {
        writeComments(legend, describe);
        writeRows();
        line({"COLUMNS"});
        line({"    MARKER 'MARKER' 'INTORG'"});
        for (std::size_t k = 0; k < names_.size(); ++k)
            for (std::size_t i = 0; i < problem_.kinds[k].candidates->size(); ++i)
                writeSensor(k, i);
        if (problem_.required == 1) line({"    MARKER 'MARKER' 'INTEND'"});
        writeCells();
        if (problem_.required != 1) line({"    MARKER 'MARKER' 'INTEND'"});
        writeLimits();
        line({"ENDATA"});
        flush();
    }

  private:
    void line(std::initializer_list<std::string_view> parts) {
        for (const std::string_view part : parts) text_ += part;
        text_ += '\n';
        if (text_.size() > 1U << 16U) flush();
    }
    void flush() {
        out_ << text_;
        text_.clear();
    }
    [[nodiscard]] std::string nameOf(std::size_t kind, std::size_t candidate) const {
        std::string name = "x_";
        name += names_[kind];
        name += '_';
        name += std::to_string(candidate);
        return name;
    }
    void writeComments(const std::string& legend,
                       const std::function<std::string(const Choice&)>& describe);
    void writeRows();
    void writeSensor(std::size_t kind, std::size_t candidate);
    void writeCells();
    void writeLimits();

    const Problem& problem_;
    const std::vector<std::string>& names_;
    std::ostream& out_;
    std::string text_;
    std::vector<int> lacks_;  ///< multiplicity still required of each cell; 0: skipped
    std::uint64_t achieved_already_ = 0;
};

void MpsWriter::writeComments(const std::string& legend,
                              const std::function<std::string(const Choice&)>& describe) {
    line(
        {"* Where sensors see most. y_CELL is 1 if the cell is covered, x_KIND_INDEX if a sensor"});
    line({"* stands there. The objective is to be minimised: the value is ",
          std::to_string(achieved_already_), " minus the objective."});
    line({"* The weights of all cells together: ", std::to_string(problem_.totalWeight())});
    if (problem_.is_connected)
        line({"* That the views hang together is not part of this model: its value is a bound."});
    line({"* Candidate: ", legend});
    for (std::size_t k = 0; k < names_.size(); ++k)
        for (std::size_t i = 0; i < problem_.kinds[k].candidates->size(); ++i)
            line({"* ", nameOf(k, i), ": ", describe({k, i})});
}

void MpsWriter::writeRows() {
    line({"NAME coverage"});
    line({"ROWS"});
    line({" N minus_value"});
    for (std::size_t cell = 0; cell < lacks_.size(); ++cell)
        if (lacks_[cell] > 0) line({" L cell_", std::to_string(cell)});
    for (const std::string& name : names_) line({" L most_", name});
    if (problem_.budget) line({" L budget"});
}

/// Coefficients are clipped to the need of the cell: the same integer solutions, a tighter model.
void MpsWriter::writeSensor(std::size_t kind, std::size_t candidate) {
    const SensorType& own = problem_.kinds[kind];
    const std::string name = nameOf(kind, candidate);
    line({"    ", name, " most_", names_[kind], " 1"});
    if (problem_.budget) line({"    ", name, " budget ", formatDouble(own.cost)});
    own.candidates->forEachRun(candidate, [&](const CellRun& run) {
        for (std::uint32_t cell = run.first; cell < run.end; ++cell)
            if (lacks_[cell] > 0)
                line({"    ", name, " cell_", std::to_string(cell), " -",
                      std::to_string(std::min(own.multiplicity, lacks_[cell]))});
    });
}

void MpsWriter::writeCells() {
    for (std::size_t cell = 0; cell < lacks_.size(); ++cell) {
        if (lacks_[cell] == 0) continue;
        const std::string number = std::to_string(cell);
        line({"    y_", number, " minus_value -", std::to_string(problem_.weights[cell])});
        line({"    y_", number, " cell_", number, " ", std::to_string(lacks_[cell])});
    }
}

void MpsWriter::writeLimits() {
    line({"RHS"});
    for (std::size_t k = 0; k < names_.size(); ++k)
        line(
            {"    RHS most_", names_[k], " ", std::to_string(std::max(problem_.kinds[k].most, 0))});
    if (problem_.budget) line({"    RHS budget ", formatDouble(*problem_.budget)});
    line({"BOUNDS"});
    for (std::size_t k = 0; k < names_.size(); ++k)
        for (std::size_t i = 0; i < problem_.kinds[k].candidates->size(); ++i)
            line({" UP BOUND ", nameOf(k, i), " 1"});
    for (std::size_t cell = 0; cell < lacks_.size(); ++cell)
        if (lacks_[cell] > 0) line({" UP BOUND y_", std::to_string(cell), " 1"});
}

}  // namespace

void writeMps(const Problem& problem, const std::vector<std::string>& kinds,
              const std::string& legend, const std::function<std::string(const Choice&)>& describe,
              std::ostream& out) {
    assert(kinds.size() == problem.kinds.size());
    MpsWriter(problem, kinds, out).write(legend, describe);
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Proofs of bounds of guards by weights of witnesses.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "extensions/proofs/gallery/gallery.h"
#include "extensions/proofs/gallery/guard_certificate.h"

namespace ispace::proofs {

namespace {

using GuardRows = std::vector<std::uint32_t>;  // ascending

using GuardBits = std::vector<std::uint64_t>;

/// Returns which of some lists hold each number below `count`.
std::vector<GuardBits> transposed(const std::vector<GuardRows>& lists, std::size_t count) {
    std::vector<GuardBits> bits(count, GuardBits(lists.size() / 64 + 1));
    for (std::size_t i = 0; i < lists.size(); ++i)
        for (const std::uint32_t number : lists[i])
            bits[number][i / 64] |= std::uint64_t{1} << (i % 64);
    return bits;
}

bool isWithin(const GuardBits& a, const GuardBits& b) {
    for (std::size_t i = 0; i < a.size(); ++i)
        if ((a[i] & ~b[i]) != 0) return false;
    return true;
}

/// Marks those of `rows` that are in all sets in which another one is, the first one of equals
/// excepted: a guard of that one is theirs, too.
std::vector<char> implied(const std::vector<GuardBits>& sets_of) {
    std::vector<char> is_implied(sets_of.size());
    std::vector<std::size_t> counts;
    for (const GuardBits& bits : sets_of) {
        std::size_t count = 0;
        for (const std::uint64_t word : bits)
            count += static_cast<std::size_t>(std::popcount(word));
        counts.push_back(count);
    }
    for (std::size_t a = 0; a < sets_of.size(); ++a)
        for (std::size_t b = 0; b < sets_of.size() && is_implied[a] == 0; ++b)
            if (a != b && counts[b] > 0 && counts[b] <= counts[a] && is_implied[b] == 0 &&
                (counts[b] < counts[a] || b < a) && isWithin(sets_of[b], sets_of[a]))
                is_implied[a] = 1;
    return is_implied;
}

/// Greatest sum of weights of rows of which no set holds more than one unit, by the simplex method.
///
/// A dense tableau: a row for each set, a column for each row of the cover that is not basic. Right
/// sides differ a little, so that no step is degenerate.
class Packing {
  public:
    Packing(const std::vector<GuardRows>& sets, std::size_t rows);

    void solve();
    /// Weights of rows, at least 0. Sums may exceed 1 by the differences and by rounding.
    [[nodiscard]] std::vector<double> weights() const;
    /// Values of sets, a fractional cover.
    [[nodiscard]] std::vector<double> cover() const;

  private:
    void pivot(std::size_t row, std::size_t column);

    std::size_t sets_, rows_, width_;
    std::vector<double> table_;                // of a row: columns, right side; last row: objective
    std::vector<std::uint32_t> basic_, free_;  // rows first, then slacks of sets
};

Packing::Packing(const std::vector<GuardRows>& sets, std::size_t rows)
    : sets_(sets.size()), rows_(rows), width_(rows + 1), table_((sets.size() + 1) * (rows + 1)) {
    constexpr double kDifference = 1e-8;
    for (std::size_t i = 0; i < sets_; ++i) {
        for (const std::uint32_t row : sets[i]) table_[i * width_ + row] = 1;
        const auto mixed = static_cast<std::uint32_t>(i * 2654435761U);
        table_[i * width_ + rows_] =
            1 + kDifference * (1 + static_cast<double>(mixed >> 12U) / 1e6);
        basic_.push_back(static_cast<std::uint32_t>(rows_ + i));
    }
    for (std::size_t k = 0; k < rows_; ++k) {
        table_[sets_ * width_ + k] = -1;
        free_.push_back(static_cast<std::uint32_t>(k));
    }
}

void Packing::pivot(std::size_t row, std::size_t column) {
    double* const own = &table_[row * width_];
    const double factor = 1 / own[column];
    for (std::size_t k = 0; k < width_; ++k) own[k] *= factor;
    own[column] = factor;
    for (std::size_t i = 0; i <= sets_; ++i) {
        double* const other = &table_[i * width_];
        const double times = other[column];
        if (i == row || times == 0) continue;
        other[column] = 0;
        for (std::size_t k = 0; k < width_; ++k) other[k] -= times * own[k];
    }
    std::swap(basic_[row], free_[column]);
}

void Packing::solve() {
    constexpr double kZero = 1e-9;
    constexpr int kMaxPivots = 20'000;
    for (int count = 0; count < kMaxPivots; ++count) {
        const double* const costs = &table_[sets_ * width_];
        const double* const best = std::min_element(costs, costs + rows_);
        if (best == costs + rows_ || *best > -kZero) return;
        const auto column = static_cast<std::size_t>(best - costs);
        double least = std::numeric_limits<double>::infinity();
        std::size_t row = sets_;
        for (std::size_t i = 0; i < sets_; ++i) {
            const double slope = table_[i * width_ + column];
            if (slope <= kZero) continue;
            const double step = table_[i * width_ + rows_] / slope;
            if (step >= least) continue;
            least = step;
            row = i;
        }
        if (row == sets_) return;  // a row in no set
        pivot(row, column);
    }
}

std::vector<double> Packing::weights() const {
    std::vector<double> all(rows_);
    for (std::size_t i = 0; i < sets_; ++i)
        if (basic_[i] < rows_) all[basic_[i]] = std::max(0.0, table_[i * width_ + rows_]);
    return all;
}

std::vector<double> Packing::cover() const {
    std::vector<double> all(sets_);
    for (std::size_t k = 0; k < rows_; ++k)
        if (free_[k] >= rows_) all[free_[k] - rows_] = table_[sets_ * width_ + k];
    return all;
}

bool holds(const GuardRows& set, std::uint32_t row) {
    return std::binary_search(set.begin(), set.end(), row);
}

/// Removes subsets of other sets and rows that others imply, in turn.
void reduceSets(std::vector<GuardRows>& sets, std::size_t rows) {
    for (std::size_t before = 0; before != sets.size();) {
        before = sets.size();
        const std::vector<char> is_left_out = implied(transposed(sets, rows));
        for (GuardRows& set : sets)
            std::erase_if(set, [&](std::uint32_t row) { return is_left_out[row] != 0; });
        std::sort(sets.begin(), sets.end());
        sets.erase(std::unique(sets.begin(), sets.end()), sets.end());
        std::vector<GuardRows> kept;
        std::vector<GuardBits> rows_of(sets.size());
        for (std::size_t i = 0; i < sets.size(); ++i) {
            rows_of[i].resize(rows / 64 + 1);
            for (const std::uint32_t row : sets[i])
                rows_of[i][row / 64] |= std::uint64_t{1} << (row % 64);
        }
        for (std::size_t i = 0; i < sets.size(); ++i) {
            bool is_subset = sets[i].empty();
            for (std::size_t k = 0; k < sets.size() && !is_subset; ++k)
                is_subset = sets[i].size() < sets[k].size() && isWithin(rows_of[i], rows_of[k]);
            if (!is_subset) kept.push_back(sets[i]);
        }
        sets = std::move(kept);
    }
}

/// Lists the rows that are in a set.
GuardRows rowsOf(const std::vector<GuardRows>& sets) {
    GuardRows rows;
    for (const GuardRows& set : sets) rows.insert(rows.end(), set.begin(), set.end());
    std::sort(rows.begin(), rows.end());
    rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    return rows;
}

/// Replaces rows by their positions in a list.
std::vector<GuardRows> renumbered(std::vector<GuardRows> sets, const GuardRows& rows) {
    for (GuardRows& set : sets)
        for (std::uint32_t& row : set)
            row = static_cast<std::uint32_t>(std::lower_bound(rows.begin(), rows.end(), row) -
                                             rows.begin());
    return sets;
}

/// Divides sets into groups without common rows.
std::vector<std::vector<GuardRows>> groupsOf(const std::vector<GuardRows>& sets, std::size_t rows) {
    std::vector<std::uint32_t> root(rows);
    std::iota(root.begin(), root.end(), 0U);
    const auto root_of = [&root](std::uint32_t row) {
        while (root[row] != row) row = root[row] = root[root[row]];
        return row;
    };
    for (const GuardRows& set : sets)
        for (const std::uint32_t row : set) root[root_of(row)] = root_of(set.front());
    std::map<std::uint32_t, std::vector<GuardRows>> groups;
    for (const GuardRows& set : sets) groups[root_of(set.front())].push_back(set);
    std::vector<std::vector<GuardRows>> all;
    all.reserve(groups.size());
    for (auto& [first, group] : groups) all.push_back(std::move(group));
    return all;
}

/// Builds a tree that proves a number of guards, or a smaller one.
class GuardProof {
  public:
    /// \param wanted 0: as many as a single leaf proves
    GuardProof(std::vector<GuardRows> sets, std::size_t witnesses, std::size_t wanted)
        : wanted_(wanted), proven_(wanted), witnesses_(witnesses) {
        prove(std::move(sets), witnesses_, 0);
    }
    [[nodiscard]] std::size_t proven() const { return proven_; }
    GuardCertificate::Tree take() { return std::move(tree_); }

  private:
    static constexpr std::size_t kMaxNodes = 2000;
    static constexpr int kMaxDepth = 30;

    void prove(std::vector<GuardRows> sets, std::size_t rows, int depth);
    /// Selects the pair of witnesses that the fractional cover sees together by about a half; two
    /// equal ones: none.
    [[nodiscard]] std::array<std::uint32_t, 2> pairOf(const std::vector<GuardRows>& sets,
                                                      const std::vector<double>& cover) const;

    std::size_t wanted_, proven_, witnesses_;
    GuardCertificate::Tree tree_;
};

std::array<std::uint32_t, 2> GuardProof::pairOf(const std::vector<GuardRows>& sets,
                                                const std::vector<double>& cover) const {
    constexpr double kWhole = 1e-6;
    std::vector<double> together(witnesses_ * witnesses_);
    for (std::size_t i = 0; i < sets.size(); ++i) {
        if (cover[i] < kWhole) continue;
        for (const std::uint32_t a : sets[i])
            for (const std::uint32_t b : sets[i])
                if (a < b && b < witnesses_) together[a * witnesses_ + b] += cover[i];
    }
    std::array<std::uint32_t, 2> best{};
    double least = 0.5 - kWhole;
    for (std::uint32_t a = 0; a < witnesses_; ++a)
        for (std::uint32_t b = a + 1; b < witnesses_; ++b) {
            const double off = std::abs(together[a * witnesses_ + b] - 0.5);
            if (off >= least) continue;
            least = off;
            best = {a, b};
        }
    return best;
}

/// A leaf packs weights on witnesses so that no set holds more than a unit, rounded down to whole
/// parts: the guards are at least the total, rounded up. A node branches on a pair of witnesses:
/// either one guard sees both, which is a new row of these sets, or none does, which splits them.
void GuardProof::prove(std::vector<GuardRows> sets, std::size_t rows, int depth) {
    constexpr std::int64_t kUnit = GuardCertificate::kUnit;
    reduceSets(sets, rows);
    const GuardRows active = rowsOf(sets);
    Packing packing(renumbered(sets, active), active.size());
    packing.solve();
    std::vector<double> solution(rows);
    const std::vector<double> own = packing.weights();
    for (std::size_t i = 0; i < active.size(); ++i) solution[active[i]] = own[i];
    std::vector<std::int64_t> weights(rows);
    double most = 1;
    for (const GuardRows& set : sets) {
        double sum = 0;
        for (const std::uint32_t row : set) sum += solution[row];
        most = std::max(most, sum);
    }
    std::int64_t total = 0;
    for (std::size_t row = 0; row < rows; ++row) {
        const double share = std::min(solution[row] / most, 1.0);
        weights[row] = static_cast<std::int64_t>(share * static_cast<double>(kUnit));
        total += weights[row];
    }
    const auto proven = static_cast<std::size_t>((total + kUnit - 1) / kUnit);
    const auto pair =
        proven < wanted_ && wanted_ == proven_ && depth < kMaxDepth && tree_.size() < kMaxNodes
            ? pairOf(sets, packing.cover())
            : std::array<std::uint32_t, 2>{};
    GuardCertificate::Node& node = tree_.emplace_back();
    if (pair[0] == pair[1]) {
        proven_ = wanted_ == 0 ? proven : std::min(proven_, proven);
        for (std::uint32_t row = 0; row < rows; ++row)
            if (weights[row] > 0) node.weights.emplace_back(row, weights[row]);
        return;
    }
    node.is_leaf = false;
    node.pair = pair;
    std::vector<GuardRows> together = sets, apart;
    for (GuardRows& set : together)
        if (holds(set, pair[0]) && holds(set, pair[1]))
            set.push_back(static_cast<std::uint32_t>(rows));
    prove(std::move(together), rows + 1, depth + 1);
    for (const GuardRows& set : sets) {
        if (!holds(set, pair[0]) || !holds(set, pair[1])) {
            apart.push_back(set);
            continue;
        }
        for (const std::uint32_t left_out : pair) {
            apart.push_back(set);
            std::erase(apart.back(), left_out);
        }
    }
    prove(std::move(apart), rows, depth + 1);
}

/// A group of sets and a tree for it.
struct ProvenGroup {
    std::vector<GuardRows> sets;
    std::size_t proven = 0;
    GuardCertificate::Tree tree = {};
    bool is_best = false;
};

/// Tries to prove one guard more.
void raise(ProvenGroup& group, std::size_t witnesses) {
    GuardProof proof(group.sets, witnesses, group.proven + 1);
    group.is_best = proof.proven() <= group.proven;
    if (group.is_best) return;
    group.proven = proof.proven();
    group.tree = proof.take();
}

}  // namespace

GuardCertificate certifyGuards(const GalleryCover& cover) {
    GuardCertificate certificate{cover.bound, cover.witnesses, {}};
    const std::size_t witnesses = cover.witnesses.size();
    std::vector<GuardRows> sets = cover.sets;
    reduceSets(sets, witnesses);
    std::vector<ProvenGroup> groups;
    std::size_t sum = 0;
    for (std::vector<GuardRows>& group : groupsOf(sets, witnesses)) {
        // A group that needs no branching ends by one leaf.
        GuardProof root(group, witnesses, 0);
        groups.push_back({std::move(group), root.proven(), root.take()});
        sum += groups.back().proven;
    }
    for (ProvenGroup& group : groups)
        while (sum < cover.bound && !group.is_best) {
            sum -= group.proven;
            raise(group, witnesses);
            sum += group.proven;
        }
    certificate.bound = std::min(sum, cover.bound);
    for (ProvenGroup& group : groups) certificate.trees.push_back(std::move(group.tree));
    return certificate;
}

}  // namespace ispace::proofs

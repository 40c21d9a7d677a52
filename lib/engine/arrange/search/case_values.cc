// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/search/case_values.h"

#include <algorithm>
#include <set>
#include <utility>

namespace ispace {

namespace {

std::vector<Choice> withoutRepeats(const std::vector<Choice>& chosen) {
    std::vector<Choice> once;
    std::set<Choice> taken;
    for (const Choice& choice : chosen)
        if (taken.insert(choice).second) once.push_back(choice);
    return once;
}

/// Calls visit(subset) for each subset of `size` of 0 ... count - 1, ascending, in lexicographic
/// order.
template <typename Visit>
void forEachSubset(std::size_t count, std::size_t size, Visit visit) {
    std::vector<std::size_t> subset(size);
    for (std::size_t i = 0; i < size; ++i) subset[i] = i;
    while (true) {
        visit(subset);
        std::size_t i = size;
        while (i > 0 && subset[i - 1] == count - size + i - 1) --i;
        if (i == 0) return;
        ++subset[i - 1];
        for (; i < size; ++i) subset[i] = subset[i - 1] + 1;
    }
}

/// Calls visit(members) for each subset of a set, as ascending numbers; not for the empty one.
template <typename Visit>
void forEachPart(const std::vector<std::size_t>& set, Visit visit) {
    std::vector<std::uint32_t> members;
    for (std::size_t bits = 1; bits < std::size_t{1} << set.size(); ++bits) {
        members.clear();
        for (std::size_t i = 0; i < set.size(); ++i)
            if ((bits >> i) & 1U) members.push_back(static_cast<std::uint32_t>(set[i]));
        visit(members);
    }
}

}  // namespace

CaseValues::CaseValues(const WorstCaseProblem& of, const std::vector<Choice>& chosen) : of_(&of) {
    countStanding();
    const Problem& problem = *of.problem;
    for (const Choice& choice : withoutRepeats(chosen)) {
        const SensorType& kind = problem.kinds[choice.kind];
        const auto added = static_cast<std::uint32_t>(of.failures > 0 ? 1 : kind.multiplicity);
        kind.candidates->forEachRun(choice.candidate, [&](const CellRun& run) {
            for (std::uint32_t i = run.first; i < run.end; ++i) counts_[i] += added;
        });
        if (of.failures > 0) views_.push_back(kind.candidates->cellsOf(choice.candidate));
    }
    countBlocks();
}

CaseValues::CaseValues(const WorstCaseProblem& of, std::span<const SensorCells> sensors)
    : of_(&of) {
    countStanding();
    for (const SensorCells& sensor : sensors) {
        const auto added = static_cast<std::uint32_t>(of.failures > 0 ? 1 : sensor.multiplicity);
        sensor.cells->forEach([&](std::size_t cell) { counts_[cell] += added; });
        if (of.failures > 0) views_.push_back(*sensor.cells);
    }
    countBlocks();
}

void CaseValues::countStanding() {
    const Problem& problem = *of_->problem;
    counts_.resize(problem.cells());
    for (std::size_t b = 0; b < of_->blocks.size(); ++b) totals_.push_back(of_->totalOf(b));
    if (of_->failures > 0) {
        views_ = of_->standing;
        for (const CellSet& view : views_) view.forEach([&](std::size_t cell) { ++counts_[cell]; });
    } else if (!problem.achieved.empty()) {
        counts_.assign(problem.achieved.begin(), problem.achieved.end());
    }
}

std::uint32_t CaseValues::required() const {
    return static_cast<std::uint32_t>(of_->failures > 0 ? 1 : of_->problem->required);
}

void CaseValues::countBlocks() {
    if (of_->ways != nullptr) return;
    const Problem& problem = *of_->problem;
    values_.resize(of_->blocks.size());
    for (std::size_t b = 0; b < of_->blocks.size(); ++b)
        for (std::size_t i = of_->blocks[b].first; i < of_->blocks[b].end; ++i)
            if (counts_[i] >= required()) values_[b] += problem.weights[i];
    if (of_->failures > 0) collectShared();
}

std::vector<std::uint32_t> CaseValues::sensorsAt(std::size_t cell) const {
    std::vector<std::uint32_t> sensors;
    for (std::size_t i = 0; i < views_.size(); ++i)
        if (views_[i].test(cell)) sensors.push_back(static_cast<std::uint32_t>(i));
    return sensors;
}

void CaseValues::collectShared() {
    const auto most = static_cast<std::uint32_t>(of_->failures);
    const CellBlock& block = of_->blocks.front();
    for (std::size_t i = block.first; i < block.end; ++i)
        if (counts_[i] > 0 && counts_[i] <= most && of_->problem->weights[i] > 0)
            shared_[sensorsAt(i)] += of_->problem->weights[i];
}

std::uint64_t CaseValues::scaled(std::size_t block, std::uint64_t value) const {
    return block == 0 || totals_[block] == 0 ? value : value * totals_[0] / totals_[block];
}

std::vector<std::uint64_t> CaseValues::ofBlocks() const {
    std::vector<std::uint64_t> values;
    if (of_->ways != nullptr) return {worst().value};
    for (std::size_t b = 0; b < values_.size(); ++b) values.push_back(scaled(b, values_[b]));
    return values;
}

std::uint64_t CaseValues::lostWithout(const std::vector<std::size_t>& failed) const {
    std::uint64_t lost = 0;
    forEachPart(failed, [&](const std::vector<std::uint32_t>& sensors) {
        if (const auto at = shared_.find(sensors); at != shared_.end()) lost += at->second;
    });
    return lost;
}

std::uint64_t CaseValues::valueIn(const CaseValue& of) const {
    if (of_->ways == nullptr) return values_[of.block] - lostWithout(of.failed);
    std::uint64_t seen = 0;
    for (const PathCell& piece : of.way)
        if (counts_[piece.cell] >= required()) seen += piece.length;
    return seen;
}

CaseValue CaseValues::worst() const { return worstOf(static_cast<std::size_t>(of_->failures)); }

CaseValue CaseValues::worstOf(std::size_t failures) const {
    if (of_->ways != nullptr) {
        CellPath way = of_->ways->leastSeen(
            [this, least = required()](std::uint32_t cell) { return counts_[cell] >= least; });
        return {0, {}, way.seen, std::move(way.cells)};
    }
    CaseValue worst{0, {}, values_[0]};
    for (std::size_t b = 1; b < values_.size(); ++b)
        if (const std::uint64_t value = scaled(b, values_[b]); value < worst.value)
            worst = {b, {}, value};
    if (failures == 0) return worst;
    std::uint64_t most = 0;
    bool is_first = true;
    forEachSubset(views_.size(), std::min(failures, views_.size()),
                  [&](const std::vector<std::size_t>& failed) {
                      const std::uint64_t lost = lostWithout(failed);
                      if (!is_first && lost <= most) return;
                      is_first = false;
                      most = lost;
                      worst.failed = failed;
                  });
    worst.value = values_[0] - most;
    return worst;
}

void CaseValues::gains(const CaseValue& in, std::size_t kind,
                       std::vector<std::uint32_t>& gains) const {
    const Problem& problem = *of_->problem;
    const bool fails = of_->failures > 0;
    const std::uint32_t least = required();
    const auto added = static_cast<std::uint32_t>(fails ? 1 : problem.kinds[kind].multiplicity);
    gains.assign(problem.cells(), 0);
    for (const PathCell& piece : in.way)
        if (counts_[piece.cell] < least && counts_[piece.cell] + added >= least)
            gains[piece.cell] = piece.length;
    if (of_->ways != nullptr) return;
    for (std::size_t i = of_->blocks[in.block].first; i < of_->blocks[in.block].end; ++i) {
        std::uint32_t count = counts_[i];
        if (count > 0)
            for (const std::size_t failed : in.failed) count -= views_[failed].test(i) ? 1 : 0;
        if (count < least && count + added >= least) gains[i] = problem.weights[i];
    }
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/connection.h"

#include <numeric>
#include <utility>

namespace ispace {

namespace {

/// Joins sets; the root of a set is its least member.
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

constexpr std::size_t kNobody = static_cast<std::size_t>(-1);

}  // namespace

Connection::Connection(const Problem& problem, const std::vector<Choice>& chosen)
    : problem_(&problem), part_of_cell_(problem.cells(), kNobody) {
    // Member 0 are those that stand, member 1 + i is choice i; at first a cell's is who sees it.
    UnionFind members(chosen.size() + 1);
    bool has_standing = false;
    problem.standing.forEach([&](std::size_t cell) {
        if (problem.weights[cell] == 0) return;
        part_of_cell_[cell] = 0;
        has_standing = true;
    });
    for (std::size_t i = 0; i < chosen.size(); ++i) {
        const auto see = [&](const CellRun& run) {
            for (std::uint32_t cell = run.first; cell < run.end; ++cell) {
                if (problem.weights[cell] == 0) continue;
                if (part_of_cell_[cell] == kNobody)
                    part_of_cell_[cell] = i + 1;
                else
                    members.join(part_of_cell_[cell], i + 1);
            }
        };
        problem.kinds[chosen[i].kind].candidates->forEachRun(chosen[i].candidate, see);
    }
    std::vector<std::size_t> part_of_member(chosen.size() + 1, kNobody);
    for (std::size_t i = has_standing ? 0 : 1; i <= chosen.size(); ++i) {
        std::size_t& part = part_of_member[members.rootOf(i)];
        if (part == kNobody) part = parts_++;
    }
    for (std::size_t& member : part_of_cell_)
        if (member != kNobody) member = part_of_member[members.rootOf(member)];
}

bool Connection::isJoinedBy(const Choice& choice) const {
    if (parts_ > 0 && cells_of_part_.empty()) {
        std::vector<std::uint32_t> is_of(part_of_cell_.size());
        cells_of_part_.reserve(parts_);
        for (std::size_t part = 0; part < parts_; ++part) {
            for (std::size_t i = 0; i < is_of.size(); ++i) is_of[i] = part_of_cell_[i] == part;
            cells_of_part_.emplace_back(is_of);
        }
    }
    const CandidateSet& candidates = *problem_->kinds[choice.kind].candidates;
    for (const CellPrices& cells : cells_of_part_)
        if (candidates.price(choice.candidate, cells) == 0) return false;
    return true;
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <cstdint>
#include <vector>

#include "solve/branch_node.h"

namespace ispace {

/// What is left of a group of a node.
struct OpenGroup {
    std::size_t kind = 0;
    std::size_t count = 0;
    std::vector<std::uint32_t> list;  ///< candidates of the reduced problem, ascending
};

/// The Lagrangian relaxation of a node of the search tree: from each group its best candidates.
class NodeRelaxation {
  public:
    explicit NodeRelaxation(const BranchNode& node);

    /// The cells with what the fixed sensors leave of them.
    [[nodiscard]] const ReducedProblem& problem() const { return problem_; }
    [[nodiscard]] const std::vector<OpenGroup>& groups() const { return groups_; }
    /// Cut to the weights that are left.
    [[nodiscard]] std::vector<std::uint32_t> start(const BranchNode& node) const;

    /// The bound for these multipliers; sets what the others tell.
    std::uint64_t evaluate(const std::vector<std::uint32_t>& multipliers);
    [[nodiscard]] const std::vector<float>& cover() const { return cover_; }
    /// The best of all groups, as named in the reduced problem.
    [[nodiscard]] std::vector<Choice> chosen() const;
    /// Reduced-cost fixing: drops candidates that are in no solution better than `cut`.
    void ruleOut(std::uint64_t cut);
    /// Candidates that are in every solution better than `cut`, as named in the reduced problem;
    /// their groups have one to choose less.
    std::vector<Choice> takeForced(std::uint64_t cut);
    /// Upper bound of the solutions that the two have excluded, at most their cut.
    [[nodiscard]] std::uint64_t ruledOut() const { return ruled_out_; }

    /// Updates the running frequency with which each candidate is chosen.
    void count(float part);
    [[nodiscard]] const std::vector<std::vector<float>>& shares() const { return shares_; }
    /// By how much what the candidates of a group see is what this one sees: 1 for itself, in
    /// multipliers given (not all 0). Overwrites the reduced costs: call evaluate() before anything
    /// but shares().
    [[nodiscard]] std::vector<float> likeness(std::size_t group, std::uint32_t pivot,
                                              const std::vector<std::uint32_t>& multipliers);

  private:
    void settle(const std::vector<Choice>& chosen);
    void findSites();
    void weigh(const std::vector<std::uint32_t>& multipliers);
    void setCover();

    ReducedProblem problem_;
    std::vector<OpenGroup> groups_;
    std::vector<std::vector<std::uint32_t>> sites_;          // per kind, to be priced
    std::vector<std::vector<std::uint32_t>> reduced_costs_;  // per kind and candidate
    std::vector<std::vector<std::uint32_t>> top_;  // per group: the best, one more than wanted
    std::vector<std::vector<float>> shares_;       // per group, beside its list
    std::vector<std::uint32_t> cell_costs_;
    std::vector<float> cover_;
    std::uint64_t bound_ = 0, ruled_out_ = 0;
};

}  // namespace ispace

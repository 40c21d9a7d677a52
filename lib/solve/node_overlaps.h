// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/solve only.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/cell_set.h"
#include "base/progress.h"
#include "solve/branch_node.h"
#include "solve/seen_runs.h"

namespace ispace {

/// A relaxation of a node that lies below the linear program, as it knows what sensors both see.
///
/// Each group has one sensor, and a spanning tree joins those that see most of the same. What two
/// joined ones both see is taken off: of c sensors that see a cell at most c - 1 pairs are edges of
/// a tree, so it still counts at least once (Hunter 1976). The best choice for given multipliers is
/// found exactly, from the leaves of the tree to its root, and back again what a solution with each
/// candidate is worth at most.
///
/// Integer arithmetic: bounds are exact.
class NodeOverlaps {
  public:
    /// True if each group has one sensor, which covers what it sees of all cells, and there are not
    /// too many candidates.
    static bool isFor(const NodeRelaxation& relaxed);

    /// \param relaxed with the frequencies of a search for these multipliers
    NodeOverlaps(const NodeRelaxation& relaxed, const std::vector<std::uint32_t>& multipliers);

    /// Upper bound of the node, fine, or of its solutions that are better than `cut`. The members
    /// below refer to the last call.
    /// If progress says stop meanwhile it is none, and nothing else may be asked.
    std::uint64_t evaluate(const std::vector<std::uint32_t>& multipliers, std::uint64_t cut,
                           const Progress& progress);
    /// The same as if there were the working candidates alone: quick, and at most what evaluate()
    /// gives.
    std::uint64_t evaluateWorking(const std::vector<std::uint32_t>& multipliers);
    /// By cell how often it counts.
    [[nodiscard]] const std::vector<float>& cover() const { return cover_; }
    /// After evaluate() for these multipliers: drops candidates that are in no solution better than
    /// `cut`.
    void ruleOut(std::uint64_t cut, const std::vector<std::uint32_t>& multipliers);
    /// The candidates of most worth for these multipliers join the working ones.
    void addWorthiest(const std::vector<std::uint32_t>& multipliers);
    /// After evaluate(): the most promising candidates join the working ones.
    void widen();

    /// True if that left no candidate of some group.
    [[nodiscard]] bool isClosed() const;
    /// What is left of the list of each group.
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> lists() const;
    /// Upper bound of the solutions that ruleOut() has excluded, at most its cut.
    [[nodiscard]] std::uint64_t ruledOut() const { return ruled_out_; }

  private:
    static constexpr std::int64_t kNoFloor = std::numeric_limits<std::int64_t>::min() / 4;

    struct Place {
        std::uint32_t candidate = 0, bundle = 0;
        SeenRuns runs;  ///< ascending
        std::int64_t worth = 0;
        bool is_working = false, has_view = false;
    };
    /// Places of a group that see much the same: most bundles are passed over as a whole.
    struct Bundle {
        SeenRuns common;            ///< what all of them see
        std::uint64_t founder = 0;  ///< weight of what the first of them sees
        std::uint64_t weight = 0;   ///< of what is common
        std::vector<std::uint32_t> places = {};
    };
    struct Group {
        std::size_t kind = 0;
        std::vector<Place> places;
        std::vector<Bundle> bundles;
    };
    /// What is at most to be had of the parts of a ranking, the most first.
    struct Chance {
        std::int64_t most = 0;
        std::uint32_t part = 0;
    };
    /// Places of a group by some value.
    struct Ranking {
        struct Part {
            std::int64_t best = 0;
            std::uint32_t bundle = 0, begin = 0, end = 0;  ///< in `order`
        };
        std::vector<std::uint32_t> order;  ///< by part, the highest first
        std::vector<Part> parts;           ///< the highest first
        std::vector<Chance> chances;       ///< of these, whatever is seen already

        void assign(const Group& group, const std::vector<std::int64_t>& values,
                    std::vector<std::uint32_t> list);
    };
    /// One sensor.
    struct Variable {
        std::size_t group = 0, parent = 0;
        std::vector<std::size_t> below;
        std::vector<std::int64_t> values;  ///< by place: with all below
        Ranking ranking;                   ///< by these
        // By place of the parent:
        std::vector<std::int64_t> gains;     ///< of the best reply
        std::vector<std::uint32_t> replies;  ///< its place
        std::vector<std::int64_t> most;      ///< by place: of a whole solution
        std::uint32_t best = 0;
        /// The highest value of the places that are not ranked.
        std::int64_t spare = kNoFloor;
        /// Values up to this need not be exact: any upper bound will do.
        std::int64_t floor = kNoFloor;
    };

    static std::int64_t topOf(const Variable& variable) {
        return std::max(variable.ranking.parts[0].best, variable.spare);
    }
    void addGroup(const OpenGroup& group, const std::vector<float>& frequencies);
    void findView(Group& group, Place& place);
    void keepOneWorking(Group& group);
    void weigh(const std::vector<std::uint32_t>& multipliers);
    std::vector<std::uint32_t> findHopeless(Variable& variable,
                                            const std::vector<std::uint32_t>& list);
    static void addToBundle(Group& group, Place& place, MaskedSums& sums,
                            const std::vector<std::uint32_t>& weights);
    void join(const NodeRelaxation& relaxed, const std::vector<std::uint32_t>& multipliers);
    std::uint64_t boundOf(const std::vector<std::uint32_t>& multipliers, bool is_all,
                          const Progress& progress);
    void gather(Variable& variable, const std::vector<std::uint32_t>& multipliers, bool is_all,
                const Progress& progress);
    /// The best replies of the variables below to one.
    struct Replies {
        std::vector<std::int64_t> gains;
        std::vector<std::uint32_t> places;         ///< good ones to begin with
        std::vector<std::vector<Chance>> chances;  ///< by variable below
        std::vector<std::int64_t> floors;          ///< of these
    };
    std::int64_t findReplies(const Variable& variable, const Place& place,
                             const std::vector<std::uint32_t>& multipliers, MaskedSums& seen,
                             Replies& replies) const;
    std::int64_t findChances(const Variable& variable, const Bundle& bundle, std::int64_t worth,
                             const std::vector<std::uint32_t>& multipliers, MaskedSums& seen,
                             Replies& replies) const;
    void setReplies(Variable& variable, std::uint32_t p, const Replies& replies);
    void spread(Variable& variable, const std::vector<std::uint32_t>& multipliers, bool is_all,
                std::int64_t cut);
    void setFloors(const std::vector<std::uint32_t>& multipliers, std::uint64_t cut);
    static std::vector<Chance> chancesOf(const Group& group, const Ranking& ranking,
                                         const MaskedSums& seen, std::int64_t floor);
    static std::int64_t bestOf(const Group& group, const Ranking& ranking,
                               const std::vector<Chance>& chances,
                               const std::vector<std::int64_t>& values, const MaskedSums& seen,
                               std::int64_t floor, std::uint32_t& place);
    void setCover();
    [[nodiscard]] std::vector<std::uint32_t> listOf(const Variable& variable, bool is_all) const;

    const ReducedProblem& problem_;
    std::vector<Group> groups_;
    MaskedSums scratch_;
    std::vector<Variable> variables_;
    std::vector<std::size_t> from_root_;  // variables, parents first
    std::vector<float> cover_;
    std::uint64_t free_ = 0, ruled_out_ = 0;
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/exact.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "place/branch_node.h"
#include "place/root_relaxation.h"
#include "place/search_notes.h"

namespace ispace {
namespace {

// Nodes at once, whatever the number of threads, so that the tree does not depend on it.
constexpr std::size_t kBatch = 8;
// With more open nodes the lowest come first, which have few children: memory stays bounded.
constexpr std::size_t kMostOpen = 20'000;
constexpr std::size_t kMostRoots = 2'000;

/// The highest bound that is within `gap` of a value.
std::uint64_t goodBound(std::uint64_t value, double gap) {
    if (!(gap > 0)) return value;
    const double most = std::floor(static_cast<double>(value) / std::max(1 - gap, 1e-9));
    return std::max(value, static_cast<std::uint64_t>(std::min(most, 4294967295.0)));
}

class Tree {
  public:
    Tree(const Problem& problem, const Bound& bound, SearchResult known, double gap,
         std::uint64_t enough)
        : problem_(problem),
          relaxed_(problem),
          result_(std::move(known)),
          gap_(gap),
          enough_(enough) {
        result_.bound = std::min(result_.bound, bound.value);
        addRoots(bound);
    }

    SearchResult search(Progress& progress) {
        progress.begin("proving", 0);
        while (!open_.empty() && result_.best.value < enough_) {
            if (progress.stopped()) {
                result_.is_complete = false;
                break;
            }
            const std::vector<BranchNode> batch = take();
            std::vector<BranchResult> results(batch.size());
            const std::uint64_t cut = relaxed_.most(goodBound(result_.best.value, gap_));
            tbb::parallel_for(std::size_t{0}, batch.size(),
                              [&](std::size_t i) { results[i] = branch(problem_, batch[i], cut); });
            for (BranchResult& result : results) add(result);
            progress.advance(static_cast<std::int64_t>(batch.size()));
            lowerBound();
            noteProgress(problem_, result_, progress);
        }
        lowerBound();
        progress.end();
        return std::move(result_);
    }

  private:
    void addRoots(const Bound& bound);
    /// The next nodes to look at, those with the highest bounds.
    std::vector<BranchNode> take() {
        std::vector<BranchNode> batch;
        while (batch.size() < kBatch && !open_.empty()) {
            const auto next = open_.size() > kMostOpen ? std::prev(open_.end()) : open_.begin();
            batch.push_back(std::move(next->second));
            open_.erase(next);
        }
        return batch;
    }
    void add(BranchResult& result) {
        if (!result.found.empty()) {
            const std::uint64_t value = valueOf(problem_, result.found);
            if (value > result_.best.value) result_.best = {std::move(result.found), value};
        }
        for (BranchNode& child : result.children) {
            const std::uint64_t bound = child.bound;
            open_.emplace(std::pair(~bound, next_++), std::move(child));
        }
    }
    void lowerBound() {
        // What is not open is worth no more than the cut.
        std::uint64_t bound = goodBound(result_.best.value, gap_);
        if (!open_.empty()) bound = std::max(bound, relaxed_.whole(open_.begin()->second.bound));
        result_.bound = std::max(std::min(result_.bound, bound), result_.best.value);
        if (gap_ > 0 || open_.empty()) return;
        // Those that are ruled out by now.
        const std::uint64_t cut = relaxed_.most(result_.best.value);
        while (!open_.empty() && std::prev(open_.end())->second.bound <= cut)
            open_.erase(std::prev(open_.end()));
    }

    const Problem& problem_;
    RelaxedCells relaxed_;
    SearchResult result_;
    double gap_;
    std::uint64_t enough_;
    std::uint64_t next_ = 0;
    /// By the complement of the bound, then by age.
    std::map<std::pair<std::uint64_t, std::uint64_t>, BranchNode> open_;
};

void Tree::addRoots(const Bound& bound) {
    const auto kept = survivors(problem_, bound, goodBound(result_.best.value, gap_));
    std::vector<std::size_t> limits;
    for (const Kind& kind : problem_.kinds) limits.push_back(kind.candidates->size());
    const CountChoice counts(problem_, limits);
    std::vector<std::uint32_t> multipliers = bound.multipliers;
    auto reduced = std::make_shared<const ReducedProblem>(
        reduce(wholeProblem(problem_, relaxed_), kept, multipliers));
    BranchNode root;
    root.problem = reduced;
    root.multipliers = std::make_shared<const std::vector<std::uint32_t>>(std::move(multipliers));
    root.bound = relaxed_.most(result_.bound);
    if (root.bound <= relaxed_.most(goodBound(result_.best.value, gap_))) return;
    for (const auto& way : counts.ways()) {
        BranchNode node = root;
        for (std::size_t k = 0; k < way.size(); ++k) {
            const std::size_t size = reduced->kinds[k].original.size();
            if (way[k] == 0 || size == 0) continue;
            std::vector<std::uint32_t> list(size);
            for (std::size_t i = 0; i < size; ++i) list[i] = static_cast<std::uint32_t>(i);
            node.groups.push_back({k, std::min(way[k], size), std::move(list)});
        }
        open_.emplace(std::pair(~node.bound, next_++), std::move(node));
    }
}

}  // namespace

std::vector<std::vector<std::uint32_t>> survivors(const Problem& problem, const Bound& bound,
                                                  std::uint64_t value) {
    RootRelaxation root(problem);
    if (!bound.survivors.empty() && value >= bound.cut) root.keepOnly(bound.survivors);
    root.evaluate(bound.multipliers, true);
    root.ruleOut(root.cells().most(value));
    return root.survivors();
}

SearchResult branchAndBound(const Problem& problem, const Bound& bound, SearchResult known,
                            double gap, Progress& progress, std::uint64_t enough) {
    std::vector<std::size_t> limits;
    for (const Kind& kind : problem.kinds) limits.push_back(kind.candidates->size());
    const CountChoice counts(problem, limits);
    if (!counts.isListed() || counts.ways().size() > kMostRoots) return known;
    return Tree(problem, bound, std::move(known), gap, enough).search(progress);
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// The search tree: a loop over batches of open nodes.
//
// Invariant: closed_ bounds all solutions that are neither known nor in an open node, so the larger
// of it and of the highest open bound is a bound of the problem; of a shard that has dealt its
// nodes, of its share. A batch is up to eight nodes, as memory allows, for any number of threads;
// they are branched against the same best value, and their results are taken in order. While memory
// is short, the newest node comes first, so that the tree goes down before it goes wide.
#include "arrange/search/branch_and_bound.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>

#include "arrange/search/branch_node.h"
#include "arrange/search/packed_search.h"
#include "arrange/search/relaxation.h"
#include "arrange/search/search.h"
#include "base/random.h"

namespace ispace {

namespace {

// A node of a map takes some more than its contents.
constexpr std::size_t kOverhead = 160;
// Children of the nodes processed together take at most about this part of the memory.
constexpr std::size_t kBatchPart = 8;

template <typename T>
std::size_t bytesOf(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

std::size_t ownBytes(const BranchNode& node) {
    return sizeof(BranchNode) + kOverhead + bytesOf(node.fixed) + bytesOf(node.pending) +
           bytesOf(node.groups);
}

}  // namespace

void OpenNodes::hold(const void* shared, std::size_t bytes) {
    Shared& of = shared_[shared];
    if (of.users++ > 0) return;
    of.bytes = bytes;
    bytes_ += bytes;
}

void OpenNodes::release(const void* shared) {
    const auto at = shared_.find(shared);
    if (--at->second.users > 0) return;
    bytes_ -= at->second.bytes;
    shared_.erase(at);
}

void OpenNodes::add(BranchNode node) {
    const Key key(~node.bound, next_++);
    insert(key, std::move(node));
}

void OpenNodes::insert(const Key& key, BranchNode node) {
    bytes_ += ownBytes(node);
    hold(node.problem.get(), node.problem->bytes());
    hold(node.multipliers.get(), bytesOf(*node.multipliers));
    for (const BranchGroup& group : node.groups) hold(group.list.get(), bytesOf(*group.list));
    by_age_.emplace(key.second, key.first);
    nodes_.emplace(key, std::move(node));
}

BranchNode OpenNodes::remove(const Key& key) {
    const auto at = nodes_.find(key);
    BranchNode node = std::move(at->second);
    nodes_.erase(at);
    by_age_.erase(key.second);
    bytes_ -= ownBytes(node);
    release(node.problem.get());
    release(node.multipliers.get());
    for (const BranchGroup& group : node.groups) release(group.list.get());
    return node;
}

std::vector<BranchNode> OpenNodes::take(std::size_t most) {
    std::vector<BranchNode> batch;
    batch.reserve(most);
    taken_.clear();
    std::size_t bytes = 0;
    const bool is_full = bytes_ > max_bytes_;
    while (batch.size() < most && !nodes_.empty()) {
        Key key = nodes_.begin()->first;
        if (is_full) key = {std::prev(by_age_.end())->second, std::prev(by_age_.end())->first};
        bytes += nodes_.at(key).problem->bytes();
        if (!batch.empty() && bytes > max_bytes_ / kBatchPart) break;
        batch.push_back(remove(key));
        taken_.push_back(key);
    }
    return batch;
}

void OpenNodes::putBack(std::vector<BranchNode> batch) {
    for (std::size_t i = 0; i < batch.size(); ++i) insert(taken_[i], std::move(batch[i]));
    taken_.clear();
}

std::uint64_t OpenNodes::dropUpTo(std::uint64_t cut) {
    std::uint64_t highest = 0;
    while (!nodes_.empty() && ~std::prev(nodes_.end())->first.first <= cut)
        highest = remove(Key(std::prev(nodes_.end())->first)).bound;
    return highest;
}

std::vector<const BranchNode*> OpenNodes::byAge() const {
    std::vector<const BranchNode*> nodes;
    nodes.reserve(nodes_.size());
    for (const auto& [age, bound] : by_age_) nodes.push_back(&nodes_.at({bound, age}));
    return nodes;
}

void OpenNodes::keepOnly(const Shard& shard) {
    std::vector<Key> others;
    const auto own = static_cast<std::size_t>(shard.index - 1),
               count = static_cast<std::size_t>(shard.count);
    std::size_t i = 0;
    for (const auto& [key, node] : nodes_)
        if (i++ % count != own) others.push_back(key);
    for (const Key& key : others) remove(key);
}

namespace {

// Nodes at once, whatever the number of threads, so that the tree does not depend on it.
constexpr std::size_t kBatch = 8;

/// Returns the highest bound that is within `gap` of a value.
std::uint64_t goodBound(std::uint64_t value, double gap) {
    if (!(gap > 0)) return value;
    const double most = std::floor(static_cast<double>(value) / std::max(1 - gap, 1e-9));
    return std::max(value, static_cast<std::uint64_t>(std::min(most, 4294967295.0)));
}

/// The remaining candidates, cut down.
struct Root {
    std::vector<std::vector<std::size_t>> ways;  ///< counts per kind
    std::vector<std::size_t> most;               ///< of them, per kind
    std::shared_ptr<const ReducedProblem> problem;
    std::shared_ptr<const std::vector<std::uint32_t>> multipliers;
    std::uint64_t closed = 0;  ///< upper bound of solutions with another candidate, fine
};

/// Excludes candidates of the whole problem: those that the bound excluded, if the value is no less
/// than its cut, and those that its multipliers exclude now. Sets `closed` to an upper bound of
/// solutions with any of them.
RootRelaxation ruledOut(const Problem& problem, const Bound& bound, std::uint64_t value,
                        std::uint64_t& closed) {
    RootRelaxation root(problem);
    if (!bound.survivors.empty() && value >= bound.cut) {
        root.keepOnly(bound.survivors);
        closed = root.cells().most(bound.cut);
    }
    root.evaluate(bound.multipliers, true);
    closed = std::max(closed, root.ruleOut(root.cells().most(value)));
    return root;
}

/// Makes the problem of the tree: without excluded candidates, and with alike cells merged.
/// Excludes first, so that the large relaxation is gone before the reduced problem is built.
Root rootOf(const Problem& problem, const Bound& bound, std::uint64_t value) {
    Root made;
    std::vector<std::vector<std::uint32_t>> kept;
    {
        const RootRelaxation root = ruledOut(problem, bound, value, made.closed);
        kept = root.survivors();
        made.ways = root.counts().ways();
        for (std::size_t k = 0; k < problem.kinds.size(); ++k)
            made.most.push_back(root.counts().most(k));
    }
    std::vector<std::uint32_t> multipliers = bound.multipliers;
    made.problem = std::make_shared<const ReducedProblem>(
        reduce(wholeProblem(problem, RelaxedCells(problem)), kept, multipliers));
    made.multipliers = std::make_shared<const std::vector<std::uint32_t>>(std::move(multipliers));
    return made;
}

/// Returns in [n] an upper bound of the bound's gain by n candidates of a kind.
std::vector<std::uint64_t> gainsOf(const Root& root, std::size_t kind) {
    const ReducedProblem::OfKind& own = root.problem->kinds[kind];
    std::vector<std::uint32_t> cells(root.problem->cells());
    for (std::size_t i = 0; i < cells.size(); ++i)
        cells[i] = reducedCost((*root.multipliers)[i], own.multiplicity, root.problem->needs[i]);
    std::vector<std::uint32_t> reduced_costs(own.original.size());
    own.candidates->weighAll(WeightSums(cells), reduced_costs);
    const std::size_t most = std::min(root.most[kind], reduced_costs.size());
    std::partial_sort(reduced_costs.begin(),
                      reduced_costs.begin() + static_cast<std::ptrdiff_t>(most),
                      reduced_costs.end(), std::greater<>());
    std::vector<std::uint64_t> gains = {0};
    gains.reserve(most + 1);
    for (std::size_t n = 0; n < most; ++n) gains.push_back(gains.back() + reduced_costs[n]);
    return gains;
}

class Tree {
  public:
    Tree(const Problem& problem, const Bound& bound, SearchResult known, double gap,
         std::uint64_t enough, std::size_t max_bytes, const SearchShare& share)
        : problem_(problem),
          relaxed_(problem),
          result_(std::move(known)),
          gap_(gap),
          enough_(enough),
          open_(max_bytes),
          share_(share) {
        result_.bound = std::min(result_.bound, bound.value);
        if (share_.results != nullptr) {
            name_ = share_.results->keyFor("tree");
            mark_ = markOf(bound);
            if (recall()) return;
        }
        if (relaxed_.most(result_.bound) > cut())
            addRoots(rootOf(problem, bound, goodBound(result_.best.value, gap_)));
        else
            closed_ = relaxed_.most(result_.bound);
    }

    /// The size of a batch does not depend on the number of threads, and results are added in its
    /// order: so the tree is the same for any number. A stop leaves bounds that hold.
    SearchResult search(Progress& progress) {
        progress.begin("proving", 0);
        lowerBound();
        while (!open_.empty() && result_.best.value < enough_) {
            if (progress.stopped()) {
                result_.is_complete = false;
                break;
            }
            deal();
            if (share_.results != nullptr && share_.results->isDue()) keep();
            if (open_.empty()) break;
            std::vector<BranchNode> batch = open_.take(kBatch);
            // A run that continues this tree takes the same steps, so no step is left half done.
            std::vector<BranchNode> before;
            if (share_.results != nullptr) before = batch;
            std::vector<BranchResult> results(batch.size());
            const std::uint64_t cut = this->cut();
            tbb::parallel_for(std::size_t{0}, batch.size(), [&](std::size_t i) {
                results[i] = branch(problem_, batch[i], cut, progress);
                batch[i] = BranchNode();
            });
            if (share_.results != nullptr && progress.stopped()) {
                open_.putBack(std::move(before));
                continue;
            }
            for (BranchResult& result : results) add(result);
            progress.advance(static_cast<std::int64_t>(batch.size()));
            lowerBound();
            noteProgress(problem_, result_, progress);
        }
        progress.end();
        if (share_.results != nullptr) keep();
        return std::move(result_);
    }

  private:
    /// Once there are enough open nodes, a shard continues with its share.
    void deal() {
        constexpr std::size_t kNodesPerShard = 8;
        if (is_dealt_ || !share_.isOwn(Shared::Tree)) return;
        if (open_.size() < kNodesPerShard * static_cast<std::size_t>(share_.own->count)) return;
        open_.keepOnly(*share_.own);
        is_dealt_ = true;
        lowerBound();
    }

    /// Computes a fingerprint that tells the searches of a run apart.
    [[nodiscard]] std::uint64_t markOf(const Bound& bound) const {
        constexpr std::uint64_t kForm = 3;  // version of the bytes that keep() writes
        std::uint64_t mark = mixedBits(fingerprintOf(problem_) ^ mixedBits(enough_) ^ kForm);
        for (const std::uint64_t number : {result_.best.value, result_.bound, bound.cut})
            mark = mixedBits(mark ^ number);
        for (const std::uint32_t multiplier : bound.multipliers)
            mark = mixedBits(mark ^ multiplier);
        return mark;
    }
    void keep() {
        Packer to;
        to.add(mark_);
        pack(to, result_);
        to.add(closed_);
        to.add(is_dealt_ ? 1 : 0);
        pack(to, open_.byAge());
        share_.results->store(name_, to.bytes());
    }
    bool recall() {
        const auto bytes = share_.results->find(name_);
        if (!bytes) return false;
        Unpacker from(*bytes);
        if (from.number() != mark_) return false;
        result_ = unpackResult(from, problem_);
        result_.is_complete = true;
        closed_ = from.number();
        is_dealt_ = from.number() != 0;
        for (BranchNode& node : unpackNodes(from, problem_)) open_.add(std::move(node));
        return true;
    }

    /// Returns the value that a useful solution exceeds, fine.
    [[nodiscard]] std::uint64_t cut() const {
        return relaxed_.most(goodBound(result_.best.value, gap_));
    }
    void addRoots(const Root& root);
    void add(BranchResult& result) {
        closed_ = std::max(closed_, result.closed);
        if (!result.found.empty()) {
            const std::uint64_t value = valueOf(problem_, result.found);
            if (value > result_.best.value) result_.best = {std::move(result.found), value};
        }
        for (BranchNode& child : result.children) open_.add(std::move(child));
        result.children.clear();
    }
    void lowerBound() {
        closed_ = std::max(closed_, open_.dropUpTo(cut()));
        const std::uint64_t most = open_.empty() ? closed_ : std::max(closed_, open_.bound());
        result_.bound = std::min(result_.bound, relaxed_.whole(most));
        result_.bound = std::max(result_.bound, result_.best.value);
    }

    const Problem& problem_;
    RelaxedCells relaxed_;
    SearchResult result_;
    double gap_;
    std::uint64_t enough_;
    std::uint64_t closed_ = 0;  // upper bound of solutions neither open nor known, fine
    OpenNodes open_;
    const SearchShare& share_;
    bool is_dealt_ = false;
    std::string name_;        // of the tree in the job results
    std::uint64_t mark_ = 0;  // of its search
};

/// A root is a way to divide the sensors among the kinds. The n highest reduced costs of a kind sum
/// to the most that n of its sensors gain, so each root begins with its own bound.
void Tree::addRoots(const Root& root) {
    closed_ = root.closed;
    std::vector<std::vector<std::uint64_t>> gains;
    std::vector<std::shared_ptr<const std::vector<std::uint32_t>>> lists;
    for (std::size_t k = 0; k < root.most.size(); ++k) {
        gains.push_back(gainsOf(root, k));
        std::vector<std::uint32_t> list(root.problem->kinds[k].original.size());
        std::iota(list.begin(), list.end(), 0U);
        lists.push_back(std::make_shared<const std::vector<std::uint32_t>>(std::move(list)));
    }
    std::uint64_t free = root.problem->settled;
    for (std::size_t i = 0; i < root.problem->cells(); ++i)
        free += root.problem->weights[i] - (*root.multipliers)[i];
    for (const auto& way : root.ways) {
        BranchNode node;
        node.problem = root.problem;
        node.multipliers = root.multipliers;
        node.bound = free;
        for (std::size_t k = 0; k < way.size(); ++k) {
            const std::size_t count = std::min(way[k], lists[k]->size());
            if (count == 0) continue;
            node.groups.push_back({k, count, lists[k]});
            node.bound += gains[k][count];
        }
        node.bound = std::min(node.bound, relaxed_.most(result_.bound));
        open_.add(std::move(node));
    }
}

}  // namespace

std::vector<std::vector<std::uint32_t>> survivors(const Problem& problem, const Bound& bound,
                                                  std::uint64_t value) {
    std::uint64_t closed = 0;
    return ruledOut(problem, bound, value, closed).survivors();
}

SearchResult branchAndBound(const Problem& problem, const Bound& bound, SearchResult known,
                            double gap, Progress& progress, std::uint64_t enough,
                            std::size_t max_bytes, const SearchShare& share) {
    if (progress.stopped()) {
        known.is_complete = false;
        return known;
    }
    if (!CountChoice(problem).isListed()) return known;
    return Tree(problem, bound, std::move(known), gap, enough, max_bytes, share).search(progress);
}

}  // namespace ispace

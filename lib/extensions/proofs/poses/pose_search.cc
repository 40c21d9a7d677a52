// SPDX-License-Identifier: GPL-3.0-or-later
// Branch and bound over tuples of boxes, the worst bound first (A. H. Land, A. G. Doig, An
// automatic method of solving discrete programming problems, 1960). Up to 256 tuples are split at a
// time, in parallel; the batch, not the threads, decides the order. Equal sensors are kept in the
// order of the tree, which leaves out n! - 1 of n! tuples. Layouts of centres of boxes that come
// near to the best one are refined, since a better layout cuts off more than a better bound.
#include "extensions/proofs/poses/pose_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

#include "base/number.h"
#include "base/random.h"
#include "extensions/proofs/poses/pose_searcher.h"
#include "extensions/proofs/poses/pose_share.h"

namespace ispace::proofs::poses {

double PoseSearcher::boundOf(const Tuple& tuple, double enough) const {
    return options_.times > 1 ? multiple_.of(boxesOf(tuple), enough) : unionBoundOf(tuple, enough);
}

double PoseSearcher::unionBoundOf(const Tuple& tuple, double enough) const {
    double bound = 0;
    for (const BoxId id : boxesOf(tuple)) bound += boxes_[id].most;
    if (count_ == 1) return bound;
    std::vector<BoxId> known, others;
    for (unsigned chosen = 1U << count_; chosen-- > 0 && bound > enough;) {
        known.clear();
        others.clear();
        for (std::size_t i = 0; i < count_; ++i)
            ((chosen >> i & 1U) != 0 ? known : others).push_back(tuple.boxes[i]);
        bound = std::min(bound, boxes_.unionFor(enough, boxesOf(tuple), known, others));
    }
    return bound;
}

PoseSearcher::Children PoseSearcher::childrenOf(const Tuple& tuple, std::size_t which) const {
    Children children;
    const std::span<const BoxId> boxes = boxesOf(tuple);
    const BoxId child = boxes_[tuple.boxes[which]].child;
    for (BoxId half = child; half < child + 2; ++half) {
        if (!boxes_.isInOrder(boxes, which, half)) continue;
        Tuple next = tuple;
        next.boxes[which] = half;
        next.bound = std::min(tuple.bound, boundOf(next, cutoff()));
        children.tuples.push_back(next);
        if (next.bound <= cutoff()) continue;
        const double value = options_.times > 1 ? multiple_.ofCentres(boxesOf(next))
                                                : boxes_.unionOfCentres(boxesOf(next));
        if (value <= children.best_value) continue;
        children.best_value = value;
        children.best = next;
    }
    return children;
}

/// Halves the boxes of one sensor where it may see most, until none can see 0.2 % more than a pose
/// that was tried or the boxes are as many as allowed: tuples start with tight single views.
void PoseSearcher::searchSingle() {
    constexpr std::size_t kBatch = 64;
    constexpr double kClose = 0.002;
    const auto is_less = [this](BoxId a, BoxId b) {
        return boxes_[a].most != boxes_[b].most ? boxes_[a].most < boxes_[b].most : a > b;
    };
    std::priority_queue<BoxId, std::vector<BoxId>, decltype(is_less)> queue(is_less);
    queue.push(0);
    double seen = 0;  // by poses that were tried
    while (!queue.empty() && boxes_.size() < options_.singles && !progress_.stopped()) {
        std::vector<BoxId> batch;
        while (!queue.empty() && batch.size() < kBatch) {
            const BoxId id = queue.top();
            if (boxes_[id].most <= seen * (1 + kClose)) break;
            queue.pop();
            if (boxes_.widestOf({&id, 1}) == 0) batch.push_back(id);
        }
        if (batch.empty()) return;
        const PoseBox& best = boxes_[batch.front()].box;
        const Point2 middle = best.at.center();
        seen = std::max(
            seen,
            outerBoundOf(floor_, sector_, {{middle, middle}, best.from + best.span / 2, 0}).area);
        boxes_.split(batch);
        for (const BoxId id : batch)
            for (BoxId half = boxes_[id].child; half < boxes_[id].child + 2; ++half)
                if (!boxes_[half].isBlind()) queue.push(half);
    }
}

void PoseSearcher::improve(const Tuple& tuple) {
    if (!options_.improve) return;
    std::vector<PoseBox> boxes;
    for (std::size_t i = 0; i < count_; ++i) boxes.push_back(boxes_[tuple.boxes[i]].box);
    PosedLayout better = options_.improve(boxes);
    if (better.area > found_.area) found_ = std::move(better);
}

void PoseSearcher::lowerBySums(std::vector<Children>& made) {
    if (count_ == 1) return;
    std::vector<SumBound::Bounded> tuples;
    for (const Children& children : made)
        for (const Tuple& tuple : children.tuples) tuples.push_back({boxesOf(tuple), tuple.bound});
    sums_.lower(tuples, cutoff());
    std::size_t next = 0;
    for (Children& children : made)
        for (Tuple& tuple : children.tuples) tuple.bound = tuples[next++].bound;
}

/// `closed_` bounds all tuples that were dropped, too small to be halved or not above the cutoff;
/// the larger of it and of the queue's top bounds what any poses of this share see.
void PoseSearcher::searchTuples() {
    constexpr std::size_t kBatch = 256;
    constexpr double kBetter = 1e-3, kNear = 0.97;  // of centres, to be worth refining
    if (tree_.empty()) {
        Tuple root;
        root.bound = boundOf(root, 0);
        queue_.push(root);
        tree_.push_back({.bound = root.bound});
    }
    for (std::size_t round = 1; !queue_.empty() && queue_.top().bound > cutoff(); ++round) {
        if (progress_.stopped() || isFull()) {
            is_complete_ = false;
            keep();
            return;
        }
        deal();
        if (options_.share.results != nullptr && options_.share.results->isDue()) keep();
        if (queue_.empty() || queue_.top().bound <= cutoff()) break;
        if ((round & (round - 1)) == 0) {
            progress_.note("best " + formatFixed(found_.area, 2) + " m2, at most " +
                           formatFixed(std::max(closed_, queue_.top().bound), 2) + " m2");
        }
        std::vector<Tuple> batch;
        std::vector<std::size_t> which;
        std::vector<BoxId> to_split;
        while (!queue_.empty() && batch.size() < kBatch && queue_.top().bound > cutoff()) {
            Tuple tuple = queue_.top();
            queue_.pop();
            // Single views may be bounded better by now.
            const double most = multiple_.ofSingles(boxesOf(tuple));
            if (most < tuple.bound) {
                tuple.bound = most;
                queue_.push(tuple);
                continue;
            }
            const std::size_t widest = boxes_.widestOf(boxesOf(tuple));
            if (widest == count_) {
                closed_ = std::max(closed_, tuple.bound);
                continue;
            }
            batch.push_back(tuple);
            which.push_back(widest);
            to_split.push_back(tuple.boxes[widest]);
        }
        boxes_.splitWithViews(to_split);
        std::vector<Children> made(batch.size());
        tbb::parallel_for(std::size_t{0}, batch.size(),
                          [&](std::size_t i) { made[i] = childrenOf(batch[i], which[i]); });
        lowerBySums(made);
        for (std::size_t i = 0; i < made.size(); ++i) {
            Children& children = made[i];
            if (options_.certificate != nullptr) addToTree(batch[i], which[i], children.tuples);
            if (children.best_value > std::max(tried_ * (1 + kBetter), found_.area * kNear)) {
                tried_ = children.best_value;
                improve(children.best);
            }
            for (const Tuple& tuple : children.tuples) {
                ++tuples_;
                if (tuple.bound > cutoff())
                    queue_.push(tuple);
                else
                    closed_ = std::max(closed_, tuple.bound);
            }
        }
    }
}

void PoseSearcher::addToTree(const Tuple& parent, std::size_t which, std::vector<Tuple>& children) {
    tree_[parent.node].which = static_cast<int>(which);
    for (Tuple& child : children) {
        child.node = static_cast<std::uint32_t>(tree_.size());
        const bool is_first = child.boxes[which] == boxes_[parent.boxes[which]].child;
        tree_[parent.node].halves[is_first ? 0 : 1] = child.node;
        tree_.push_back({.bound = child.bound});
    }
}

void PoseSearcher::writeTuples(std::uint32_t id, double bound, std::string& text) const {
    const TupleNode& node = tree_[id];
    const bool is_leaf = node.which < 0 || node.bound <= bound;
    text += is_leaf ? '.' : static_cast<char>('0' + node.which);
    if (is_leaf) return;
    for (const std::uint32_t half : node.halves)
        if (half != 0)
            writeTuples(half, bound, text);
        else
            text += '-';
}

void PoseSearcher::deal() {
    constexpr std::size_t kPerShard = 8;
    const std::optional<Shard>& own = options_.share.own;
    if (dealt_ != 0 || !own || queue_.size() < kPerShard * static_cast<std::size_t>(own->count))
        return;
    queue_.sortByBound();
    Packer tuples;
    for (const Tuple& tuple : queue_.all()) {
        pack(tuples, tuple.bound);
        for (const BoxId id : boxesOf(tuple)) {
            const PoseBox& box = boxes_[id].box;
            for (const double number :
                 {box.at.low.x, box.at.low.y, box.at.high.x, box.at.high.y, box.from, box.span})
                pack(tuples, number);
        }
    }
    dealt_ = std::max<std::uint64_t>(hashOf(tuples.bytes()), 1);
    queue_.keepOnly(*own);
}

PoseBound PoseSearcher::run() {
    if (boxes_[0].isBlind()) return {};
    if (!recall()) {
        searchSingle();
        if (progress_.stopped()) is_kept_ = false;  // cut short
    }
    searchTuples();
    const double open = queue_.empty() ? 0 : queue_.top().bound;
    const double bound = std::max({closed_, open, found_.area});
    if (PoseCertificate* certificate = options_.certificate; certificate != nullptr) {
        *certificate = {.bound = bound, .boxes = boxes_.text(), .tuples = {}};
        writeTuples(0, bound, certificate->tuples);
    }
    return {bound, found_, boxes_.size(), tuples_, is_complete_};
}

}  // namespace ispace::proofs::poses

namespace ispace::proofs {

PoseBound boundOverPoses(const poses::PoseFloor& floor, const poses::Sector& sector,
                         const PoseSearchOptions& options, Progress& progress) {
    const PoseShare& share = options.share;
    if (share.joined > 0)
        return poses::joinedProof(share, poses::markOf(floor, sector, options), options.sensors,
                                  options.found);
    poses::PoseSearcher search(floor, sector, options, progress);
    PoseBound proof = search.run();
    if (share.own)
        poses::storeProof(share, poses::markOf(floor, sector, options), search.dealt(), proof);
    return proof;
}

}  // namespace ispace::proofs

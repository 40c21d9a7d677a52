// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a search over poses, from which another run continues.
#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "base/random.h"
#include "extensions/proofs/poses/pose_searcher.h"
#include "extensions/proofs/poses/pose_share.h"

namespace ispace::proofs::poses {

void PoseSearcher::keep() {
    if (!is_kept_) return;
    JobResults& results = *options_.share.results;
    Packer to;
    to.add(mark_);
    boxes_.pack(to);
    pack(to, found_);
    for (const double area : {tried_, closed_}) pack(to, area);
    to.add(tuples_);
    to.add(dealt_);
    std::vector<std::uint64_t> bounds;
    std::vector<std::uint32_t> tuples, tree;
    for (const Tuple& tuple : queue_.all()) {
        bounds.push_back(std::bit_cast<std::uint64_t>(tuple.bound));
        tuples.insert(tuples.end(), tuple.boxes.begin(), tuple.boxes.end());
        tuples.push_back(tuple.node);
    }
    for (const TupleNode& node : tree_) {
        const auto bound = std::bit_cast<std::uint64_t>(node.bound);
        tree.insert(tree.end(),
                    {node.halves[0], node.halves[1], static_cast<std::uint32_t>(node.which + 1),
                     static_cast<std::uint32_t>(bound >> 32U), static_cast<std::uint32_t>(bound)});
    }
    to.addAll(bounds);
    to.addAll(tuples);
    to.addAll(tree);
    results.store(name_, to.bytes());
}

bool PoseSearcher::recall() {
    JobResults* const results = options_.share.results;
    // A run that is stopped already may have another layout to begin with.
    if (results == nullptr || progress_.stopped()) return false;
    name_ = results->keyFor("posestate");
    is_kept_ = true;
    Packer marked;
    marked.add(markOf(floor_, sector_, options_));
    for (const double number : {options_.found, static_cast<double>(options_.max_bytes)})
        pack(marked, number);
    marked.add(options_.certificate != nullptr ? 1 : 0);
    mark_ = hashOf(marked.bytes());
    const auto bytes = results->find(name_);
    if (!bytes) return false;
    Unpacker from(*bytes);
    if (from.number() != mark_) return false;
    boxes_.unpack(from);
    found_ = unpackLayout(from, options_.sensors);
    if (found_.area < options_.found) Unpacker::refuse();
    tried_ = unpackArea(from);
    closed_ = unpackArea(from);
    tuples_ = from.number();
    dealt_ = from.number();
    unpackTuples(from);
    if (!from.atEnd()) Unpacker::refuse();
    return true;
}

/// Reads five numbers for each node: its halves, later nodes, the box that is halved, and its
/// bound.
void PoseSearcher::readTree(const std::vector<std::uint32_t>& numbers) {
    constexpr std::size_t kNode = 5, kMaxDepth = std::size_t{64} * kMaxPosed;
    if (numbers.size() % kNode != 0) Unpacker::refuse();
    const std::size_t nodes = numbers.size() / kNode;
    std::vector<std::size_t> depths(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        const std::uint32_t* own = &numbers[kNode * i];
        if (own[2] > count_ || (i > 0 && depths[i] == 0)) Unpacker::refuse();
        for (const std::uint32_t half : {own[0], own[1]}) {
            if (half == 0) continue;
            if (half >= nodes || half <= i || depths[half] != 0 || depths[i] == kMaxDepth)
                Unpacker::refuse();
            depths[half] = depths[i] + 1;
        }
        const double bound = std::bit_cast<double>(std::uint64_t{own[3]} << 32U | own[4]);
        if (!std::isfinite(bound) || bound < 0) Unpacker::refuse();
        tree_.push_back({{own[0], own[1]}, static_cast<int>(own[2]) - 1, bound});
    }
}

void PoseSearcher::unpackTuples(Unpacker& from) {
    constexpr std::size_t kNumbers = kMaxPosed + 1;
    const auto bounds = from.all<std::uint64_t>();
    const auto tuples = from.all<std::uint32_t>(), tree = from.all<std::uint32_t>();
    if (tuples.size() != kNumbers * bounds.size()) Unpacker::refuse();
    readTree(tree);
    std::vector<BoxId> open;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        Tuple tuple{std::bit_cast<double>(bounds[i]), {}, tuples[kNumbers * i + kMaxPosed]};
        if (!std::isfinite(tuple.bound) || tuple.bound < 0 || tuple.node >= tree_.size())
            Unpacker::refuse();
        for (std::size_t k = 0; k < kMaxPosed; ++k) {
            tuple.boxes[k] = tuples[kNumbers * i + k];
            if (tuple.boxes[k] >= boxes_.size()) Unpacker::refuse();
            if (k < count_) open.push_back(tuple.boxes[k]);
        }
        queue_.push(tuple);
    }
    boxes_.addMissingViews(std::move(open));
}

}  // namespace ispace::proofs::poses

// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/open_nodes.h"

#include <iterator>

namespace ispace {
namespace {

// A node of a map takes some more than what is in it.
constexpr std::size_t kOverhead = 160;
// What is made of the nodes that are looked at together is at most about this part of the memory.
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
    bytes_ += ownBytes(node);
    hold(node.problem.get(), node.problem->bytes());
    hold(node.multipliers.get(), bytesOf(*node.multipliers));
    for (const BranchGroup& group : node.groups) hold(group.list.get(), bytesOf(*group.list));
    const Key key(~node.bound, next_++);
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
    std::size_t bytes = 0;
    const bool is_full = bytes_ > most_bytes_;
    while (batch.size() < most && !nodes_.empty()) {
        Key key = nodes_.begin()->first;
        if (is_full) key = {std::prev(by_age_.end())->second, std::prev(by_age_.end())->first};
        bytes += nodes_.at(key).problem->bytes();
        if (!batch.empty() && bytes > most_bytes_ / kBatchPart) break;
        batch.push_back(remove(key));
    }
    return batch;
}

std::uint64_t OpenNodes::dropUpTo(std::uint64_t cut) {
    std::uint64_t highest = 0;
    while (!nodes_.empty() && ~std::prev(nodes_.end())->first.first <= cut)
        highest = remove(Key(std::prev(nodes_.end())->first)).bound;
    return highest;
}

}  // namespace ispace

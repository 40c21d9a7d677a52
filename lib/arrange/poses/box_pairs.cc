// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/poses/box_pairs.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <queue>

namespace ispace::poses {

double BoxPairs::mostOf(BoxId first, BoxId second) const {
    constexpr int kMostVisits = 64;
    const auto is_apart = [this](BoxId a, BoxId b) {
        return boxes_[a].high <= boxes_[b].low || boxes_[b].high <= boxes_[a].low;
    };
    const auto is_within = [this](BoxId a, BoxId b) {
        return boxes_[b].low <= boxes_[a].low && boxes_[a].high <= boxes_[b].high;
    };
    if (pairs_.empty()) return std::numeric_limits<double>::infinity();
    thread_local std::vector<std::uint32_t> stack;  // memory is reused
    stack.assign(1, 0);
    double most = 0;
    for (int visits = 0; !stack.empty(); ++visits) {
        const PairNode& pair = pairs_[stack.back()];
        stack.pop_back();
        if (pair.most <= most || is_apart(pair.boxes[0], first) || is_apart(pair.boxes[1], second))
            continue;
        if (!pair.is_split || visits >= kMostVisits ||
            (is_within(pair.boxes[0], first) && is_within(pair.boxes[1], second))) {
            most = pair.most;
            continue;
        }
        for (std::uint32_t i = 0; i < pair.children; ++i) stack.push_back(pair.child + i);
    }
    return most;
}

double BoxPairs::unionOf(BoxId first, BoxId second) const {
    using Known = PoseBoxes::Known;
    const Known a{{first}, 1, boxes_[first].most}, b{{second}, 1, boxes_[second].most};
    const Known both[] = {a, b};
    const BoxId ids[] = {first, second};
    const Grain grain = boxes_.areWithinCells(Grain::Large, ids) ? Grain::Fine : Grain::Large;
    return std::min({boxes_.unionOf(both, {}, grain), boxes_.unionOf({}, ids, grain),
                     boxes_.unionOf({&a, 1}, {&second, 1}, grain),
                     boxes_.unionOf({&b, 1}, {&first, 1}, grain)});
}

void BoxPairs::lower(std::uint32_t id) {
    while (true) {
        PairNode& pair = pairs_[id];
        double most = 0;
        for (std::uint32_t i = 0; i < pair.children; ++i)
            most = std::max(most, pairs_[pair.child + i].most);
        if (!(most < pair.most)) return;
        pair.most = most;
        if (id == 0) return;
        id = pair.parent;
    }
}

void BoxPairs::split(const std::vector<std::uint32_t>& ids) {
    std::vector<std::size_t> which;
    std::vector<BoxId> to_split;
    for (const std::uint32_t id : ids) {
        which.push_back(boxes_.widestOf(pairs_[id].boxes));
        to_split.push_back(pairs_[id].boxes[which.back()]);
    }
    boxes_.splitWithViews(to_split);
    std::vector<std::vector<PairNode>> made(ids.size());
    tbb::parallel_for(std::size_t{0}, ids.size(), [&](std::size_t i) {
        const PairNode& pair = pairs_[ids[i]];
        const BoxId child = boxes_[to_split[i]].child;
        for (BoxId half = child; half < child + 2; ++half) {
            if (!boxes_.isInOrder(pair.boxes, which[i], half)) continue;
            PairNode next{.boxes = pair.boxes, .parent = ids[i]};
            next.boxes[which[i]] = half;
            const double both = boxes_[next.boxes[0]].most + boxes_[next.boxes[1]].most;
            next.most = std::min({pair.most, both, unionOf(next.boxes[0], next.boxes[1])});
            made[i].push_back(next);
        }
    });
    for (std::size_t i = 0; i < ids.size(); ++i) {
        PairNode& pair = pairs_[ids[i]];
        pair.is_split = true;
        pair.child = static_cast<std::uint32_t>(pairs_.size());
        pair.children = static_cast<std::uint32_t>(made[i].size());
        pairs_.insert(pairs_.end(), made[i].begin(), made[i].end());
        lower(ids[i]);
    }
}

void BoxPairs::search(std::size_t most, const std::function<bool()>& is_stopped) {
    constexpr std::size_t kBatch = 256;
    const auto is_less = [this](std::uint32_t a, std::uint32_t b) {
        return pairs_[a].most != pairs_[b].most ? pairs_[a].most < pairs_[b].most : a > b;
    };
    std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, decltype(is_less)> queue(
        is_less);
    if (pairs_.empty()) pairs_.push_back({.boxes = {0, 0}, .most = 2 * boxes_[0].most});
    std::vector<BoxId> open;
    for (std::uint32_t id = 0; id < pairs_.size(); ++id) {
        if (pairs_[id].is_split) continue;
        queue.push(id);
        open.insert(open.end(), pairs_[id].boxes.begin(), pairs_[id].boxes.end());
    }
    boxes_.addMissingViews(std::move(open));
    while (!queue.empty() && pairs_.size() < most && !is_stopped()) {
        std::vector<std::uint32_t> batch;
        while (!queue.empty() && batch.size() < kBatch) {
            const std::uint32_t id = queue.top();
            if (pairs_[id].most <= 0) break;
            queue.pop();
            if (boxes_.widestOf(pairs_[id].boxes) < 2) batch.push_back(id);
        }
        if (batch.empty()) return;
        split(batch);
        for (const std::uint32_t id : batch)
            for (std::uint32_t i = 0; i < pairs_[id].children; ++i)
                queue.push(pairs_[id].child + i);
    }
}

void BoxPairs::write(std::uint32_t id, std::string& text) const {
    const PairNode& pair = pairs_[id];
    if (!pair.is_split) {
        text += '.';
        return;
    }
    const std::size_t which = boxes_.widestOf(pair.boxes);
    text += static_cast<char>('0' + which);
    const BoxId child = boxes_[pair.boxes[which]].child;
    std::uint32_t next = pair.child;
    for (BoxId half = child; half < child + 2; ++half)
        if (next < pair.child + pair.children && pairs_[next].boxes[which] == half)
            write(next++, text);
        else
            text += '-';
}

std::string BoxPairs::text() const {
    std::string text;
    if (!pairs_.empty()) write(0, text);
    return text;
}

}  // namespace ispace::poses

// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/poses/pose_boxes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "base/simd.h"

namespace ispace::poses {

namespace {

ISPACE_SIMD_CLONES void addParts(std::uint8_t* sums, const std::uint8_t* parts,
                                 const std::uint8_t* most, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto sum = static_cast<std::uint8_t>(sums[i] + parts[i]);
        sums[i] = sum < most[i] ? sum : most[i];
    }
}

ISPACE_SIMD_CLONES std::uint32_t sumOf(const std::uint8_t* parts, std::size_t count) {
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) sum += parts[i];
    return sum;
}

}  // namespace

CellParts::CellParts(const std::vector<std::uint8_t>& all) {
    const auto is_some = [](std::uint8_t part) { return part != 0; };
    const auto begin = std::find_if(all.begin(), all.end(), is_some);
    const auto end = std::find_if(all.rbegin(), all.rend(), is_some).base();
    if (begin >= end) return;
    first = static_cast<std::size_t>(begin - all.begin());
    parts.assign(begin, end);
}

PoseBoxes::PoseBoxes(const PoseFloor& floor, const Sector& sector)
    : floor_(floor), sector_(sector) {
    boxes_.push_back(nodeOf({floor.box(), 0, sector.isRound() ? 0 : 2 * std::numbers::pi}, 0));
    boxes_.front().high = std::uint64_t{1} << 62U;
}

BoxNode PoseBoxes::nodeOf(const PoseBox& box, BoxId parent) const {
    BoxNode node;
    node.box = box;
    node.parent = parent;
    const FatView view = fatViewOf(floor_, sector_, box);
    node.parts = CellParts(view.parts);
    node.most = view.area;
    const Point2 middle = box.at.center();
    node.centre =
        CellParts(fatViewOf(floor_, sector_, {{middle, middle}, box.from + box.span / 2, 0}).parts);
    return node;
}

double PoseBoxes::slackOf(const PoseBox& box) const {
    const double rim = sector_.range * (2 + std::min(sector_.field, 2 * std::numbers::pi)) / 2;
    return (box.at.width() + box.at.depth()) / 2 * rim + turnOf(box);
}

double PoseBoxes::turnOf(const PoseBox& box) const {
    return sector_.isRound() ? 0 : box.span * sector_.range * sector_.range / 2;
}

std::array<BoxNode, 2> PoseBoxes::halvesOf(BoxId id) const {
    const BoxNode& node = boxes_[id];
    PoseBox first = node.box, second = node.box;
    if (turnOf(node.box) > slackOf(node.box) / 2) {
        first.span = second.span = node.box.span / 2;
        second.from += first.span;
    } else if (node.box.at.width() > node.box.at.depth()) {
        first.at.high.x = second.at.low.x = node.box.at.center().x;
    } else {
        first.at.high.y = second.at.low.y = node.box.at.center().y;
    }
    std::array<BoxNode, 2> halves = {nodeOf(first, id), nodeOf(second, id)};
    const std::uint64_t middle = node.low + (node.high - node.low) / 2;
    halves[0].low = node.low;
    halves[0].high = halves[1].low = middle;
    halves[1].high = node.high;
    return halves;
}

void PoseBoxes::split(std::vector<BoxId> ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    std::erase_if(ids, [this](BoxId id) { return boxes_[id].child != 0; });
    std::vector<std::array<BoxNode, 2>> made(ids.size());
    tbb::parallel_for(std::size_t{0}, ids.size(),
                      [&](std::size_t i) { made[i] = halvesOf(ids[i]); });
    for (std::size_t i = 0; i < ids.size(); ++i) {
        boxes_[ids[i]].child = static_cast<BoxId>(boxes_.size());
        for (BoxNode& half : made[i]) {
            half.most = std::min(half.most, boxes_[ids[i]].most);
            bytes_ += sizeof(BoxNode) + half.parts.parts.size() + half.centre.parts.size();
            boxes_.push_back(std::move(half));
        }
        lowerMost(ids[i]);
    }
}

void PoseBoxes::lowerMost(BoxId id) {
    while (true) {
        BoxNode& node = boxes_[id];
        const double most = std::max(boxes_[node.child].most, boxes_[node.child + 1].most);
        if (!(most < node.most)) return;
        node.most = most;
        if (id == 0) return;
        id = node.parent;
    }
}

double PoseBoxes::unionOf(std::span<const BoxId> boxes, CellParts BoxNode::*views) const {
    thread_local std::vector<std::uint8_t> sums;  // memory is reused
    const std::vector<std::uint8_t>& most = floor_.parts();
    sums.assign(most.size(), 0);
    std::size_t begin = most.size(), end = 0;
    for (const BoxId id : boxes) {
        const CellParts& view = boxes_[id].*views;
        if (view.parts.empty()) continue;
        addParts(&sums[view.first], view.parts.data(), &most[view.first], view.parts.size());
        begin = std::min(begin, view.first);
        end = std::max(end, view.first + view.parts.size());
    }
    if (begin >= end) return 0;
    return sumOf(&sums[begin], end - begin) * floor_.partArea();
}

std::size_t PoseBoxes::widestOf(std::span<const BoxId> boxes) const {
    constexpr double kFinest = 1e-4;  // m2: smaller boxes are hardly wider than kWiden
    std::size_t widest = boxes.size();
    double most = kFinest;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const BoxNode& node = boxes_[boxes[i]];
        const double slack = slackOf(node.box);
        if (node.high - node.low <= 1 || slack <= most) continue;
        most = slack;
        widest = i;
    }
    return widest;
}

bool PoseBoxes::isInOrder(std::span<const BoxId> boxes, std::size_t which, BoxId half) const {
    const BoxNode& node = boxes_[half];
    if (node.parts.parts.empty()) return false;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const BoxNode& other = boxes_[boxes[i]];
        if (i < which && node.high <= other.low) return false;
        if (i > which && other.high <= node.low) return false;
    }
    return true;
}

}  // namespace ispace::poses

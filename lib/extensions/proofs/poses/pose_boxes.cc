// SPDX-License-Identifier: GPL-3.0-or-later
// The subdivision of all poses. A box is halved where its fat view may shrink most: along x, along
// y or in its headings. Bounds of halves lower those of the boxes around them, so a box knows the
// largest single view in it ever more closely.
#include "extensions/proofs/poses/pose_boxes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "base/simd.h"
#include "extensions/proofs/poses/inner_bound.h"

namespace ispace::proofs::poses {

namespace {

ISPACE_SIMD_CLONES void addParts(std::uint8_t* sums, const std::uint8_t* parts,
                                 const std::uint8_t* most, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const auto sum = static_cast<std::uint8_t>(sums[i] + parts[i]);
        sums[i] = sum < most[i] ? sum : most[i];
    }
}

ISPACE_SIMD_CLONES void widen(std::int16_t* __restrict free, const std::uint8_t* most,
                              std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) free[i] = most[i];
}

/// Takes cores off the floor that is free.
ISPACE_SIMD_CLONES void takeCore(std::int16_t* __restrict free, const std::uint8_t* core,
                                 std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) free[i] = static_cast<std::int16_t>(free[i] - core[i]);
}

/// Returns the sum of parts, in each cell at most those that are free, which may be negative.
ISPACE_SIMD_CLONES std::int32_t sumWithin(const std::uint8_t* parts, const std::int16_t* free,
                                          std::size_t count) {
    std::int32_t sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto part = static_cast<std::int16_t>(parts[i]);
        sum += part < free[i] ? part : free[i];
    }
    return sum;
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
    BoxNode root;
    root.box = {floor.box(), 0, sector.isRound() ? 0 : 2 * std::numbers::pi};
    root.most = fatAreaOf(floor_, sector_, root.box);
    root.high = std::uint64_t{1} << 62U;
    addViews(root);
    boxes_.push_back(std::move(root));
}

void PoseBoxes::addViews(BoxNode& node) const {
    node.has_views = true;
    node.is_bare = false;
    if (node.isBlind()) return;
    const PoseBox& box = node.box;
    const OuterBound view = outerBoundOf(floor_, sector_, box);
    node.parts = CellParts(view.parts);
    node.most = std::min(node.most, view.area);
    node.core = CellParts(innerBoundOf(floor_, sector_, box));
    const PoseFloor& large = floor_.in(Grain::Large);
    node.large_parts = CellParts(outerBoundOf(large, sector_, box).parts);
    node.large_core = CellParts(innerBoundOf(large, sector_, box));
    const Point2 middle = box.at.center();
    const PoseBox centre{{middle, middle}, box.from + box.span / 2, 0};
    node.centre = CellParts(outerBoundOf(large, sector_, centre).parts);
}

void PoseBoxes::addLarge(BoxNode& node) const {
    node.is_large = true;
    node.is_bare = false;
    const PoseFloor& large = floor_.in(Grain::Large);
    const OuterBound view = outerBoundOf(large, sector_, node.box);
    node.most = std::min(node.most, view.area);
    if (node.isBlind()) return;
    node.large_parts = CellParts(view.parts);
    node.large_core = CellParts(innerBoundOf(large, sector_, node.box));
}

void PoseBoxes::addLargeViews(std::vector<BoxId> ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    std::vector<BoxId> halves;
    for (const BoxId id : ids)
        for (BoxId half = boxes_[id].child; half < boxes_[id].child + 2; ++half)
            if (!boxes_[half].hasLarge()) halves.push_back(half);
    std::vector<char> is_new;  // no views of an earlier run, which are in the sum
    is_new.reserve(halves.size());
    for (const BoxId half : halves) is_new.push_back(boxes_[half].is_bare ? 0 : 1);
    tbb::parallel_for(std::size_t{0}, halves.size(), [&](std::size_t i) {
        BoxNode& node = boxes_[halves[i]];
        node.has_views ? addViews(node) : addLarge(node);
    });
    for (std::size_t i = 0; i < halves.size(); ++i) {
        const BoxNode& node = boxes_[halves[i]];
        if (is_new[i] != 0) bytes_ += node.large_parts.parts.size() + node.large_core.parts.size();
    }
}

void PoseBoxes::splitWithLarge(std::vector<BoxId> ids) {
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    for (const BoxId id : ids) {
        if (boxes_[id].child != 0) continue;
        std::array<BoxNode, 2> halves = bareHalvesOf(id);
        boxes_[id].child = static_cast<BoxId>(boxes_.size());
        for (BoxNode& half : halves) {
            half.most = boxes_[id].most;
            bytes_ += sizeof(BoxNode);
            boxes_.push_back(std::move(half));
        }
    }
    addLargeViews(ids);
    for (const BoxId id : ids) lowerMost(id);
}

double PoseBoxes::rim() const {
    return sector_.range * (2 + std::min(sector_.field, 2 * std::numbers::pi)) / 2;
}

double PoseBoxes::slackOf(const PoseBox& box) const {
    return (box.at.width() + box.at.depth()) / 2 * rim() + turnOf(box);
}

double PoseBoxes::turnOf(const PoseBox& box) const {
    return sector_.isRound() ? 0 : box.span * sector_.range * sector_.range / 2;
}

std::array<BoxNode, 2> PoseBoxes::halvesOf(BoxId id) const {
    std::array<BoxNode, 2> halves = bareHalvesOf(id);
    for (BoxNode& half : halves) half.most = fatAreaOf(floor_, sector_, half.box);
    return halves;
}

std::array<BoxNode, 2> PoseBoxes::bareHalvesOf(BoxId id) const {
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
    std::array<BoxNode, 2> halves;
    halves[0].box = first;
    halves[1].box = second;
    for (BoxNode& half : halves) half.parent = id;
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
            bytes_ += sizeof(BoxNode);
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

BoxId PoseBoxes::largestIn(BoxId id) const {
    while (boxes_[id].child != 0) {
        const BoxId child = boxes_[id].child;
        id = boxes_[child].most >= boxes_[child + 1].most ? child : child + 1;
    }
    return id;
}

void PoseBoxes::splitWithViews(const std::vector<BoxId>& ids) {
    constexpr int kCloser = 4;  // further halvings of the part with the largest single view
    split(ids);
    std::vector<BoxId> halves, bare;
    for (const BoxId id : ids)
        for (BoxId half = boxes_[id].child; half < boxes_[id].child + 2; ++half) {
            if (boxes_[half].has_views) {
                if (boxes_[half].is_bare) bare.push_back(half);
                continue;
            }
            boxes_[half].has_views = true;
            halves.push_back(half);
        }
    addMissingViews(std::move(bare));
    tbb::parallel_for(std::size_t{0}, halves.size(),
                      [&](std::size_t i) { addViews(boxes_[halves[i]]); });
    for (const BoxId half : halves) {
        const BoxNode& node = boxes_[half];
        for (const CellParts* view : {&node.parts, &node.core, &node.centre})
            bytes_ += view->parts.size();
        if (!node.is_large)  // else these are in the sum
            bytes_ += node.large_parts.parts.size() + node.large_core.parts.size();
        lowerMost(node.parent);
    }
    for (int round = 0; round < kCloser; ++round) {
        std::vector<BoxId> largest;
        for (const BoxId half : halves) {
            if (boxes_[half].isBlind()) continue;
            const BoxId leaf = largestIn(half);
            if (widestOf({&leaf, 1}) == 0) largest.push_back(leaf);
        }
        split(std::move(largest));
    }
}

double PoseBoxes::unionOfCentres(std::span<const BoxId> boxes) const {
    thread_local std::vector<std::uint8_t> sums;  // memory is reused
    const std::vector<std::uint8_t>& most = floor_.in(Grain::Large).parts();
    sums.assign(most.size(), 0);
    for (const BoxId id : boxes) {
        const CellParts& view = boxes_[id].centre;
        addParts(&sums[view.first], view.parts.data(), &most[view.first], view.parts.size());
    }
    return floor_.in(Grain::Large).weightOf([](std::size_t first, std::size_t count) {
        return sumOf(&sums[first], count);
    });
}

bool PoseBoxes::areWithinCells(Grain grain, std::span<const BoxId> boxes) const {
    const double most = floor_.in(grain).side() * rim();
    return std::none_of(boxes.begin(), boxes.end(),
                        [&](BoxId id) { return slackOf(boxes_[id].box) > most; });
}

bool PoseBoxes::areSmall(std::span<const BoxId> boxes) const {
    const double most = 1.3 * sector_.area();
    return std::all_of(boxes.begin(), boxes.end(),
                       [&](BoxId id) { return slackOf(boxes_[id].box) < most; });
}

bool PoseBoxes::isWorthFine(double large, double enough, std::span<const BoxId> boxes) const {
    constexpr double kNear = 0.003;
    return large > enough && (large <= enough * (1 + kNear) || areWithinCells(Grain::Fine, boxes));
}

double PoseBoxes::unionFor(double enough, std::span<const BoxId> boxes,
                           std::span<const BoxId> known, std::span<const BoxId> others) const {
    const double large = unionOf(known, others, Grain::Large);
    return isWorthFine(large, enough, boxes) ? std::min(large, unionOf(known, others)) : large;
}

double PoseBoxes::unionOf(std::span<const BoxId> known, std::span<const BoxId> others,
                          Grain grain) const {
    thread_local std::vector<std::int16_t> free;  // memory is reused
    thread_local std::vector<std::uint8_t> fat;
    const std::vector<std::uint8_t>& most = floor_.in(grain).parts();
    double area = 0;
    free.resize(most.size());
    widen(free.data(), most.data(), most.size());
    fat.assign(most.size(), 0);
    for (const BoxId id : known) {
        area += boxes_[id].most;
        const CellParts& core = boxes_[id].coreIn(grain);
        takeCore(&free[core.first], core.parts.data(), core.parts.size());
    }
    for (const BoxId id : others) {
        const CellParts& view = boxes_[id].fatIn(grain);
        addParts(&fat[view.first], view.parts.data(), &most[view.first], view.parts.size());
    }
    // Cores are rounded down but for kNoShare of a cell.
    if (!known.empty())
        area += 8 * kNoShare * kParts * floor_.in(grain).partArea() * floor_.mostWeight() *
                static_cast<double>(most.size());
    return area + floor_.in(grain).weightOf([](std::size_t first, std::size_t count) {
        return sumWithin(&fat[first], &free[first], count);
    });
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
    if (node.isBlind()) return false;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const BoxNode& other = boxes_[boxes[i]];
        if (i < which && node.high <= other.low) return false;
        if (i > which && other.high <= node.low) return false;
    }
    return true;
}

void PoseBoxes::write(BoxId id, std::string& text) const {
    const BoxNode& node = boxes_[id];
    if (node.child == 0) {
        text += '.';
        return;
    }
    const PoseBox& half = boxes_[node.child].box;
    text += half.span != node.box.span ? 'h' : half.at.width() != node.box.at.width() ? 'x' : 'y';
    for (BoxId child = node.child; child < node.child + 2; ++child) write(child, text);
}

std::string PoseBoxes::text() const {
    std::string text;
    write(0, text);
    return text;
}

}  // namespace ispace::proofs::poses

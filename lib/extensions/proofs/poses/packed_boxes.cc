// SPDX-License-Identifier: GPL-3.0-or-later
// The tree of boxes as bytes, for a run that continues.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "extensions/proofs/poses/pose_boxes.h"

namespace ispace::proofs::poses {

namespace {

/// Reads an area. \throws FormatError if it is none
double areaFrom(std::uint64_t bits) {
    const auto area = std::bit_cast<double>(bits);
    if (!std::isfinite(area) || area < 0) Unpacker::refuse();
    return area;
}

}  // namespace

void PoseBoxes::pack(Packer& to) const {
    std::vector<std::uint64_t> most;
    std::vector<std::uint8_t> viewed;
    std::vector<BoxId> parents;  // of pairs of halves, in their order
    for (const BoxNode& node : boxes_) {
        most.push_back(std::bit_cast<std::uint64_t>(node.most));
        viewed.push_back(node.has_views ? 2 : node.is_large ? 1 : 0);
    }
    for (std::size_t id = 1; id < boxes_.size(); id += 2) parents.push_back(boxes_[id].parent);
    to.add(bytes_);
    to.addAll(parents);
    to.addAll(most);
    to.addAll(viewed);
}

void PoseBoxes::unpack(Unpacker& from) {
    const std::uint64_t bytes = from.number();
    const auto parents = from.all<BoxId>();
    const auto most = from.all<std::uint64_t>();
    const auto viewed = from.all<std::uint8_t>();
    if (most.size() != 2 * parents.size() + 1 || viewed.size() != most.size()) Unpacker::refuse();
    boxes_.resize(1);
    boxes_[0].child = 0;
    for (const BoxId parent : parents) {
        if (parent >= boxes_.size()) Unpacker::refuse();
        const BoxNode& node = boxes_[parent];
        if (node.child != 0 || node.high - node.low <= 1) Unpacker::refuse();
        for (BoxNode& half : bareHalvesOf(parent)) boxes_.push_back(std::move(half));
        boxes_[parent].child = static_cast<BoxId>(boxes_.size() - 2);
    }
    for (std::size_t id = 0; id < boxes_.size(); ++id) {
        boxes_[id].most = areaFrom(most[id]);
        if (viewed[id] > 2) Unpacker::refuse();
        if (id == 0 || viewed[id] == 0) continue;
        boxes_[id].is_bare = true;
        (viewed[id] == 1 ? boxes_[id].is_large : boxes_[id].has_views) = true;
    }
    bytes_ = bytes;
}

void PoseBoxes::addMissingViews(std::vector<BoxId> ids) {
    std::erase_if(ids, [this](BoxId id) { return !boxes_[id].is_bare; });
    std::sort(ids.begin(), ids.end());
    ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
    tbb::parallel_for(std::size_t{0}, ids.size(), [&](std::size_t i) { addViews(boxes_[ids[i]]); });
}

}  // namespace ispace::proofs::poses

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/far_holes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "env/point_location.h"
#include "geom/spatial_index.h"

namespace ispace {

namespace {

/// Bounds of the curves of all views.
std::vector<Box2> boundsOfViews(std::span<const CoveredSet> sets) {
    std::vector<Box2> boxes;
    for (const CoveredSet& set : sets)
        for (const Curve& curve : *set.region) boxes.push_back(bounds(curve));
    return boxes;
}

}  // namespace

FarHoles::FarHoles(const Regions& indoor, const std::vector<Region>& free_floor,
                   std::span<const Segment2> sheets)
    : floor_(free_floor) {
    const Box2 all = bounds(indoor);
    // Rounding in an overlay moves edges by less.
    margin_ = std::ldexp(std::max(all.width(), all.depth()), -25);
    std::vector<Box2> boxes;
    for (const Region& region : floor_)
        for (const Polygon& hole : region.holes) boxes.push_back(bounds(hole));
    is_lone_.resize(boxes.size());
    const auto add_edge = [&boxes](const Segment2& edge) { boxes.push_back(bounds(edge)); };
    for (const Region& region : floor_) forEachEdge(region.outline, add_edge);
    indoor.forEachEdge(add_edge);
    std::for_each(sheets.begin(), sheets.end(), add_edge);
    const BoxTree tree(boxes);
    parallelChunks(is_lone_.size() > kManyRecords, is_lone_.size(),
                   [&](std::size_t first, std::size_t last) {
                       for (std::size_t i = first; i < last; ++i) {
                           bool is_lone = true;
                           tree.search(boxes[i].expanded(margin_),
                                       [&](std::size_t k) { is_lone = is_lone && k == i; });
                           is_lone_[i] = static_cast<char>(is_lone);
                       }
                   });
}

std::vector<Curve> FarHoles::curvesWithout(std::span<const CoveredSet> sets) {
    const BoxTree views(boundsOfViews(sets));
    const auto is_seen = [&](const Polygon& hole) {
        bool is_near = false;
        views.search(bounds(hole).expanded(margin_), [&](std::size_t) { is_near = true; });
        return is_near;
    };
    std::vector<Curve> curves;
    far_.clear();
    auto is_lone = is_lone_.begin();
    for (const Region& region : floor_) {
        curves.push_back(curveOf(region.outline));
        for (const Polygon& hole : region.holes) {
            if (*is_lone++ != 0 && !is_seen(hole))
                far_.push_back(&hole);
            else
                curves.push_back(curveOf(hole));
        }
    }
    return curves;
}

void FarHoles::cutOut(std::vector<Region>& pieces, std::vector<double>& areas) const {
    std::vector<Box2> boxes;
    boxes.reserve(pieces.size());
    for (const Region& piece : pieces) boxes.push_back(bounds(piece.outline));
    const BoxTree tree(boxes);
    std::vector<std::optional<RegionIndex>> indices(pieces.size());
    std::vector<std::size_t> holders;
    for (const Polygon* const hole : far_) {
        const Point2 corner = hole->front();
        holders.clear();
        tree.search({corner, corner}, [&](std::size_t i) { holders.push_back(i); });
        // One of them holds it: the largest is looked at last.
        std::sort(holders.begin(), holders.end(),
                  [&](std::size_t i, std::size_t k) { return areas[i] < areas[k]; });
        const auto is_inside = [&](std::size_t i) {
            if (i == holders.back()) return true;
            if (!indices[i]) indices[i].emplace(std::span(&pieces[i], 1));
            return indices[i]->locate(corner) == Side::Inside;
        };
        const auto found = std::find_if(holders.begin(), holders.end(), is_inside);
        if (found == holders.end()) continue;
        pieces[*found].holes.push_back(*hole);
        areas[*found] += signedArea(*hole);
    }
}

}  // namespace ispace

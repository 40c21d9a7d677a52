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

Box2 grown(const Box2& box, double margin) {
    return {box.low - Vec2{margin, margin}, box.high + Vec2{margin, margin}};
}

/// Bounds of the curves of all views.
std::vector<Box2> boundsOfViews(std::span<const CoveredSet> sets) {
    std::vector<Box2> boxes;
    for (const CoveredSet& set : sets)
        for (const Curve& curve : *set.region) boxes.push_back(bounds(curve));
    return boxes;
}

/// Bounds of all holes, and of the edges of all other boundaries.
std::vector<Box2> boundsOfFloor(const FloorCurves& floor, std::span<const Box2> holes,
                                std::span<const Segment2> sheets) {
    std::vector<Box2> boxes(holes.begin(), holes.end());
    const auto add_edges = [&boxes](const Curve& curve) {
        for (const CurveEdge& edge : curve) boxes.push_back(bounds(Curve{edge}));
    };
    for (const Curve& curve : floor.indoor) add_edges(curve);
    for (std::size_t i = 0; i < floor.free.size(); ++i)
        if (holes[i].empty()) add_edges(floor.free[i]);
    for (const Segment2& sheet : sheets) boxes.push_back(bounds(sheet));
    return boxes;
}

}  // namespace

FarHoles::FarHoles(FloorCurves& floor, std::span<const CoveredSet> sets,
                   std::span<const Segment2> sheets) {
    std::vector<Curve>& free = floor.free;
    std::vector<Box2> boxes(free.size());  // empty: an outline
    Box2 all;
    for (std::size_t i = 0; i < free.size(); ++i) {
        const Box2 box = bounds(free[i]);
        all.add(box.low);
        all.add(box.high);
        if (signedArea(free[i]) < 0) boxes[i] = box;
    }
    // Rounding in an overlay moves edges by less.
    const double margin = std::ldexp(std::max(all.width(), all.depth()), -25);
    const BoxTree views(boundsOfViews(sets)), others(boundsOfFloor(floor, boxes, sheets));
    std::vector<char> is_far(free.size());
    parallelChunks(
        free.size() > kManyRecords, free.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i) {
                if (boxes[i].empty()) continue;
                const Box2 near = grown(boxes[i], margin);
                bool is_alone = true;
                views.search(near, [&](std::size_t) { is_alone = false; });
                others.search(near, [&](std::size_t k) { is_alone = is_alone && k == i; });
                is_far[i] = static_cast<char>(is_alone);
            }
        });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < free.size(); ++i) {
        if (is_far[i] != 0)
            holes_.push_back(chords(free[i]));
        else if (i != kept++)
            free[kept - 1] = std::move(free[i]);
    }
    free.resize(kept);
}

void FarHoles::cutOut(std::vector<Region>& pieces, std::vector<double>& areas) const {
    std::vector<Box2> boxes;
    boxes.reserve(pieces.size());
    for (const Region& piece : pieces) boxes.push_back(bounds(piece.outline));
    const BoxTree tree(boxes);
    std::vector<std::optional<RegionIndex>> indices(pieces.size());
    std::vector<std::size_t> holders;
    for (const Polygon& hole : holes_) {
        const Point2 corner = hole.front();
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
        pieces[*found].holes.push_back(hole);
        areas[*found] += signedArea(hole);
    }
}

}  // namespace ispace

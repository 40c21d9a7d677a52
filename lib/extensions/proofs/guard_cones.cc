// SPDX-License-Identifier: GPL-3.0-or-later
// Sight over triangles, as triangular expansion does it (F. Bungiu et al., Efficient computation of
// visibility polygons, 2014): a cone leaves a triangle by an edge and is narrowed by its ends. This
// is other code than that of the search, which uses VisibilityMap.
#include "extensions/proofs/guard_cones.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "base/error.h"
#include "geom/predicates.h"

namespace ispace::proofs {

namespace {

/// Distances within this share of the extent of the floor are none; roundings are a thousandth of
/// it.
constexpr double kBlur = 0x1p-40;

/// Most cones in memory, and most tests whether a point is in a triangle.
constexpr std::size_t kMaxCones = 1'000'000, kMaxStarts = 50'000'000;

}  // namespace

GuardFloor::GuardFloor(std::span<const Region> floor, std::string name)
    : floor_(floor, 1), name_(std::move(name)) {
    const Box2& box = floor_.box();
    extent_ = std::max(
        {std::abs(box.low.x), std::abs(box.low.y), std::abs(box.high.x), std::abs(box.high.y)});
}

void GuardFloor::refuse(const std::string& message) const {
    throw FormatError({name_, 0, 0, message});
}

poses::Convex GuardFloor::outlineOf(std::size_t triangle) const {
    const poses::PoseFloor::Corners corners = floor_.cornersOf(triangle);
    return {corners.begin(), corners.end()};
}

double GuardFloor::blurAt(const GuardCone& cone, Point2 end, Point2 p) const {
    return kBlur * extent_ * (1 + length(p - cone.apex) / length(end - cone.apex));
}

/// Triangles around a point, with a margin for rounding, are seen whole; through each of their
/// edges the lines of sight go on. Points are joined in their order, whatever the threads.
GuardCones GuardFloor::conesFrom(std::span<const Point2> points, bool must_be_on) const {
    const std::size_t count = floor_.triangles().size();
    if (points.size() > kMaxStarts / std::max<std::size_t>(count, 1))
        refuse("too many witnesses for a floor of " + std::to_string(count) + " triangles");
    std::atomic<std::size_t> cones = 0;
    std::vector<Sight> own(points.size());
    std::vector<char> is_off(points.size());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
        const Point2 at = points[i];
        std::vector<char> is_start(count);
        for (std::size_t t = 0; t < count; ++t) {
            const poses::PoseFloor::Corners corners = floor_.cornersOf(t);
            bool is_in = true;
            for (std::size_t k = 0; k < 3 && is_in; ++k) {
                const Segment2 edge{corners[k], corners[(k + 1) % 3]};
                is_in = cross(edge.b - edge.a, at - edge.a) >= 0;
            }
            for (std::size_t k = 0; k < 3 && !is_in; ++k)
                is_in = distance(at, Segment2{corners[k], corners[(k + 1) % 3]}) <= kBlur * extent_;
            is_start[t] = is_in ? 1 : 0;
            if (is_in)
                own[i].emplace_back(t, GuardCone{static_cast<std::uint32_t>(i), true, at, at, at});
        }
        is_off[i] = std::find(is_start.begin(), is_start.end(), 1) == is_start.end() ? 1 : 0;
        for (std::size_t t = 0; t < count; ++t)
            for (std::size_t edge = 0; edge < 3 && is_start[t] != 0; ++edge)
                follow({static_cast<std::uint32_t>(i), false, at, at, at}, t, edge, is_start, cones,
                       own[i]);
    });
    if (must_be_on && std::find(is_off.begin(), is_off.end(), 1) != is_off.end())
        refuse("a witness is not on the floor");
    GuardCones all(count);
    for (Sight& sight : own) {
        for (const auto& [t, cone] : sight) all[t].push_back(cone);
        Sight().swap(sight);
    }
    return all;
}

/// Follows all lines of sight that leave a triangle with the apex by an edge.
void GuardFloor::follow(const GuardCone& first, std::size_t triangle, std::size_t edge,
                        const std::vector<char>& is_start, std::atomic<std::size_t>& cones,
                        Sight& sight) const {
    struct Step {
        std::size_t triangle, edge;  // that it leaves, and by which edge
        GuardCone cone;
    };
    const auto triangles = floor_.triangles();
    std::vector<Step> open;
    GuardCone cone = first;
    const auto ends_of = [&](std::size_t of, std::size_t k) {
        const auto& corners = triangles[of].corners;
        return std::pair(floor_.at(corners[k]), floor_.at(corners[(k + 1) % 3]));
    };
    std::tie(cone.right, cone.left) = ends_of(triangle, edge);
    open.push_back({triangle, edge, cone});
    while (!open.empty()) {
        const Step step = open.back();
        open.pop_back();
        const std::int32_t next = triangles[step.triangle].beyond[step.edge];
        if (next < 0) continue;
        const auto beyond = static_cast<std::size_t>(next);
        if (is_start[beyond] != 0) continue;
        if (++cones > kMaxCones) refuse("its points see the floor through too many edges");
        sight.emplace_back(beyond, step.cone);
        for (std::size_t k = 0; k < 3; ++k) {
            if (triangles[beyond].beyond[k] == static_cast<std::int32_t>(step.triangle)) continue;
            const auto [right, left] = ends_of(beyond, k);
            GuardCone narrow = step.cone;
            if (narrow.rightSide().beyond(right) < 0) narrow.right = right;
            if (narrow.leftSide().beyond(left) < 0) narrow.left = left;
            if (narrow.rightSide().beyond(narrow.left) > blurAt(narrow, narrow.right, narrow.left))
                continue;
            open.push_back({beyond, k, narrow});
        }
    }
}

double GuardFloor::missedBy(const GuardCones& cones) const {
    double missed = 0;
    for (std::size_t t = 0; t < cones.size(); ++t) {
        std::vector<poses::Convex> open = {outlineOf(t)};
        for (const GuardCone& cone : cones[t]) {
            if (cone.is_whole) open.clear();
            std::vector<poses::Convex> rest;
            for (poses::Convex& piece : open)
                for (const poses::Side2& side : {cone.rightSide(), cone.leftSide()}) {
                    poses::Convex inside, outside;
                    poses::divide(piece, side, inside, &outside);
                    if (!outside.empty()) rest.push_back(std::move(outside));
                    piece = std::move(inside);
                }
            open = std::move(rest);
        }
        for (const poses::Convex& piece : open) missed += poses::areaOf(piece);
    }
    return missed;
}

}  // namespace ispace::proofs

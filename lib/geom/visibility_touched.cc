// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <limits>

#include "geom/polygon.h"
#include "geom/predicates.h"
#include "geom/visibility_mesh.h"

namespace ispace {

namespace {

using Index = std::uint32_t;

double squaredLength(Vec2 v) { return dot(v, v); }

constexpr double kSquaredEpsilon = kRayEpsilon * kRayEpsilon;

}  // namespace

void TouchedLines::gather(Point2 p, Index triangle) {
    lines_.clear();
    triangles_.clear();
    many_.clear();
    add(triangle);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        for (Index edge = 3 * triangles_[i], k = 0; k < 3; ++k, ++edge) {
            if (squaredDistance(p, edge) > kSquaredEpsilon) continue;
            if (mesh_.isLine(edge)) lines_.push_back(edge);
            const Index behind = mesh_.portals[edge].behind;
            if (behind != Portal::kFree) add(behind / 3);
        }
    }
}

Point2 TouchedLines::moved(Point2 p) const {
    double least = kSquaredEpsilon;
    Point2 nearest = p;
    bool is_vertex = false;
    for (const Index edge : lines_) {
        for (const Index end : {nextOf(edge), beforeOf(edge)}) {
            const double squared = squaredLength(mesh_.portals[end].corner - p);
            if (!(squared <= least)) continue;
            least = squared;
            nearest = mesh_.portals[end].corner;
            is_vertex = true;
        }
    }
    if (is_vertex) return nearest;
    least = std::numeric_limits<double>::infinity();
    for (const Index edge : lines_) {
        const double squared = squaredDistance(p, edge);
        if (!(squared < least)) continue;
        least = squared;
        nearest = nearestPoint(wallOf(edge), p);
    }
    return nearest;
}

std::span<const Index> TouchedLines::bothSides() {
    const std::size_t count = lines_.size();
    for (std::size_t i = 0; i < count; ++i) lines_.push_back(mesh_.portals[lines_[i]].behind);
    std::sort(lines_.begin(), lines_.end());
    lines_.erase(std::unique(lines_.begin(), lines_.end()), lines_.end());
    return lines_;
}

Segment2 TouchedLines::wallOf(Index edge) const {
    return {mesh_.portals[nextOf(edge)].corner, mesh_.portals[beforeOf(edge)].corner};
}

double TouchedLines::squaredDistance(Point2 p, Index edge) const {
    return squaredLength(nearestPoint(wallOf(edge), p) - p);
}

void TouchedLines::add(Index triangle) {
    // Seldom more than a few.
    constexpr std::size_t kFew = 32;
    if (triangles_.size() < kFew) {
        if (std::find(triangles_.begin(), triangles_.end(), triangle) != triangles_.end()) return;
    } else {
        if (many_.empty()) many_.insert(triangles_.begin(), triangles_.end());
        if (!many_.insert(triangle).second) return;
    }
    triangles_.push_back(triangle);
}

}  // namespace ispace

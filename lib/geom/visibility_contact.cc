// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/visibility_contact.h"

#include <algorithm>
#include <limits>

namespace ispace {

namespace {

using Index = std::uint32_t;

double squaredLength(Vec2 v) { return dot(v, v); }

constexpr double kSquaredContact = kSightContact * kSightContact;

}  // namespace

void ContactFinder::gather(Point2 p, Index triangle) {
    lines_.clear();
    triangles_.clear();
    many_.clear();
    add(triangle);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        for (Index edge = 3 * triangles_[i], k = 0; k < 3; ++k, ++edge) {
            if (squaredDistance(p, edge) > kSquaredContact) continue;
            if (mesh_.isLine(edge)) lines_.push_back(edge);
            const Index behind = mesh_.doors[edge].behind;
            if (behind != Door::kFree) add(behind / 3);
        }
    }
}

Point2 ContactFinder::moved(Point2 p) const {
    double least = kSquaredContact;
    Point2 nearest = p;
    bool is_vertex = false;
    for (const Index edge : lines_) {
        for (const Index end : {nextOf(edge), beforeOf(edge)}) {
            const double squared = squaredLength(mesh_.doors[end].corner - p);
            if (!(squared <= least)) continue;
            least = squared;
            nearest = mesh_.doors[end].corner;
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

std::span<const Index> ContactFinder::bothSides() {
    const std::size_t count = lines_.size();
    for (std::size_t i = 0; i < count; ++i) lines_.push_back(mesh_.doors[lines_[i]].behind);
    std::sort(lines_.begin(), lines_.end());
    lines_.erase(std::unique(lines_.begin(), lines_.end()), lines_.end());
    return lines_;
}

Segment2 ContactFinder::wallOf(Index edge) const {
    return {mesh_.doors[nextOf(edge)].corner, mesh_.doors[beforeOf(edge)].corner};
}

double ContactFinder::squaredDistance(Point2 p, Index edge) const {
    return squaredLength(nearestPoint(wallOf(edge), p) - p);
}

void ContactFinder::add(Index triangle) {
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

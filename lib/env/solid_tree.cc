// SPDX-License-Identifier: GPL-3.0-or-later
#include "env/solid_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "geom/predicates.h"

namespace ispace {

namespace {

std::vector<Box2> boxesOf(const std::vector<Polygon>& solids) {
    std::vector<Box2> boxes;
    boxes.reserve(solids.size());
    for (const Polygon& solid : solids) boxes.push_back(bounds(solid));
    return boxes;
}

double distanceFromEdges(const Polygon& solid, Point2 p) {
    double least = std::numeric_limits<double>::infinity();
    forEachEdge(solid, [&](const Segment2& edge) { least = std::min(least, distance(p, edge)); });
    return least;
}

}  // namespace

SolidTree::SolidTree(std::vector<Polygon> solids)
    : solids_(std::move(solids)), boxes_(boxesOf(solids_)) {}

bool SolidTree::isInside(Point2 p, double contact) const {
    bool inside = false;
    boxes_.search({p, p}, [&](std::size_t i) {
        inside = inside || (locate(solids_[i], p) == Side::Inside &&
                            distanceFromEdges(solids_[i], p) > contact);
    });
    return inside;
}

std::vector<Polygon> SolidTree::touching(Point2 p, double contact) const {
    const Vec2 reach{contact, contact};
    std::vector<Polygon> touching;
    boxes_.search({p - reach, p + reach}, [&](std::size_t i) {
        if (distanceFromEdges(solids_[i], p) <= contact) touching.push_back(solids_[i]);
    });
    return touching;
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/near_segments.h"

#include <algorithm>

namespace ispace {

namespace {

std::vector<Box2> boxesOf(std::span<const Segment2> segments) {
    std::vector<Box2> boxes(segments.size());
    for (std::size_t i = 0; i < segments.size(); ++i) {
        boxes[i].add(segments[i].a);
        boxes[i].add(segments[i].b);
    }
    return boxes;
}

}  // namespace

NearSegments::NearSegments(std::span<const Segment2> segments) : tree_(boxesOf(segments)) {}

std::vector<std::size_t> NearSegments::near(Point2 p, double reach) const {
    Box2 box;
    box.add(p);
    return near(box, reach);
}

std::vector<std::size_t> NearSegments::near(const Box2& box, double reach) const {
    const Vec2 margin{reach, reach};
    std::vector<std::size_t> found;
    tree_.search({box.low - margin, box.high + margin},
                 [&found](std::size_t i) { found.push_back(i); });
    std::sort(found.begin(), found.end());
    return found;
}

}  // namespace ispace

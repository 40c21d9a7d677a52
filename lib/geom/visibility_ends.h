// SPDX-License-Identifier: GPL-3.0-or-later
// Private to VisibilityMap.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/simd.h"
#include "geom/visibility.h"

namespace ispace {

/// Collects what ends sight, counter-clockwise; inline, as it is most of what a look does besides
/// finding its way.
class EndWriter {
  public:
    EndWriter(Point2 viewpoint, double range, std::vector<SightEnd>& ends)
        : viewpoint_(viewpoint), range_(range), ends_(ends) {}

    ISPACE_INLINE void addLine(std::uint32_t line, Point2 from, Point2 to) {
        if (has_arc_) flushArc();
        if (!ends_.empty()) {
            SightEnd& last = ends_.back();
            if (last.line == line && last.to == from &&
                cross(last.from - viewpoint_, to - viewpoint_) > 0) {
                last.to = to;
                return;
            }
        }
        // Else it has no width that doubles can tell.
        if (cross(from - viewpoint_, to - viewpoint_) > 0) ends_.push_back({from, to, line});
    }

    /// Nothing stops sight from one direction to another, less than a half turn on.
    void addFree(Vec2 from, Vec2 to) {
        const bool is_wide = dot(from, to) < 0;
        if (!is_wide && !(cross(from, to) > 0)) return;
        if (!has_arc_) arc_from_ = from;
        has_arc_ = true;
        // Up to here, a quarter turn at most was open: now it is less than three.
        const bool is_almost_three = is_wide && dot(arc_from_, to) >= 0 && cross(arc_from_, to) < 0;
        if (is_almost_three) addQuarter();
        for (int i = 0; i < 2 && dot(arc_from_, to) < 0; ++i) addQuarter();
        arc_to_ = to;
    }

    void finish() {
        if (has_arc_) flushArc();
        if (ends_.size() < 2) return;
        SightEnd& first = ends_.front();
        const SightEnd& last = ends_.back();
        if (first.line != last.line || last.to != first.from) return;
        const Vec2 from = last.from - viewpoint_, to = first.to - viewpoint_;
        if (!(cross(from, to) > 0)) return;
        if (first.line == SightEnd::kArc && dot(from, to) < 0) return;
        first.from = last.from;
        ends_.pop_back();
    }

  private:
    [[nodiscard]] Point2 onCircle(Vec2 direction) const {
        // In two steps: the square of a very short way may be nothing.
        const double size = std::max(std::abs(direction.x), std::abs(direction.y));
        const Vec2 scaled{direction.x / size, direction.y / size};
        return viewpoint_ + (range_ / std::sqrt(dot(scaled, scaled))) * scaled;
    }
    void addArc(Vec2 from, Vec2 to) {
        const Point2 a = onCircle(from), b = onCircle(to);
        if (cross(a - viewpoint_, b - viewpoint_) > 0) ends_.push_back({a, b, SightEnd::kArc});
    }
    void addQuarter() {
        const Vec2 to = perpendicular(arc_from_);
        addArc(arc_from_, to);
        arc_from_ = to;
    }
    void flushArc() {
        addArc(arc_from_, arc_to_);
        has_arc_ = false;
    }

    Point2 viewpoint_;
    double range_;
    std::vector<SightEnd>& ends_;
    bool has_arc_ = false;  // begun, and not yet written
    Vec2 arc_from_, arc_to_;
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Half-planes of boxes and rays, and clipping by them (I. E. Sutherland, G. W. Hodgman, Reentrant
// polygon clipping, 1974).
#include "extensions/proofs/poses/convex.h"

#include <cmath>

namespace ispace::proofs::poses {

void clip(Outline& polygon, const HalfPlane& half, Outline& spare) {
    const std::size_t n = polygon.size();
    bool is_cut = false;
    for (const Point2 p : polygon) is_cut = is_cut || half.beyond(p) > 0;
    if (!is_cut) return;
    spare.clear();
    for (std::size_t i = 0; i < n; ++i) {
        const Point2 a = polygon[i], b = polygon[i + 1 == n ? 0 : i + 1];
        const double da = half.beyond(a), db = half.beyond(b);
        if (da <= 0) spare.push_back(a);
        if ((da < 0 && db > 0) || (da > 0 && db < 0))
            spare.push_back(a + (da / (da - db)) * (b - a));
    }
    polygon.swap(spare);
    if (polygon.size() < 3) polygon.clear();
}

double areaOf(const Outline& polygon) {
    double twice = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        twice += cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return twice / 2;
}

HalfPlane besideRay(Point2 at, Vec2 way, double side) {
    const Vec2 normal = -side * perpendicular(way);
    return {normal, dot(normal, at - Point2())};
}

Vec2 wayAt(double angle) { return {std::cos(angle), std::sin(angle)}; }

Outline cornersOf(const Box2& box) {
    return {box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}};
}

HalfPlane aroundBox(const Box2& box, Vec2 normal) {
    const Point2 corner{normal.x > 0 ? box.high.x : box.low.x,
                        normal.y > 0 ? box.high.y : box.low.y};
    return {normal, dot(normal, corner - Point2())};
}

HalfPlane behindBox(const Box2& box, Vec2 normal) { return aroundBox(box, -normal).opposite(); }

}  // namespace ispace::proofs::poses

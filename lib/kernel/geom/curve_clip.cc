// SPDX-License-Identifier: GPL-3.0-or-later
#include "geom/curve_clip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace ispace {

namespace {

/// The points with x (or y) at most `limit`; of the opposite side if `sign` is -1.
struct CutLine {
    bool is_x;
    double sign;
    double limit;

    [[nodiscard]] double heightOf(Point2 p) const { return sign * ((is_x ? p.x : p.y) - limit); }
    [[nodiscard]] CutLine opposite() const { return {is_x, -sign, limit}; }
    [[nodiscard]] Point2 onLine(double along) const {
        return is_x ? Point2{limit, along} : Point2{along, limit};
    }
};

/// Angle from `from` to `to` in the direction of an arc, 0 to 2 pi.
double turnTo(Vec2 from, Vec2 to, double sign) {
    const double angle = std::atan2(sign * cross(from, to), dot(from, to));
    return angle < 0 ? angle + 2 * std::numbers::pi : angle;
}

/// Appends the parts of an edge that lie on the side.
void addParts(const CurveEdge& edge, const CutLine& side, Curve& parts) {
    const double at_from = side.heightOf(edge.from), at_to = side.heightOf(edge.to);
    if (!edge.isArc()) {
        if (at_from <= 0 && at_to <= 0) {
            parts.push_back(edge);
        } else if (at_from < 0 || at_to < 0) {
            const double share = at_from / (at_from - at_to);
            const Vec2 way = edge.to - edge.from;
            const Point2 cut =
                side.onLine(side.is_x ? edge.from.y + share * way.y : edge.from.x + share * way.x);
            if (at_from < 0)
                parts.push_back({edge.from, cut});
            else
                parts.push_back({cut, edge.to});
        }
        return;
    }
    const double radius = std::abs(edge.radius), sign = edge.radius > 0 ? 1 : -1;
    const double height = side.heightOf(edge.center);
    const Vec2 from = edge.from - edge.center;
    // By the chord: of ends that coincide but for rounding, turnTo() may be a whole turn.
    const double span = 2 * std::asin(std::min(1.0, length(edge.to - edge.from) / (2 * radius)));
    std::array<std::pair<double, Point2>, 2> cuts;
    std::size_t count = 0;
    if (std::abs(height) < radius) {
        const double half = std::sqrt((radius - height) * (radius + height));
        const double middle = side.is_x ? edge.center.y : edge.center.x;
        for (const double along : {middle - half, middle + half}) {
            const Point2 cut = side.onLine(along);
            const double turn = turnTo(from, cut - edge.center, sign);
            if (turn > 0 && turn < span) cuts[count++] = {turn, cut};
        }
        if (count == 2 && cuts[1].first < cuts[0].first) std::swap(cuts[0], cuts[1]);
    }
    CurveEdge part = edge;
    double begin = 0;
    for (std::size_t i = 0; i <= count; ++i) {
        const double end = i < count ? cuts[i].first : span;
        part.to = i < count ? cuts[i].second : edge.to;
        const double middle = std::atan2(from.y, from.x) + sign * (begin + end) / 2;
        const Point2 inner = edge.center + radius * Vec2{std::cos(middle), std::sin(middle)};
        if (side.heightOf(inner) <= 0 && part.from != part.to) parts.push_back(part);
        part.from = part.to;
        begin = end;
    }
}

/// The part of a curve on a side, closed along its line; empty if none is.
Curve partOn(const Curve& curve, const CutLine& side) {
    Curve parts;
    for (const CurveEdge& edge : curve) addParts(edge, side, parts);
    Curve closed;
    closed.reserve(2 * parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i) {
        closed.push_back(parts[i]);
        const Point2 next = parts[i + 1 == parts.size() ? 0 : i + 1].from;
        if (parts[i].to != next) closed.push_back({parts[i].to, next});
    }
    return closed;
}

}  // namespace

CutCurves cutAlong(std::span<const Curve> curves, const Box2& box) {
    CutCurves cut;
    for (const Curve& curve : curves) {
        if (box.contains(bounds(curve))) {
            cut.inside.push_back(curve);
            continue;
        }
        Curve rest = curve;
        for (const CutLine& side : {CutLine{true, -1, box.low.x}, CutLine{true, 1, box.high.x},
                                    CutLine{false, -1, box.low.y}, CutLine{false, 1, box.high.y}}) {
            if (Curve beyond = partOn(rest, side.opposite()); signedArea(beyond) != 0)
                cut.outside.push_back(std::move(beyond));
            rest = partOn(rest, side);
        }
        if (!rest.empty()) cut.inside.push_back(std::move(rest));
    }
    return cut;
}

}  // namespace ispace

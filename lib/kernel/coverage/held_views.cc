// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/held_views.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "geom/interval.h"
#include "scene/sensor/lens_resolution.h"

namespace ispace {

namespace {

/// Bounds of a quantity that is at least 0 inside a view, over the points of a rectangle.
struct Margin {
    double least = 0, most = 0;

    static Margin around(double value, double change) { return {value - change, value + change}; }
    friend Margin both(Margin a, Margin b) {
        return {std::min(a.least, b.least), std::min(a.most, b.most)};
    }
};

/// A level rectangle as a view sees it.
struct SeenRectangle {
    const FieldOfView& view;
    const DistortedPicture* picture;  ///< of a pinhole
    Vec2 half;
    double distance = 0, radius = 0;
    Vec3 center;  ///< in the frame of the view

    /// Bounds a function with this value at the centre whose gradient is `slope` times the forward
    /// axis plus `sign` times another.
    [[nodiscard]] Margin linear(double value, double slope, double sign, Vec3 axis) const {
        const Vec3 forward = view.frame.forward;
        return Margin::around(value, std::fabs(slope * forward.x + sign * axis.x) * half.x +
                                         std::fabs(slope * forward.y + sign * axis.y) * half.y);
    }
    [[nodiscard]] Margin range() const {
        return view.is_by_depth ? linear(view.max_range - center.x, 1, 0, view.frame.left)
                                : Margin::around(view.max_range - distance, radius);
    }
    [[nodiscard]] Margin pyramid() const {
        const Frame3& frame = view.frame;
        const Tangents& sides = view.sides;
        Margin margin{HUGE_VAL, HUGE_VAL};
        for (const auto& [tangent, sign, axis, along] :
             {std::tuple{sides.left, -1.0, frame.left, center.y},
              {sides.right, 1.0, frame.left, center.y},
              {sides.up, -1.0, frame.up, center.z},
              {sides.down, 1.0, frame.up, center.z}})
            margin = both(margin, linear(tangent * center.x + sign * along, tangent, sign, axis));
        return margin;
    }
    [[nodiscard]] Margin shape() const {
        switch (view.shape) {
            case FieldOfView::Shape::Pyramid:
                return pyramid();
            case FieldOfView::Shape::Window:
                return both(Margin::around(center.x - view.across * std::hypot(center.x, center.y),
                                           (1 + std::fabs(view.across)) * radius),
                            Margin::around(view.upright * distance - std::fabs(center.z),
                                           (1 + view.upright) * radius));
            case FieldOfView::Shape::Cone:
                return Margin::around(center.x - view.across * distance,
                                      (1 + std::fabs(view.across)) * radius);
            case FieldOfView::Shape::Picture:
                if (picture != nullptr) return distorted();
                break;
        }
        return {-HUGE_VAL, HUGE_VAL};
    }
    /// Bounds the rectangle in the plane at depth 1 by its corners, and the picture of that box.
    [[nodiscard]] Margin distorted() const {
        const Frame3& frame = view.frame;
        const Vec3 along_x = half.x * Vec3{frame.forward.x, frame.left.x, frame.up.x};
        const Vec3 along_y = half.y * Vec3{frame.forward.y, frame.left.y, frame.up.y};
        const Point3 middle{center.x, center.y, center.z};
        Interval depth{HUGE_VAL, -HUGE_VAL}, x = depth, y = depth;
        const auto widen = [](Interval& all, double one) {
            all = {std::min(all.low, one), std::max(all.high, one)};
        };
        for (const double i : {-1.0, 1.0})
            for (const double k : {-1.0, 1.0}) {
                const Point3 corner = middle + i * along_x + k * along_y;
                widen(depth, corner.x);
                widen(x, -corner.y / corner.x);
                widen(y, -corner.z / corner.x);
            }
        if (!(depth.high > 0)) return {-HUGE_VAL, -HUGE_VAL};
        if (!(depth.low > 0)) return {-HUGE_VAL, HUGE_VAL};
        const Interval inside = picture->margin(x, y);
        return {depth.low * inside.low, depth.low * inside.high};
    }
};

/// Bounds the pixels a metre within `radius` of a point, with a margin for rounding.
Interval densityAround(const FieldOfView& view, Vec3 center, double distance, double radius) {
    constexpr double kRounding = 1e-9;
    if (!(radius < distance)) return {0, HUGE_VAL};
    const Interval a_radian = view.resolution->around(center, radius);
    return {(1 - kRounding) * a_radian.low / (distance + radius),
            (1 + kRounding) * a_radian.high / (distance - radius)};
}

}  // namespace

HeldViews::HeldViews(std::span<const FieldOfView> views) : views_(views) {
    const FieldOfView& first = views.front();
    if (first.shape != FieldOfView::Shape::Picture) return;
    if (first.camera->lens == Lens::Pinhole)
        picture_.emplace(*first.camera);
    else
        table_.emplace(*first.camera);
}

bool HeldViews::isHeld(const FieldOfView& view, Point3 place) const {
    if (!table_) return view.holds(place);
    const Vec3 local = view.frame.toLocal(place);
    const double distance = std::sqrt(dot(local, local));
    if (!withinRange(distance, view.max_range) || !view.isDense(local)) return false;
    const PictureTable::Answer answer = table_->locate(local, distance);
    if (answer == PictureTable::Answer::Unsure) return view.points(local);
    return answer == PictureTable::Answer::Inside;
}

std::uint64_t HeldViews::holding(Point3 place, std::uint64_t among) const {
    std::uint64_t held = 0;
    for (std::uint64_t bits = among; bits != 0; bits &= bits - 1)
        if (isHeld(views_[static_cast<std::size_t>(std::countr_zero(bits))], place))
            held |= bits & -bits;
    return held;
}

HeldViews::Verdict HeldViews::decide(Point3 center, Vec2 half, std::uint64_t among) const {
    constexpr double kSlack = 1e-6;    // ranges are compared as float32
    constexpr double kMaxShare = 0.5;  // of the radius in the distance
    constexpr double kSteeper = 1.05;  // asin(x) / x is less up to kMaxShare
    const Vec3 way = center - views_.front().frame.origin;
    const double distance = std::sqrt(dot(way, way)), radius = std::sqrt(dot(half, half));
    const double slack = kSlack * (distance + radius), turn = kSteeper * radius / distance;
    const bool is_narrow = radius < kMaxShare * distance;
    Verdict verdict;
    for (std::uint64_t bits = among; bits != 0; bits &= bits - 1) {
        const FieldOfView& view = views_[static_cast<std::size_t>(std::countr_zero(bits))];
        const SeenRectangle seen{view,   picture_ ? &*picture_ : nullptr, half, distance,
                                 radius, view.frame.toLocal(center)};
        Margin margin = seen.range();
        if (!table_)
            margin = both(margin, seen.shape());
        else if (const auto answer = is_narrow ? table_->locate(seen.center, distance, turn)
                                               : PictureTable::Answer::Unsure;
                 answer == PictureTable::Answer::Outside)
            continue;
        else if (answer == PictureTable::Answer::Unsure)
            margin.least = -HUGE_VAL;
        if (view.least_density > 0) {
            const Interval density = densityAround(view, seen.center, distance, radius);
            if (density.high < view.least_density) continue;
            if (!(density.low > view.least_density)) margin.least = -HUGE_VAL;
        }
        if (margin.least > slack)
            verdict.held |= bits & -bits;
        else if (margin.most >= -slack)
            verdict.unsure |= bits & -bits;
    }
    return verdict;
}

}  // namespace ispace

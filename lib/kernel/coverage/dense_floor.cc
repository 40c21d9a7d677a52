// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/dense_floor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "coverage/level_set.h"
#include "geom/polygon.h"

namespace ispace {

namespace {

/// Samples along each side of a box.
constexpr int kSamples = 128;

/// Puts the edges that close a level set well beyond a box.
Box2 enlarged(const Box2& box) {
    constexpr double kShare = 0.06, kMinMargin = 1e-3;
    return box.expanded(kShare * std::max(box.width(), box.depth()) + kMinMargin);
}

}  // namespace

DenseFloor::DenseFloor(const LensResolution& lens, const Frame3& frame, double drop,
                       const Box2& box)
    : lens_(lens), frame_(frame), drop_(drop) {
    if (!box.empty()) box_ = enlarged(box);
}

DenseFloor::Sample DenseFloor::sampleAt(Point2 place) const {
    const Vec3 local = frame_.toLocal(frame_.origin + Vec3{place.x, place.y, drop_});
    return {lens_.at(local), std::sqrt(dot(local, local))};
}

void DenseFloor::sampleIn(const Box2& box, int side) {
    sampled_ = box;
    side_ = side;
    samples_.assign(static_cast<std::size_t>(side) * static_cast<std::size_t>(side), {});
}

DenseFloor::Bounds DenseFloor::boundsIn(const Box2& box) const {
    constexpr double kRounding = 1e-9;
    const Vec2 half{box.width() / 2, box.depth() / 2};
    const Point2 middle = box.low + half;
    const Vec3 local = frame_.toLocal(frame_.origin + Vec3{middle.x, middle.y, drop_});
    const double radius = (1 + kRounding) * length(half), distance = std::sqrt(dot(local, local));
    const Interval pixels = lens_.around(local, radius);
    return {{(1 - kRounding) * pixels.low, (1 + kRounding) * pixels.high},
            {(1 - kRounding) * std::max(0.0, distance - radius),
             (1 + kRounding) * (distance + radius)}};
}

namespace {

/// Returns true unless a box lies beside all of these polygons.
bool meets(const std::vector<Polygon>& polygons, const Box2& box) {
    bool is_inside = false;  // the centre, by parity
    for (const Polygon& polygon : polygons) {
        bool is_met = false;
        forEachEdge(polygon, [&](const Segment2& edge) {
            if (is_met || !box.meets(bounds(edge))) return;
            const auto side = [&](double x, double y) {
                return cross(edge.b - edge.a, Point2{x, y} - edge.a);
            };
            const auto [least, most] =
                std::minmax({side(box.low.x, box.low.y), side(box.high.x, box.low.y),
                             side(box.low.x, box.high.y), side(box.high.x, box.high.y)});
            is_met = least <= 0 && most >= 0;
        });
        if (is_met) return true;
        is_inside = is_inside != (locate(polygon, box.center()) == Side::Inside);
    }
    return is_inside;
}

}  // namespace

/// Splits boxes of the part until their bounds are those at its vertices, with a margin that covers
/// the error of chords, or they are small.
Interval DenseFloor::densitiesIn(const std::vector<Curve>& part) const {
    constexpr double kMargin = 1.01, kSlack = 1e-3;  // metres
    constexpr int kMaxDepth = 6;
    Interval range{HUGE_VAL, 0};
    std::vector<Polygon> polygons;
    Box2 all;
    for (const Curve& curve : part)
        for (const Point2 p : polygons.emplace_back(chords(curve))) {
            const Sample sample = sampleAt(p);
            range.low = std::min(range.low, sample.pixels / sample.distance / kMargin);
            range.high = std::max(range.high, sample.pixels / sample.distance * kMargin);
            all.add(p);
        }
    const auto widen = [&](const auto& self, const Box2& box, int depth) -> void {
        const auto [pixels, distance] = boundsIn(box);
        const double low = pixels.low / distance.high, high = pixels.high / distance.low;
        if (low >= range.low && high <= range.high) return;
        if (!meets(polygons, box)) return;
        if (depth == kMaxDepth) {
            range = {std::min(range.low, low), std::max(range.high, high)};
            return;
        }
        const Point2 middle = box.center();
        self(self, {box.low, middle}, depth + 1);
        self(self, {{middle.x, box.low.y}, {box.high.x, middle.y}}, depth + 1);
        self(self, {{box.low.x, middle.y}, {middle.x, box.high.y}}, depth + 1);
        self(self, {middle, box.high}, depth + 1);
    };
    if (!all.empty()) widen(widen, all.expanded(kSlack), 0);
    return range;
}

std::vector<Curve> DenseFloor::traced(double pixels_per_metre) {
    LevelFunction function;
    function.value = [&](Point2 p) { return sampleAt(p).over(pixels_per_metre); };
    function.sample = [&](int column, int row) {
        auto& sample = samples_[static_cast<std::size_t>(row) * static_cast<std::size_t>(side_) +
                                static_cast<std::size_t>(column)];
        if (!sample) sample = sampleAt(levelPlace(sampled_, side_, column, row));
        return sample->over(pixels_per_metre);
    };
    function.bounds = [&](const Box2& box) {
        const auto [pixels, distance] = boundsIn(box);
        return Interval{pixels.low / pixels_per_metre - distance.high,
                        pixels.high / pixels_per_metre - distance.low};
    };
    return levelSet(function, sampled_, side_);
}

std::vector<Curve> DenseFloor::least(double pixels_per_metre) {
    if (box_.empty()) return {};
    if (!most_) most_ = lens_.most();
    const double far = *most_ / pixels_per_metre;
    if (!(std::fabs(drop_) < far)) return {};
    const double reach = std::sqrt(far * far - drop_ * drop_);
    const Box2 wanted = common(box_, enlarged({{-reach, -reach}, {reach, reach}}));
    if (wanted.empty()) return {};
    constexpr double kFiner = 2;  // sample anew for parts of less than half the box
    const double size = std::max(wanted.width(), wanted.depth());
    if (samples_.empty() || !sampled_.contains(wanted) ||
        kFiner * size < std::max(sampled_.width(), sampled_.depth()))
        sampleIn(wanted, kSamples);
    return traced(pixels_per_metre);
}

std::vector<Curve> DenseFloor::alone(const LensResolution& lens, const Frame3& frame, double drop,
                                     const Box2& box, double pixels_per_metre) {
    DenseFloor floor(lens, frame, drop, box);
    if (floor.box_.empty()) return {};
    floor.sampleIn(floor.box_, kSamples);
    return floor.traced(pixels_per_metre);
}

}  // namespace ispace

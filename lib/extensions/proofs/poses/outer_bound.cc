// SPDX-License-Identifier: GPL-3.0-or-later
// Points that some pose of a box sees, by expansion from triangle to triangle: behind a portal lie
// the points between the two extreme lines of sight, which turn about corners of portals and touch
// the rectangle. Polygons around the range and the sector are circumscribed, cells rounded up: the
// result is a superset in doubles as well.
#include "extensions/proofs/poses/outer_bound.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "extensions/proofs/poses/convex.h"

namespace ispace::proofs::poses {

namespace {

double distanceToBox(Point2 p, const Box2& box) {
    const double x = std::max({box.low.x - p.x, p.x - box.high.x, 0.0});
    const double y = std::max({box.low.y - p.y, p.y - box.high.y, 0.0});
    return std::hypot(x, y);
}

bool meets(const PoseFloor::Corners& triangle, const Box2& box) {
    Box2 around;
    for (const Point2 p : triangle) around.add(p);
    if (!around.meets(box)) return false;
    const Outline corners = cornersOf(box);
    for (std::size_t i = 0; i < 3; ++i) {
        const Point2 a = triangle[i], b = triangle[(i + 1) % 3];
        bool is_outside = true;
        for (const Point2 p : corners) is_outside = is_outside && cross(b - a, p - a) < 0;
        if (is_outside) return false;
    }
    return true;
}

/// A line of sight that bounds the view on one side: from a corner of a wall on.
struct Limit {
    Point2 at;
    Vec2 way;
};

/// Expands the view of a rectangle from triangle to triangle (as VisibilityMap does for points),
/// between two limits: the extreme lines that the corners of the portals on both sides leave to
/// sources in the rectangle.
class WeakView {
  public:
    /// \param tally collects the view by cells; null: its area is wanted alone
    WeakView(const PoseFloor& floor, const Sector& sector, const PoseBox& box,
             PoseFloor::Tally* tally)
        : floor_(floor), sector_(sector), box_(box), tally_(tally) {
        box_.at = box.at.expanded(kWiden);
        addRange();
        addField();
    }

    /// Returns the area of the view; none, if the box holds no floor.
    std::optional<double> compute();

  private:
    void addRange();
    void addField();
    /// Adds the part of a polygon within range and field; returns false if there is none.
    bool add(const Outline& polygon);
    void count(const Outline& polygon);
    void expandFrom(std::size_t triangle, std::size_t edge);
    void expand(std::size_t triangle, std::uint32_t right, std::uint32_t left, Limit right_limit,
                Limit left_limit);
    /// Returns the extreme way of a line of sight that passes a corner of the portal and, on its
    /// other side, all corners so far. \param side 1: the corner is on the left, -1: on the right
    [[nodiscard]] Vec2 extremeWay(Point2 corner, Point2 opposite, double side) const;
    [[nodiscard]] bool isFar(Point2 a, Point2 b) const;

    static constexpr std::size_t kMaxSteps = 20'000;  // more: all floor within range is taken

    const PoseFloor& floor_;
    const Sector& sector_;
    PoseBox box_;
    std::vector<HalfPlane> range_;
    std::vector<std::vector<HalfPlane>> fields_;  // disjoint convex parts
    std::vector<char> is_start_;
    Outline source_;                      // part of the rectangle behind the first portal
    std::vector<Point2> lefts_, rights_;  // corners of the portals passed
    Outline piece_, clipped_, spare_;
    PoseFloor::Tally* tally_;
    double area_ = 0;
    std::size_t steps_ = 0;
};

/// A polygon around the disc of the range, moved outwards by the rectangle.
void WeakView::addRange() {
    constexpr int kSides = 96;
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        const Vec2 normal{std::cos(angle), std::sin(angle)};
        HalfPlane side = aroundBox(box_.at, normal);
        side.reach += sector_.range;
        range_.push_back(side);
    }
}

void WeakView::addField() {
    const double span = sector_.field + box_.span;
    if (sector_.isRound() || span >= 2 * std::numbers::pi - 1e-9) {
        fields_.emplace_back();
        return;
    }
    constexpr double kTurn = 1e-9;  // widens the sector by more than rounding
    const double from = box_.from + sector_.first - kTurn, to = from + span + 2 * kTurn;
    const auto beside = [this](double angle, double side) {
        const Vec2 way{std::cos(angle), std::sin(angle)};
        return aroundBox(box_.at, -side * perpendicular(way));
    };
    const HalfPlane first = beside(from, 1), last = beside(to, -1);
    if (to - from > std::numbers::pi - kStraight) {  // two half-planes cover it
        fields_.push_back({first});
        fields_.push_back({last, first.opposite()});
        return;
    }
    std::vector<HalfPlane> cone = {first, last};
    const Vec2 a{std::cos(from), std::sin(from)}, b{std::cos(to), std::sin(to)};
    const Vec2 axes[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (const Vec2 normal : axes) {
        if (dot(normal, a) > 0 || dot(normal, b) > 0) continue;
        cone.push_back(aroundBox(box_.at, normal));
    }
    fields_.push_back(std::move(cone));
}

void WeakView::count(const Outline& polygon) {
    area_ += floor_.weigh(polygon);
    if (tally_ != nullptr) tally_->add(polygon);
}

bool WeakView::add(const Outline& polygon) {
    clipped_ = polygon;
    bool is_within = true;
    for (const Point2 p : polygon)
        is_within = is_within && distanceToBox(p, box_.at) <= sector_.range;
    if (!is_within)
        for (const HalfPlane& half : range_) clip(clipped_, half, spare_);
    if (clipped_.empty()) return false;
    if (fields_.size() == 1 && fields_[0].empty()) {
        count(clipped_);
        return true;
    }
    bool is_seen = false;
    Outline part;
    for (const auto& field : fields_) {
        part = clipped_;
        for (const HalfPlane& half : field) clip(part, half, spare_);
        if (part.empty()) continue;
        count(part);
        is_seen = true;
    }
    return is_seen;
}

bool WeakView::isFar(Point2 a, Point2 b) const {
    const Point2 middle = box_.at.center();
    const double radius = distance(middle, box_.at.high);
    const Vec2 way = b - a;
    const double squared = dot(way, way);
    const double share = squared > 0 ? std::clamp(dot(middle - a, way) / squared, 0.0, 1.0) : 0;
    return distance(middle, a + share * way) > sector_.range + radius;
}

Vec2 WeakView::extremeWay(Point2 corner, Point2 opposite, double side) const {
    // In the frame of the portal: x away from its other end, y ahead. A way is the more extreme,
    // the larger its x over its length.
    const Vec2 out = corner - opposite;
    const double width = length(out);
    if (!(width > 0)) return out;
    const Vec2 along = (1 / width) * out, ahead = -side * perpendicular(along);
    const auto extent = [&](Vec2 way, double none) {
        const double size = length(way);
        return size > 0 && dot(way, ahead) >= 0 ? dot(way, along) / size : none;
    };
    double most = -1;
    Vec2 extreme = -along;
    for (const Point2 s : source_) {
        const double x = extent(corner - s, 1);
        if (x < most) continue;
        most = x;
        extreme = x >= 1 ? along : corner - s;
    }
    for (const Point2 p : side > 0 ? rights_ : lefts_) {
        const double x = extent(corner - p, 1);
        if (x >= most) continue;
        most = x;
        extreme = corner - p;
    }
    return extreme;
}

void WeakView::expandFrom(std::size_t triangle, std::size_t edge) {
    const PoseFloor::Triangle& from = floor_.triangles()[triangle];
    // Seen from inside, the edge runs from right to left.
    const std::uint32_t right = from.corners[edge], left = from.corners[(edge + 1) % 3];
    const Point2 a = floor_.at(right), b = floor_.at(left);
    if (isFar(a, b)) return;
    source_ = cornersOf(box_.at);
    clip(source_, besideRay(a, b - a, 1), spare_);
    if (source_.empty()) return;
    rights_ = {a};
    lefts_ = {b};
    expand(static_cast<std::size_t>(from.beyond[edge]), right, left, {a, extremeWay(a, b, -1)},
           {b, extremeWay(b, a, 1)});
}

void WeakView::expand(std::size_t triangle, std::uint32_t right, std::uint32_t left,
                      Limit right_limit, Limit left_limit) {
    if (is_start_[triangle] != 0 || ++steps_ > kMaxSteps) return;
    const PoseFloor::Triangle& own = floor_.triangles()[triangle];
    const PoseFloor::Corners corners = floor_.cornersOf(triangle);
    piece_.assign(corners.begin(), corners.end());
    clip(piece_, besideRay(left_limit.at, left_limit.way, -1), spare_);
    clip(piece_, besideRay(right_limit.at, right_limit.way, 1), spare_);
    if (piece_.empty() || !add(piece_)) return;
    std::size_t apex = 0;
    while (own.corners[apex] == right || own.corners[apex] == left) ++apex;
    const std::uint32_t top = own.corners[apex];
    const Point2 v = floor_.at(top), a = floor_.at(right), b = floor_.at(left);
    const bool is_right = cross(right_limit.way, v - right_limit.at) > 0;  // of the apex: a view
    const bool is_left = cross(left_limit.way, v - left_limit.at) < 0;
    // Corners counter-clockwise: apex, left, right of the portal seen from inside this triangle.
    const std::int32_t beyond_left = own.beyond[apex], beyond_right = own.beyond[(apex + 2) % 3];
    if (is_right && beyond_right >= 0 && !isFar(a, v)) {
        lefts_.push_back(v);
        Limit limit = left_limit;
        if (is_left) {
            limit = {v, extremeWay(v, a, 1)};
            if (cross(left_limit.way, limit.way) > 0) limit.way = left_limit.way;
        }
        expand(static_cast<std::size_t>(beyond_right), right, top, right_limit, limit);
        lefts_.pop_back();
    }
    if (is_left && beyond_left >= 0 && !isFar(v, b)) {
        rights_.push_back(v);
        Limit limit = right_limit;
        if (is_right) {
            limit = {v, extremeWay(v, b, -1)};
            if (cross(right_limit.way, limit.way) < 0) limit.way = right_limit.way;
        }
        expand(static_cast<std::size_t>(beyond_left), top, left, limit, left_limit);
        rights_.pop_back();
    }
}

std::optional<double> WeakView::compute() {
    const std::size_t count = floor_.triangles().size();
    is_start_.assign(count, 0);
    bool is_any = false;
    for (std::size_t i = 0; i < count; ++i) {
        const PoseFloor::Corners corners = floor_.cornersOf(i);
        if (!meets(corners, box_.at)) continue;
        is_start_[i] = 1;
        is_any = true;
        add({corners.begin(), corners.end()});
    }
    if (!is_any) return std::nullopt;
    for (std::size_t i = 0; i < count; ++i) {
        if (is_start_[i] == 0) continue;
        const PoseFloor::Triangle& triangle = floor_.triangles()[i];
        for (std::size_t edge = 0; edge < 3; ++edge)
            if (triangle.beyond[edge] >= 0 &&
                is_start_[static_cast<std::size_t>(triangle.beyond[edge])] == 0)
                expandFrom(i, edge);
    }
    if (steps_ > kMaxSteps) {
        area_ = 0;
        if (tally_ != nullptr) tally_->clear();
        for (std::size_t i = 0; i < count; ++i) {
            const PoseFloor::Corners corners = floor_.cornersOf(i);
            add({corners.begin(), corners.end()});
        }
    }
    return std::min(area_, sector_.area() * floor_.mostWeight());
}

}  // namespace

OuterBound outerBoundOf(const PoseFloor& floor, const Sector& sector, const PoseBox& box) {
    OuterBound view;
    PoseFloor::Tally tally(floor);
    const std::optional<double> area = WeakView(floor, sector, box, &tally).compute();
    if (!area) return view;
    tally.round(view.parts);
    // Views around several sides of a hole overlap: the sum of their areas may exceed that of
    // cells.
    view.area = std::min(*area, floor.weightOf([&view](std::size_t first, std::size_t count) {
        const auto begin = view.parts.begin() + static_cast<std::ptrdiff_t>(first);
        return std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(count), std::uint64_t{0});
    }));
    return view;
}

double fatAreaOf(const PoseFloor& floor, const Sector& sector, const PoseBox& box) {
    return WeakView(floor, sector, box, nullptr).compute().value_or(0);
}

}  // namespace ispace::proofs::poses

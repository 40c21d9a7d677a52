// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/poses/fat_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace ispace::poses {

namespace {

/// The points p with dot(normal, p) <= reach.
struct HalfPlane {
    Vec2 normal;
    double reach;
    [[nodiscard]] double beyond(Point2 p) const { return dot(normal, p - Point2()) - reach; }
};

using Outline = std::vector<Point2>;

/// Clips a convex polygon; `spare` is memory.
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

/// The points left of the ray from `at`, or right of it for a negative side.
HalfPlane besideRay(Point2 at, Vec2 way, double side) {
    const Vec2 normal = -side * perpendicular(way);
    return {normal, dot(normal, at - Point2())};
}

double distanceToBox(Point2 p, const Box2& box) {
    const double x = std::max({box.low.x - p.x, p.x - box.high.x, 0.0});
    const double y = std::max({box.low.y - p.y, p.y - box.high.y, 0.0});
    return std::hypot(x, y);
}

bool meets(const PoseFloor::Corners& triangle, const Box2& box) {
    Box2 around;
    for (const Point2 p : triangle) around.add(p);
    if (!around.meets(box)) return false;
    const Point2 corners[] = {box.low, {box.high.x, box.low.y}, box.high, {box.low.x, box.high.y}};
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
    WeakView(const PoseFloor& floor, const Sector& sector, const PoseBox& box)
        : floor_(floor), sector_(sector), box_(box), tally_(floor) {
        box_.at.low = box.at.low - Vec2{kWiden, kWiden};
        box_.at.high = box.at.high + Vec2{kWiden, kWiden};
        addRange();
        addField();
    }

    FatView compute();

  private:
    void addRange();
    void addField();
    /// Adds the part of a polygon within range and field; returns false if there is none.
    bool add(const Outline& polygon);
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
    PoseFloor::Tally tally_;
    std::size_t steps_ = 0;
};

/// A polygon around the disc of the range, moved outwards by the rectangle.
void WeakView::addRange() {
    constexpr int kSides = 96;
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        const Vec2 normal{std::cos(angle), std::sin(angle)};
        const Point2 corner{normal.x > 0 ? box_.at.high.x : box_.at.low.x,
                            normal.y > 0 ? box_.at.high.y : box_.at.low.y};
        range_.push_back({normal, dot(normal, corner - Point2()) + sector_.range});
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
        const Vec2 normal = -side * perpendicular(way);  // outwards
        const Point2 corner{normal.x > 0 ? box_.at.high.x : box_.at.low.x,
                            normal.y > 0 ? box_.at.high.y : box_.at.low.y};
        return HalfPlane{normal, dot(normal, corner - Point2())};
    };
    const HalfPlane first = beside(from, 1), last = beside(to, -1);
    if (to - from > std::numbers::pi) {  // two half-planes cover it
        fields_.push_back({first});
        fields_.push_back({last, {-first.normal, -first.reach}});
        return;
    }
    std::vector<HalfPlane> cone = {first, last};
    const Vec2 a{std::cos(from), std::sin(from)}, b{std::cos(to), std::sin(to)};
    const Vec2 axes[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    for (const Vec2 normal : axes) {
        if (dot(normal, a) > 0 || dot(normal, b) > 0) continue;
        const Point2 corner = normal.x + normal.y > 0 ? box_.at.high : box_.at.low;
        cone.push_back({normal, dot(normal, corner - Point2())});
    }
    fields_.push_back(std::move(cone));
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
        tally_.add(clipped_);
        return true;
    }
    bool is_seen = false;
    Outline part;
    for (const auto& field : fields_) {
        part = clipped_;
        for (const HalfPlane& half : field) clip(part, half, spare_);
        if (part.empty()) continue;
        tally_.add(part);
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
    source_ = {box_.at.low,
               {box_.at.high.x, box_.at.low.y},
               box_.at.high,
               {box_.at.low.x, box_.at.high.y}};
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

FatView WeakView::compute() {
    const std::size_t count = floor_.triangles().size();
    is_start_.assign(count, 0);
    FatView view;
    bool is_any = false;
    for (std::size_t i = 0; i < count; ++i) {
        const PoseFloor::Corners corners = floor_.cornersOf(i);
        if (!meets(corners, box_.at)) continue;
        is_start_[i] = 1;
        is_any = true;
        add({corners.begin(), corners.end()});
    }
    if (!is_any) return view;
    for (std::size_t i = 0; i < count; ++i) {
        if (is_start_[i] == 0) continue;
        const PoseFloor::Triangle& triangle = floor_.triangles()[i];
        for (std::size_t edge = 0; edge < 3; ++edge)
            if (triangle.beyond[edge] >= 0 &&
                is_start_[static_cast<std::size_t>(triangle.beyond[edge])] == 0)
                expandFrom(i, edge);
    }
    if (steps_ > kMaxSteps) {
        tally_.clear();
        for (std::size_t i = 0; i < count; ++i) {
            const PoseFloor::Corners corners = floor_.cornersOf(i);
            add({corners.begin(), corners.end()});
        }
    }
    tally_.round(view.parts);
    // Views around several sides of a hole overlap: the sum of their areas may exceed that of
    // cells.
    const auto parts = std::accumulate(view.parts.begin(), view.parts.end(), std::uint64_t{0});
    view.area =
        std::min({tally_.area(), static_cast<double>(parts) * floor_.partArea(), sector_.area()});
    return view;
}

}  // namespace

FatView fatViewOf(const PoseFloor& floor, const Sector& sector, const PoseBox& box) {
    return WeakView(floor, sector, box).compute();
}

}  // namespace ispace::poses

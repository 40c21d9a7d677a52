// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/triangle_set.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace ispace {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A ray meets what it passes as near as this, in metres, and thinner triangles are none.
constexpr double kTouch = 1e-9;

/// What a ray tracer in float32 errs by, relative to the extent of the scene: rounding of corners
/// and directions, and of its products.
constexpr double kFloatError = 0x1p-21;

/// A splinter is thinner than this many times the slack, so that no hit is certain to lie in it,
/// and than its length over this.
constexpr double kSplinter = 8;

/// Indices of distinct places, by open addressing.
class PlaceIndex {
  public:
    explicit PlaceIndex(std::size_t count)
        : slots_(std::bit_ceil(2 * count + 1), kEmpty), mask_(slots_.size() - 1) {}

    /// The index of an equal place in `places`, which it is added to if there is none.
    std::uint32_t find(Point3 place, std::vector<Point3>& places) {
        // Both zeros are one place.
        const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };
        std::uint64_t hash = bits(place.x);
        hash = mixed(hash) ^ bits(place.y);
        hash = mixed(hash) ^ bits(place.z);
        for (std::size_t slot = mixed(hash) & mask_;; slot = (slot + 1) & mask_) {
            if (slots_[slot] == kEmpty) {
                slots_[slot] = static_cast<std::uint32_t>(places.size());
                places.push_back(place);
                return slots_[slot];
            }
            if (places[slots_[slot]] == place) return slots_[slot];
        }
    }

  private:
    static constexpr std::uint32_t kEmpty = ~0U;
    static std::uint64_t mixed(std::uint64_t value) {
        value *= 0x9E3779B97F4A7C15U;
        return value ^ (value >> 29U);
    }
    std::vector<std::uint32_t> slots_;
    std::size_t mask_;
};

Vec3 unit(Vec3 v) { return (1 / length(v)) * v; }

}  // namespace

TriangleSet::TriangleSet(TriangleSoup soup)
    : triangles_(std::move(soup.triangles)),
      rounds_(std::move(soup.rounds)),
      round_of_(std::move(soup.round_of)) {
    round_of_.resize(triangles_.size(), TriangleSoup::kFlat);
    merge(std::move(soup.vertices));
    enclose();
    measure();
    listCorners();
}

void TriangleSet::merge(std::vector<Point3> vertices) {
    PlaceIndex index(vertices.size());
    vertices_.reserve(vertices.size());
    std::vector<std::uint32_t> merged(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        merged[i] = index.find(vertices[i], vertices_);
    for (auto& triangle : triangles_)
        for (std::uint32_t& vertex : triangle) vertex = merged[vertex];
}

void TriangleSet::enclose() {
    if (vertices_.empty()) return;
    Point3 low = vertices_.front(), high = low;
    for (const Point3& p : vertices_) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double size = length(high - low);
    slack_ = kFloatError * size;
    ball_ = {low + 0.5 * (high - low), 0.75 * size};
}

void TriangleSet::measure() {
    const std::vector<Corners> all = std::exchange(triangles_, {});
    const std::vector<std::uint32_t> round_of = std::exchange(round_of_, {});
    triangles_.reserve(all.size());
    planes_.reserve(all.size());
    margins_.reserve(all.size());
    round_of_.reserve(all.size());
    struct Splinter {
        Corners corners;
        Plane plane;
        std::uint32_t round;
    };
    std::vector<Splinter> splinters;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Corners& corners = all[i];
        const Point3 a = vertices_[corners[0]], b = vertices_[corners[1]],
                     c = vertices_[corners[2]];
        const double sides[] = {length(b - a), length(c - b), length(a - c)};
        const double* const longest = std::max_element(sides, sides + 3);
        const Vec3 across = cross(b - a, c - a);
        const double twice = length(across), thin = twice / *longest;
        if (!(thin > kTouch)) continue;
        const Vec3 normal = (1 / twice) * across;
        const Plane plane{normal, normal.x * a.x + normal.y * a.y + normal.z * a.z};
        if (thin < kSplinter * slack_ && thin * kSplinter < *longest) {
            const auto first = static_cast<std::size_t>(longest - sides);
            splinters.push_back(
                {{corners[first], corners[(first + 1) % 3], corners[(first + 2) % 3]},
                 plane,
                 round_of[i]});
        } else {
            add(corners, plane, 2.5 * slack_ / thin, round_of[i]);
        }
    }
    splinters_ = triangles_.size();
    for (const auto& [corners, plane, round] : splinters)
        for (int half = 0; half < 2; ++half) add(corners, plane, kInfinity, round);
}

void TriangleSet::add(const Corners& corners, const Plane& plane, double margin,
                      std::uint32_t round) {
    round_of_.push_back(round);
    if (round != TriangleSoup::kFlat) margin = kInfinity;
    triangles_.push_back(corners);
    planes_.push_back(plane);
    margins_.push_back(margin);
}

void TriangleSet::listCorners() {
    // Count, then fill: the lists of all vertices lie in one array.
    first_.assign(vertices_.size() + 1, 0);
    for (const auto& triangle : triangles_)
        for (const std::uint32_t vertex : triangle) ++first_[vertex];
    std::uint32_t end = 0;
    for (std::uint32_t& entry : first_) entry = end += entry;
    around_.resize(end);
    for (std::size_t i = triangles_.size(); i-- > 0;)
        for (const std::uint32_t vertex : triangles_[i])
            around_[--first_[vertex]] = static_cast<std::uint32_t>(i);
}

std::array<std::array<float, 3>, 3> TriangleSet::enlarged(std::size_t triangle) const {
    std::array<Point3, 3> moved;
    if (triangle >= splinters_) {
        moved = halfRectangle(triangle);
    } else {
        for (std::size_t i = 0; i < 3; ++i) {
            const Point3 p = corner(triangle, i);
            const Vec3 left = unit(corner(triangle, (i + 1) % 3) - p);
            const Vec3 right = unit(corner(triangle, (i + 2) % 3) - p);
            // The slack over the sine of half the angle, along the line that halves it.
            const double sine = length({left.x - right.x, left.y - right.y, left.z - right.z}) / 2;
            moved[i] =
                p + (-slack_ / sine) * unit({left.x + right.x, left.y + right.y, left.z + right.z});
        }
    }
    std::array<std::array<float, 3>, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i)
        corners[i] = {static_cast<float>(moved[i].x), static_cast<float>(moved[i].y),
                      static_cast<float>(moved[i].z)};
    return corners;
}

/// Their longest side is the first.
std::array<Point3, 3> TriangleSet::halfRectangle(std::size_t splinter) const {
    const Point3 a = corner(splinter, 0), b = corner(splinter, 1), c = corner(splinter, 2);
    const Vec3 along = unit(b - a), up = cross(planes_[splinter].normal, along);
    const Point3 begin = a + -slack_ * along, end = b + slack_ * along;
    const double height = dot(c - a, up) + slack_;
    const Point3 low = begin + -slack_ * up, high = end + height * up;
    if ((splinter - splinters_) % 2 == 0) return {low, end + -slack_ * up, high};
    return {low, high, begin + height * up};
}

double TriangleSet::meet(std::size_t triangle, const Ray& ray) const {
    const Vec3 d = ray.direction;
    // Products of what is far away round too much.
    const double ahead = ball_.ahead(ray.origin, d);
    const Point3 begin = ray.origin + ahead * d;
    const Vec3 ways[] = {corner(triangle, 0) - begin, corner(triangle, 1) - begin,
                         corner(triangle, 2) - begin};
    const double squared = dot(d, d), size = std::sqrt(squared);
    bool left = true, right = true;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 a = ways[i], b = ways[(i + 1) % 3];
        // Neighbours find the same number with the other sign: no ray slips between them.
        const double aside = dot(d, cross(a, b));
        const double touch = kTouch * size * length(Vec3{b.x - a.x, b.y - a.y, b.z - a.z});
        if (aside < -touch) left = false;
        if (aside > touch) right = false;
    }
    if (!left && !right) return kInfinity;
    const Plane& plane = planes_[triangle];
    const double slope = dot(plane.normal, d);
    if (slope == 0) return kInfinity;
    // Where the ray grazes the plane it meets it within the triangle's extent all the same.
    double near = kInfinity, far = -kInfinity;
    for (const Vec3& way : ways) {
        near = std::min(near, ahead + dot(way, d) / squared);
        far = std::max(far, ahead + dot(way, d) / squared);
    }
    const double multiple =
        std::clamp(plane.heightOver(ray.origin) / slope, near - kTouch / size, far + kTouch / size);
    if (!(multiple >= 0 && multiple <= ray.reach)) return kInfinity;
    return multiple;
}

RoundMeeting TriangleSet::meetRound(std::size_t triangle, const Ray& ray, double contact) const {
    constexpr RoundMeeting kNone{kInfinity, 0};
    const auto& [curve, bottom, top] = rounds_[round_of_[triangle]];
    const Vec2 q = curve.toUnit(ray.origin.onFloor() - curve.center);
    const Vec2 d = curve.toUnit({ray.direction.x, ray.direction.y});
    const double a = dot(d, d), b = dot(q, d), c = dot(q, q) - 1;
    // The stretch of the ray within the side, and between both ends.
    double from = -kInfinity, to = kInfinity;
    if (a > 0) {
        const double square = a - cross(q, d) * cross(q, d);
        if (square < 0) return kNone;
        // Written so that neither root cancels.
        const double far = b > 0 ? -b - std::sqrt(square) : std::sqrt(square) - b;
        from = b > 0 ? far / a : c / far;
        to = b > 0 ? c / far : far / a;
    } else if (c > 0) {
        return kNone;
    }
    double low = -kInfinity, high = kInfinity;
    const double z = ray.origin.z, rise = ray.direction.z;
    if (rise != 0) {
        low = std::min((bottom - z) / rise, (top - z) / rise);
        high = std::max((bottom - z) / rise, (top - z) / rise);
    } else if (z < bottom || z > top) {
        return kNone;
    }
    const double enter = std::max(from, low), leave = std::min(to, high);
    if (!(enter <= leave && leave >= 0)) return kNone;
    const double height = curve.heightOf(ray.origin.onFloor());
    const double outside = std::max({height, z - top, bottom - z});
    const bool touches = std::fabs(outside) <= contact;
    if (touches) {
        const bool goes_out = (std::fabs(height) <= contact && b >= 0) ||
                              (std::fabs(z - top) <= contact && rise > 0) ||
                              (std::fabs(bottom - z) <= contact && rise < 0);
        if (goes_out || leave * length(ray.direction) <= contact) return kNone;
    }
    const bool enters = enter >= 0 && !touches;
    const double multiple = enters ? enter : leave;
    if (!(multiple <= ray.reach)) return kNone;
    if (multiple == (enters ? low : high)) return {multiple, std::fabs(rise)};
    const Point2 place = (ray.origin + multiple * ray.direction).onFloor();
    const Vec2 normal = curve.normalAt(place);
    const Vec2 flat{ray.direction.x, ray.direction.y};
    return {multiple, std::fabs(dot(normal, flat)) / length(normal)};
}

double TriangleSet::distance(std::size_t triangle, Point3 p) const {
    const Plane& plane = planes_[triangle];
    bool is_over = true;
    double nearest = kInfinity;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 from = corner(triangle, i);
        const Vec3 side = corner(triangle, (i + 1) % 3) - from, way = p - from;
        if (dot(cross(plane.normal, side), way) < 0) is_over = false;
        const double share = std::clamp(dot(way, side) / dot(side, side), 0.0, 1.0);
        nearest = std::min(nearest, length(p - (from + share * side)));
    }
    return is_over ? std::fabs(plane.heightOver(p)) : nearest;
}

}  // namespace ispace

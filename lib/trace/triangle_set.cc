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

TriangleSet::TriangleSet(TriangleSoup soup) : triangles_(std::move(soup.triangles)) {
    merge(std::move(soup.vertices));
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

void TriangleSet::measure() {
    Point3 low{kInfinity, kInfinity, kInfinity}, high{-kInfinity, -kInfinity, -kInfinity};
    for (const Point3& p : vertices_) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    slack_ = vertices_.empty() ? 0 : kFloatError * length(high - low);

    planes_.reserve(triangles_.size());
    margins_.reserve(triangles_.size());
    std::size_t kept = 0;
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const Point3 a = corner(i, 0), b = corner(i, 1), c = corner(i, 2);
        const Vec3 across = cross(b - a, c - a);
        const double twice = length(across);
        const double thin = twice / std::max({length(b - a), length(c - b), length(a - c)});
        if (!(thin > kTouch)) continue;
        const Vec3 normal = (1 / twice) * across;
        planes_.push_back({normal, normal.x * a.x + normal.y * a.y + normal.z * a.z});
        margins_.push_back(2.5 * slack_ / thin);
        triangles_[kept++] = triangles_[i];
    }
    triangles_.resize(kept);
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
    // The tips of splinters move by no more than this many times the slack.
    constexpr double kFarthest = 1000;
    std::array<std::array<float, 3>, 3> corners{};
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 p = corner(triangle, i);
        const Vec3 left = unit(corner(triangle, (i + 1) % 3) - p);
        const Vec3 right = unit(corner(triangle, (i + 2) % 3) - p);
        const Vec3 inwards = {left.x + right.x, left.y + right.y, left.z + right.z};
        const double size = length(inwards);
        const double sine = length({left.x - right.x, left.y - right.y, left.z - right.z}) / 2;
        const double way = slack_ * (sine * kFarthest > 1 ? 1 / sine : kFarthest);
        const Point3 q = size > 0 ? p + (-way / size) * inwards : p;
        corners[i] = {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z)};
    }
    return corners;
}

double TriangleSet::meet(std::size_t triangle, const Ray& ray) const {
    const Vec3 d = ray.direction;
    const Vec3 ways[] = {corner(triangle, 0) - ray.origin, corner(triangle, 1) - ray.origin,
                         corner(triangle, 2) - ray.origin};
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
        near = std::min(near, dot(way, d) / squared);
        far = std::max(far, dot(way, d) / squared);
    }
    const double multiple =
        std::clamp(plane.heightOver(ray.origin) / slope, near - kTouch / size, far + kTouch / size);
    if (!(multiple >= 0 && multiple <= ray.reach)) return kInfinity;
    return multiple;
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

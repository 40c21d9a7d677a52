// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/triangle_set.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "base/simd.h"
#include "env/body.h"
#include "env/mesh.h"
#include "geom/tolerance.h"
#include "trace/flat_kernels.h"

namespace ispace {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Rounding of corners, origins and directions to float32 and of Embree's products, relative to the
/// extent of the scene.
constexpr double kFloatError = 0x1p-21;

constexpr std::size_t kLanes = TriangleLanes::kSize;

/// Of the bounding box.
double diagonalOf(const TriangleSoup& soup) {
    Box2 plan;
    double low = kInfinity, high = -kInfinity;
    for (const Point3& p : soup.vertices) {
        plan.add(p.onFloor());
        low = std::min(low, p.z);
        high = std::max(high, p.z);
    }
    for (const RoundBody& round : soup.rounds) {
        const Box2 box = round.curve.box();
        plan.add(box.low);
        plan.add(box.high);
        low = std::min(low, round.bottom);
        high = std::max(high, round.top);
    }
    return plan.empty() ? 0 : length(Vec3{plan.width(), plan.depth(), high - low});
}

}  // namespace

namespace {

/// Number of triangles that closely enclose a body with this footprint.
std::size_t trianglesAround(const Polygon& footprint) { return 4 * footprint.size() - 4; }

/// Returns triangles that closely enclose a round body.
TriangleSoup soupAround(const RoundBody& round, Polygon footprint) {
    const Point2 center = round.curve.center;
    // By a hair more, for rounding.
    const double growth = growthAround(footprint.size()) * (1 + 1e-9);
    for (Point2& p : footprint) p = center + growth * (p - center);
    const Body body{{{std::move(footprint), round.bottom, round.top}}, {}, {}, {}};
    Mesh mesh = std::move(meshesOf(body, Surfaces::Solid).front());
    return {std::move(mesh.vertices), std::move(mesh.triangles)};
}

}  // namespace

TriangleSet::TriangleSet(const TriangleSoup& soup) : tolerance_(kFloatError * diagonalOf(soup)) {
    corners_.reserve(soup.triangles.size());
    planes_.reserve(soup.triangles.size());
    margins_.reserve(soup.triangles.size());
    sources_.reserve(soup.triangles.size());
    addTriangles(soup);
    flats_ = size();
    rounds_.reserve(soup.rounds.size());
    std::vector<Polygon> footprints;
    std::size_t count = 0;
    for (const RoundBody& round : soup.rounds) {
        rounds_.push_back({round});
        if (count <= kMaxOfRounds)
            count += trianglesAround(footprints.emplace_back(inscribedIn(round.curve)));
    }
    for (std::size_t i = 0; i < rounds_.size(); ++i) {
        const std::size_t first = size();
        if (count <= kMaxOfRounds) {
            addTriangles(soupAround(rounds_[i].body, std::move(footprints[i])));
        } else {
            rounds_[i].surface = static_cast<std::uint32_t>(size());
            planes_.emplace_back();
        }
        sources_.resize(first);
        sources_.resize(size(), static_cast<std::uint32_t>(i));
    }
    margins_.resize(flats_);
    margins_.resize(size(), kInfinity);
}

/// Adds the triangles of a soup.
void TriangleSet::addTriangles(const TriangleSoup& soup) {
    const std::size_t count = soup.triangles.size();
    TriangleLanes lanes;
    TriangleLanePlanes found;
    for (std::size_t first = 0; first < count; first += kLanes) {
        const std::size_t size = std::min(kLanes, count - first);
        for (std::size_t lane = 0; lane < kLanes; ++lane) {
            const auto& triangle = soup.triangles[first + std::min(lane, size - 1)];
            for (std::size_t k = 0; k < 3; ++k) lanes.set(lane, k, soup.vertices[triangle[k]]);
        }
        findPlanes(lanes, found);
        for (std::size_t lane = 0; lane < size; ++lane) {
            const double thin = found.thin[lane];
            if (!(thin > kContactTolerance)) continue;
            const std::size_t i = first + lane;
            const auto& [a, b, c] = soup.triangles[i];
            corners_.push_back({soup.vertices[a], soup.vertices[b], soup.vertices[c]});
            planes_.push_back(
                {{found.normals.x[lane], found.normals.y[lane], found.normals.z[lane]},
                 found.offsets[lane]});
            margins_.push_back(2.5 * tolerance_ / thin);
            sources_.push_back(static_cast<std::uint32_t>(i));
        }
    }
}

void TriangleSet::enlarge(std::span<FloatTriangle> out) const {
    assert(out.size() == triangles());
    TriangleLanes lanes;
    for (std::size_t first = 0; first < out.size(); first += kLanes) {
        const std::size_t count = std::min(kLanes, out.size() - first);
        for (std::size_t lane = 0; lane < kLanes; ++lane)
            for (std::size_t k = 0; k < 3; ++k)
                lanes.set(lane, k, corners_[first + std::min(lane, count - 1)][k]);
        ispace::enlarge(lanes, tolerance_);
        for (std::size_t lane = 0; lane < count; ++lane)
            for (std::size_t k = 0; k < 3; ++k) {
                const TriangleLanes::Vectors& moved = lanes.corners[k];
                out[first + lane][k] = {static_cast<float>(moved.x[lane]),
                                        static_cast<float>(moved.y[lane]),
                                        static_cast<float>(moved.z[lane])};
            }
    }
}

RayHit TriangleSet::meet(std::size_t surface, const Ray& ray, double ray_epsilon) const {
    const RoundBody* const round = roundOf(surface);
    return round != nullptr ? meetRound(*round, ray, ray_epsilon) : meetFlat(surface, ray);
}

RayHit TriangleSet::meetFlat(std::size_t triangle, const Ray& ray) const {
    const Vec3 d = ray.direction;
    double near = kInfinity, far = -kInfinity;
    for (const Point3& corner : corners_[triangle]) {
        const double along = dot(corner - ray.origin, d) / dot(d, d);
        near = std::min(near, along);
        far = std::max(far, along);
    }
    const Plane& plane = planes_[triangle];
    const double slope = dot(plane.normal, d);
    // NaN if the ray lies in the plane: return the near end.
    const double unlimited = plane.heightOver(ray.origin) / slope;
    const double multiple = unlimited > near ? std::min(unlimited, far) : near;
    if (!(multiple >= 0 && multiple <= ray.reach)) return {};
    return {multiple, std::fabs(slope)};
}

double TriangleSet::distance(std::size_t triangle, Point3 p) const {
    const Plane& plane = planes_[triangle];
    const auto& corners = corners_[triangle];
    bool is_over = true;
    double nearest = kInfinity;
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 from = corners[i];
        const Vec3 side = corners[(i + 1) % 3] - from, way = p - from;
        if (dot(cross(plane.normal, side), way) < 0) is_over = false;
        const double share = std::clamp(dot(way, side) / dot(side, side), 0.0, 1.0);
        nearest = std::min(nearest, length(p - (from + share * side)));
    }
    return is_over ? std::fabs(plane.heightOver(p)) : nearest;
}

void TriangleSet::addTouched(std::size_t surface, Point3 p, double distance,
                             std::vector<Vec3>& normals) const {
    const RoundBody* const round = roundOf(surface);
    if (round == nullptr) {
        const Plane& plane = planes_[surface];
        // Most surfaces of a search are rejected by their planes alone.
        if (std::fabs(plane.heightOver(p)) <= 2 * distance &&
            this->distance(surface, p) <= distance)
            normals.push_back(plane.normal);
        return;
    }
    const double height = round->curve.heightOf(p.onFloor());
    const double under = round->top - p.z, over = p.z - round->bottom;
    if (height > distance || std::min(under, over) < -distance) return;
    if (std::min(under, over) <= distance) normals.push_back({0, 0, 1});
    if (height >= -distance) {
        const Vec2 side = round->curve.normalAt(p.onFloor());
        normals.push_back(1 / length(side) * Vec3{side.x, side.y, 0});
    }
}

namespace {

constexpr std::size_t kSize = TriangleLanes::kSize;
using Vectors = TriangleLanes::Vectors;

ISPACE_INLINE Point3 pointAt(const Vectors& v, std::size_t lane) {
    return {v.x[lane], v.y[lane], v.z[lane]};
}

/// Computes the same bits as std::hypot of libstdc++, without a branch.
ISPACE_INLINE double sizeOf(Vec3 v) {
    const double x = std::fabs(v.x), y = std::fabs(v.y), z = std::fabs(v.z);
    const double most = flatMax(flatMax(x, y), z);
    const double over = simd::choose(most > 0, most, 1.0);
    return most *
           std::sqrt((x / over) * (x / over) + (y / over) * (y / over) + (z / over) * (z / over));
}

ISPACE_INLINE Vec3 unit(Vec3 v) { return (1 / sizeOf(v)) * v; }

}  // namespace

ISPACE_SIMD_CLONES void findPlanes(const TriangleLanes& triangles, TriangleLanePlanes& planes) {
    ISPACE_LANES for (std::size_t i = 0; i < kSize; ++i) {
        const Point3 a = pointAt(triangles.corners[0], i), b = pointAt(triangles.corners[1], i),
                     c = pointAt(triangles.corners[2], i);
        const Vec3 across = cross(b - a, c - a);
        const double twice = sizeOf(across);
        const double longest = flatMax(flatMax(sizeOf(b - a), sizeOf(c - b)), sizeOf(a - c));
        const Vec3 normal = (1 / twice) * across;
        planes.normals.x[i] = normal.x;
        planes.normals.y[i] = normal.y;
        planes.normals.z[i] = normal.z;
        planes.offsets[i] = normal.x * a.x + normal.y * a.y + normal.z * a.z;
        planes.thin[i] = twice / longest;
    }
}

namespace {

/// Returns the moved position of a corner. \param left, right unit vectors along its sides
ISPACE_INLINE Point3 movedOut(Point3 p, Vec3 left, Vec3 right, double tolerance) {
    // Sharper corners would move far away.
    constexpr double kMinSine = 1.0 / 16;
    // The tolerance over the sine of half the angle, along the line that halves it.
    const double sine = sizeOf({left.x - right.x, left.y - right.y, left.z - right.z}) / 2;
    const Vec3 between{left.x + right.x, left.y + right.y, left.z + right.z};
    return p + (-tolerance / flatMax(sine, kMinSine)) * unit(between);
}

ISPACE_INLINE void put(Point3 p, Vectors& v, std::size_t lane) {
    v.x[lane] = p.x;
    v.y[lane] = p.y;
    v.z[lane] = p.z;
}

}  // namespace

ISPACE_SIMD_CLONES void enlarge(TriangleLanes& triangles, double tolerance) {
    auto& [first, second, third] = triangles.corners;
    ISPACE_LANES for (std::size_t i = 0; i < kSize; ++i) {
        const Point3 a = pointAt(first, i), b = pointAt(second, i), c = pointAt(third, i);
        const Vec3 ab = unit(b - a), bc = unit(c - b), ca = unit(a - c);
        put(movedOut(a, ab, -1 * ca, tolerance), first, i);
        put(movedOut(b, bc, -1 * ab, tolerance), second, i);
        put(movedOut(c, ca, -1 * bc, tolerance), third, i);
    }
}

}  // namespace ispace

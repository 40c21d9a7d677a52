// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/sight_tracer.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/simd.h"

namespace ispace {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A query of the bodies that passes the hidden ones.
struct PassingHidden : EmbreeQuery {
    const SurfaceSet& bodies;
    const std::vector<bool>& hidden;

    PassingHidden(const SurfaceSet& set, const std::vector<bool>& labels)
        : EmbreeQuery(labels.empty() ? nullptr : pass), bodies(set), hidden(labels) {}

    static void pass(const RTCFilterFunctionNArguments* args) {
        const auto& query =
            static_cast<const PassingHidden&>(*reinterpret_cast<const EmbreeQuery*>(args->context));
        for (unsigned i = 0; i < args->N; ++i) {
            if (args->valid[i] == 0) continue;
            const std::size_t label =
                query.bodies.finish(RTCHitN_primID(args->hit, args->N, i)).label;
            if (label < query.hidden.size() && query.hidden[label]) args->valid[i] = 0;
        }
    }
};

}  // namespace

void SightTile::set(std::size_t lane, const SightLine& line, Vec3 shift) {
    has_new_origins = true;
    x[lane] = line.direction.x;
    y[lane] = line.direction.y;
    z[lane] = line.direction.z;
    origin_x[lane] = line.origin.x + shift.x;
    origin_y[lane] = line.origin.y + shift.y;
    origin_z[lane] = line.origin.z + shift.z;
}

SightTracer::SightTracer(const RenderScene::Data& scene, const std::vector<bool>& hidden,
                         double min_depth)
    : scene_(scene),
      hidden_(hidden),
      width_(scene.still->packet_width),
      people_(hidden),
      min_depth_(min_depth) {
    valid_.fill(-1);
    far_.fill(static_cast<float>(kFarthest));
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        hits_.ray.mask[lane] = ~0U;
        hits_.ray.tnear[lane] = static_cast<float>(min_depth);
        hits_.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

namespace {

/// Places of a tile's pixels from its first.
alignas(64) constexpr std::array<double, kLanes> kAside{0, 1, 2, 3, 0, 1, 2, 3,
                                                        0, 1, 2, 3, 0, 1, 2, 3};
alignas(64) constexpr std::array<double, kLanes> kBelow{0, 0, 0, 0, 1, 1, 1, 1,
                                                        2, 2, 2, 2, 3, 3, 3, 3};
static_assert(kTile == 4);

ISPACE_SIMD_CLONES void fillDirections(const EvenSightLines& lines, PixelPoint first,
                                       SightTile& tile) {
    const Vec3 d = lines.direction, right = lines.right, down = lines.down;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double u = first.column + kAside[lane], v = first.row + kBelow[lane];
        tile.x[lane] = d.x + u * right.x + v * down.x;
        tile.y[lane] = d.y + u * right.y + v * down.y;
        tile.z[lane] = d.z + u * right.z + v * down.z;
    }
}

ISPACE_SIMD_CLONES void fillOrigins(const EvenSightLines& lines, Vec3 shift, PixelPoint first,
                                    SightTile& tile) {
    const Point3 o = lines.origin + shift;
    const Vec3 right = lines.origin_right, down = lines.origin_down;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double u = first.column + kAside[lane], v = first.row + kBelow[lane];
        tile.origin_x[lane] = o.x + u * right.x + v * down.x;
        tile.origin_y[lane] = o.y + u * right.y + v * down.y;
        tile.origin_z[lane] = o.z + u * right.z + v * down.z;
    }
}

ISPACE_SIMD_CLONES void readHits(const RTCRayHit16& hits, SightTile& tile) {
    const std::uint32_t triangle = hits.hit.primID[0], kind = hits.hit.geomID[0];
    std::uint32_t other = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        tile.triangle[lane] = hits.hit.primID[lane];
        tile.kind[lane] = static_cast<SurfaceKind>(hits.hit.geomID[lane]);
        other |= (hits.hit.primID[lane] ^ triangle) | (hits.hit.geomID[lane] ^ kind);
    }
    tile.is_one_triangle = other == 0 && kind != RTC_INVALID_GEOMETRY_ID;
}

ISPACE_SIMD_CLONES void blacken(SightTile& tile) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        tile.multiples[lane] = simd::choose(tile.is_black[lane], kNoReturn, tile.multiples[lane]);
}

}  // namespace

void SightTile::set(const EvenSightLines& lines, PixelPoint first, Vec3 shift) {
    fillDirections(lines, first, *this);
    const Point3 kept = lines.origin + shift;
    const bool is_one = lines.origin_right == Vec3() && lines.origin_down == Vec3();
    if (is_one && origin(0) == kept && origin(kLanes - 1) == kept) return;
    fillOrigins(lines, shift, first, *this);
    has_new_origins = true;
}

void SightTracer::trace(SightTile& tile) {
    if (tile.has_new_origins) roundOrigins(tile, hits_);
    tile.has_new_origins = false;
    roundRays(tile, far_, hits_);
    const SurfaceSet& solid = *scene_.still->solid;
    tracePacket(query_, solid.scene(), width_, valid_.data(), hits_);
    bool is_careful = solid.empty();
    if (!scene_.bodies.empty()) {
        PassingHidden passing(scene_.bodies, hidden_);
        tracePacket(passing, scene_.bodies.scene(), width_, valid_.data(), hits_);
    }
    if (!scene_.people.empty())
        tracePacket(people_, scene_.people.scene(), width_, valid_.data(), hits_);
    for (const unsigned geometry : hits_.hit.geomID)
        is_careful |= geometry == static_cast<unsigned>(SurfaceKind::Body) ||
                      geometry == static_cast<unsigned>(SurfaceKind::Person);
    readHits(hits_, tile);
    std::uint32_t care = ~0U >> (32 - kLanes);
    if (!is_careful) {
        const TriangleSet& set = solid.triangles();
        care = meetPlanes(hits_, set.planes().data(), set.margins().data(), set.tolerance(),
                          kNoReturn, tile);
    }
    for (; care != 0; care &= care - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(care));
        tile.multiples[lane] = static_cast<float>(resolve(tile, lane));
    }
    blacken(tile);
}

double SightTracer::resolve(const SightTile& tile, std::size_t lane) const {
    if (hits_.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return kInfinity;
    const std::uint32_t triangle = tile.triangle[lane];
    const double found = static_cast<double>(hits_.ray.tfar[lane]);
    if (tile.kind[lane] == SurfaceKind::Person) {
        const BodyMeeting met =
            scene_.people.body(triangle).meet(tile.origin(lane), tile.direction(lane), min_depth_);
        return met.multiple < kInfinity ? met.multiple : found;
    }
    const TriangleSet& set = scene_.set(tile.kind[lane]).triangles();
    if (set.isRound(triangle)) {
        const RayHit hit =
            set.meet(triangle, {tile.origin(lane), tile.direction(lane), kFarthest}, 0);
        return hit.isNone() ? found : hit.multiple;
    }
    const Plane& plane = set.planes()[triangle];
    const double depth =
        plane.heightOver(tile.origin(lane)) / dot(plane.normal, tile.direction(lane));
    // What is seen almost edge-on is met at the rim of its enlarged triangle.
    return std::fabs(depth - found) <= 1e-4 * (1 + found) ? depth : found;
}

std::vector<PixelPoint> placesInPixel(int count) {
    std::vector<std::pair<std::uint32_t, int>> order;
    for (int i = 0; i < count; ++i) {
        std::uint32_t turned = 0;
        for (unsigned bit = 0; bit < 32; ++bit)
            turned |= (static_cast<std::uint32_t>(i) >> bit & 1U) << (31 - bit);
        order.emplace_back(turned, i);
    }
    std::sort(order.begin(), order.end());
    std::vector<PixelPoint> places;
    places.reserve(order.size());
    for (int rank = 0; rank < count; ++rank)
        places.push_back({(order[static_cast<std::size_t>(rank)].second + 0.5) / count - 0.5,
                          (rank + 0.5) / count - 0.5});
    return places;
}

}  // namespace ispace

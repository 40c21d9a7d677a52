// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/sight_tracer.h"

#include <cmath>
#include <limits>

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
    x[lane] = line.direction.x;
    y[lane] = line.direction.y;
    z[lane] = line.direction.z;
    origin_x[lane] = line.origin.x + shift.x;
    origin_y[lane] = line.origin.y + shift.y;
    origin_z[lane] = line.origin.z + shift.z;
}

SightTracer::SightTracer(const RenderScene::Data& scene, const std::vector<bool>& hidden,
                         double min_depth)
    : scene_(scene), hidden_(hidden), width_(scene.still->packet_width) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        hits_.ray.mask[lane] = ~0U;
        hits_.ray.tnear[lane] = static_cast<float>(min_depth);
        hits_.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

ISPACE_SIMD_CLONES static void roundTile(const SightTile& tile, RTCRayHit16& rays) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        rays.ray.org_x[lane] = static_cast<float>(tile.origin_x[lane]);
        rays.ray.org_y[lane] = static_cast<float>(tile.origin_y[lane]);
        rays.ray.org_z[lane] = static_cast<float>(tile.origin_z[lane]);
        rays.ray.dir_x[lane] = static_cast<float>(tile.x[lane]);
        rays.ray.dir_y[lane] = static_cast<float>(tile.y[lane]);
        rays.ray.dir_z[lane] = static_cast<float>(tile.z[lane]);
        rays.ray.tfar[lane] = static_cast<float>(kFarthest);
        rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

void SightTracer::trace(SightTile& tile) {
    roundTile(tile, hits_);
    for (std::size_t lane = 0; lane < kLanes; ++lane) valid_[lane] = tile.is_black[lane] ? 0 : -1;
    EmbreeQuery query;
    tracePacket(query, scene_.still->solid->scene(), width_, valid_.data(), hits_);
    if (!scene_.bodies.empty()) {
        PassingHidden passing(scene_.bodies, hidden_);
        tracePacket(passing, scene_.bodies.scene(), width_, valid_.data(), hits_);
    }
    resolve(tile);
}

void SightTracer::resolve(SightTile& tile) const {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        tile.depth[lane] = kInfinity;
        if (hits_.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID || tile.is_black[lane]) continue;
        const auto kind = static_cast<SurfaceKind>(hits_.hit.geomID[lane]);
        const std::uint32_t triangle = hits_.hit.primID[lane];
        tile.kind[lane] = kind;
        tile.triangle[lane] = triangle;
        const TriangleSet& set = scene_.set(kind).triangles();
        const double found = static_cast<double>(hits_.ray.tfar[lane]);
        if (set.isRound(triangle)) {
            const RayHit hit =
                set.meet(triangle, {tile.origin(lane), tile.direction(lane), kFarthest}, 0);
            tile.depth[lane] = hit.isNone() ? found : hit.multiple;
            continue;
        }
        const Plane& plane = set.planes()[triangle];
        const double depth =
            plane.heightOver(tile.origin(lane)) / dot(plane.normal, tile.direction(lane));
        // What is seen almost edge-on is met at the rim of its enlarged triangle.
        const bool is_near = std::fabs(depth - found) <= 1e-4 * (1 + found);
        tile.depth[lane] = is_near ? depth : found;
    }
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/shading.h"

#include <algorithm>
#include <cmath>

#include "render/lights.h"

namespace ispace {

namespace {

/// What a lamp's panel shines with.
constexpr Rgb kPanel{3, 3, 2.9F};
/// Light that clear glass throws back, and lets pass.
constexpr Rgb kGlassShine{0.05F, 0.06F, 0.07F}, kGlassPasses{0.80F, 0.89F, 0.90F};
/// A clear pane, or a cone of vision, that is seen so often through itself is thick enough.
constexpr std::size_t kMostLayers = 32;

}  // namespace

Shading::Shading(const RenderScene::Data& scene, Illumination light, const RenderOptions& options)
    : scene_(scene), light_(light), options_(options), far_(25 * scene.still->extent) {}

bool Shading::meetsSurface(const SightTile& tile, std::size_t lane) const {
    if (tile.is_black[lane]) return false;
    if (tile.meets(lane)) return true;
    // The ground ends in the haze.
    constexpr double kEnd = 12;
    const double height = tile.origin_z[lane], fall = -tile.z[lane];
    return !options_.background && height > 0 && fall > 0 &&
           height * length(tile.direction(lane)) < kEnd * far_ * fall;
}

SurfacePoint Shading::ground(const SightTile& tile, std::size_t lane) const {
    const double depth = -tile.origin_z[lane] / tile.z[lane];
    SurfacePoint point;
    point.place = tile.origin(lane) + depth * tile.direction(lane);
    point.normal = {0, 0, 1};
    point.color = kGround;
    const double distance = depth * length(tile.direction(lane));
    point.haze = static_cast<float>(1 - std::exp(-distance / far_));
    return point;
}

Vec3 Shading::normalAt(const SightTile& tile, std::size_t lane, Point3 place) const {
    const std::uint32_t triangle = tile.triangle[lane];
    const auto seen = [&](Vec3 normal) {
        return dot(normal, tile.direction(lane)) > 0 ? -1 * normal : normal;
    };
    if (tile.kind[lane] == SurfaceKind::Person)
        return seen(scene_.people.body(triangle).body.normalAt(place));
    const TriangleSet& set = scene_.set(tile.kind[lane]).triangles();
    Vec3 normal = set.planes()[triangle].normal;
    if (const RoundBody* round = set.roundOf(triangle)) {
        constexpr double kAtEnd = 1e-6;
        const bool is_end = place.z > round->top - kAtEnd || place.z < round->bottom + kAtEnd;
        const Vec2 side = round->curve.normalAt(place.onFloor());
        normal = is_end ? Vec3{0, 0, 1} : 1 / length(side) * Vec3{side.x, side.y, 0};
    }
    return seen(normal);
}

SurfacePoint Shading::surface(const SightTile& tile, std::size_t lane) const {
    return tile.meets(lane) ? met(tile, lane) : ground(tile, lane);
}

SurfacePoint Shading::met(const SightTile& tile, std::size_t lane) const {
    const SurfaceSet& set = scene_.set(tile.kind[lane]);
    SurfacePoint point;
    point.place = tile.place(lane);
    const Finish finish = scene_.finishAt(set.finish(tile.triangle[lane]), point.place);
    point.normal = normalAt(tile, lane, point.place);
    const bool is_person = tile.kind[lane] == SurfaceKind::Person;
    if (!is_person && set.triangles().isRound(tile.triangle[lane])) point.lift = 3e-4;
    const Paint& look = scene_.still->paints[finish.paint];
    point.color = look.color;
    if (finish.face != Finish::kNoFace)
        point.color = scene_.still->faces[finish.face].colorAt(point.place, tile.direction(lane),
                                                               scene_.still->textures, look.color);
    if (look.is_ceiling && point.normal.z < 0 && light_ == Illumination::Lamps &&
        scene_.still->lamps.shinesAt(static_cast<float>(point.place.x),
                                     static_cast<float>(point.place.y)))
        point.glow = kPanel;
    return point;
}

Rgb Shading::background(const SightTile& tile, std::size_t lane) const {
    if (tile.is_black[lane]) return {};
    if (options_.background) return *options_.background;
    return Sky::seen(static_cast<float>(tile.z[lane] / length(tile.direction(lane))));
}

Rgb Shading::lit(const SurfacePoint& point, const Rgb& light) const {
    Rgb out = point.glow;
    if (point.glow[0] == 0)
        for (std::size_t k = 0; k < 3; ++k) out[k] = point.color[k] * light[k];
    if (point.haze > 0) {
        const Rgb far = Sky::seen(0);
        for (std::size_t k = 0; k < 3; ++k) out[k] += point.haze * (far[k] - out[k]);
    }
    return out;
}

/// Collects everything on the way, and stops at nothing.
struct ClearTracer::Query : EmbreeQuery {
    ClearTracer& tracer;
    SurfaceKind kind;

    Query(ClearTracer& collector, SurfaceKind of)
        : EmbreeQuery(pass), tracer(collector), kind(of) {}

    static void pass(const RTCFilterFunctionNArguments* args) {
        const auto& query =
            static_cast<const Query&>(*reinterpret_cast<const EmbreeQuery*>(args->context));
        for (unsigned i = 0; i < args->N; ++i) {
            if (args->valid[i] == 0) continue;
            args->valid[i] = 0;
            query.tracer.add(query.kind, RTCRayN_id(args->ray, args->N, i),
                             RTCHitN_primID(args->hit, args->N, i),
                             RTCRayN_tfar(args->ray, args->N, i));
        }
    }
};

ClearTracer::ClearTracer(const RenderScene::Data& scene, double min_depth) : scene_(scene) {
    for (const SurfaceKind kind : {SurfaceKind::Glass, SurfaceKind::Paint, SurfaceKind::View})
        if (!scene.set(kind).empty()) sets_.push_back(kind);
    for (unsigned lane = 0; lane < kLanes; ++lane) {
        hits_.ray.mask[lane] = ~0U;
        hits_.ray.id[lane] = lane;
        hits_.ray.tnear[lane] = static_cast<float>(min_depth);
        hits_.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

const std::array<std::vector<ClearLayer>, kLanes>& ClearTracer::trace(const SightTile& tile) {
    alignas(64) std::array<int, kLanes> valid;
    valid.fill(-1);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        layers_[lane].clear();
        hits_.ray.org_x[lane] = static_cast<float>(tile.origin_x[lane]);
        hits_.ray.org_y[lane] = static_cast<float>(tile.origin_y[lane]);
        hits_.ray.org_z[lane] = static_cast<float>(tile.origin_z[lane]);
        hits_.ray.dir_x[lane] = static_cast<float>(tile.x[lane]);
        hits_.ray.dir_y[lane] = static_cast<float>(tile.y[lane]);
        hits_.ray.dir_z[lane] = static_cast<float>(tile.z[lane]);
        const double far = tile.meets(lane) ? tile.depth(lane) * (1 - 1e-6) : kFarthest;
        hits_.ray.tfar[lane] = tile.is_black[lane] ? -1.0F : static_cast<float>(far);
        hits_.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    for (const SurfaceKind kind : sets_) {
        Query query(*this, kind);
        tracePacket(query, scene_.set(kind).scene(), scene_.still->packet_width, valid.data(),
                    hits_);
    }
    for (std::vector<ClearLayer>& layers : layers_)
        std::stable_sort(
            layers.begin(), layers.end(),
            [](const ClearLayer& a, const ClearLayer& b) { return a.depth < b.depth; });
    return layers_;
}

void ClearTracer::add(SurfaceKind kind, std::size_t lane, std::uint32_t triangle, float depth) {
    if (layers_[lane].size() >= kMostLayers) return;
    if (kind == SurfaceKind::Glass) {
        layers_[lane].push_back({depth, kGlassShine, kGlassPasses, false});
        return;
    }
    const Paint& paint = scene_.still->paints[scene_.set(kind).finish(triangle).paint];
    ClearLayer layer{depth, {}, {}, paint.is_lit};
    for (std::size_t k = 0; k < 3; ++k) {
        layer.light[k] = paint.opacity * paint.color[k];
        layer.passes[k] = 1 - paint.opacity;
    }
    layers_[lane].push_back(layer);
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/shading.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "base/simd.h"
#include "geom/tolerance.h"
#include "trace/render/lights.h"

namespace ispace {

namespace {

/// Radiance of a lamp's panel.
constexpr Rgb kPanel{3, 3, 2.9F};
/// Shares of light that clear glass reflects and transmits.
constexpr Rgb kGlassShine{0.05F, 0.06F, 0.07F}, kGlassPasses{0.80F, 0.89F, 0.90F};
/// Maximum number of layers of one clear pane or field of view.
constexpr std::size_t kMaxLayers = 32;

}  // namespace

Shading::Shading(const RenderScene::Data& scene, Illumination light, const RenderOptions& options)
    : scene_(scene), light_(light), options_(options), far_(25 * scene.still->extent) {}

bool Shading::meetsSurface(const RayTile& tile, std::size_t lane) const {
    if (tile.is_black[lane]) return false;
    if (tile.meets(lane)) return true;
    // The ground ends in the haze.
    constexpr double kEnd = 12;
    const double height = tile.origin_z[lane], fall = -tile.z[lane];
    return !options_.background && height > 0 && fall > 0 &&
           height * length(tile.direction(lane)) < kEnd * far_ * fall;
}

SurfacePoint Shading::ground(const RayTile& tile, std::size_t lane) const {
    const double depth = -tile.origin_z[lane] / tile.z[lane];
    SurfacePoint point;
    point.place = tile.origin(lane) + depth * tile.direction(lane);
    point.normal = {0, 0, 1};
    point.color = kGround;
    const double distance = depth * length(tile.direction(lane));
    point.haze = static_cast<float>(1 - std::exp(-distance / far_));
    return point;
}

namespace {

/// Turns a normal towards the viewer.
Vec3 seen(Vec3 normal, Vec3 direction) { return dot(normal, direction) > 0 ? -1 * normal : normal; }

}  // namespace

Vec3 Shading::normalAt(const RayTile& tile, std::size_t lane, Point3 place) const {
    const std::uint32_t triangle = tile.triangle[lane];
    if (tile.kind[lane] == SurfaceKind::Person)
        return seen(scene_.people.body(triangle).body.normalAt(place), tile.direction(lane));
    const TriangleSet& set = scene_.set(tile.kind[lane]).triangles();
    Vec3 normal = set.planes()[triangle].normal;
    if (const RoundBody* round = set.roundOf(triangle)) {
        const bool is_end =
            place.z > round->top - kCornerTolerance || place.z < round->bottom + kCornerTolerance;
        const Vec2 side = round->curve.normalAt(place.onFloor());
        normal = is_end ? Vec3{0, 0, 1} : 1 / length(side) * Vec3{side.x, side.y, 0};
    }
    return seen(normal, tile.direction(lane));
}

SurfacePoint Shading::surface(const RayTile& tile, std::size_t lane, Facet& last) const {
    if (!tile.meets(lane)) return ground(tile, lane);
    const bool is_last = tile.triangle[lane] == last.triangle && tile.kind[lane] == last.kind;
    if (is_last && last.is_plain) {
        SurfacePoint point = last.point;
        point.place = tile.place(lane);
        point.normal = seen(point.normal, tile.direction(lane));
        return point;
    }
    const SurfacePoint point = met(tile, lane);
    if (!is_last) {
        last.kind = tile.kind[lane];
        last.triangle = tile.triangle[lane];
        last.is_plain = isPlain(last.kind, last.triangle);
        if (last.is_plain) last.point = point;
    }
    return point;
}

/// True if all points of a triangle have one normal and one colour.
bool Shading::isPlain(SurfaceKind kind, std::uint32_t triangle) const {
    const SurfaceSet& set = scene_.set(kind);
    if (kind == SurfaceKind::Person || set.triangles().roundOf(triangle) != nullptr) return false;
    const SurfaceFinish& finish = set.finish(triangle);
    const Paint& look = scene_.still->paints[finish.paint];
    const bool is_covered = finish.label == 0 && look.is_floor && !scene_.still->coverings.empty();
    if (look.glows) return false;
    const bool has_panels = look.is_ceiling && light_ == Illumination::Lamps;
    return finish.face == SurfaceFinish::kNoFace && !is_covered && !has_panels;
}

SurfacePoint Shading::met(const RayTile& tile, std::size_t lane) const {
    const SurfaceSet& set = scene_.set(tile.kind[lane]);
    SurfacePoint point;
    point.place = tile.place(lane);
    const SurfaceFinish finish = scene_.finishAt(set.finish(tile.triangle[lane]), point.place);
    point.normal = normalAt(tile, lane, point.place);
    const bool is_person = tile.kind[lane] == SurfaceKind::Person;
    if (!is_person && set.triangles().roundOf(tile.triangle[lane]) != nullptr) point.lift = 3e-4;
    const Paint& look = scene_.still->paints[finish.paint];
    point.color = look.color;
    if (look.glows) point.glow = look.color;
    if (finish.face != SurfaceFinish::kNoFace)
        point.color = scene_.still->faces[finish.face].colorAt(point.place, tile.direction(lane),
                                                               scene_.still->textures, look.color);
    if (look.is_ceiling && point.normal.z < 0 && light_ == Illumination::Lamps &&
        scene_.still->lamps.shinesAt(static_cast<float>(point.place.x),
                                     static_cast<float>(point.place.y)))
        point.glow = kPanel;
    return point;
}

Rgb Shading::background(const RayTile& tile, std::size_t lane) const {
    if (tile.is_black[lane]) return {};
    if (options_.background) return *options_.background;
    return Sky::seen(static_cast<float>(tile.z[lane] / length(tile.direction(lane))));
}

Rgb Shading::lit(const SurfacePoint& point, const Rgb& light) const {
    Rgb out = point.glow;
    if (point.glow == Rgb{})
        for (std::size_t k = 0; k < 3; ++k) out[k] = point.color[k] * light[k];
    if (point.haze > 0) {
        const Rgb far = Sky::seen(0);
        for (std::size_t k = 0; k < 3; ++k) out[k] += point.haze * (far[k] - out[k]);
    }
    return out;
}

/// Collects all layers on the way without stopping the ray.
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

const std::array<std::vector<ClearLayer>, kLanes>& ClearTracer::trace(const RayTile& tile) {
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
        const double far = tile.meets(lane) ? tile.depth(lane) * (1 - 1e-6) : kMaxRayReach;
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
    if (layers_[lane].size() >= kMaxLayers) return;
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

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A query that skips hidden bodies.
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

void RayTile::set(std::size_t lane, const PixelRay& line, Vec3 shift) {
    has_new_origins = true;
    x[lane] = line.direction.x;
    y[lane] = line.direction.y;
    z[lane] = line.direction.z;
    origin_x[lane] = line.origin.x + shift.x;
    origin_y[lane] = line.origin.y + shift.y;
    origin_z[lane] = line.origin.z + shift.z;
}

TileTracer::TileTracer(const RenderScene::Data& scene, const std::vector<bool>& hidden,
                       double min_depth)
    : scene_(scene),
      hidden_(hidden),
      width_(scene.still->packet_width),
      people_(hidden),
      min_depth_(min_depth) {
    valid_.fill(-1);
    far_.fill(static_cast<float>(kMaxRayReach));
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

ISPACE_SIMD_CLONES void fillDirections(const EvenPixelRays& lines, PixelPoint first,
                                       RayTile& tile) {
    const Vec3 d = lines.direction, right = lines.right, down = lines.down;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double u = first.column + kAside[lane], v = first.row + kBelow[lane];
        tile.x[lane] = d.x + u * right.x + v * down.x;
        tile.y[lane] = d.y + u * right.y + v * down.y;
        tile.z[lane] = d.z + u * right.z + v * down.z;
    }
}

ISPACE_SIMD_CLONES void fillOrigins(const EvenPixelRays& lines, Vec3 shift, PixelPoint first,
                                    RayTile& tile) {
    const Point3 o = lines.origin + shift;
    const Vec3 right = lines.origin_right, down = lines.origin_down;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const double u = first.column + kAside[lane], v = first.row + kBelow[lane];
        tile.origin_x[lane] = o.x + u * right.x + v * down.x;
        tile.origin_y[lane] = o.y + u * right.y + v * down.y;
        tile.origin_z[lane] = o.z + u * right.z + v * down.z;
    }
}

ISPACE_SIMD_CLONES void readHits(const RTCRayHit16& hits, RayTile& tile) {
    const std::uint32_t triangle = hits.hit.primID[0], kind = hits.hit.geomID[0];
    std::uint32_t other = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        tile.triangle[lane] = hits.hit.primID[lane];
        tile.kind[lane] = static_cast<SurfaceKind>(hits.hit.geomID[lane]);
        other |= (hits.hit.primID[lane] ^ triangle) | (hits.hit.geomID[lane] ^ kind);
    }
    tile.is_one_triangle = other == 0 && kind != RTC_INVALID_GEOMETRY_ID;
}

ISPACE_SIMD_CLONES void blacken(RayTile& tile) {
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        tile.multiples[lane] = simd::choose(tile.is_black[lane], kNoReturn, tile.multiples[lane]);
}

}  // namespace

void RayTile::set(const EvenPixelRays& lines, PixelPoint first, Vec3 shift) {
    fillDirections(lines, first, *this);
    const Point3 kept = lines.origin + shift;
    const bool is_one = lines.origin_right == Vec3() && lines.origin_down == Vec3();
    if (is_one && origin(0) == kept && origin(kLanes - 1) == kept) return;
    fillOrigins(lines, shift, first, *this);
    has_new_origins = true;
}

namespace {

using Pixels = SurroundedTile::Pixels;

/// Interpolates between each pixel of a tile and its neighbours.
ISPACE_SIMD_CLONES void fillBetween(const Pixels& values, PixelPoint at, double shift,
                                    std::array<double, kLanes>& out) {
    constexpr int kSide = SurroundedTile::kSide;
    const double u = std::fabs(at.column), v = std::fabs(at.row);
    const double* const middle = &values[kSide + 1];
    const double* const aside = middle + (at.column < 0 ? -1 : 1);
    const double* const below = middle + (at.row < 0 ? -kSide : kSide);
    std::size_t lane = 0;
    for (int row = 0; row < kTile; ++row)
        for (int column = 0; column < kTile; ++column) {
            const int i = row * kSide + column;
            const double a = middle[i];
            out[lane++] = a + u * (aside[i] - a) + v * (below[i] - a) + shift;
        }
}

}  // namespace

void RayTile::set(const SurroundedTile& lines, PixelPoint at, Vec3 shift) {
    is_black.fill(false);
    has_new_origins = true;
    fillBetween(lines.x, at, 0, x);
    fillBetween(lines.y, at, 0, y);
    fillBetween(lines.z, at, 0, z);
    fillBetween(lines.origin_x, at, shift.x, origin_x);
    fillBetween(lines.origin_y, at, shift.y, origin_y);
    fillBetween(lines.origin_z, at, shift.z, origin_z);
}

void TileTracer::trace(RayTile& tile) {
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

double TileTracer::resolve(const RayTile& tile, std::size_t lane) const {
    if (hits_.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) return kInfinity;
    const std::uint32_t triangle = tile.triangle[lane];
    const double found = static_cast<double>(hits_.ray.tfar[lane]);
    if (tile.kind[lane] == SurfaceKind::Person) {
        const RayHit met =
            scene_.people.body(triangle).meet(tile.origin(lane), tile.direction(lane), min_depth_);
        return met.multiple < kInfinity ? met.multiple : found;
    }
    const TriangleSet& set = scene_.set(tile.kind[lane]).triangles();
    if (set.roundOf(triangle) != nullptr) {
        const RayHit hit =
            set.meet(triangle, {tile.origin(lane), tile.direction(lane), kMaxRayReach}, 0);
        return hit.isNone() ? found : hit.multiple;
    }
    const Plane& plane = set.planes()[triangle];
    const double depth =
        plane.heightOver(tile.origin(lane)) / dot(plane.normal, tile.direction(lane));
    // Surfaces seen almost edge-on are hit at the rim of their enlarged triangle.
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

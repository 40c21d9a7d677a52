// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/thrown_light.h"

#include <array>
#include <vector>

#include "trace/embree_bodies.h"
#include "trace/embree_query.h"

namespace ispace {

namespace {

/// Illuminance of a white surface of radiance 1: that of lamps of 3600 lumens in a room of 2.5 m.
constexpr double kWhite = 660;

const std::vector<bool> kNoOwnerHidden;

/// Returns true if a body is between a surface and a lens.
bool isInShadow(const RenderScene::Data& scene, const SurfacePoint& point, Point3 lens) {
    const Point3 from = point.place + point.lift * point.normal;
    const Vec3 way = lens - from;
    alignas(64) RTCRay16 rays{};
    alignas(64) std::array<int, kLanes> valid{};
    valid[0] = -1;
    rays.org_x[0] = static_cast<float>(from.x);
    rays.org_y[0] = static_cast<float>(from.y);
    rays.org_z[0] = static_cast<float>(from.z);
    rays.dir_x[0] = static_cast<float>(way.x);
    rays.dir_y[0] = static_cast<float>(way.y);
    rays.dir_z[0] = static_cast<float>(way.z);
    rays.tfar[0] = 0.999F;
    rays.mask[0] = ~0U;
    BodyQuery query(kNoOwnerHidden);
    query.makeIncoherent();
    for (const SurfaceKind kind : {SurfaceKind::Solid, SurfaceKind::Body, SurfaceKind::Person}) {
        const SurfaceSet& set = scene.set(kind);
        if (set.empty()) continue;
        traceShadows(query, set.scene(), scene.still->packet_width, valid.data(), rays);
        if (!(rays.tfar[0] > 0)) return true;
    }
    return false;
}

}  // namespace

Rgb thrownLight(const RenderScene::Data& scene, const SurfacePoint& point) {
    Rgb sum{};
    for (const ThrownPicture& picture : scene.still->thrown) {
        const auto spot = picture.beam.spotAt(point.place, point.normal);
        if (!spot || isInShadow(scene, point, picture.beam.lens.origin)) continue;
        Rgb color{1, 1, 1};
        if (picture.texture != ThrownPicture::kPlain)
            color = scene.still->textures[picture.texture].at(spot->u, spot->v, {});
        for (std::size_t k = 0; k < 3; ++k)
            sum[k] += static_cast<float>(spot->lux / kWhite) * picture.color[k] * color[k];
    }
    return sum;
}

}  // namespace ispace

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

/// Pictures that fall on a point unless a body is between, as many as one packet of rays holds.
struct ThrownPacket {
    struct Entry {
        const ThrownPicture* picture = nullptr;
        ProjectorBeam::Spot spot;
    };
    std::array<Entry, kLanes> entries;
    std::size_t count = 0;
};

/// Traces from a surface to the lenses. \returns the lanes without a body between
std::array<bool, kLanes> litLanes(const RenderScene::Data& scene, const SurfacePoint& point,
                                  const ThrownPacket& packet) {
    const Point3 from = point.place + point.lift * point.normal;
    alignas(64) RTCRay16 rays{};
    alignas(64) std::array<int, kLanes> valid{};
    for (std::size_t k = 0; k < packet.count; ++k) {
        const Vec3 way = packet.entries[k].picture->beam.lens.origin - from;
        valid[k] = -1;
        rays.org_x[k] = static_cast<float>(from.x);
        rays.org_y[k] = static_cast<float>(from.y);
        rays.org_z[k] = static_cast<float>(from.z);
        rays.dir_x[k] = static_cast<float>(way.x);
        rays.dir_y[k] = static_cast<float>(way.y);
        rays.dir_z[k] = static_cast<float>(way.z);
        rays.tfar[k] = 0.999F;
        rays.mask[k] = ~0U;
    }
    BodyQuery query(kNoOwnerHidden);
    query.makeIncoherent();
    for (const SurfaceKind kind : {SurfaceKind::Solid, SurfaceKind::Body, SurfaceKind::Person}) {
        const SurfaceSet& set = scene.set(kind);
        if (set.empty()) continue;
        traceShadows(query, set.scene(), scene.still->packet_width, valid.data(), rays);
        for (std::size_t k = 0; k < packet.count; ++k)
            if (!(rays.tfar[k] > 0)) valid[k] = 0;
    }
    std::array<bool, kLanes> is_lit{};
    for (std::size_t k = 0; k < packet.count; ++k) is_lit[k] = valid[k] != 0;
    return is_lit;
}

void addLight(const RenderScene::Data& scene, const SurfacePoint& point, ThrownPacket& packet,
              Rgb& sum) {
    if (packet.count == 0) return;
    const auto is_lit = litLanes(scene, point, packet);
    for (std::size_t k = 0; k < packet.count; ++k) {
        if (!is_lit[k]) continue;
        const auto& [picture, spot] = packet.entries[k];
        Rgb color{1, 1, 1};
        if (picture->texture != ThrownPicture::kPlain)
            color = scene.still->textures[picture->texture].at(spot.u, spot.v, {});
        for (std::size_t c = 0; c < 3; ++c)
            sum[c] += static_cast<float>(spot.lux / kWhite) * picture->color[c] * color[c];
    }
    packet.count = 0;
}

}  // namespace

Rgb thrownLight(const RenderScene::Data& scene, const SurfacePoint& point) {
    Rgb sum{};
    ThrownPacket packet;
    for (const ThrownPicture& picture : scene.still->thrown) {
        const auto spot = picture.beam.spotAt(point.place, point.normal);
        if (!spot) continue;
        packet.entries[packet.count++] = {&picture, *spot};
        if (packet.count == kLanes) addLight(scene, point, packet, sum);
    }
    addLight(scene, point, packet, sum);
    return sum;
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/render/light_tracer.h"

#include <algorithm>
#include <cmath>

#include "base/simd.h"

namespace ispace {

namespace {

/// Share of a bright room's light that surfaces reflect; less from nearby ones, so that corners and
/// narrow gaps are darker.
constexpr float kBounce = 0.90F, kNearBounce = 0.35F, kNear = 0.9F;
/// Without a ceiling, a bright one is assumed above the lamps.
constexpr float kOpen = 0.50F;
/// Share of light transmitted by clear glass.
constexpr Rgb kGlass{0.80F, 0.88F, 0.88F};

/// The point of a net (Sobol) that a pixel of a tile takes: neighbours take points far apart.
constexpr std::array<std::uint8_t, kLanes> kOrder{0, 8,  2, 10, 12, 4, 14, 6,
                                                  3, 11, 1, 9,  15, 7, 13, 5};
/// Bodies of people are never hidden from light.
const std::vector<bool> kNotHidden;

using Directions4 = std::array<unsigned, 4>;
constexpr std::array<Directions4, 3> kNet{{{8, 4, 2, 1}, {8, 12, 10, 15}, {8, 12, 6, 9}}};

/// One coordinate of the point of a net for a sample, somewhere in its sixteenth.
float inNet(std::size_t dimension, std::size_t lane, int sample, float within) {
    const unsigned point = (kOrder[lane] + 5U * static_cast<unsigned>(sample)) % 16U;
    unsigned cell = 0;
    for (unsigned bit = 0; bit < 4; ++bit)
        if ((point >> bit & 1U) != 0) cell ^= kNet[dimension][bit];
    return (static_cast<float>(cell) + within) / 16;
}

/// A point in the unit disc.
struct InDisc {
    float a, b, height;  ///< height: of the half sphere over it

    InDisc(float u, float v) : height(std::sqrt(std::max(0.0F, 1 - u))) {
        const float radius = std::sqrt(u);
        const auto turn = static_cast<std::uint32_t>(v * 0x1p32F);
        a = radius * simd::sineOfTurn(turn + 0x40000000U);
        b = radius * simd::sineOfTurn(turn);
    }
};

struct Vec3f {
    float x, y, z;
};

/// Two unit vectors at right angles to a unit vector and to each other (Duff et al., Building an
/// Orthonormal Basis, Revisited, 2017).
struct TangentFrame {
    Vec3f a, b;

    explicit TangentFrame(const Vec3f& n) {
        const float sign = std::copysign(1.0F, n.z), c = -1 / (sign + n.z), d = n.x * n.y * c;
        a = {1 + sign * n.x * n.x * c, sign * d, -sign * n.x};
        b = {d, sign + n.y * n.y * c, -n.y};
    }
};

}  // namespace

void LitPlaces::set(std::size_t lane, Point3 place, Vec3 normal, double lift) {
    is_wanted[lane] = true;
    x[lane] = static_cast<float>(place.x + lift * normal.x);
    y[lane] = static_cast<float>(place.y + lift * normal.y);
    z[lane] = static_cast<float>(place.z + lift * normal.z);
    normal_x[lane] = static_cast<float>(normal.x);
    normal_y[lane] = static_cast<float>(normal.y);
    normal_z[lane] = static_cast<float>(normal.z);
}

LightTracer::LightTracer(const RenderScene::Data& scene, Illumination light, int samples)
    : scene_(scene), light_(light), samples_(samples) {
    valid_.fill(-1);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        shadows_.mask[lane] = hits_.ray.mask[lane] = ~0U;
        hits_.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
}

void LightTracer::gather(LitPlaces& places, std::span<const float> draws) {
    places.direct.fill({});
    places.bounced.fill({});
    for (int sample = 0; sample < samples_; ++sample) {
        if (light_ == Illumination::Lamps)
            towardsLamps(places, draws, sample);
        else
            towardsSun(places, draws, sample);
        addDirect(places);
        addBounced(places, draws, sample);
    }
    const float share = 1 / static_cast<float>(samples_);
    for (std::size_t lane = 0; lane < kLanes; ++lane)
        for (std::size_t k = 0; k < 3; ++k) {
            places.direct[lane][k] *= share;
            places.bounced[lane][k] *= share;
        }
}

void LightTracer::aimShadow(std::size_t lane, const LitPlaces& places, float x, float y, float z,
                            float far) {
    shadows_.org_x[lane] = places.x[lane];
    shadows_.org_y[lane] = places.y[lane];
    shadows_.org_z[lane] = places.z[lane];
    shadows_.dir_x[lane] = x;
    shadows_.dir_y[lane] = y;
    shadows_.dir_z[lane] = z;
    shadows_.tnear[lane] = 0;
    shadows_.tfar[lane] = far;
}

void LightTracer::towardsLamps(const LitPlaces& places, std::span<const float> draws, int sample) {
    const Lamps& lamps = scene_.still->lamps;
    const float fading = 1 / (lamps.reach() * lamps.reach());
    std::array<float, 512> weights;  // NOLINT: computed as far as it is read
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        aimShadow(lane, places, 0, 0, 1, -1);
        strength_[lane] = {};
        if (!places.is_wanted[lane]) continue;
        const float x = places.x[lane], y = places.y[lane], z = lamps.height() - places.z[lane];
        if (z <= 0) continue;
        auto near = lamps.near(x, y);
        near = near.first(std::min(near.size(), weights.size()));
        float sum = 0;
        for (std::size_t i = 0; i < near.size(); ++i) {
            const Lamps::Lamp& lamp = lamps.all()[near[i]];
            const float dx = lamp.x - x, dy = lamp.y - y, flat = dx * dx + dy * dy;
            // Near a panel its size matters: its centre is too near as a point source.
            const float square = flat + z * z + Lamps::kHalf * Lamps::kHalf;
            const float facing =
                places.normal_x[lane] * dx + places.normal_y[lane] * dy + places.normal_z[lane] * z;
            const float fade = std::max(0.0F, 1 - flat * fading);
            weights[i] =
                lamp.strength * std::max(0.0F, facing) * z * fade * fade / (square * square);
            sum += weights[i];
        }
        if (!(sum > 0)) continue;
        const float* const draw = &draws[kLightDraws * (lane * static_cast<std::size_t>(samples_) +
                                                        static_cast<std::size_t>(sample))];
        float left = sum * inNet(0, lane, sample, draw[0]);
        std::size_t chosen = 0;
        while (chosen + 1 < near.size() && (left -= weights[chosen]) > 0) ++chosen;
        const float u = inNet(1, lane, sample, draw[1]), v = inNet(2, lane, sample, draw[2]);
        const Lamps::Lamp& lamp = lamps.all()[near[chosen]];
        const float along = Lamps::kHalf * (2 * u - 1), across = Lamps::kHalf * (2 * v - 1);
        aimShadow(lane, places, lamp.x - x + (lamp.cosine * along - lamp.sine * across),
                  lamp.y - y + (lamp.sine * along + lamp.cosine * across), z, 0.999F);
        for (std::size_t k = 0; k < 3; ++k) strength_[lane][k] = sum * lamp.color[k];
    }
}

void LightTracer::towardsSun(const LitPlaces& places, std::span<const float> draws, int sample) {
    const Vec3 sun = Sky::sun();
    const Vec3f to{static_cast<float>(sun.x), static_cast<float>(sun.y), static_cast<float>(sun.z)};
    const TangentFrame across(to);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        aimShadow(lane, places, 0, 0, 1, -1);
        strength_[lane] = {};
        if (!places.is_wanted[lane]) continue;
        const float facing = places.normal_x[lane] * to.x + places.normal_y[lane] * to.y +
                             places.normal_z[lane] * to.z;
        if (facing <= 0) continue;
        const float* const draw = &draws[kLightDraws * (lane * static_cast<std::size_t>(samples_) +
                                                        static_cast<std::size_t>(sample))];
        const InDisc at(inNet(1, lane, sample, draw[1]), inNet(2, lane, sample, draw[2]));
        const float a = Sky::kSunRadius * at.a, b = Sky::kSunRadius * at.b;
        aimShadow(lane, places, to.x + a * across.a.x + b * across.b.x,
                  to.y + a * across.a.y + b * across.b.y, to.z + a * across.a.z + b * across.b.z,
                  1e30F);
        for (std::size_t k = 0; k < 3; ++k) strength_[lane][k] = facing * Sky::kSunlight[k];
    }
}

void LightTracer::addDirect(LitPlaces& places) {
    const std::size_t width = scene_.still->packet_width;
    BodyQuery query(kNotHidden);
    query.makeIncoherent();
    RTCRay16 through = shadows_;  // copied before it is traced
    traceShadows(query, scene_.still->solid->scene(), width, valid_.data(), shadows_);
    if (!scene_.bodies.empty())
        traceShadows(query, scene_.bodies.scene(), width, valid_.data(), shadows_);
    if (!scene_.people.empty())
        traceShadows(query, scene_.people.scene(), width, valid_.data(), shadows_);
    const bool has_glass = !scene_.still->glass->empty();
    if (has_glass) traceShadows(query, scene_.still->glass->scene(), width, valid_.data(), through);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (!(shadows_.tfar[lane] > 0)) continue;
        const bool is_behind = has_glass && !(through.tfar[lane] > 0);
        for (std::size_t k = 0; k < 3; ++k)
            places.direct[lane][k] += strength_[lane][k] * (is_behind ? kGlass[k] : 1);
    }
}

void LightTracer::addBounced(LitPlaces& places, std::span<const float> draws, int sample) {
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        const float* const draw = &draws[kLightDraws * (lane * static_cast<std::size_t>(samples_) +
                                                        static_cast<std::size_t>(sample))];
        const InDisc at(inNet(1, lane, sample, draw[3]), inNet(2, lane, sample, draw[4]));
        const Vec3f n{places.normal_x[lane], places.normal_y[lane], places.normal_z[lane]};
        const TangentFrame across(n);
        const float a = at.a, b = at.b, c = at.height;
        RTCRay16& ray = hits_.ray;
        ray.org_x[lane] = places.x[lane];
        ray.org_y[lane] = places.y[lane];
        ray.org_z[lane] = places.z[lane];
        ray.dir_x[lane] = a * across.a.x + b * across.b.x + c * n.x;
        ray.dir_y[lane] = a * across.a.y + b * across.b.y + c * n.y;
        ray.dir_z[lane] = a * across.a.z + b * across.b.z + c * n.z;
        ray.tnear[lane] = 0;
        ray.tfar[lane] = places.is_wanted[lane] ? 1e30F : -1.0F;
        hits_.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
    }
    BodyQuery query(kNotHidden);
    query.makeIncoherent();
    const std::size_t width = scene_.still->packet_width;
    tracePacket(query, scene_.still->solid->scene(), width, valid_.data(), hits_);
    if (!scene_.bodies.empty())
        tracePacket(query, scene_.bodies.scene(), width, valid_.data(), hits_);
    if (!scene_.people.empty())
        tracePacket(query, scene_.people.scene(), width, valid_.data(), hits_);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (!places.is_wanted[lane]) continue;
        const Rgb more = bounced(lane);
        for (std::size_t k = 0; k < 3; ++k) places.bounced[lane][k] += more[k];
    }
}

/// Radiance that comes along a ray from near by, or from the sky.
Rgb LightTracer::bounced(std::size_t lane) const {
    const float up = hits_.ray.dir_z[lane];
    if (hits_.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) {
        if (light_ == Illumination::Sky && up > 0) return Sky::light(up);
        if (up > 0) return {kOpen, kOpen, kOpen};
        return {0.5F * kGround[0], 0.5F * kGround[1], 0.5F * kGround[2]};
    }
    const SurfaceSet& set = scene_.set(static_cast<SurfaceKind>(hits_.hit.geomID[lane]));
    const Rgb& color = scene_.still->paints[set.finish(hits_.hit.primID[lane]).paint].color;
    const float near = std::min(1.0F, hits_.ray.tfar[lane] / kNear);
    const float share = kNearBounce + (kBounce - kNearBounce) * near;
    return {share * color[0], share * color[1], share * color[2]};
}

}  // namespace ispace

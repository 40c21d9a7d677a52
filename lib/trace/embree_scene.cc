// SPDX-License-Identifier: GPL-3.0-or-later
#include "trace/embree_scene.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

namespace ispace {

namespace {

constexpr float kNoReturn = std::numeric_limits<float>::infinity();

void throwOnError(RTCDevice device) {
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_NONE) return;
    throw std::runtime_error(code == RTC_ERROR_OUT_OF_MEMORY
                                 ? "Embree has no memory left for the scene"
                                 : "Embree failed with error " + std::to_string(code));
}

int nativeWidth(RTCDevice device) {
    const auto has = [device](RTCDeviceProperty property) {
        return rtcGetDeviceProperty(device, property) != 0;
    };
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)) return 16;
    if (has(RTC_DEVICE_PROPERTY_NATIVE_RAY8_SUPPORTED)) return 8;
    return 4;
}

/// Planes through the origin of rays that stop none of them: those of the surfaces it touches.
struct TouchedPlanes {
    float contact = 0;          ///< metres
    std::vector<Vec3> normals;  ///< unit length

    /// True if a hit belongs to such a plane.
    [[nodiscard]] bool contain(Vec3 hit_normal, Vec3 direction, float distance) const {
        constexpr double kParallel = 1 - 1e-6;  // cosine
        const double size = length(hit_normal);
        if (std::fabs(dot(hit_normal, direction)) * distance > contact * size) return false;
        return std::any_of(normals.begin(), normals.end(), [&](Vec3 normal) {
            return std::fabs(dot(normal, hit_normal)) >= kParallel * size;
        });
    }
};

/// Skips what touched planes contain, for one ray at a time.
void planeFilter(const RTCFilterFunctionNArguments* args);

// One query of Embree 3 or 4, first so that the filter gets it back as its context.
#if RTC_VERSION_MAJOR >= 4
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
struct Query {
    RTCRayQueryContext context;
    RTCIntersectArguments arguments;
    const TouchedPlanes* skipped;  ///< null: nothing is skipped

    explicit Query(const TouchedPlanes* planes) : skipped(planes) {
        rtcInitRayQueryContext(&context);
        rtcInitIntersectArguments(&arguments);
        arguments.context = &context;
        arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
        if (skipped == nullptr) return;
        arguments.filter = planeFilter;
        arguments.flags = RTC_RAY_QUERY_FLAG_INVOKE_ARGUMENT_FILTER;
    }
    template <auto kCall, typename Rays>
    void trace(const int* valid, RTCScene scene, Rays* rays) {
        kCall(valid, scene, rays, &arguments);
    }
    void trace(RTCScene scene, RTCRayHit* ray) { rtcIntersect1(scene, ray, &arguments); }
};
#else
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION;
struct Query {
    RTCIntersectContext context;
    const TouchedPlanes* skipped;  ///< null: nothing is skipped

    explicit Query(const TouchedPlanes* planes) : skipped(planes) {
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        if (skipped != nullptr) context.filter = planeFilter;
    }
    template <auto kCall, typename Rays>
    void trace(const int* valid, RTCScene scene, Rays* rays) {
        kCall(valid, scene, &context, rays);
    }
    void trace(RTCScene scene, RTCRayHit* ray) { rtcIntersect1(scene, &context, ray); }
};
#endif

void planeFilter(const RTCFilterFunctionNArguments* args) {
    const TouchedPlanes& skipped = *reinterpret_cast<const Query*>(args->context)->skipped;
    for (unsigned i = 0; i < args->N; ++i) {
        const Vec3 normal{RTCHitN_Ng_x(args->hit, args->N, i), RTCHitN_Ng_y(args->hit, args->N, i),
                          RTCHitN_Ng_z(args->hit, args->N, i)};
        const Vec3 direction{RTCRayN_dir_x(args->ray, args->N, i),
                             RTCRayN_dir_y(args->ray, args->N, i),
                             RTCRayN_dir_z(args->ray, args->N, i)};
        if (skipped.contain(normal, direction, RTCRayN_tfar(args->ray, args->N, i)))
            args->valid[i] = 0;
    }
}

/// Surfaces whose bounds come near the point of a query.
bool collect(RTCPointQueryFunctionArguments* args) {
    static_cast<std::vector<unsigned>*>(args->userPtr)->push_back(args->primID);
    return false;
}

/// Distance of a point from a triangle and the triangle's unit normal; nothing for one without
/// area.
struct Facing {
    double distance;
    Vec3 normal;
};
std::optional<Facing> facing(const TriangleSoup& soup, std::size_t triangle, Point3 p) {
    const Point3 corners[] = {soup.corner(triangle, 0), soup.corner(triangle, 1),
                              soup.corner(triangle, 2)};
    const Vec3 across = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double size = length(across);
    if (size == 0) return std::nullopt;
    const Vec3 normal = (1 / size) * across;
    bool is_over = true;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec3 side = corners[(i + 1) % 3] - corners[i], way = p - corners[i];
        if (dot(cross(normal, side), way) < 0) is_over = false;
        const double share = std::clamp(dot(way, side) / dot(side, side), 0.0, 1.0);
        nearest = std::min(nearest, length(p - (corners[i] + share * side)));
    }
    return Facing{is_over ? std::fabs(dot(normal, p - corners[0])) : nearest, normal};
}

TouchedPlanes touchedBy(RTCScene scene, const TriangleSoup& soup, Point3 origin, double contact) {
    RTCPointQuery query{};
    query.x = static_cast<float>(origin.x);
    query.y = static_cast<float>(origin.y);
    query.z = static_cast<float>(origin.z);
    query.radius = static_cast<float>(2 * contact);  // more than rounding to float32
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    std::vector<unsigned> near;
    rtcPointQuery(scene, &query, &context, collect, &near);
    TouchedPlanes planes{static_cast<float>(contact), {}};
    for (const unsigned triangle : near) {
        const auto found = facing(soup, triangle, origin);
        if (found && found->distance <= contact) planes.normals.push_back(found->normal);
    }
    return planes;
}

template <int kRays, typename RayHit, auto kIntersectCall>
struct PacketOf {
    static constexpr std::size_t kWidth = kRays;
    using Hits = RayHit;
    static constexpr auto kIntersect = kIntersectCall;
};
using Packet4 = PacketOf<4, RTCRayHit4, rtcIntersect4>;
using Packet8 = PacketOf<8, RTCRayHit8, rtcIntersect8>;
using Packet16 = PacketOf<16, RTCRayHit16, rtcIntersect16>;

/// Below this cosine between ray and normal (half a degree) float32 no longer tells where a surface
/// is met to a tenth of a millimetre.
constexpr float kGrazing = 0.01F;

/// What rounding to float32 moves a corner by in a building, in metres.
constexpr double kRounding = 5e-6;

/// Where a ray meets a triangle that it grazes, in doubles: on its plane, but within its extent;
/// one seen exactly from its edge is met at its near end.
double grazingDistance(const TriangleSoup& soup, std::size_t triangle, Point3 origin,
                       Vec3 direction) {
    const Point3 a = soup.corner(triangle, 0), b = soup.corner(triangle, 1),
                 c = soup.corner(triangle, 2);
    const auto [near, far] = std::minmax(
        {dot(a - origin, direction), dot(b - origin, direction), dot(c - origin, direction)});
    const Vec3 normal = cross(b - a, c - a);
    const double slope = dot(normal, direction);
    const double height = dot(normal, a - origin);
    const bool is_edge_on = std::fabs(height) <= kRounding * length(normal);
    return std::max(0.0, is_edge_on ? near : std::clamp(height / slope, near, far));
}

/// One ray again, through what it skips.
RTCRayHit hitBeyond(RTCScene scene, Point3 origin, Vec3 direction, float reach,
                    const TouchedPlanes& skipped) {
    Query query(&skipped);
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(origin.x);
    ray.ray.org_y = static_cast<float>(origin.y);
    ray.ray.org_z = static_cast<float>(origin.z);
    ray.ray.dir_x = static_cast<float>(direction.x);
    ray.ray.dir_y = static_cast<float>(direction.y);
    ray.ray.dir_z = static_cast<float>(direction.z);
    ray.ray.tfar = reach;
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.trace(scene, &ray);
    return ray;
}

/// The distance of a hit, exact where float32 is not.
float distanceOf(const TriangleSoup& soup, unsigned triangle, Vec3 hit_normal, float found,
                 Point3 origin, Vec3 direction, float reach) {
    const double slope = dot(hit_normal, direction);
    if (slope * slope >= kGrazing * kGrazing * dot(hit_normal, hit_normal)) return found;
    const auto exact = static_cast<float>(grazingDistance(soup, triangle, origin, direction));
    if (exact > reach) return kNoReturn;
    return exact;
}

/// Lanes that need not be set for each packet.
template <typename Rays>
void setOrigin(Rays& rays, std::size_t width, Point3 origin) {
    for (std::size_t lane = 0; lane < width; ++lane) {
        rays.org_x[lane] = static_cast<float>(origin.x);
        rays.org_y[lane] = static_cast<float>(origin.y);
        rays.org_z[lane] = static_cast<float>(origin.z);
        rays.tnear[lane] = 0;
        rays.time[lane] = 0;
        rays.mask[lane] = ~0U;
        rays.id[lane] = 0;
        rays.flags[lane] = 0;
    }
}

template <typename Packet>
void intersectWith(RTCScene scene, const TriangleSoup& soup, Point3 origin,
                   std::span<const Vec3> directions, std::span<const float> reach,
                   const TouchedPlanes& touched, std::span<float> distances) {
    constexpr std::size_t kWidth = Packet::kWidth;
    Query query(nullptr);
    typename Packet::Hits hits;
    auto& [ray, hit] = hits;
    setOrigin(ray, kWidth, origin);
    for (std::size_t first = 0; first < directions.size(); first += kWidth) {
        alignas(64) std::array<int, kWidth> valid{};
        const std::size_t lanes = std::min(kWidth, directions.size() - first);
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            const std::size_t i = first + std::min(lane, lanes - 1);
            valid[lane] = lane < lanes ? -1 : 0;
            ray.dir_x[lane] = static_cast<float>(directions[i].x);
            ray.dir_y[lane] = static_cast<float>(directions[i].y);
            ray.dir_z[lane] = static_cast<float>(directions[i].z);
            ray.tfar[lane] = reach[i];
            hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
            hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        }
        query.trace<Packet::kIntersect>(valid.data(), scene, &hits);
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            const std::size_t i = first + lane;
            distances[i] = kNoReturn;
            if (hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) continue;
            const Vec3 normal{hit.Ng_x[lane], hit.Ng_y[lane], hit.Ng_z[lane]};
            if (!touched.normals.empty() &&
                touched.contain(normal, directions[i], ray.tfar[lane])) {
                const RTCRayHit beyond = hitBeyond(scene, origin, directions[i], reach[i], touched);
                if (beyond.hit.geomID == RTC_INVALID_GEOMETRY_ID) continue;
                distances[i] = distanceOf(soup, beyond.hit.primID,
                                          {beyond.hit.Ng_x, beyond.hit.Ng_y, beyond.hit.Ng_z},
                                          beyond.ray.tfar, origin, directions[i], reach[i]);
                continue;
            }
            distances[i] = distanceOf(soup, hit.primID[lane], normal, ray.tfar[lane], origin,
                                      directions[i], reach[i]);
        }
    }
}

}  // namespace

std::uint32_t TriangleSoup::add(Point3 corner) {
    const auto x = static_cast<float>(corner.x), y = static_cast<float>(corner.y),
               z = static_cast<float>(corner.z);
    const auto next = static_cast<std::uint32_t>(vertices.size());
    const auto [place, is_new] = known_.try_emplace({x, y, z}, next);
    if (is_new) vertices.push_back({x, y, z});
    return place->second;
}

void EmbreeScene::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }
void EmbreeScene::Release::operator()(RTCSceneTy* scene) const { rtcReleaseScene(scene); }

EmbreeScene::EmbreeScene(TriangleSoup soup, int packet_width) : soup_(std::move(soup)) {
    // Nothing but this line decides how Embree works: no file in the user's home does.
    device_.reset(rtcNewDevice("ignore_config_files=1"));
    throwOnError(device_.get());
    scene_.reset(rtcNewScene(device_.get()));
    throwOnError(device_.get());
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST | kFilterFlag);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);
    if (!soup_.triangles.empty()) {
        const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        throwOnError(device_.get());
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);  // the scene holds it
        auto* const positions = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), soup_.vertices.size()));
        auto* const corners = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(std::uint32_t), soup_.triangles.size()));
        throwOnError(device_.get());
        std::memcpy(positions, soup_.vertices.data(),
                    soup_.vertices.size() * sizeof(soup_.vertices[0]));
        std::memcpy(corners, soup_.triangles.data(),
                    soup_.triangles.size() * sizeof(soup_.triangles[0]));
        rtcCommitGeometry(geometry);
    }
    rtcCommitScene(scene_.get());
    throwOnError(device_.get());
    width_ = static_cast<std::size_t>(packet_width > 0 ? packet_width : nativeWidth(device_.get()));
}

void EmbreeScene::intersect(Point3 origin, std::span<const Vec3> directions,
                            std::span<const float> reach, double contact,
                            std::span<float> distances) const {
    RTCScene const scene = scene_.get();
    const TouchedPlanes touched = touchedBy(scene, soup_, origin, contact);
    if (width_ >= Packet16::kWidth)
        intersectWith<Packet16>(scene, soup_, origin, directions, reach, touched, distances);
    else if (width_ >= Packet8::kWidth)
        intersectWith<Packet8>(scene, soup_, origin, directions, reach, touched, distances);
    else
        intersectWith<Packet4>(scene, soup_, origin, directions, reach, touched, distances);
}

}  // namespace ispace

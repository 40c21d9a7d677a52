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

/// What rounding to float32 moves a corner by in a building, in metres.
constexpr double kRounding = 5e-6;

/// Below this cosine between ray and normal (half a degree) float32 no longer tells where a surface
/// is met to a tenth of a millimetre.
constexpr float kGrazing = 0.01F;

/// The plane of a triangle as seen from an origin.
struct Plane {
    Vec3 normal;    ///< unit length; null for a triangle without area
    double height;  ///< of the plane over the origin, along the normal
};

Plane planeOf(const TriangleSoup& soup, std::size_t triangle, Point3 origin) {
    const Point3 a = soup.corner(triangle, 0);
    const Vec3 across = cross(soup.corner(triangle, 1) - a, soup.corner(triangle, 2) - a);
    const double size = length(across);
    const Vec3 normal = size > 0 ? (1 / size) * across : Vec3{};
    return {normal, dot(normal, a - origin)};
}

/// The surfaces that stop no ray of an origin: those seen exactly from their edge, those in contact
/// with the origin, and those that continue the plane of one in contact.
struct Passed {
    const TriangleSoup& soup;
    Point3 origin;
    double contact;
    std::vector<Vec3> touched;  ///< unit normals of the surfaces in contact

    [[nodiscard]] bool contain(std::size_t triangle) const {
        constexpr double kParallel = 1 - 1e-6;  // cosine
        const Plane plane = planeOf(soup, triangle, origin);
        const double height = std::fabs(plane.height);
        if (height <= kRounding) return true;
        return height <= contact && std::any_of(touched.begin(), touched.end(), [&](Vec3 normal) {
                   return std::fabs(dot(normal, plane.normal)) >= kParallel;
               });
    }
};

/// Skips what is passed.
void passFilter(const RTCFilterFunctionNArguments* args);

// One query of Embree 3 or 4, first so that the filter gets it back as its context.
#if RTC_VERSION_MAJOR >= 4
constexpr RTCSceneFlags kFilterFlag = RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS;
struct Query {
    RTCRayQueryContext context;
    RTCIntersectArguments arguments;
    const Passed* passed;  ///< null: nothing is

    explicit Query(const Passed* surfaces) : passed(surfaces) {
        rtcInitRayQueryContext(&context);
        rtcInitIntersectArguments(&arguments);
        arguments.context = &context;
        arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
        if (passed == nullptr) return;
        arguments.filter = passFilter;
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
    const Passed* passed;  ///< null: nothing is

    explicit Query(const Passed* surfaces) : passed(surfaces) {
        rtcInitIntersectContext(&context);
        context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        if (passed != nullptr) context.filter = passFilter;
    }
    template <auto kCall, typename Rays>
    void trace(const int* valid, RTCScene scene, Rays* rays) {
        kCall(valid, scene, &context, rays);
    }
    void trace(RTCScene scene, RTCRayHit* ray) { rtcIntersect1(scene, &context, ray); }
};
#endif

void passFilter(const RTCFilterFunctionNArguments* args) {
    const Passed& passed = *reinterpret_cast<const Query*>(args->context)->passed;
    for (unsigned i = 0; i < args->N; ++i)
        if (passed.contain(RTCHitN_primID(args->hit, args->N, i))) args->valid[i] = 0;
}

/// Surfaces whose bounds come near the point of a query.
bool collect(RTCPointQueryFunctionArguments* args) {
    static_cast<std::vector<unsigned>*>(args->userPtr)->push_back(args->primID);
    return false;
}

/// Distance of a point from the closed triangle with this plane.
double distanceFrom(const TriangleSoup& soup, std::size_t triangle, const Plane& plane, Point3 p) {
    bool is_over = true;
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Point3 corner = soup.corner(triangle, i);
        const Vec3 side = soup.corner(triangle, (i + 1) % 3) - corner, way = p - corner;
        if (dot(cross(plane.normal, side), way) < 0) is_over = false;
        const double share = std::clamp(dot(way, side) / dot(side, side), 0.0, 1.0);
        nearest = std::min(nearest, length(p - (corner + share * side)));
    }
    return is_over ? std::fabs(plane.height) : nearest;
}

Passed passedFrom(RTCScene scene, const TriangleSoup& soup, Point3 origin, double contact) {
    RTCPointQuery query{};
    query.x = static_cast<float>(origin.x);
    query.y = static_cast<float>(origin.y);
    query.z = static_cast<float>(origin.z);
    query.radius = static_cast<float>(2 * contact);  // more than rounding to float32
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    std::vector<unsigned> near;
    rtcPointQuery(scene, &query, &context, collect, &near);
    Passed passed{soup, origin, contact, {}};
    for (const unsigned triangle : near) {
        const Plane plane = planeOf(soup, triangle, origin);
        if (plane.normal != Vec3{} && distanceFrom(soup, triangle, plane, origin) <= contact)
            passed.touched.push_back(plane.normal);
    }
    return passed;
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

/// One ray again, through what it passes; the triangle it meets and where, or nothing.
struct Met {
    unsigned triangle;
    float distance;
};
std::optional<Met> meetBeyond(RTCScene scene, const Passed& passed, Vec3 direction, float reach) {
    Query query(&passed);
    RTCRayHit ray{};
    ray.ray.org_x = static_cast<float>(passed.origin.x);
    ray.ray.org_y = static_cast<float>(passed.origin.y);
    ray.ray.org_z = static_cast<float>(passed.origin.z);
    ray.ray.dir_x = static_cast<float>(direction.x);
    ray.ray.dir_y = static_cast<float>(direction.y);
    ray.ray.dir_z = static_cast<float>(direction.z);
    ray.ray.tfar = reach;
    ray.ray.mask = ~0U;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    query.trace(scene, &ray);
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return Met{ray.hit.primID, ray.ray.tfar};
}

/// The distance of a hit that needs a closer look: beyond what is passed, and in doubles, but
/// within the triangle's extent, where the ray grazes it.
float carefulDistance(RTCScene scene, const Passed& passed, Met met, Vec3 direction, float reach) {
    if (passed.contain(met.triangle)) {
        const auto beyond = meetBeyond(scene, passed, direction, reach);
        if (!beyond) return kNoReturn;
        met = *beyond;
    }
    const Plane plane = planeOf(passed.soup, met.triangle, passed.origin);
    const double slope = dot(plane.normal, direction);
    if (std::fabs(slope) >= kGrazing) return met.distance;
    double near = std::numeric_limits<double>::infinity(), far = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double along = dot(passed.soup.corner(met.triangle, i) - passed.origin, direction);
        near = std::min(near, along);
        far = std::max(far, along);
    }
    const double exact = std::clamp(plane.height / slope, std::max(near, 0.0), far);
    return exact <= static_cast<double>(reach) ? static_cast<float>(exact) : kNoReturn;
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
void intersectWith(RTCScene scene, const Passed& passed, std::span<const Vec3> directions,
                   std::span<const float> reach, std::span<float> distances) {
    constexpr std::size_t kWidth = Packet::kWidth;
    Query query(nullptr);
    typename Packet::Hits hits;
    auto& [ray, hit] = hits;
    setOrigin(ray, kWidth, passed.origin);
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
            const float x = hit.Ng_x[lane], y = hit.Ng_y[lane], z = hit.Ng_z[lane];
            const float slope = x * ray.dir_x[lane] + y * ray.dir_y[lane] + z * ray.dir_z[lane];
            const bool grazes = slope * slope < kGrazing * kGrazing * (x * x + y * y + z * z);
            distances[i] = ray.tfar[lane];
            if (grazes || !passed.touched.empty())
                distances[i] = carefulDistance(scene, passed, {hit.primID[lane], distances[i]},
                                               directions[i], reach[i]);
        }
    }
}

}  // namespace

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
    const Passed passed = passedFrom(scene, soup_, origin, contact);
    if (width_ >= Packet16::kWidth)
        intersectWith<Packet16>(scene, passed, directions, reach, distances);
    else if (width_ >= Packet8::kWidth)
        intersectWith<Packet8>(scene, passed, directions, reach, distances);
    else
        intersectWith<Packet4>(scene, passed, directions, reach, distances);
}

}  // namespace ispace

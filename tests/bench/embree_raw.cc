// SPDX-License-Identifier: GPL-3.0-or-later
#include "embree_raw.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <algorithm>
#include <cstring>
#include <limits>
#include <stdexcept>

#include "env/mesh.h"

namespace ispace::bench {

namespace {

constexpr std::size_t kWidth = 16;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Vertex {
    float x, y, z;
};

Vertex vertex(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

/// What stops rays.
std::vector<Mesh> meshesThatStop(const Environment& environment) {
    std::vector<Mesh> meshes{floorMesh(environment.indoor())};
    for (const Element& element : environment.elements())
        for (Mesh& mesh : meshesOf(element.body, false)) meshes.push_back(std::move(mesh));
    return meshes;
}

}  // namespace

struct RawEmbree::Data {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    std::vector<RTCRayHit16> packets;
    std::vector<float> reach;  // per packet
    std::size_t beams = 0;     // of one sensor

    Data() = default;
    Data(const Data&) = delete;
    Data& operator=(const Data&) = delete;
    ~Data() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    /// Surfaces of `corners` vertices each.
    void build(RTCGeometryType type, unsigned corners, const std::vector<Vertex>& vertices) {
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
        const RTCGeometry geometry = rtcNewGeometry(device, type);
        auto* const positions = static_cast<Vertex*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Vertex), vertices.size()));
        auto* const indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, corners == 4 ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
            corners * sizeof(unsigned), vertices.size() / corners));
        if (positions == nullptr || indices == nullptr) throw std::runtime_error("Embree failed");
        for (std::size_t i = 0; i < vertices.size(); ++i) {
            positions[i] = vertices[i];
            indices[i] = static_cast<unsigned>(i);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
    }
};

RawEmbree::RawEmbree(std::unique_ptr<Data> data) : data_(std::move(data)) {}
RawEmbree::RawEmbree(RawEmbree&&) noexcept = default;
RawEmbree::~RawEmbree() = default;

RawEmbree RawEmbree::ofSlice(const Slice& slice) {
    std::vector<Vertex> vertices;
    slice.forEachLine([&](const Segment2& line) {
        const double low = slice.height - 1;
        const double high = slice.height + 1;
        vertices.push_back(vertex(line.a.x, line.a.y, low));
        vertices.push_back(vertex(line.b.x, line.b.y, low));
        vertices.push_back(vertex(line.b.x, line.b.y, high));
        vertices.push_back(vertex(line.a.x, line.a.y, high));
    });
    auto data = std::make_unique<Data>();
    data->build(RTC_GEOMETRY_TYPE_QUAD, 4, vertices);
    return RawEmbree(std::move(data));
}

RawEmbree RawEmbree::ofEnvironment(const Environment& environment) {
    std::vector<Vertex> vertices;
    for (const Mesh& mesh : meshesThatStop(environment)) {
        for (const auto& triangle : mesh.triangles) {
            for (const std::uint32_t i : triangle) {
                const Point3& p = mesh.vertices[i];
                vertices.push_back(vertex(p.x, p.y, p.z));
            }
        }
    }
    auto data = std::make_unique<Data>();
    data->build(RTC_GEOMETRY_TYPE_TRIANGLE, 3, vertices);
    return RawEmbree(std::move(data));
}

void RawEmbree::prepare(std::span<const PlacedLaser> sensors) {
    data_->packets.clear();
    data_->reach.clear();
    for (const PlacedLaser& sensor : sensors) {
        data_->beams = static_cast<std::size_t>(sensor.laser.beams);
        const Point3 origin = sensor.pose.position;
        for (std::size_t begin = 0; begin < data_->beams; begin += kWidth) {
            RTCRayHit16 packet{};
            for (std::size_t lane = 0; lane < kWidth; ++lane) {
                // The last packet is filled up with its last beam.
                const auto beam = static_cast<int>(std::min(begin + lane, data_->beams - 1));
                const Vec3 direction = sensor.pose.beam(sensor.laser.bearing(beam));
                packet.ray.org_x[lane] = static_cast<float>(origin.x);
                packet.ray.org_y[lane] = static_cast<float>(origin.y);
                packet.ray.org_z[lane] = static_cast<float>(origin.z);
                packet.ray.dir_x[lane] = static_cast<float>(direction.x);
                packet.ray.dir_y[lane] = static_cast<float>(direction.y);
                packet.ray.dir_z[lane] = static_cast<float>(direction.z);
                packet.ray.mask[lane] = ~0U;
                packet.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
            }
            data_->packets.push_back(packet);
            data_->reach.push_back(static_cast<float>(sensor.laser.max_range));
        }
    }
    trace(0, packets());
}

void RawEmbree::trace(std::size_t first, std::size_t last) {
    alignas(64) static constexpr int kAll[kWidth] = {-1, -1, -1, -1, -1, -1, -1, -1,
                                                     -1, -1, -1, -1, -1, -1, -1, -1};
#if RTC_VERSION_MAJOR >= 4
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
#endif
    for (std::size_t i = first; i < last; ++i) {
        RTCRayHit16& packet = data_->packets[i];
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            packet.ray.tfar[lane] = data_->reach[i];
            packet.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        }
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect16(kAll, data_->scene, &packet, &arguments);
#else
        rtcIntersect16(kAll, data_->scene, &context, &packet);
#endif
    }
}

std::size_t RawEmbree::packets() const { return data_->packets.size(); }

std::size_t RawEmbree::packetsPerSensor() const { return (data_->beams + kWidth - 1) / kWidth; }

std::vector<float> RawEmbree::ranges() const {
    std::vector<float> ranges;
    for (std::size_t i = 0; i < packets(); ++i) {
        const std::size_t begin = i % packetsPerSensor() * kWidth;
        const RTCRayHit16& packet = data_->packets[i];
        for (std::size_t lane = 0; lane < kWidth && begin + lane < data_->beams; ++lane) {
            const bool hit = packet.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID;
            ranges.push_back(hit ? packet.ray.tfar[lane] : kInfinity);
        }
    }
    return ranges;
}

RawTriangles::RawTriangles(const Slice& slice) {
    slice.forEachLine([&](const Segment2& line) {
        const auto first = static_cast<std::uint32_t>(vertices_.size());
        for (const double z : {-1.0, 1.0})
            for (const Point2 p : {line.a, line.b}) {
                const Vertex v = vertex(p.x, p.y, z);
                vertices_.push_back({v.x, v.y, v.z});
            }
        triangles_.push_back({first, first + 1, first + 3});
        triangles_.push_back({first, first + 3, first + 2});
    });
}

RawTriangles::RawTriangles(const Environment& environment) {
    for (const Mesh& mesh : meshesThatStop(environment)) {
        const auto first = static_cast<std::uint32_t>(vertices_.size());
        for (const Point3& p : mesh.vertices) {
            const Vertex v = vertex(p.x, p.y, p.z);
            vertices_.push_back({v.x, v.y, v.z});
        }
        for (const auto& [i, j, k] : mesh.triangles)
            triangles_.push_back({first + i, first + j, first + k});
    }
}

void RawTriangles::build() const {
    const RTCDevice device = rtcNewDevice(nullptr);
    const RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    void* const positions =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof vertices_[0], vertices_.size());
    void* const indices =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof triangles_[0], triangles_.size());
    if (positions == nullptr || indices == nullptr) throw std::runtime_error("Embree failed");
    std::memcpy(positions, vertices_.data(), vertices_.size() * sizeof vertices_[0]);
    std::memcpy(indices, triangles_.data(), triangles_.size() * sizeof triangles_[0]);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
}

}  // namespace ispace::bench

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
constexpr int kTile = 4;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Vertex {
    float x, y, z;
};

Vertex vertex(double x, double y, double z) {
    return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

/// Rays of one packet, as compact as possible, and their hits. Whole RTCRayHit16s stored from call
/// to call would stream a kilobyte each through the memory.
struct alignas(64) Packet {
    float x[kWidth], y[kWidth], z[kWidth], range[kWidth];
    Vertex origin;
    float reach;
};

/// Meshes of all surfaces that stop rays.
std::vector<Mesh> meshesThatStop(const Environment& environment) {
    std::vector<Mesh> meshes{environment.floor()};
    for (const Element& element : environment.elements())
        for (Mesh& mesh : meshesOf(element.body, Surfaces::Opaque))
            meshes.push_back(std::move(mesh));
    return meshes;
}

}  // namespace

struct RawEmbree::Data {
    RTCDevice device = rtcNewDevice(nullptr);
    RTCScene scene = rtcNewScene(device);
    std::vector<Packet> packets;
    std::vector<std::array<std::uint32_t, kWidth>> lanes;  // their beams; at the end beyond all
    std::size_t beams = 0;                                 // of one sensor

    Data() = default;
    Data(const Data&) = delete;
    Data& operator=(const Data&) = delete;
    ~Data() {
        rtcReleaseScene(scene);
        rtcReleaseDevice(device);
    }

    void set(std::size_t packet, Point3 origin, double most) {
        packets[packet].origin = vertex(origin.x, origin.y, origin.z);
        packets[packet].reach = static_cast<float>(most);
    }
    void point(std::size_t packet, std::size_t lane, Vec3 direction) {
        packets[packet].x[lane] = static_cast<float>(direction.x);
        packets[packet].y[lane] = static_cast<float>(direction.y);
        packets[packet].z[lane] = static_cast<float>(direction.z);
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

RawEmbree RawEmbree::ofSlice(const Slice& slice, double height) {
    std::vector<Vertex> vertices;
    slice.forEachLine([&](const Segment2& line) {
        const double low = height - 1;
        const double high = height + 1;
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

void RawEmbree::reserve(std::size_t sensors, std::size_t beams) {
    Data& d = *data_;
    d.beams = beams;
    const std::size_t packets = sensors * packetsPerSensor();
    d.packets.assign(packets, {});
    d.lanes.resize(packets);
}

void RawEmbree::prepare(std::span<const Sensor> sensors) {
    reserve(sensors.size(), static_cast<std::size_t>(sensors.front().as<Laser>().beams));
    std::size_t packet = 0;
    for (const Sensor& sensor : sensors) {
        for (std::size_t begin = 0; begin < data_->beams; begin += kWidth, ++packet) {
            data_->set(packet, sensor.pose.position, sensor.as<Laser>().max_range);
            for (std::size_t lane = 0; lane < kWidth; ++lane) {
                // The last packet is filled up with its last beam.
                const auto beam = static_cast<int>(std::min(begin + lane, data_->beams - 1));
                data_->point(packet, lane, sensor.pose.beam(sensor.as<Laser>().bearing(beam)));
                data_->lanes[packet][lane] = static_cast<std::uint32_t>(begin + lane);
            }
        }
    }
    trace(0, packets());
}

void RawEmbree::prepare(std::span<const Point3> origins, std::span<const RayGrid> grids,
                        double most) {
    const RayGrid& size = grids.front();
    if (size.columns % kTile != 0 || size.rows % kTile != 0)
        throw std::invalid_argument("pictures are of whole tiles");
    reserve(grids.size(), size.size());
    std::size_t packet = 0;
    for (std::size_t picture = 0; picture < grids.size(); ++picture) {
        const RayGrid& grid = grids[picture];
        for (int row = 0; row < grid.rows; row += kTile) {
            for (int column = 0; column < grid.columns; column += kTile, ++packet) {
                data_->set(packet, origins[picture], most);
                for (std::size_t lane = 0; lane < kWidth; ++lane) {
                    const int i = column + static_cast<int>(lane) % kTile;
                    const int j = row + static_cast<int>(lane) / kTile;
                    data_->point(packet, lane, grid.ray(i, j));
                    data_->lanes[packet][lane] = static_cast<std::uint32_t>(j * grid.columns + i);
                }
            }
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
    RTCRayHit16 rays{};
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
        rays.ray.mask[lane] = ~0U;
        rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
    }
    for (std::size_t i = first; i < last; ++i) {
        Packet& packet = data_->packets[i];
        std::memcpy(rays.ray.dir_x, packet.x, sizeof packet.x);
        std::memcpy(rays.ray.dir_y, packet.y, sizeof packet.y);
        std::memcpy(rays.ray.dir_z, packet.z, sizeof packet.z);
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            rays.ray.org_x[lane] = packet.origin.x;
            rays.ray.org_y[lane] = packet.origin.y;
            rays.ray.org_z[lane] = packet.origin.z;
            rays.ray.tfar[lane] = packet.reach;
            rays.hit.geomID[lane] = RTC_INVALID_GEOMETRY_ID;
        }
#if RTC_VERSION_MAJOR >= 4
        rtcIntersect16(kAll, data_->scene, &rays, &arguments);
#else
        rtcIntersect16(kAll, data_->scene, &context, &rays);
#endif
        for (std::size_t lane = 0; lane < kWidth; ++lane) {
            packet.range[lane] = rays.ray.tfar[lane];
            if (rays.hit.geomID[lane] == RTC_INVALID_GEOMETRY_ID) packet.range[lane] = kInfinity;
        }
    }
}

std::size_t RawEmbree::packets() const { return data_->packets.size(); }

std::size_t RawEmbree::packetsPerSensor() const { return (data_->beams + kWidth - 1) / kWidth; }

std::vector<float> RawEmbree::ranges() const {
    std::vector<float> ranges(packets() / packetsPerSensor() * data_->beams);
    for (std::size_t i = 0; i < packets(); ++i) {
        const std::size_t begin = i / packetsPerSensor() * data_->beams;
        for (std::size_t lane = 0; lane < kWidth; ++lane)
            if (data_->lanes[i][lane] < data_->beams)
                ranges[begin + data_->lanes[i][lane]] = data_->packets[i].range[lane];
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

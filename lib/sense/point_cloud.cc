// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/point_cloud.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/number.h"
#include "geom/rotation.h"
#include "sense/float_text.h"

namespace ispace {

namespace {

/// Fills a cloud point by point.
class Filler {
  public:
    Filler(PointCloud& cloud, std::size_t width, std::size_t height) {
        cloud.width = width;
        cloud.height = height;
        cloud.xyz.resize(3 * cloud.size());
        next_ = cloud.xyz.data();
    }
    void add(Point3 p) {
        *next_++ = static_cast<float>(p.x);
        *next_++ = static_cast<float>(p.y);
        *next_++ = static_cast<float>(p.z);
    }
    void addMissing() {
        for (int i = 0; i < 3; ++i) *next_++ = std::numeric_limits<float>::quiet_NaN();
    }

  private:
    float* next_;
};

/// The rays of all pixels: those of a column share a part, and so do those of a row.
struct PixelRays {
    std::vector<Vec3> columns;  ///< with z 0
    std::vector<Vec2> rows;     ///< what a column's ray is multiplied by, and its z

    explicit PixelRays(const Ranger& ranger) {
        const bool spherical = ranger.projection == Projection::Spherical;
        columns.reserve(static_cast<std::size_t>(ranger.columns));
        for (int column = 0; column < ranger.columns; ++column) {
            Vec3 ray = ranger.ray(column, ranger.cy());
            ray.z = 0;
            columns.push_back(spherical ? 1 / length(ray) * ray : ray);
        }
        rows.reserve(static_cast<std::size_t>(ranger.rows));
        for (int row = 0; row < ranger.rows; ++row) {
            const Vec3 ray = ranger.ray(ranger.cx(), row);
            rows.push_back({spherical ? std::hypot(ray.x, ray.y) : 1, ray.z});
        }
    }
};

/// Directions of a laser's beams in its frame. What one thread computed last is kept, as most
/// clouds are those of one laser, or of lasers alike; valid until the next call.
const std::vector<Vec2>& beamsOf(const Laser& laser) {
    struct Known {
        Angle first, step;
        std::vector<Vec2> beams;
    };
    thread_local Known known;
    const auto count = static_cast<std::size_t>(laser.beams);
    if (known.beams.size() == count && known.first == laser.first && known.step == laser.step)
        return known.beams;
    known.first = laser.first;
    known.step = laser.step;
    known.beams.resize(count);
    for (std::size_t k = 0; k < count; ++k)
        known.beams[k] = unitVector(laser.bearing(static_cast<int>(k)));
    return known.beams;
}

}  // namespace

PointCloud cloudOf(const Ranger& ranger, const DepthFrame& frame, Coordinates in) {
    PointCloud cloud;
    Filler filler(cloud, static_cast<std::size_t>(ranger.columns),
                  static_cast<std::size_t>(ranger.rows));
    const Frame3 world = in == Coordinates::World ? Frame3(frame.pose) : Frame3();
    if (in == Coordinates::Sensor) cloud.viewpoint = frame.pose;
    const PixelRays rays(ranger);
    const float* depth = frame.depths.data();
    for (const auto [across, z] : rays.rows) {
        for (const Vec3& column : rays.columns) {
            const double range = *depth++;
            if (std::isfinite(range)) {
                filler.add(world.origin +
                           world * (range * Vec3{across * column.x, across * column.y, z}));
            } else {
                filler.addMissing();
            }
        }
    }
    return cloud;
}

PointCloud cloudOf(const Laser& laser, std::span<const Scan> scans, Coordinates in) {
    PointCloud cloud;
    Filler filler(cloud, static_cast<std::size_t>(laser.beams), scans.size());
    if (scans.empty()) return cloud;
    const std::vector<Vec2>& beams = beamsOf(laser);
    const Pose3& first = scans.front().pose;
    if (in == Coordinates::Sensor) cloud.viewpoint = first;
    const Frame3 target = in == Coordinates::Sensor ? Frame3(first) : Frame3();

    for (const Scan& scan : scans) {
        const bool at_home =
            in == Coordinates::Sensor && scan.beam_poses.empty() && scan.pose == first;
        Frame3 world(scan.pose);
        for (std::size_t k = 0; k < beams.size(); ++k) {
            const double range = scan.ranges[k];
            if (!std::isfinite(range)) {
                filler.addMissing();
                continue;
            }
            const Vec3 local{range * beams[k].x, range * beams[k].y, 0};
            if (!scan.beam_poses.empty()) world = Frame3(scan.beam_poses[k]);
            if (at_home) {
                filler.add({local.x, local.y, 0});
            } else {
                filler.add(Point3{} + target.toLocal(world.origin + world * local));
            }
        }
    }
    return cloud;
}

namespace {

void appendReturns(std::vector<float>& to, const std::vector<float>& xyz) {
    for (std::size_t i = 0; i < xyz.size(); i += 3)
        if (!std::isnan(xyz[i])) to.insert(to.end(), {xyz[i], xyz[i + 1], xyz[i + 2]});
}

}  // namespace

void CloudPile::add(PointCloud cloud) {
    if (all_.width == 0 && all_.xyz.empty()) {
        all_ = std::move(cloud);
        return;
    }
    if (organised_ && cloud.width != all_.width) {
        organised_ = false;
        std::vector<float> returns;
        appendReturns(returns, all_.xyz);
        all_.xyz = std::move(returns);
    }
    if (organised_) {
        all_.height += cloud.height;
        all_.xyz.insert(all_.xyz.end(), cloud.xyz.begin(), cloud.xyz.end());
    } else {
        appendReturns(all_.xyz, cloud.xyz);
    }
}

PointCloud CloudPile::take() {
    if (!organised_) {
        all_.width = all_.xyz.size() / 3;
        all_.height = 1;
    }
    organised_ = true;
    return std::exchange(all_, PointCloud());
}

namespace {

void appendViewpoint(std::string& out, const Pose3& pose) {
    const Eigen::Quaterniond turn = quaternionOf(pose);
    out += "VIEWPOINT";
    for (const double part : {pose.position.x, pose.position.y, pose.position.z, turn.w(), turn.x(),
                              turn.y(), turn.z()}) {
        out += ' ';
        appendDouble(out, part);
    }
    out += '\n';
}

}  // namespace

std::string pcdOf(const PointCloud& cloud, Encoding encoding) {
    std::string out =
        "# .PCD v0.7 - Point Cloud Data file format\n"
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
    out.append("WIDTH ").append(std::to_string(cloud.width));
    out.append("\nHEIGHT ").append(std::to_string(cloud.height)).append("\n");
    appendViewpoint(out, cloud.viewpoint);
    out.append("POINTS ").append(std::to_string(cloud.size())).append("\n");
    out += encoding == Encoding::Binary ? "DATA binary\n" : "DATA ascii\n";

    const std::vector<float>& xyz = cloud.xyz;
    if (encoding == Encoding::Binary) {
        static_assert(std::endian::native == std::endian::little);
        out.append(reinterpret_cast<const char*>(xyz.data()), xyz.size() * sizeof(float));
        return out;
    }
    TextTail tail(out, kNumberRoom * xyz.size());
    for (std::size_t i = 0; i < xyz.size(); ++i) {
        if (std::isnan(xyz[i])) {
            tail.put("nan");
        } else {
            tail.put(xyz[i]);
        }
        tail.put(i % 3 == 2 ? '\n' : ' ');
    }
    return out;
}

namespace {

bool isMissing(const PointCloud& cloud, std::size_t point) {
    return std::isnan(cloud.xyz[3 * point]);
}

std::string header(const PointCloud& cloud, Encoding encoding, std::size_t present) {
    const bool organised = cloud.height > 1;
    std::string out = "ply\nformat ";
    out += encoding == Encoding::Binary ? "binary_little_endian 1.0\n" : "ascii 1.0\n";
    if (organised) {
        out.append("obj_info num_cols ").append(std::to_string(cloud.width));
        out.append("\nobj_info num_rows ").append(std::to_string(cloud.height)).append("\n");
    }
    out.append("element vertex ").append(std::to_string(present));
    out += "\nproperty float x\nproperty float y\nproperty float z\n";
    if (organised) {
        out.append("element range_grid ").append(std::to_string(cloud.size()));
        out += "\nproperty list uchar int vertex_indices\n";
    }
    return out + "end_header\n";
}

void appendBinary(std::string& out, const PointCloud& cloud) {
    static_assert(std::endian::native == std::endian::little);
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (!isMissing(cloud, i))
            out.append(reinterpret_cast<const char*>(&cloud.xyz[3 * i]), 3 * sizeof(float));
    if (cloud.height <= 1) return;
    std::int32_t index = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (isMissing(cloud, i)) {
            out += '\0';
            continue;
        }
        out += '\1';
        out.append(reinterpret_cast<const char*>(&index), sizeof(index));
        ++index;
    }
}

void appendAscii(std::string& out, const PointCloud& cloud) {
    TextTail tail(out, kNumberRoom * 4 * cloud.size());
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (isMissing(cloud, i)) continue;
        for (std::size_t part = 0; part < 3; ++part) {
            tail.put(cloud.xyz[3 * i + part]);
            tail.put(part == 2 ? '\n' : ' ');
        }
    }
    if (cloud.height <= 1) return;
    std::size_t index = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (isMissing(cloud, i)) {
            tail.put("0\n");
            continue;
        }
        tail.put("1 ");
        tail.put(index++);
        tail.put('\n');
    }
}

}  // namespace

std::string plyOf(const PointCloud& cloud, Encoding encoding) {
    std::size_t present = 0;
    for (std::size_t i = 0; i < cloud.size(); ++i)
        if (!isMissing(cloud, i)) ++present;
    std::string out = header(cloud, encoding, present);
    if (encoding == Encoding::Binary) {
        out.reserve(out.size() + cloud.size() * (3 * sizeof(float) + 5));
        appendBinary(out, cloud);
    } else {
        appendAscii(out, cloud);
    }
    return out;
}

}  // namespace ispace

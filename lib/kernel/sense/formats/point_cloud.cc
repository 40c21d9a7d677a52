// SPDX-License-Identifier: GPL-3.0-or-later
// Writes point clouds as PCD and PLY, whole or incrementally.
#include "sense/formats/point_cloud.h"

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/number.h"
#include "base/per_thread.h"
#include "geom/rotation.h"

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

/// The rays of all pixels: pixels of a column share a part, and so do pixels of a row.
struct PixelRays {
    std::vector<Vec3> columns;  ///< z is 0
    std::vector<Vec2> rows;     ///< factor of a column's ray, and its z

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

/// Returns directions of a laser's beams in its frame; valid until the next call. Each thread
/// caches its last result, as most clouds come from one laser, or from lasers with equal beams.
const std::vector<Vec2>& beamsOf(const Laser& laser) {
    struct Known {
        Angle first, step;
        std::vector<Vec2> beams;
    };
    Known& known = perThread<Known, Known>();
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

/// Size of a cloud in its header.
struct CloudSize {
    std::size_t width = 0, height = 1;
    std::size_t returns = 0;

    [[nodiscard]] std::size_t points() const { return width * height; }
};

std::string pcdHeader(const CloudSize& size, const Pose3& viewpoint, Encoding encoding) {
    std::string out =
        "# .PCD v0.7 - Point Cloud Data file format\n"
        "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
    out.append("WIDTH ").append(std::to_string(size.width));
    out.append("\nHEIGHT ").append(std::to_string(size.height)).append("\n");
    appendViewpoint(out, viewpoint);
    out.append("POINTS ").append(std::to_string(size.points())).append("\n");
    out += encoding == Encoding::Binary ? "DATA binary\n" : "DATA ascii\n";
    return out;
}

void appendBytes(std::string& out, std::span<const float> values) {
    static_assert(std::endian::native == std::endian::little);
    out.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
}

/// Appends all points, missing ones as nan.
void appendAll(std::string& out, std::span<const float> xyz, Encoding encoding) {
    if (encoding == Encoding::Binary) {
        appendBytes(out, xyz);
        return;
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
}

/// Appends the points that are not missing. \return their number
std::size_t appendReturns(std::string& out, std::span<const float> xyz, Encoding encoding) {
    std::size_t count = 0;
    if (encoding == Encoding::Binary) {
        out.reserve(out.size() + xyz.size() * sizeof(float));
        for (std::size_t i = 0; i < xyz.size(); i += 3) {
            if (std::isnan(xyz[i])) continue;
            appendBytes(out, xyz.subspan(i, 3));
            ++count;
        }
        return count;
    }
    TextTail tail(out, kNumberRoom * xyz.size());
    for (std::size_t i = 0; i < xyz.size(); i += 3) {
        if (std::isnan(xyz[i])) continue;
        for (std::size_t part = 0; part < 3; ++part) {
            tail.put(xyz[i + part]);
            tail.put(part == 2 ? '\n' : ' ');
        }
        ++count;
    }
    return count;
}

std::string plyHeader(const CloudSize& size, Encoding encoding) {
    const bool organised = size.height > 1;
    std::string out = "ply\nformat ";
    out += encoding == Encoding::Binary ? "binary_little_endian 1.0\n" : "ascii 1.0\n";
    if (organised) {
        out.append("obj_info num_cols ").append(std::to_string(size.width));
        out.append("\nobj_info num_rows ").append(std::to_string(size.height)).append("\n");
    }
    out.append("element vertex ").append(std::to_string(size.returns));
    out += "\nproperty float x\nproperty float y\nproperty float z\n";
    if (organised) {
        out.append("element range_grid ").append(std::to_string(size.points()));
        out += "\nproperty list uchar int vertex_indices\n";
    }
    return out + "end_header\n";
}

/// Writes the items of PLY's range_grid: the number of the next vertex for each return.
class GridWriter {
  public:
    explicit GridWriter(Encoding encoding) : encoding_(encoding) {}

    void append(std::string& out, bool is_return) {
        if (encoding_ == Encoding::Ascii) {
            out += is_return ? "1 " + std::to_string(next_) + '\n' : "0\n";
        } else {
            out += is_return ? '\1' : '\0';
            if (is_return) out.append(reinterpret_cast<const char*>(&next_), sizeof(next_));
        }
        next_ += is_return ? 1 : 0;
    }

  private:
    Encoding encoding_;
    std::int32_t next_ = 0;
};

bool isReturn(const PointCloud& cloud, std::size_t point) {
    return !std::isnan(cloud.xyz[3 * point]);
}

}  // namespace

std::string pcdOf(const PointCloud& cloud, Encoding encoding) {
    std::string out = pcdHeader({cloud.width, cloud.height}, cloud.viewpoint, encoding);
    appendAll(out, cloud.xyz, encoding);
    return out;
}

std::string plyOf(const PointCloud& cloud, Encoding encoding) {
    CloudSize size{cloud.width, cloud.height};
    for (std::size_t i = 0; i < cloud.size(); ++i) size.returns += isReturn(cloud, i) ? 1 : 0;
    std::string out = plyHeader(size, encoding);
    appendReturns(out, cloud.xyz, encoding);
    GridWriter grid(encoding);
    for (std::size_t i = 0; size.height > 1 && i < cloud.size(); ++i)
        grid.append(out, isReturn(cloud, i));
    return out;
}

std::optional<CloudFormat> cloudFormatOf(std::string_view name) {
    if (name == "pcd") return CloudFormat::Pcd;
    if (name == "ply") return CloudFormat::Ply;
    return std::nullopt;
}

void CloudRows::add(std::size_t row_width, std::size_t rows) {
    if (count == 0) width = row_width;
    if (row_width != width) width = 0;
    count += rows;
    points += row_width * rows;
}

CloudStream::CloudStream(CloudFormat format, Encoding encoding, std::size_t width,
                         std::optional<std::size_t> rows, ByteSink write)
    : format_(format), encoding_(encoding), width_(width), write_(std::move(write)) {
    // The values of this header are known.
    is_begun_ = format == CloudFormat::Pcd && width > 0 && rows.value_or(0) > 0;
    if (is_begun_) write_(pcdHeader({width, *rows}, {}, encoding));
}

void CloudStream::add(const PointCloud& cloud) {
    std::string bytes;
    const bool keeps_missing = format_ == CloudFormat::Pcd && width_ > 0;
    if (keeps_missing)
        appendAll(bytes, cloud.xyz, encoding_);
    else
        returns_ += appendReturns(bytes, cloud.xyz, encoding_);
    rows_ += cloud.height;
    if (format_ == CloudFormat::Ply && width_ > 0)
        for (std::size_t i = 0; i < cloud.size(); ++i) grid_.push_back(isReturn(cloud, i));
    if (is_begun_)
        write_(bytes);
    else
        points_.append(bytes);
}

void CloudStream::finish() {
    if (is_begun_) return;
    const bool is_organised = width_ > 0 && rows_ > 0;
    const CloudSize size{is_organised ? width_ : returns_, is_organised ? rows_ : 1, returns_};
    write_(format_ == CloudFormat::Pcd ? pcdHeader(size, {}, encoding_)
                                       : plyHeader(size, encoding_));
    points_.copyTo(write_);
    if (format_ == CloudFormat::Pcd || size.height <= 1) return;
    constexpr std::size_t kPiece = std::size_t{1} << 16U;
    GridWriter grid(encoding_);
    std::string bytes;
    for (const bool is_return : grid_) {
        grid.append(bytes, is_return);
        if (bytes.size() < kPiece) continue;
        write_(bytes);
        bytes.clear();
    }
    write_(bytes);
}

}  // namespace ispace

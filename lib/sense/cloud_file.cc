// SPDX-License-Identifier: GPL-3.0-or-later
// Point clouds as PCD and PLY, whole or as they come.
#include <bit>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/number.h"
#include "geom/rotation.h"
#include "sense/float_text.h"
#include "sense/point_cloud.h"

namespace ispace {

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

/// What a header says of a cloud.
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

/// All points, missing ones as nan.
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

/// Those that are not missing. \return how many
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

/// Items of PLY's range_grid: the number of the next vertex where there is a return.
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
    // All that this header says is known.
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

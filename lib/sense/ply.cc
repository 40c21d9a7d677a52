// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>
#include <cmath>
#include <cstdint>

#include "sense/float_text.h"
#include "sense/point_cloud.h"

namespace ispace {

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

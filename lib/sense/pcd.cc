// SPDX-License-Identifier: GPL-3.0-or-later
#include <bit>
#include <cmath>
#include <string_view>

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

}  // namespace ispace

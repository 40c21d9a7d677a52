// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef TRACKER_GEOMETRY_H
#define TRACKER_GEOMETRY_H

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/StdVector>

namespace tracker {

using Eigen::Vector2d;
/// Before C++17 vectors of Eigen's types require their allocator.
using MoverPoses = std::vector<Vector2d, Eigen::aligned_allocator<Vector2d>>;

/// A laser of the room: where it stands, m, and where it looks, rad.
struct Mount {
    std::string id;
    Vector2d place = Vector2d::Zero();
    double heading = 0;
};

/// The lasers of a layout (.3dm), such as arrange(1) writes; those on robots are passed over.
inline std::vector<Mount> readMounts(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path);
    std::vector<Mount> mounts;
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream words(line);
        std::string word;
        if (!(words >> word) || word != "laser") continue;
        Mount mount;
        bool placed = false, rides = false;
        while (words >> word) {
            const std::size_t equals = word.find('=');
            if (equals == std::string::npos) continue;
            const std::string key = word.substr(0, equals), value = word.substr(equals + 1);
            if (key == "id") mount.id = value;
            if (key == "on") rides = true;
            if (key == "heading") mount.heading = std::atof(value.c_str()) * M_PI / 180;
            if (key == "at") {
                char* end = nullptr;
                mount.place.x() = std::strtod(value.c_str(), &end);
                mount.place.y() = *end == ',' ? std::strtod(end + 1, nullptr) : 0;
                placed = true;
            }
        }
        if (placed && !rides && !mount.id.empty()) mounts.push_back(mount);
    }
    if (mounts.empty()) throw std::runtime_error(path + " has no laser with id= and at=");
    return mounts;
}

}  // namespace tracker

#endif  // TRACKER_GEOMETRY_H

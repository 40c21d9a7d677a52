// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/walls_between.h"

#include <span>

namespace ispace {

namespace {

constexpr double kThickWall = 0.5;  // metres
constexpr int kMaxWalls = 100;      // no signal passes so many

}  // namespace

int wallsBetween(Point3 from, Point3 to, const RayWorld& mesh) {
    const double way = length(to - from);
    if (way == 0) return 0;
    const Vec3 direction = (1 / way) * (to - from);
    Directions ray;
    ray.resize(1);
    ray.set(0, direction);
    int walls = 0;
    for (double done = 0; done < way && walls < kMaxWalls; ++walls) {
        float range = kNoReturn;
        mesh.cast(from + done * direction, ray, way - done, std::span(&range, 1));
        if (range == kNoReturn) break;
        done += static_cast<double>(range) + kThickWall;
    }
    return walls;
}

}  // namespace ispace

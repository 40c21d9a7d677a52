// SPDX-License-Identifier: GPL-3.0-or-later
// For tests and benchmarks: creates plans of any size, as lines of an .env file without the magic
// line.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/number.h"
#include "geom/pose.h"

namespace ispace::testing {

inline std::string pointText(Point2 p) { return formatDouble(p.x) + ',' + formatDouble(p.y); }

/// Parameters of a plan.
struct PlanStyle {
    double thickness = 0;
    int walls_per_door = 5;  ///< 0: no doors
    bool open_doors = false;
    Angle heading = {};  ///< of the whole building, rotated about the origin
};

/// Creates a building of about `walls` wall records: wings of a corridor with rooms on both sides,
/// side by side; partitions end on the middle of longer walls. Its inside point lies in the first
/// corridor.
inline std::string buildingPlan(int walls, const PlanStyle& style = {}) {
    constexpr double kRoom = 4, kDepth = 5, kCorridor = 2;
    const int columns = std::max(1, static_cast<int>(std::sqrt(walls / 6.0) * 1.5));
    const Pose2 world_from_plan{{0, 0}, style.heading};
    std::string out = "inside at=" + pointText(world_from_plan * Point2{1, kDepth + 1}) + '\n';
    int made = 0;
    const auto add = [&](Point2 from, Point2 to) {
        const std::string id = "w" + std::to_string(made++);
        out += "wall id=" + id + " from=" + pointText(world_from_plan * from) +
               " to=" + pointText(world_from_plan * to);
        if (style.thickness > 0) out += " thickness=" + formatDouble(style.thickness);
        out += '\n';
        if (style.walls_per_door == 0 || made % style.walls_per_door != 0) return;
        out += "door wall=" + id + " offset=" +
               formatDouble(std::min(distance(from, to) / 2 + 0.7, distance(from, to) - 0.6));
        out += style.open_doors ? " open=yes\n" : "\n";
    };
    const double width = columns * kRoom, pitch = 2 * kDepth + kCorridor;
    int wing = 0;
    while (made < walls) {
        const double y = wing * pitch;
        const double levels[] = {y, y + kDepth, y + kDepth + kCorridor, y + pitch};
        for (int level = wing == 0 ? 0 : 1; level < 4; ++level)
            add({0, levels[level]}, {width, levels[level]});
        add({0, levels[1]}, {0, levels[2]});
        add({width, levels[1]}, {width, levels[2]});
        for (int column = 0; column <= columns; ++column) {
            add({column * kRoom, levels[0]}, {column * kRoom, levels[1]});
            add({column * kRoom, levels[2]}, {column * kRoom, levels[3]});
        }
        ++wing;
    }
    return out;
}

/// Creates one closed fence of this many walls about the origin, with a ragged outline.
inline std::string fencePlan(int walls) {
    std::string out = "fence id=f closed=yes path=";
    for (int i = 0; i < walls; ++i) {
        const double angle = 2 * std::numbers::pi * i / walls;
        const double radius = 0.01 * walls * (1 + 0.2 * std::sin(7 * angle) + (i % 2) * 0.001);
        out +=
            (i == 0 ? "" : ";") + pointText({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return out + "\ninside at=0,0\n";
}

}  // namespace ispace::testing

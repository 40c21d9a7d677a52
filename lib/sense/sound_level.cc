// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/sound_level.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ispace {

namespace {

constexpr double kNearest = 0.1;    // metres: speakers are no points
constexpr double kThickWall = 0.5;  // metres
constexpr int kMaxWalls = 100;      // so many are silence

/// Counts the walls between two points.
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

double energyOf(double decibels) { return std::pow(10.0, decibels / 10); }

}  // namespace

SoundLevel readingOf(const Microphone& microphone, const Moment& now) {
    SoundLevel reading{now.time, now.frame, now.pose, 0};
    double energy = energyOf(microphone.floor);
    for (const SoundSource& source : microphone.sources) {
        const double distance = std::max(kNearest, length(source.at - now.pose.position));
        const int walls = wallsBetween(now.pose.position, source.at, now.mesh());
        energy += energyOf(source.volume - 20 * std::log10(distance) - walls * microphone.loss);
    }
    reading.level = 10 * std::log10(energy);
    if (now.options.noise_seed && microphone.sigma > 0) {
        std::array<float, 1> normal{};
        draw(now.noiseKey(), 0, {.normal = normal});
        reading.level += microphone.sigma * static_cast<double>(normal[0]);
    }
    reading.level = std::clamp(reading.level, microphone.floor, microphone.max);
    return reading;
}

}  // namespace ispace

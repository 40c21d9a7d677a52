// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/microphones/sound_level.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "sense/walls_between.h"

namespace ispace::microphones {

namespace {

constexpr double kNearest = 0.1;  // metres: speakers are no points

double energyOf(double decibels) { return std::pow(10.0, decibels / 10); }

}  // namespace

SoundLevel readingOf(const Microphone& microphone, const Moment& now) {
    SoundLevel reading;
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

}  // namespace ispace::microphones

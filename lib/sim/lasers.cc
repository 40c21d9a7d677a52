// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/lasers.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "sense/sensors.h"

namespace ispace {

namespace {

constexpr __int128 kSecond = 1'000'000'000;

}  // namespace

Periods::Periods(double rate) {
    constexpr double kDecimals = 1e9;
    // Slower than a period in three hundred years.
    if (rate < 1e-10) return;
    const auto decimal = static_cast<std::int64_t>(std::llround(rate * kDecimals));
    if (static_cast<double>(decimal) / kDecimals == rate) {
        numerator_ = decimal;
        denominator_ = kSecond * kSecond;
        return;
    }
    int exponent = 0;
    const double mantissa = std::frexp(rate, &exponent);
    constexpr int kBits = std::numeric_limits<double>::digits;
    numerator_ = static_cast<std::int64_t>(std::ldexp(mantissa, kBits));
    denominator_ = kSecond;
    // Up to 2^53 every fraction of two has its shift to the right.
    denominator_ <<= std::max(0, kBits - exponent);
    numerator_ <<= std::max(0, exponent - kBits);
}

std::int64_t Periods::newest(SimTime time) const {
    return static_cast<std::int64_t>(time.count() * numerator_ / denominator_);
}

SimTime Periods::begin(std::int64_t k) const {
    if (numerator_ == 0) return k == 0 ? SimTime(0) : SimTime::max();
    const __int128 begin = (k * denominator_ + numerator_ - 1) / numerator_;
    constexpr __int128 kMax = std::numeric_limits<SimTime::rep>::max();
    return SimTime(static_cast<SimTime::rep>(std::min(begin, kMax)));
}

LaserReader::LaserReader(const Scene& scene)
    : scene_(&scene),
      lasers_(sensorsOf<Laser>(scene)),
      worlds_(scene.environment),
      due_(lasers_.size()) {
    periods_.reserve(lasers_.size());
    readings_.reserve(lasers_.size());
    casters_.reserve(lasers_.size());
    for (const Sensor& laser : lasers_) {
        periods_.emplace_back(laser.as<Laser>().rate);
        readings_.push_back({.sensor = laser, .scan = {}});
        worlds_.prepare(laser.pose);
        if (laser.as<Laser>().sweep != SweepAxis::None) worlds_.prepareMesh();
    }
    for (const SensorReading& reading : readings_)
        casters_.emplace_back(worlds_, bodies_, reading.sensor, reading.sensor.mount.has_value(),
                              ReadingOptions());
    latest_.reserve(lasers_.size());
    // Robots first, as they move; people behind them.
    places_ = bodiesOf(scene);
}

void LaserReader::follow(const LaserReader& before,
                         const std::unordered_set<std::string_view>& stayers) {
    std::unordered_map<std::string_view, std::size_t> old;
    for (std::size_t i = 0; i < before.lasers_.size(); ++i) old.emplace(before.lasers_[i].id, i);
    for (std::size_t i = 0; i < lasers_.size(); ++i) {
        const Sensor& laser = lasers_[i];
        const auto found = stayers.contains(laser.id) ? old.find(laser.id) : old.end();
        if (found == old.end()) continue;
        if (!laser.mount && laser.pose != before.lasers_[found->second].pose) continue;
        const auto mount = laser.mount;  // the carrier may have another index
        readings_[i] = before.readings_[found->second];
        readings_[i].sensor.mount = mount;
        due_[i] = before.due_[found->second];
    }
}

void LaserReader::read(SimTime time, std::span<const Motion> robots) {
    latest_.clear();
    for (std::size_t i = 0; i < due_.size(); ++i) {
        if (due_[i] <= time) latest_.push_back(i);
    }
    if (latest_.empty()) return;
    update(time, robots);
    tbb::parallel_for(std::size_t{0}, latest_.size(), [&](std::size_t k) {
        SensorReading& reading = readings_[latest_[k]];
        reading.scan.pose = reading.sensor.pose;
        casters_[latest_[k]].cast(reading.scan);
        reading.scan.time = seconds(time);
        constexpr std::int64_t kLast = std::numeric_limits<int>::max();
        const std::int64_t sweep = reading.seq / reading.sensor.as<Laser>().scans();
        reading.scan.frame = static_cast<int>(std::min(sweep, kLast));
    });
}

/// All that does not depend on rays: times, poses, bodies.
void LaserReader::update(SimTime time, std::span<const Motion> robots) {
    for (const std::size_t i : latest_) {
        SensorReading& reading = readings_[i];
        reading.time = time;
        reading.seq = periods_[i].newest(time);
        due_[i] = periods_[i].begin(reading.seq + 1);
        if (const auto& mount = reading.sensor.mount)
            reading.sensor.pose = mountedPose(robots[mount->robot].pose, mount->robot_from_sensor);
        const Laser& laser = reading.sensor.as<Laser>();
        if (laser.sweep == SweepAxis::None) continue;
        const std::int64_t number = reading.seq % laser.scans();
        reading.scan.number = static_cast<int>(number);
        if (!reading.sensor.mount) reading.sensor.pose = lasers_[i].pose;
        reading.sensor.pose = sweptPose(laser, reading.sensor.pose, static_cast<double>(number));
    }
    if (!std::exchange(moved_, false)) return;
    for (std::size_t i = 0; i < robots.size(); ++i) {
        places_[i] =
            robotBody(scene_->robots[i].model, robots[i].pose, static_cast<std::uint32_t>(i));
    }
    bodies_.rebuild(places_);
}

}  // namespace ispace

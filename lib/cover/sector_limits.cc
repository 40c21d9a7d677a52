// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/sector_limits.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ispace {

namespace {

SectorLimit limitAt(Angle angle) {
    const Vec2 unit = unitVector(angle);
    // cot(a -+ d) = (cos a +- d sin a) / (sin a -+ d cos a) for such small d.
    return {angle.degrees(), unit, (unit.x + kNearLimit * unit.y) / (unit.y - kNearLimit * unit.x),
            (unit.x - kNearLimit * unit.y) / (unit.y + kNearLimit * unit.x)};
}

}  // namespace

void SectorLimits::set(std::span<const Angle> angles) {
    if (std::equal(angles.begin(), angles.end(), angles_.begin(), angles_.end())) return;
    angles_.assign(angles.begin(), angles.end());
    limits_.clear();
    limits_.reserve(angles.size());
    for (const Angle angle : angles) limits_.push_back(limitAt(angle));
    setHalf(lower_, -1);
    setHalf(upper_, 1);
}

void SectorLimits::setHalf(LimitsOfHalf& half, double side) {
    half = {};
    if (limits_.empty()) return;
    for (std::size_t i = 0; i < size(); ++i)
        if (side * limits_[i].unit.y > 2 * kNearLimit && half.count++ == 0) half.first = i;
    half.first_part =
        half.count == 0 ? partOf({0, side}) : 2 * ((half.first + size() - 1) % size()) + 1;
}

std::size_t SectorLimits::partOf(Vec2 offset) const {
    constexpr double kOn = 1e-9;  // degrees, as Laser::sees has it
    double direction = directionOf(offset.x, offset.y).degrees();
    if (direction < 0) direction += 360;
    const auto beyond = std::upper_bound(
        limits_.begin(), limits_.end(), direction,
        [](double degrees, const SectorLimit& limit) { return degrees < limit.degrees; });
    const auto next = static_cast<std::size_t>(beyond - limits_.begin()) % size();
    const std::size_t last = (next + size() - 1) % size();
    const auto turn = [](double degrees) { return degrees < 0 ? degrees + 360 : degrees; };
    if (turn(direction - limits_[last].degrees) <= kOn) return 2 * last;
    if (turn(limits_[next].degrees - direction) <= kOn) return 2 * next;
    return 2 * last + 1;
}

std::size_t SectorLimits::partNear(std::size_t i, Vec2 offset) const {
    constexpr double kSurelyOn = 0.999e-9 * (std::numbers::pi / 180);
    const Vec2 unit = limits_[i].unit;
    const double far = std::abs(offset.x) + std::abs(offset.y);  // at most sqrt(2) too much
    const bool on = std::abs(cross(unit, offset)) <= kSurelyOn / 2 * far;
    return on && dot(unit, offset) > 0 ? 2 * i : partOf(offset);
}

}  // namespace ispace

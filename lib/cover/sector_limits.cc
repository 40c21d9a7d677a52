// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/sector_limits.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ispace {

namespace {

/// The greatest width of a group: more than the 2e-9 degrees between the limits of fans that meet,
/// and well below kNearLimit.
constexpr double kJoined = 1e-8;

LimitGroup groupFrom(std::size_t first, Angle angle) {
    const Vec2 unit = unitVector(angle);
    // cot(a -+ d) = (cos a +- d sin a) / (sin a -+ d cos a) for such small d.
    return {first, first, unit, (unit.x + kNearLimit * unit.y) / (unit.y - kNearLimit * unit.x),
            (unit.x - kNearLimit * unit.y) / (unit.y + kNearLimit * unit.x)};
}

}  // namespace

void SectorLimits::set(std::span<const Angle> limits) {
    if (std::equal(limits.begin(), limits.end(), limits_.begin(), limits_.end())) return;
    assert(std::is_sorted(limits.begin(), limits.end()));
    limits_.assign(limits.begin(), limits.end());
    groups_.clear();
    groups_.reserve(limits.size());
    for (std::size_t i = 0; i < limits.size(); ++i) {
        if (groups_.empty() || limits[i] > limits[groups_.back().first] + Angle::degrees(kJoined))
            groups_.push_back(groupFrom(i, limits[i]));
        groups_.back().end = i + 1;
    }
    setHalf(lower_, -1);
    setHalf(upper_, 1);
}

void SectorLimits::setHalf(LimitsOfHalf& half, double side) {
    half = {};
    if (groups_.empty()) return;
    for (std::size_t i = 0; i < groups_.size(); ++i)
        if (side * groups_[i].unit.y > 2 * kNearLimit && half.count++ == 0) half.first = i;
    half.first_part = half.count == 0 ? partOf({0, side}) : partBefore(groups_[half.first].first);
}

std::size_t SectorLimits::partOf(Vec2 offset) const {
    const Angle direction = directionOf(offset.x, offset.y);
    const auto beyond = std::upper_bound(limits_.begin(), limits_.end(), direction);
    return partBefore(static_cast<std::size_t>(beyond - limits_.begin()));
}

std::size_t SectorLimits::partNear(std::size_t i, Vec2 offset) const {
    constexpr double kSmall = 1e-7;    // radians: the tangent is the angle
    constexpr double kUnsure = 1e-13;  // radians: far more than what rounds
    constexpr double kLeast = 1e-100;  // metres: nothing underflows
    const LimitGroup& group = groups_[i];
    const double along = dot(group.unit, offset), aside = cross(group.unit, offset);
    if (!(along > kLeast) || !(std::abs(aside) < kSmall * along)) return partOf(offset);
    const double angle = aside / along;
    const auto beyond = [&](std::size_t limit) {
        return angle - (limits_[limit] - limits_[group.first]).radians();
    };
    const auto is_unsure = [&](std::size_t limit) { return std::abs(beyond(limit)) < kUnsure; };
    // The first limit beyond the cell may be one of the groups next to this one.
    std::size_t next = group.first;
    while (next < parts() && beyond(next) >= 0) ++next;
    while (next > 0 && beyond(next - 1) < 0) --next;
    const bool unsure = (next < parts() && is_unsure(next)) || (next > 0 && is_unsure(next - 1));
    return unsure ? partOf(offset) : partBefore(next);
}

}  // namespace ispace

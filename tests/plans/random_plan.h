// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>

namespace ispace::testing {

/// Properties of a plan.
struct PlanOptions {
    std::uint64_t seed = 1;
    double area = 100;       ///< indoor, in square metres; kept to within some per cent
    double room_area = 16;   ///< about that of a room
    double furniture = 0.3;  ///< pieces a square metre, as far as they find room
    double holes = 0.02;     ///< closed fences, and as many pillars, a square metre
    bool is_askew = false;   ///< turned as a whole, and its inner walls not at right angles
};

/// The text of an `.env` with a floor of a building: a rectangular or L-shaped outline, divided by
/// walls into rooms; an open door in each wall, so that all rooms are one indoor region; desks with
/// chairs, round tables, cabinets, pillars, and closed fences (shafts), which are not indoor.
/// Things do not touch each other, walls, or the way through a door. The same for the same options,
/// on every machine with the same standard library.
std::string randomPlan(const PlanOptions& options);

}  // namespace ispace::testing

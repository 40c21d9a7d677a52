// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

#include "layout/scene.h"

namespace ispace {

/// A type of Pioneer as clients know it: by its name they look up how to read its numbers.
struct P2osType {
    std::string_view name;
    double distance;  ///< millimetres of a unit of x and y
    double range;     ///< millimetres of a unit of a sonar's range
    double turn;      ///< radians a second that a millimetre a second of (right - left) / 2 makes
    int top_speed, top_rotspeed;  ///< mm/s and deg/s that clients never exceed
    double laser_x, laser_y;      ///< millimetres, where clients take the laser to be
};

/// All types, the usual one first. Figures: parameters of ARIA, the same in Player's p2os driver
/// (but for the laser of the p3dx-sh, 18 mm there).
std::span<const P2osType> p2osTypes();
/// Null if there is none of that name.
const P2osType* p2osTypeNamed(std::string_view name);
/// That of a robot: what its record says, else that of its model. \pre the scene has it
const P2osType& p2osTypeOf(const Scene& scene, std::string_view robot);

/// Clients count 4096 units of heading in a turn.
constexpr int kP2osTurn = 4096;

}  // namespace ispace

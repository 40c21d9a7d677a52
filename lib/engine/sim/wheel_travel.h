// SPDX-License-Identifier: GPL-3.0-or-later
// The way of a robot's wheels, for device protocols that count it.
#pragma once

#include "geom/pose.h"
#include "scene/robot.h"

namespace ispace {

/// The motion of a robot's wheels since its start.
struct WheelTravel {
    double driven = 0;  ///< metres along the heading: ahead less back
    Angle turned = {};  ///< counter-clockwise less clockwise, also beyond a turn

    /// Returns the angle by which the left (+1) or the right wheel (-1) has rolled, ahead positive.
    [[nodiscard]] Angle of(const Wheels& wheels, double side) const {
        return Angle::radians((driven - side * turned.radians() * wheels.track / 2) /
                              wheels.radius);
    }
};

}  // namespace ispace

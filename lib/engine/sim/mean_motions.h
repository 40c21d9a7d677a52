// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/sim: mean motions between the readings of sensors that integrate.
//
// A sensor that reads less often than the world steps must not miss motion: the integral of its
// readings is the motion of its carrier, whatever the two rates are.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "scene/sensor/sensor.h"
#include "sense/moment.h"
#include "sim/motion.h"
#include "sim/robot_sensors.h"
#include "sim/sim_time.h"

namespace ispace {

/// Integrates the rates and accelerations of carried sensors (SensorKind::integrates), step by
/// step, in the axes that the carrier has on the way: at a constant speed v along an arc with rate
/// w the mean acceleration is 0 ahead and v w to the left, however far the carrier turns between
/// two readings.
///
/// A step is an arc along which the velocity in the carrier's axes changes evenly.
class MeanMotions {
  public:
    /// Adds a sensor. \param robot or else person: its carrier \param mount its position on it
    void add(std::size_t sensor, std::optional<std::size_t> robot,
             std::optional<std::size_t> person, Point2 mount);
    /// Call it once after each step.
    void step(const Movers& movers);
    /// Records that movers were set to other poses: the jump is no motion.
    void jumped();
    /// Ends the interval of a sensor that is read now and begins its next one.
    void read(std::size_t sensor, SimTime time);
    /// Goes on from the same sensor in another scene.
    void goOn(std::size_t sensor, const MeanMotions& before, std::size_t old_sensor);
    /// Returns the means of the interval that ended last; empty for a sensor that stands.
    [[nodiscard]] std::optional<MeanMotion> of(std::size_t sensor) const;

  private:
    /// An interval: turn in radians, gain of velocity in the axes on the way.
    struct Gain {
        double turn = 0;
        Vec2 velocity;
    };
    struct Unit {
        std::size_t sensor = 0;
        std::optional<std::size_t> robot, person;
        Point2 mount;
        std::optional<Angle> heading = {};  // of the carrier after the last step; empty: unknown
        Vec2 velocity = {};                 // likewise of the unit, in the carrier's axes
        SimTime since{};
        Gain gain = {};
        MeanMotion mean = {};  // of the last interval
    };
    [[nodiscard]] const Unit* find(std::size_t sensor) const;

    std::vector<Unit> units_;
};

}  // namespace ispace

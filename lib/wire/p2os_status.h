// SPDX-License-Identifier: GPL-3.0-or-later
// What a Pioneer tells its client, as packets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "geom/pose.h"
#include "layout/robot.h"
#include "sim/sim_time.h"
#include "wire/p2os_type.h"

namespace ispace {

/// Contents of a standard status packet.
struct P2osStatus {
    Pose2 pose;                   ///< by odometry, metres
    double speed = 0;             ///< m/s
    Angle rotspeed;               ///< a second, counter-clockwise
    bool stall = false;           ///< a motor is blocked
    bool motors = false;          ///< they are on
    bool sonars = false;          ///< they are on
    bool stopped = false;         ///< by an emergency stop that lasts
    std::vector<float> ranges;    ///< of the sonars, metres; +infinity for no echo
    std::size_t first_sonar = 0;  ///< where a packet begins that cannot hold all of them
    std::uint16_t bumpers = 0;    ///< see p2osBumpers()
};

/// Sonars that fit into one packet.
constexpr std::size_t kMaxP2osSonars = 32;

std::string p2osStatusPacket(const P2osType& type, const P2osStatus& status);

/// Pressed bumpers as clients have them, clockwise: the front ones in bits 9 to 15, the rear ones
/// in bits 1 to 7. Bits 0 and 8 are left for stalled motors. \pre as many as the model has
std::uint16_t p2osBumpers(const RobotModel& model, const std::vector<bool>& pressed);
/// How many of a model's bumpers are in front or at the rear.
int p2osBumperCount(const RobotModel& model, bool front);

/// What can be set of the way a robot moves: mm/s, mm/s^2, deg/s, deg/s^2.
struct P2osLimits {
    double speed = 0, accel = 0, decel = 0;
    double rotspeed = 0, rotaccel = 0, rotdecel = 0;
    friend bool operator==(const P2osLimits&, const P2osLimits&) = default;
};
/// As it starts; and the most that can be set.
P2osLimits p2osUsualLimits(const RobotModel& model);
P2osLimits p2osTopLimits(const P2osType& type, const RobotModel& model);

/// What the robot is and can do, and how it is set.
struct P2osConfig {
    std::string name;
    P2osLimits top, now;
    bool sonars = false;
    int front_bumpers = 0, rear_bumpers = 0;
    std::chrono::milliseconds cycle{}, watchdog{};
};

std::string p2osConfigPacket(const P2osType& type, const P2osConfig& config);

/// The true pose, and steps of that length.
std::string p2osSimPacket(const Pose2& pose, SimTime step);

/// A laser that the simulator has in place of a device: what clients ask of it.
struct P2osLaser {
    Angle first = Angle::degrees(-90), last = Angle::degrees(90), step = Angle::degrees(1);
    int mode = 0;  ///< 0: off; 1: ranges alone; 2: with reflectance and flags
    friend bool operator==(const P2osLaser&, const P2osLaser&) = default;

    /// Readings of a scan; 0 if it is none that can be, or has more than kMaxReadings.
    [[nodiscard]] int readings() const;
    static constexpr int kMaxReadings = 3601;
};

/// A scan in as many packets as it needs. \param ranges metres; +infinity is `max_range`
/// \param pose of the robot, by odometry
std::string p2osLaserPackets(int mode, const P2osType& type, const Pose2& pose,
                             std::span<const float> ranges, double max_range);

}  // namespace ispace

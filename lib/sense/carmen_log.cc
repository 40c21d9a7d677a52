// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/carmen_log.h"

#include <cmath>

#include "base/number.h"
#include "sense/float_text.h"

namespace ispace {

namespace {

constexpr int kSimulatedLaser = 3;  // of CARMEN's laser types

void appendNumber(std::string& out, double value) {
    out += ' ';
    appendDouble(out, value);
}

void appendPose(std::string& out, Point2 position, Angle heading) {
    appendNumber(out, position.x);
    appendNumber(out, position.y);
    appendNumber(out, wrapped(heading).radians());
}

}  // namespace

std::string carmenHeader() {
    return "# CARMEN Logfile\n"
           "# file format is one message per line; metres, radians, seconds\n"
           "# message_name [message contents] ipc_timestamp ipc_hostname logger_timestamp\n"
           "# ROBOTLASER1 laser_type start_angle field_of_view angular_resolution maximum_range "
           "accuracy remission_mode num_readings [range_readings] num_remissions "
           "[remission values] laser_pose_x laser_pose_y laser_pose_theta robot_pose_x "
           "robot_pose_y robot_pose_theta laser_tv laser_rv forward_safety_dist "
           "side_safety_dist turn_axis\n"
           "# a reading of maximum_range is no return\n";
}

void appendCarmenLine(std::string& out, std::size_t number, const Sensor& sensor, const Scan& scan,
                      const Pose2& robot) {
    const Laser& laser = sensor.as<Laser>();
    const Angle fov = laser.last() - laser.first;
    const Angle middle = laser.first + 0.5 * fov;
    out.append("ROBOTLASER").append(std::to_string(number)).append(" ");
    out += std::to_string(kSimulatedLaser);
    appendNumber(out, (-0.5 * fov).radians());
    appendNumber(out, fov.radians());
    appendNumber(out, laser.step.radians());
    appendNumber(out, laser.max_range);
    appendNumber(out, laser.noise.sigma[0]);
    out.append(" 0 ").append(std::to_string(scan.ranges.size()));
    {
        TextTail tail(out, kNumberRoom * scan.ranges.size());
        const auto none = static_cast<float>(laser.max_range);
        for (const float range : scan.ranges) {
            tail.put(' ');
            tail.put(std::isfinite(range) ? range : none);
        }
    }
    out += " 0";
    appendPose(out, scan.pose.position.onFloor(), scan.pose.heading + middle);
    appendPose(out, robot.position, robot.heading);
    // Neither speeds nor safety distances are known of a scan.
    out += " 0 0 0 0 0";
    appendNumber(out, scan.time);
    out += " sim";
    appendNumber(out, scan.time);
    out += '\n';
}

}  // namespace ispace

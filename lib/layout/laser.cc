// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/laser.h"

#include <cmath>
#include <utility>

#include "base/number.h"
#include "env/environment.h"

namespace ispace {

namespace {

/// Slack of divisions and comparisons in degrees: fov=0.3 step=0.1 are four beams, not three.
constexpr double kSlack = 1e-9;

/// Numbers of beams within a span, both ends included; a double as it may be huge.
double beamsWithin(double span, double step) { return std::floor(span / step + kSlack) + 1; }

void applyRange(Laser& laser, const Record& record, Diagnostics& findings) {
    if (!record.has("range")) return;
    const Tuple& range = record.tuple("range");
    if (range.size() == 2) laser.min_range = range.front();
    laser.max_range = range.back();
    if (laser.max_range <= 0) {
        findings.add(record.finding("range", "the greatest range is 0, it must be above 0"));
    } else if (laser.min_range > laser.max_range) {
        findings.add(record.finding("range", "the least range " + formatDouble(laser.min_range) +
                                                 " m is above the greatest, " +
                                                 formatDouble(laser.max_range) + " m"));
    }
}

void applyBeams(Laser& laser, const Record& record, Diagnostics& findings) {
    const bool fov = record.has("fov"), step = record.has("step"), beams = record.has("beams");
    const double old_span = (laser.last() - laser.first).degrees();
    double count = laser.beams;
    if (step) laser.step = record.angle("step");
    if (fov) {
        laser.first = -0.5 * record.angle("fov");
        count = beamsWithin(record.number("fov"), laser.step.degrees());
    } else if (step) {
        count = beamsWithin(old_span, laser.step.degrees());
    }
    if (record.has("first")) laser.first = record.angle("first");
    if (beams) {
        const double written = record.number("beams");
        if (written != std::floor(written)) {
            findings.add(record.finding(
                "beams", "`beams`: " + formatDouble(written) + " is not a whole number"));
            return;
        }
        if (fov && written != count) {
            findings.add(record.finding(
                "beams", "`beams` is " + formatDouble(written) + ", but fov and step give " +
                             formatDouble(count) + "; leave out one of the three"));
            return;
        }
        count = written;
    }
    const std::string cause = beams ? "beams" : step ? "step" : "fov";
    if (count > kMostBeams) {
        findings.add(record.finding(cause, formatDouble(count) + " beams, at most " +
                                               std::to_string(kMostBeams) + " are possible"));
        return;
    }
    laser.beams = static_cast<int>(count);
    const double span = (laser.last() - laser.first).degrees();
    if (span > 360 + kSlack)
        findings.add(record.finding(
            cause, "the beams cover " + formatDouble(span) + " degrees, more than a full turn"));
}

}  // namespace

bool Laser::sees(Angle bearing) const {
    double beyond_first = std::fmod((bearing - first).degrees(), 360.0);
    if (beyond_first < 0) beyond_first += 360;
    return beyond_first <= (last() - first).degrees() + kSlack || beyond_first >= 360 - kSlack;
}

Laser withFigures(Laser base, const Record& record) {
    Diagnostics findings;
    applyRange(base, record, findings);
    applyBeams(base, record, findings);
    if (record.has("rate")) base.rate = record.number("rate");
    findings.throwIfAny();
    return base;
}

Laser laserOf(const Record& record, const DeviceCatalogue& devices) {
    Laser base;
    if (const Record* device = deviceOf(record, devices)) {
        base = withFigures(Laser(), *device);
        base.model = record.text("model");
    }
    return withFigures(std::move(base), record);
}

Pose3 poseOf(const Record& record) {
    const bool placed = record.has("at");
    const Tuple at = placed ? record.tuple("at") : Tuple{0, 0};
    return {{at[0], at[1], at.size() > 2 ? at[2] : kScanHeight},
            record.angle("heading"),
            record.angle("tilt"),
            record.angle("roll")};
}

Pose3 mountedPose(const Pose2& world_from_robot, const Pose3& robot_from_sensor) {
    const Point2 place = world_from_robot * robot_from_sensor.position.onFloor();
    // Adding 0 makes -0 plain 0.
    const Angle heading = wrapped(world_from_robot.heading + robot_from_sensor.heading) + Angle();
    return {{place.x, place.y, robot_from_sensor.position.z},
            heading,
            robot_from_sensor.tilt,
            robot_from_sensor.roll};
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sense/scan_plane.h"

#include <algorithm>
#include <cmath>

#include "geom/tolerance.h"

namespace ispace {

namespace {

Angle angleOf(const Laser& laser, const Pose3& pose) {
    switch (laser.sweep) {
        case SweepAxis::Tilt:
            return pose.tilt;
        case SweepAxis::Roll:
            return pose.roll;
        default:
            return pose.heading;
    }
}

/// From the first scan to the last, or a full turn.
Angle sweepOf(const Laser& laser) {
    const Angle turn = Angle::degrees(360);
    if (laser.sweep_span >= turn) return turn;
    return static_cast<double>(laser.scans() - 1) * laser.sweep_step;
}

double cosineOfHalf(Angle span) { return span >= Angle::degrees(360) ? -1 : cos(0.5 * span); }

}  // namespace

bool scansSlice(const Laser& laser, const Pose3& pose) {
    return pose.isLevel() && (laser.sweep == SweepAxis::None || laser.sweep == SweepAxis::Heading);
}

bool scansSlice(const Sensor& sensor) {
    return sensor.is<Laser>() && scansSlice(sensor.as<Laser>(), sensor.pose);
}

BearingWindow::BearingWindow(const Laser& laser, Angle more)
    : middle(unitVector(laser.first + 0.5 * (laser.span() + more))),
      cosine(cosineOfHalf(laser.span() + std::max(more, -more))) {}

bool BearingWindow::holds(Vec3 local) const {
    const double distance = std::sqrt(local.x * local.x + local.y * local.y);
    return dot(Vec2{local.x, local.y}, middle) >= (cosine - kUnitTolerance) * distance;
}

SweptScan::SweptScan(const Sensor& placed)
    : axis_(placed.as<Laser>().sweep),
      origin_(placed.pose.position),
      turns_{cosSin(placed.pose.heading), cosSin(placed.pose.tilt), cosSin(placed.pose.roll)},
      middle_(cosSin(angleOf(placed.as<Laser>(), placed.pose) + 0.5 * sweepOf(placed.as<Laser>()))),
      cosine_(cosineOfHalf(sweepOf(placed.as<Laser>()))),
      window_(placed.as<Laser>()),
      // Upside down, it turns the other way in its own frame.
      wide_(placed.as<Laser>(),
            (turns_.tilt.cos * turns_.roll.cos < 0 ? -1.0 : 1.0) * sweepOf(placed.as<Laser>())) {}

/// Rx(-roll) Ry(tilt) Rz(-heading).
Vec3 SweptScan::Turns::toSensor(Vec3 way) const {
    const Vec3 faced{heading.cos * way.x + heading.sin * way.y,
                     heading.cos * way.y - heading.sin * way.x, way.z};
    const Vec3 nodded{tilt.cos * faced.x + tilt.sin * faced.z, faced.y,
                      tilt.cos * faced.z - tilt.sin * faced.x};
    return {nodded.x, roll.cos * nodded.y + roll.sin * nodded.z,
            roll.cos * nodded.z - roll.sin * nodded.y};
}

CosSin& SweptScan::sweptOf(Turns& turns) const {
    switch (axis_) {
        case SweepAxis::Tilt:
            return turns.tilt;
        case SweepAxis::Roll:
            return turns.roll;
        default:
            return turns.heading;
    }
}

/// toSensor().z, by the cosine and the sine of the swept angle.
Vec3 SweptScan::equationOf(Vec3 way) const {
    const auto& [heading, tilt, roll] = turns_;
    const double x = heading.cos * way.x + heading.sin * way.y;
    const double y = heading.cos * way.y - heading.sin * way.x;
    switch (axis_) {
        case SweepAxis::Tilt:
            return {roll.cos * way.z, -roll.cos * x, -roll.sin * y};
        case SweepAxis::Roll:
            return {tilt.cos * way.z - tilt.sin * x, -y, 0};
        default:
            return {-roll.cos * tilt.sin * way.x - roll.sin * way.y,
                    roll.sin * way.x - roll.cos * tilt.sin * way.y, roll.cos * tilt.cos * way.z};
    }
}

bool SweptScan::isSeenAt(CosSin swept, Vec3 way) const {
    if (swept.cos * middle_.cos + swept.sin * middle_.sin < cosine_ - kUnitTolerance) return false;
    Turns turns = turns_;
    sweptOf(turns) = swept;
    return window_.holds(turns.toSensor(way));
}

bool SweptScan::passes(Point3 place) const {
    const Vec3 way = place - origin_;
    const auto [a, b, c] = equationOf(way);
    const double squared = a * a + b * b;
    const double slack = kUnitTolerance * kUnitTolerance * dot(way, way);
    if (squared <= slack) {
        // Every scan has the place in its plane, or none. The place is on the axis of the sweep,
        // or the plane turns in itself.
        if (c * c > slack) return false;
        const bool turns_in_itself =
            axis_ == SweepAxis::Heading && turns_.tilt.sin == 0 && turns_.roll.sin == 0;
        return (turns_in_itself ? wide_ : window_).holds(turns_.toSensor(way));
    }
    const double rest = squared - c * c;
    if (rest < -slack) return false;
    const double root = std::sqrt(std::max(rest, 0.0));
    const CosSin one{(-a * c - b * root) / squared, (-b * c + a * root) / squared};
    const CosSin other{(-a * c + b * root) / squared, (-b * c - a * root) / squared};
    return isSeenAt(one, way) || isSeenAt(other, way);
}

}  // namespace ispace

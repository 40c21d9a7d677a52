// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sensor/laser.h"

#include <algorithm>
#include <cmath>

#include "base/number.h"
#include "geom/tolerance.h"
#include "scene/sensor/field_of_view.h"
#include "scene/sensor/kind_functions.h"
#include "scene/sensor/sensor.h"
#include "scene/sensor/sensor_keys.h"

namespace ispace {

namespace {

constexpr Angle kTurn = Angle::degrees(360);

/// Computes the number of beams within a span, both ends included; a double as it may be huge.
double beamsWithin(double span, double step) {
    return std::floor(span / step + kStepTolerance) + 1;
}

/// As beamsWithin; a full turn ends before its start.
double scansWithin(const Laser& laser) {
    const double span = laser.sweep_span.degrees(), step = laser.sweep_step.degrees();
    return span < 360 ? beamsWithin(span, step) : std::ceil(span / step - kStepTolerance);
}

void applyBeams(Laser& laser, const Record& record, Diagnostics& findings) {
    const bool fov = record.has("fov"), step = record.has("step"), beams = record.has("beams");
    const double old_span = (laser.last() - laser.first).degrees();
    const bool was_closed = laser.span() >= kTurn && old_span < 360 - kStepTolerance;
    double count = laser.beams;
    if (step) laser.step = record.angle("step");
    // Beams spread over a field of view.
    if (fov && beams && !step && record.number("beams") > 1)
        laser.step = (1 / (record.number("beams") - 1)) * record.angle("fov");
    if (fov) {
        laser.first = -0.5 * record.angle("fov");
        count = beamsWithin(record.number("fov"), laser.step.degrees());
    } else if (step) {
        count = was_closed ? std::ceil(360 / laser.step.degrees() - kStepTolerance)
                           : beamsWithin(old_span, laser.step.degrees());
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
    if (count > kMaxBeams) {
        findings.add(record.finding(cause, formatDouble(count) + " beams, at most " +
                                               std::to_string(kMaxBeams) + " are possible"));
        return;
    }
    laser.beams = static_cast<int>(count);
    const double span = (laser.last() - laser.first).degrees();
    if (span > 360 + kStepTolerance)
        findings.add(record.finding(
            cause, "the beams cover " + formatDouble(span) + " degrees, more than a full turn"));
}

void applySweep(Laser& laser, const Record& record, Diagnostics& findings) {
    if (record.has("sweep")) {
        const std::string& axis = record.text("sweep");
        laser.sweep = axis == "heading" ? SweepAxis::Heading
                      : axis == "tilt"  ? SweepAxis::Tilt
                      : axis == "roll"  ? SweepAxis::Roll
                                        : SweepAxis::None;
    }
    if (record.has("sweep_span")) laser.sweep_span = record.angle("sweep_span");
    if (record.has("sweep_step")) laser.sweep_step = record.angle("sweep_step");
    const double beams = scansWithin(laser) * laser.beams;
    if (laser.sweep != SweepAxis::None && beams > kMaxSwept)
        findings.add(record.finding("sweep_step", "a sweep of " + formatDouble(beams) +
                                                      " beams, at most " + formatDouble(kMaxSwept) +
                                                      " are possible"));
}

void applyTimes(Laser& laser, const Record& record, Diagnostics& findings) {
    if (record.has("rate")) {
        const double rate = record.number("rate");
        laser.spin *= rate / laser.rate;
        laser.rate = rate;
    }
    if (record.has("spin")) laser.spin = record.number("spin");
    if (laser.duration() * laser.rate > 1 + kStepTolerance)
        findings.add(record.finding(record.has("spin") ? "spin" : "rate",
                                    "a scan takes " + formatDouble(laser.duration()) + " s at " +
                                        formatDouble(laser.spin) + " turns a second, longer than " +
                                        formatDouble(laser.rate) + " scans a second leave it"));
}

}  // namespace

int Laser::scans() const {
    return sweep == SweepAxis::None ? 1 : static_cast<int>(scansWithin(*this));
}

double Laser::timeOf(int beam) const {
    if (spin == 0) return 0;
    const double steps = spin > 0 ? beam : beams - 1 - beam;
    return steps * step.degrees() / (360 * std::fabs(spin));
}

double Laser::duration() const { return timeOf(spin > 0 ? beams - 1 : 0); }

Angle Laser::span() const {
    constexpr double kMaxGap = 1.01;  // in steps
    const Angle beside = last() - first;
    const bool is_closed = beams > 2 && kTurn - beside <= kMaxGap * step;
    return is_closed ? kTurn : beside;
}

Angle Laser::sweptSpan() const {
    if (sweep != SweepAxis::Heading) return span();
    if (sweep_span >= kTurn) return kTurn;
    return std::min(span() + static_cast<double>(scans() - 1) * sweep_step, kTurn);
}

bool Laser::seesAround() const {
    return (sweep == SweepAxis::None || sweep == SweepAxis::Heading) &&
           sweptSpan() >= Angle::degrees(360 - kStepTolerance / 2);
}

bool Laser::sees(Angle bearing) const {
    double beyond_first = std::fmod((bearing - first).degrees(), 360.0);
    if (beyond_first < 0) beyond_first += 360;
    return beyond_first <= span().degrees() + kStepTolerance ||
           beyond_first >= 360 - kStepTolerance;
}

Laser withParameters(Laser base, const Record& record) {
    Diagnostics findings;
    applyRange(record, base.min_range, base.max_range, findings);
    applyBeams(base, record, findings);
    applySweep(base, record, findings);
    applyTimes(base, record, findings);
    applyNoise(record, base.noise, findings);
    findings.throwIfAny();
    return base;
}

Pose3 sweptPose(const Laser& laser, Pose3 pose, double scans) {
    const Angle by = scans * laser.sweep_step;
    switch (laser.sweep) {
        case SweepAxis::Heading:
            pose.heading = pose.heading + by;
            break;
        case SweepAxis::Tilt:
            pose.tilt = pose.tilt + by;
            break;
        case SweepAxis::Roll:
            pose.roll = pose.roll + by;
            break;
        case SweepAxis::None:
            break;
    }
    return pose;
}

namespace {

void addSweepKeys(std::vector<KeySpec>& keys) {
    keys.push_back({.name = "sweep",
                    .type = KeyType::Choice,
                    .help = "which of its angles changes from scan to scan, for a picture of the "
                            "whole space",
                    .choices = {"none", "heading", "tilt", "roll"}});
    keys.push_back({.name = "sweep_span",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "by how much it changes in a sweep, from the angle written on; 360 "
                            "without it",
                    .lower = 0,
                    .upper = 360,
                    .lower_open = true});
    keys.push_back({.name = "sweep_step",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "by how much from scan to scan; 1 without it",
                    .lower = 0,
                    .upper = 360,
                    .lower_open = true});
}

void addLaserKeys(std::vector<KeySpec>& keys) {
    keys.push_back(rangeKey("least and greatest distance measured, or the greatest alone"));
    keys.push_back({.name = "fov",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "field of view, half of it to each side",
                    .lower = 0,
                    .upper = 360});
    keys.push_back({.name = "step",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "angle between neighbouring beams",
                    .lower = 0,
                    .upper = 360,
                    .lower_open = true});
    keys.push_back({.name = "first",
                    .type = KeyType::Number,
                    .unit = Unit::Angle,
                    .help = "bearing of the first beam",
                    .lower = -360,
                    .upper = 360});
    keys.push_back({.name = "beams",
                    .type = KeyType::Number,
                    .help = "number of beams",
                    .lower = 1,
                    .upper = kMaxBeams});
    keys.push_back(positiveKey("rate", Unit::Frequency, "scans a second", kMaxRate));
    keys.push_back({.name = "spin",
                    .type = KeyType::Number,
                    .unit = Unit::Frequency,
                    .help = "turns a second of its beam, which give each beam its own time; below "
                            "0 clockwise, 0: all beams at once",
                    .lower = -kMaxRate,
                    .upper = kMaxRate});
    addSweepKeys(keys);
    addNoiseKeys(keys);
}

Mesh fanOf(const Laser& laser, ViewLimits limits) {
    Mesh mesh{Material::View, {}, {}, true};
    const Angle span = laser.span();
    addSheet(mesh, piecesOf(span), 1, [&](double u, double v) {
        return (limits.near + v * (limits.far - limits.near)) *
               directionOf(laser.first + u * span, {});
    });
    return mesh;
}

/// Builds the ends of all beams of a sweep, in the frame of its first scan.
Mesh sweptOf(const Sensor& sensor, ViewLimits limits) {
    const Laser& laser = sensor.as<Laser>();
    Mesh mesh{Material::View, {}, {}, true};
    const Angle span = laser.span();
    const Frame3 frame(sensor.pose);
    addSheet(mesh, piecesOf(span), piecesOf(laser.sweep_span), [&](double u, double v) {
        const double scans = v * (laser.sweep_span.degrees() / laser.sweep_step.degrees());
        const Pose3 pose = sweptPose(laser, sensor.pose, scans);
        return limits.far * frame.toLocal(frame.origin + pose.beam(laser.first + u * span));
    });
    return mesh;
}

Mesh laserView(const Sensor& sensor, double reach) {
    const Laser& laser = sensor.as<Laser>();
    const ViewLimits range = viewLimits(laser.min_range, laser.max_range, reach);
    return laser.sweep == SweepAxis::None ? fanOf(laser, range) : sweptOf(sensor, range);
}

std::vector<Mesh> laserBody() { return {noseBox()}; }

DeviceSummary laserSummary(const SensorModel& model) {
    const Laser& laser = std::get<Laser>(model);
    return {rangeText(laser.min_range, laser.max_range), degreesText(laser.span()),
            std::to_string(laser.beams), formatDouble(laser.rate)};
}

}  // namespace

const SensorKind Laser::kKind = {
    .keyword = "laser",
    .noun = "laser",
    .help = "planar laser range finder; bare: range=0,5 fov=180 step=1",
    .heading_help = "direction of bearing 0, from +x",
    .device_help = "a planar laser range finder one can buy",
    .add_keys = addLaserKeys,
    .body = laserBody,
    .read = readModel<Laser>,
    .summary = laserSummary,
    .view = laserView,
    .bearings = [](const SensorModel& model) -> BearingSpan {
        const Laser& laser = std::get<Laser>(model);
        return {laser.first, laser.first + laser.span(), laser.max_range};
    },
    .is_read = true,
    .is_arranged = true,
    .follows_poses = true,
    .sight_errors = [](const SensorModel& model, double range) -> SightErrors {
        const Laser& laser = std::get<Laser>(model);
        return {distanceSigma(laser.noise, range),
                directionSigma(laser.noise, laser.step.radians())};
    }};

}  // namespace ispace

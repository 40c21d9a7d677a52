// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/sensor_reading.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/sensor/sensor.h"

namespace ispace {

namespace {

constexpr __int128 kSecond = 1'000'000'000;

}  // namespace

Periods::Periods(double rate) {
    constexpr double kDecimals = 1e9;
    // Slower than a period in three hundred years.
    if (rate < 1e-10) return;
    const auto decimal = static_cast<std::int64_t>(std::llround(rate * kDecimals));
    if (static_cast<double>(decimal) / kDecimals == rate) {
        numerator_ = decimal;
        denominator_ = kSecond * kSecond;
        return;
    }
    int exponent = 0;
    const double mantissa = std::frexp(rate, &exponent);
    constexpr int kBits = std::numeric_limits<double>::digits;
    numerator_ = static_cast<std::int64_t>(std::ldexp(mantissa, kBits));
    denominator_ = kSecond;
    // Every binary fraction up to 2^53 becomes whole by a shift.
    denominator_ <<= std::max(0, kBits - exponent);
    numerator_ <<= std::max(0, exponent - kBits);
}

std::int64_t Periods::newest(SimTime time) const {
    return static_cast<std::int64_t>(time.count() * numerator_ / denominator_);
}

SimTime Periods::begin(std::int64_t k) const {
    if (numerator_ == 0) return k == 0 ? SimTime(0) : SimTime::max();
    const __int128 begin = (k * denominator_ + numerator_ - 1) / numerator_;
    constexpr __int128 kMax = std::numeric_limits<SimTime::rep>::max();
    return SimTime(static_cast<SimTime::rep>(std::min(begin, kMax)));
}

std::string_view RunSensor::keyword() const {
    if (const Sensor* placed = sensor()) return kindOf(placed->model).keyword;
    return std::holds_alternative<Mat>(what) ? "mat" : "gate";
}

double RunSensor::rate() const {
    if (const auto* laser = model<Laser>()) return laser->rate;
    if (const Sensor* placed = sensor()) return readingRate(placed->model);
    if (const auto* mat = std::get_if<Mat>(&what)) return mat->rate;
    return std::get<Gate>(what).rate;
}

bool RunSensor::isHeavy() const { return model<Ranger>() != nullptr || model<Camera>() != nullptr; }

Pose3 RunSensor::floorPose() const {
    const auto* mat = std::get_if<Mat>(&what);
    const Pose2& pose = mat != nullptr ? mat->pose : std::get<Gate>(what).pose;
    return {{pose.position.x, pose.position.y, 0}, pose.heading, {}, {}};
}

bool RunSensor::isOn(std::size_t robot) const {
    return sensor() != nullptr && sensor()->mount && sensor()->mount->robot == robot;
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Periods in exact arithmetic: periods per nanosecond are a fraction of 128-bit whole numbers, of
// the decimal that was written, or else of the double. No time within a run overflows them.
#include "sim/sensor_reading.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sense/formats/reading_fields.h"

namespace ispace {

namespace {

constexpr __int128 kUnitsPerSecond = 1'000'000'000;

}  // namespace

Periods::Periods(double rate) {
    constexpr double kDecimals = 1e9;
    // Slower than a period in three hundred years.
    if (rate < 1e-10) return;
    const auto decimal = static_cast<std::int64_t>(std::llround(rate * kDecimals));
    if (static_cast<double>(decimal) / kDecimals == rate) {
        numerator_ = decimal;
        denominator_ = kUnitsPerSecond * kUnitsPerSecond;
        return;
    }
    int exponent = 0;
    const double mantissa = std::frexp(rate, &exponent);
    constexpr int kBits = std::numeric_limits<double>::digits;
    numerator_ = static_cast<std::int64_t>(std::ldexp(mantissa, kBits));
    denominator_ = kUnitsPerSecond;
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

double periodRate(const Sensor& sensor) {
    const auto* const laser = sensor.tryAs<Laser>();
    return laser != nullptr ? laser->rate : readingRate(sensor.model);
}

bool isHeavy(const Sensor& sensor) { return sensor.is<Ranger>() || sensor.is<Camera>(); }

ReadingView viewOf(const Sensor& sensor, const SensorReading& reading,
                   std::span<const Sensor> receivers) {
    return std::visit(
        [&](const auto& one) -> ReadingView {
            // Scans, frames and bursts hold their time and number.
            if constexpr (requires { one.frame; })
                return viewOf(sensor, one, receivers);
            else
                return {sensor, &one, receivers, seconds(reading.time), reading.seq, reading.pose};
        },
        reading.value);
}

}  // namespace ispace

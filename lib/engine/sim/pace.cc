// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/pace.h"

#include <time.h>

#include <algorithm>

#include "sim/sensor_reading.h"

namespace ispace {

namespace {

double inSeconds(Pace::Nanoseconds time) { return std::chrono::duration<double>(time).count(); }

}  // namespace

std::chrono::nanoseconds threadTime() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

void Pace::worked(const Work& work, Moment now) {
    // Sensors of one reading a second are in each window.
    constexpr SimTime kWindow = std::chrono::seconds(1);
    constexpr auto kPatience = std::chrono::seconds(3);
    if (window_.simulated == SimTime() && window_.all == Nanoseconds()) begun_ = now;
    window_.all += work.all;
    window_.reading += work.reading;
    window_.simulated += std::max(work.simulated, SimTime());
    const bool is_slow = now - begun_ >= kPatience && window_.simulated > SimTime();
    if (window_.simulated < kWindow && !is_slow) return;
    const double simulated = seconds(window_.simulated);
    measured_ = {inSeconds(window_.all) / simulated, inSeconds(window_.reading) / simulated};
    window_ = {};
    std::erase_if(unmeasured_, [](const auto& entry) { return entry.second.is_old; });
    for (auto& [sensor, share] : unmeasured_) share.is_old = true;
}

void Pace::added(const std::vector<const Sensor*>& sensors, Nanoseconds work, const World* world) {
    constexpr double kTimes = 2;
    const double each =
        inSeconds(work) / static_cast<double>(std::max<std::size_t>(1, sensors.size()));
    for (const Sensor* const sensor : sensors)
        unmeasured_[{world, sensor->id}] = {kTimes * each * periodRate(*sensor), false};
}

void Pace::rescaled(double times) {
    measured_.all += (times - 1) * measured_.reading;
    measured_.reading *= times;
    for (auto& [sensor, share] : unmeasured_) share.load *= times;
}

void Pace::restarted() { *this = Pace(); }

Pace::Load Pace::load(const std::function<bool(const std::string& id)>& exists,
                      const World* world) const {
    Load load = measured_;
    for (const auto& [sensor, share] : unmeasured_) {
        if (sensor.first == world && !exists(sensor.second)) continue;
        load.all += share.load;
        load.reading += share.load;
    }
    return load;
}

}  // namespace ispace

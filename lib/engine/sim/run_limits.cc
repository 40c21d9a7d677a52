// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/run_limits.h"

#include <algorithm>

#include "base/number.h"
#include "sim/pace.h"
#include "sim/robot_sensors.h"

namespace ispace {

namespace {

/// Some 70 bytes of memory a beam, and 3 a pixel, add up to less than half a gigabyte.
struct Bound {
    double RunLoad::*sum;
    double most;
    const char* name;
};
constexpr Bound kBounds[] = {
    {&RunLoad::records, 100e3, "records"},
    {&RunLoad::beams, 4e6, "beams of lasers and sonars"},
    {&RunLoad::beam_rate, 100e6, "beams a second"},
    {&RunLoad::pixels, 64e6, "pixels of cameras and rangers"},
    {&RunLoad::pixel_rate, 2e9, "pixels a second"},
    {&RunLoad::recorded_bytes, 250e6, "recorded bytes a second"},
};

/// Approximate bytes in a record: of a mover's row, of a range, of a pixel as PNG.
constexpr double kRow = 80, kRange = 8, kPixel = 3;

}  // namespace

RunLoad operator+(const RunLoad& a, const RunLoad& b) {
    RunLoad sum = a;
    for (const Bound& bound : kBounds) sum.*bound.sum += b.*bound.sum;
    sum.readings += b.readings;
    return sum;
}

double readingRate(const Scene& scene) {
    double rate = 0;
    for (const Sensor& sensor : scene.sensors)
        if (!isHeavy(sensor)) rate += periodRate(sensor);
    return rate;
}

RunLoad loadOf(const Scene& scene, SimTime step, const RecordOptions* record) {
    RunLoad load;
    load.records = static_cast<double>(scene.records.size());
    load.readings = readingRate(scene);
    double recorded_pixels = 0, tags = 0, receivers = 0, sound_rate = 0;
    for (const Sensor& sensor : scene.sensors) {
        const double rate = periodRate(sensor);
        if (const auto* const laser = std::get_if<Laser>(&sensor.model)) {
            const auto beams = static_cast<double>(laser->beams);
            load.beams += beams;
            load.beam_rate += beams * rate;
        } else if (sensor.is<Tag>() || sensor.is<Receiver>()) {
            ++(sensor.is<Tag>() ? tags : receivers);
            sound_rate = std::max(sound_rate, rate);
        } else if (isHeavy(sensor)) {
            const double pixels = pixelsOf(sensor);
            load.pixels += pixels;
            load.pixel_rate += pixels * rate;
            if (record != nullptr && record->readings)
                recorded_pixels += pixels * std::min(rate, record->frame_rate);
        } else {
            const auto rays = static_cast<double>(rayCount(sensor.model));
            load.beams += rays;
            load.beam_rate += rays * rate;
        }
    }
    double echoes = 0;
    for (const PlacedRobot& robot : scene.robots)
        echoes += static_cast<double>(robot.model.sonar.places.size());
    // Tags query receivers, and receivers tags.
    const double sounds = 2 * tags * receivers;
    load.beams += echoes * kSonarRays + sounds;
    load.beam_rate += sounds * sound_rate;
    if (record == nullptr) return load;
    const auto movers = static_cast<double>(scene.robots.size() + scene.people.size());
    load.recorded_bytes = movers * kRow / seconds(std::max(step, record->form.every)) +
                          (record->readings ? load.beam_rate * kRange : 0) +
                          echoes * kRange * record->sonar_rate + recorded_pixels * kPixel;
    return load;
}

void checkPace(const RunLoad& before, const RunLoad& after, double work) {
    if (work <= Pace::kMost) return;
    if (after.records <= before.records && after.readings <= before.readings &&
        after.beam_rate <= before.beam_rate)
        return;
    throw OverLimit(Diagnostic{"", 0, 0,
                               "the world would take more than " + formatFixed(work, 2) +
                                   " s of work for each second, and may take " +
                                   formatFixed(Pace::kMost, 2) +
                                   "; delete sensors, or lower their rates"});
}

double pixelsOf(const Sensor& sensor) {
    const auto size = [](const auto& model) {
        return static_cast<double>(model.columns) * static_cast<double>(model.rows);
    };
    if (const auto* const camera = sensor.tryAs<Camera>()) return size(*camera);
    const auto* const ranger = sensor.tryAs<Ranger>();
    return ranger == nullptr ? 0 : size(*ranger);
}

void checkLoad(const RunLoad& before, const RunLoad& after) {
    for (const auto& [sum, most, name] : kBounds) {
        if (after.*sum <= most || after.*sum <= before.*sum) continue;
        throw OverLimit(Diagnostic{"", 0, 0,
                                   "the world would have " + formatFixed(after.*sum, 0) + ' ' +
                                       name + ", more than " + formatFixed(most, 0)});
    }
}

}  // namespace ispace

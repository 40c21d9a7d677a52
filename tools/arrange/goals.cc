// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/goals.h"

#include <string>
#include <variant>

#include "arrange/report.h"
#include "base/error.h"
#include "base/number.h"
#include "sense/ultrasound.h"
#include "solve/problem.h"

namespace ispace {

namespace {

/// Sensors that stand and those that may be placed.
struct Numbers {
    std::size_t receivers = 0, others = 0;
};

Numbers numbersOf(const ArrangeWork& work) {
    const Scene& scene = work.input.scene;
    Numbers numbers;
    for (const Sensor& sensor : scene.sensors)
        if (kindOf(sensor.model).perceives)
            ++(isPartial(sensor.model) ? numbers.receivers : numbers.others);
    for (const SensorGroup& group : work.groups) {
        auto most = static_cast<std::size_t>(group.most);
        if (work.how.budget)
            most = affordableCount(*work.how.budget, 0, group.record.number("cost"), most);
        (isPartial(group.model) ? numbers.receivers : numbers.others) += most;
    }
    return numbers;
}

/// Where the pixels of a camera are too few; "" without one, or if any number will do.
std::string reasonOfDensity(const ArrangeWork& work) {
    const double density = work.how.pixel_density;
    if (!(density > 0)) return "";
    for (const SensorGroup& group : work.groups)
        if (const auto* camera = std::get_if<Camera>(&group.model))
            return "nowhere on the " + std::string(work.how.plane > 0 ? "plane" : "floor") +
                   " are there " + formatDouble(density) + " pixels a metre (--density): " +
                   (camera->model.empty() ? "a camera" : camera->model) + " has so many up to " +
                   formatFixed(rangeOf(*camera, density), 2) + " m away";
    return "";
}

/// Why nothing is covered; "" where something is.
std::string reasonForNothing(const ArrangeWork& work, const Arrangement& arrangement) {
    const auto [receivers, others] = numbersOf(work);
    const std::size_t together = others + receivers / kMinReceivers;
    const auto times = static_cast<std::size_t>(work.how.redundancy);
    if (receivers > 0 && receivers < kMinReceivers)
        return "ultrasound covers nothing: at least " + std::to_string(kMinReceivers) +
               " receivers have to hear a tag, here are " + std::to_string(receivers);
    if (times > 1 && together < times)
        return "nothing counts: floor has to be seen by " + std::to_string(times) +
               " sensors, and there are " + std::to_string(together);
    if (arrangement.coverage > 0 || arrangement.sensors.empty()) return "";
    if (!work.how.judges_inside && arrangement.candidate_value > 0) return "";
    if (std::string text = reasonOfDensity(work); !text.empty()) return text;
    return "the sensors cover nothing: look at their heights, tilts and ranges, and at what "
           "`coverage` draws (-o map.png)";
}

/// Section 4.4.5 of the thesis; "" where it does not apply.
std::string hintAlongWalls(const ArrangeWork& work) {
    constexpr double kSlack = 1e-9;  // degrees
    const bool has_headings = work.how.headings.has_value();
    if (work.how.strategy != Strategy::Wall || has_headings || work.how.mount.on == MountOn::Frame)
        return "";
    for (const SensorGroup& group : work.groups) {
        const auto* laser = std::get_if<Laser>(&group.model);
        const double span = laser == nullptr ? 0 : laser->sweptSpan().degrees();
        if (span > 180 + kSlack)
            return "along walls " + formatDouble(roundSignificant(span - 180, 4)) + " of the " +
                   formatDouble(roundSignificant(span, 4)) +
                   " degrees of a laser's field of view face the wall: --strategy grid or random "
                   "may cover more";
    }
    return "";
}

/// Nothing hangs above the room.
void warnOfHeights(const ArrangeToolOptions& options, const ArrangeWork& work) {
    const double top = work.input.scene.environment.height();
    for (const double height : work.how.mount.heights)
        if (height > top)
            warn(options.common, "arrange",
                 "--z " + formatDouble(height) + ": the room is " + formatDouble(top) +
                     " m high, and nothing is there to mount a sensor on");
}

/// Where nothing is covered there is a reason, which is worth a word; and so are sensors too many.
void warnOfNothing(const ArrangeToolOptions& options, const ArrangeWork& work,
                   const Arrangement& arrangement) {
    std::string text = reasonForNothing(work, arrangement);
    if (text.empty()) text = idleText(arrangement);
    if (!text.empty()) warn(options.common, "arrange", text);
}

}  // namespace

void warnOfSearch(const ArrangeToolOptions& options, const ArrangeWork& work) {
    if (const std::string hint = hintAlongWalls(work); !hint.empty())
        warn(options.common, "arrange", hint);
    warnOfHeights(options, work);
}

void checkGoals(const ArrangeToolOptions& options, const ArrangeWork& work,
                const Arrangement& arrangement) {
    warnOfNothing(options, work, arrangement);
    if (const std::string text = doubledText(arrangement); !text.empty())
        warn(options.common, "arrange", text);
    if (!arrangement.is_reached) {
        std::string text = shortfallText(work.how, arrangement);
        if (arrangement.candidate_bound <= 0)
            if (const std::string reason = reasonOfDensity(work); !reason.empty())
                text += "; " + reason;
        throw UnmetError(text);
    }
    if (arrangement.unplaced > 0)
        throw UnmetError(std::to_string(arrangement.unplaced) +
                         " of the sensors are not placed: there are " +
                         (work.how.is_connected
                              ? "no candidates left from which views hang together (--connected)"
                              : "fewer candidates than sensors"));
}

}  // namespace ispace

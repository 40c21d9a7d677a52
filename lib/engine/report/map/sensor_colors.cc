// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/map/sensor_colors.h"

#include <algorithm>
#include <array>
#include <limits>

namespace ispace {

namespace {

/// Returns the hue whose nearest sensor among the first `count` is farthest from a point.
std::size_t farthestHue(const Coverage& coverage, const std::vector<std::size_t>& hues,
                        Point2 place) {
    std::array<double, kSeriesColors> nearest{};
    nearest.fill(std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < hues.size(); ++i) {
        double& known = nearest[hues[i]];
        known = std::min(known, distance(place, coverage.sensors[i].pose.position.onFloor()));
    }
    const auto best = std::max_element(nearest.begin(), nearest.end());
    return static_cast<std::size_t>(best - nearest.begin());
}

}  // namespace

std::vector<std::size_t> sensorHues(const Coverage& coverage) {
    constexpr std::size_t kMaxSensors = 4000;
    const std::vector<SensorView>& sensors = coverage.sensors;
    const auto first_partial = std::find_if(sensors.begin(), sensors.end(),
                                            [](const auto& view) { return view.isPartial(); });
    const auto shared = static_cast<std::size_t>(first_partial - sensors.begin());
    std::vector<std::size_t> hues;
    hues.reserve(sensors.size());
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        if (sensors[i].isPartial() && i != shared)
            hues.push_back(hues[shared]);
        else if (i < kSeriesColors || sensors.size() > kMaxSensors)
            hues.push_back(i % kSeriesColors);
        else
            hues.push_back(farthestHue(coverage, hues, sensors[i].pose.position.onFloor()));
    }
    return hues;
}

std::vector<Color> sensorColors(const Coverage& coverage) {
    std::vector<Color> colors;
    for (const std::size_t hue : sensorHues(coverage)) colors.push_back(seriesColor(hue));
    return colors;
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/localisation.h"

#include <algorithm>
#include <cmath>

#include "scene/sensor/field_of_view.h"
#include "scene/sensor/ultrasound.h"
#include "sense/scan.h"

namespace ispace {

void SpotInformation::add(const Sensor& sensor, const SpaceInformation& information) {
    if (sensor.is<Uwb>()) {
        ranged += atKnownHeight(information);
        ++anchors;
    } else if (kindOf(sensor.model).together == 1) {
        seen += atKnownHeight(information);
    } else {
        heard += information;
        ++receivers;
    }
}

double SpotInformation::error() const {
    FloorInformation all = seen;
    if (anchors >= kMinAnchors) all += ranged;
    if (receivers >= kMinReceivers) all += atAnyHeight(heard);
    return all.error();
}

Point3 spotFor(const Sensor& sensor, Point2 at, double plane) {
    return {at.x, at.y, scansSlice(sensor) ? sensor.pose.position.z : plane};
}

namespace {

/// Returns the value that this share of the floor does not exceed; empty if it is infinite.
std::optional<double> quantile(const std::vector<double>& ascending, double share) {
    if (ascending.empty()) return std::nullopt;
    const auto count = static_cast<double>(ascending.size());
    const auto rank = static_cast<std::size_t>(std::max(1.0, std::ceil(share * count)));
    const double value = ascending[rank - 1];
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace

Localisation localise(const Scene& scene, const Coverage& coverage, double within) {
    const Grid& grid = coverage.target.grid;
    std::vector<SpotInformation> spots(grid.size());
    for (const SensorView& view : coverage.sensors) {
        const Sensor& sensor = scene.sensors[view.index];
        view.cells.forEach([&](std::size_t cell) {
            const Point3 spot = spotFor(sensor, grid.center(cell), coverage.report.plane);
            spots[cell].add(sensor, informationOf(sensor.model, sensor.pose.position, spot));
        });
    }
    Localisation result{within, {}};
    result.errors.reserve(spots.size());
    for (const SpotInformation& spot : spots) result.errors.push_back(spot.error());
    std::vector<double> ascending;
    coverage.target.indoor.forEach(
        [&](std::size_t cell) { ascending.push_back(result.errors[cell]); });
    if (ascending.empty()) return result;
    std::sort(ascending.begin(), ascending.end());
    double sum = 0;
    std::size_t finite = 0, near = 0;
    for (const double error : ascending) {
        sum += std::min(error, within);
        finite += std::isfinite(error) ? 1 : 0;
        near += error <= within ? 1 : 0;
    }
    const auto count = static_cast<double>(ascending.size());
    result.localised = static_cast<double>(finite) / count;
    result.share_within = static_cast<double>(near) / count;
    result.mean = sum / count;
    result.median = quantile(ascending, 0.5);
    result.most = quantile(ascending, 0.95);
    return result;
}

}  // namespace ispace

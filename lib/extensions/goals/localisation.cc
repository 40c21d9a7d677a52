// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/goals/localisation.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "scene/sensor/field_of_view.h"
#include "scene/sensor/ultrasound.h"
#include "sense/scan.h"

namespace ispace::goals {

void SpotInformation::add(const Sensor& sensor, const SpaceInformation& information) {
    const SensorKind& kind = kindOf(sensor.model);
    if (kind.locates_together > 1) {
        ranged += atKnownHeight(information);
        ++anchors;
        needed_anchors = kind.locates_together;
    } else if (kind.together == 1) {
        seen += atKnownHeight(information);
    } else {
        heard += information;
        ++receivers;
    }
}

double SpotInformation::error() const {
    FloorInformation all = seen;
    if (anchors >= needed_anchors) all += ranged;
    if (receivers >= kMinReceivers) all += atAnyHeight(heard);
    return all.error();
}

Point3 spotFor(const Sensor& sensor, Point2 at, double plane) {
    return {at.x, at.y, scansSlice(sensor) ? sensor.pose.position.z : plane};
}

namespace {

/// An error and the area of its cell.
using CellError = std::pair<double, double>;

/// Returns the value that this share of the floor does not exceed; empty if it is infinite.
std::optional<double> quantile(const std::vector<CellError>& ascending, double share, double all) {
    double area = 0;
    for (const auto& [error, own] : ascending) {
        area += own;
        // Sums of equal areas differ by rounding.
        if (area >= share * all * (1 - 1e-12))
            return std::isfinite(error) ? std::optional(error) : std::nullopt;
    }
    return std::nullopt;
}

/// Sets the figures by the errors of all cells.
void describe(std::vector<CellError> errors, Localisation& result) {
    if (errors.empty()) return;
    std::sort(errors.begin(), errors.end());
    double all = 0, sum = 0, finite = 0, near = 0;
    for (const auto& [error, area] : errors) {
        all += area;
        sum += area * std::min(error, result.within);
        finite += std::isfinite(error) ? area : 0;
        near += error <= result.within ? area : 0;
    }
    result.localised = finite / all;
    result.share_within = near / all;
    result.mean = sum / all;
    result.median = quantile(errors, 0.5, all);
    result.most = quantile(errors, 0.95, all);
}

/// Appends the errors of the indoor cells. \param area of each
void addErrors(const Localisation& room, const CellSet& indoor, double area,
               std::vector<CellError>& errors) {
    indoor.forEach([&](std::size_t cell) { errors.emplace_back(room.errors[cell], area); });
}

}  // namespace

Localisation localise(const Scene& scene, const Coverage& coverage, double within) {
    const Grid& grid = coverage.target.grid;
    std::vector<SpotInformation> spots(grid.size());
    for (const SensorView& view : coverage.sensors) {
        if (view.index >= scene.sensors.size()) continue;
        const Sensor& sensor = scene.sensors[view.index];
        view.cells.forEach([&](std::size_t cell) {
            const Point3 spot = spotFor(sensor, grid.center(cell), coverage.report.plane);
            spots[cell].add(sensor, informationOf(sensor.model, sensor.pose.position, spot));
        });
    }
    Localisation result{within, {}};
    result.errors.reserve(spots.size());
    for (const SpotInformation& spot : spots) result.errors.push_back(spot.error());
    std::vector<CellError> errors;
    // Cells of one room count alike.
    addErrors(result, coverage.target.indoor, 1, errors);
    describe(std::move(errors), result);
    return result;
}

Localisation localisedOver(std::span<const Localisation> rooms,
                           std::span<const Coverage> coverages) {
    Localisation result{rooms.empty() ? 0 : rooms.front().within, {}};
    std::vector<CellError> errors;
    for (std::size_t i = 0; i < rooms.size(); ++i)
        addErrors(rooms[i], coverages[i].target.indoor, coverages[i].target.grid.cellArea(),
                  errors);
    describe(std::move(errors), result);
    return result;
}

}  // namespace ispace::goals

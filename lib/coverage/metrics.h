// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/coverage only: what the parts of measureCoverage() share.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "coverage/coverage.h"
#include "env/environment.h"

namespace ispace {

/// The region that at least kMinReceivers of these hear; nothing if it is not known.
std::optional<std::vector<Curve>> regionHeardByEnough(std::span<const SensorView* const> receivers);
/// A zone of the environment.
struct Zone {
    std::string id;
    Polygon outline;
};
std::vector<Zone> zonesOf(const Environment& environment);
/// Their indoor areas, exact.
std::vector<ZoneMetrics> zoneMetricsOf(const Environment& environment,
                                       const std::vector<Zone>& zones);

/// Sets what the report says by cells, of a Coverage whose target, sensors and sets are there.
void addCellMetrics(Coverage& coverage, const std::vector<Zone>& zones);

/// Boundaries of the indoor region and of its free floor, arcs included.
struct FloorCurves {
    std::vector<Curve> indoor, free;
};
FloorCurves floorCurvesOf(const Environment& environment, const std::vector<Region>& free_floor);

/// Makes the overlay, with depths or without, and sets what the report says in closed form.
/// \pre all regions are known
void addExactMetrics(Coverage& coverage, const Environment& environment, FloorCurves floor,
                     const std::vector<Zone>& zones, bool keep_depths);

/// A share of `whole`, from 0 to 1 whatever rounds; 0 of nothing
double shareOf(double part, double whole);

}  // namespace ispace

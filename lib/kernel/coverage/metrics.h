// SPDX-License-Identifier: GPL-3.0-or-later
// Steps of measureCoverage(), which reports reuse.
//
// Exact figures are sums over the faces of one overlay of all views: the marks of a face stand for
// floor and zones, its count and numbers for the sensors that see it. Zones beyond kZonesAtOnce
// need further overlays. Figures by cells are counts of bits.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "coverage/requirement.h"
#include "env/environment.h"

namespace ispace {

/// Returns a layer that sets bits of `marks` and is not counted.
Layer markLayer(SharedCurves curves, std::uint64_t marks);
/// Sets the exact region of a view, cut along the limits of the room.
void setRegion(std::optional<std::vector<Curve>> region, const Box2& limits, SensorView& view);
/// Returns the region heard by at least kMinReceivers of these receivers; empty if unknown.
std::optional<std::vector<Curve>> regionHeardByEnough(
    std::span<const SensorView* const> receivers,
    std::size_t most_crossings = Overlay::kAnyCrossings);
/// A zone of the environment.
struct Zone {
    std::string id;
    Polygon outline;
};
/// Returns the zones in the order of their records.
std::vector<Zone> zonesOf(const Environment& environment);
/// Zones take the bits from here on; further zones require further passes.
constexpr std::size_t kFirstZoneBit = 2, kZonesAtOnce = 62;
/// Adds layers that mark these zones. \pre at most kZonesAtOnce
void addZoneLayers(std::span<const Zone> zones, std::vector<Layer>& layers);
/// Calls visit(zone) for each zone of a pass that holds an indoor face.
template <typename Visit>
void forEachIndoorZone(const LayerLabel& label, Visit visit) {
    if ((label.marks & kIndoorMark) == 0) return;
    for (std::uint64_t bits = label.marks >> kFirstZoneBit; bits != 0; bits &= bits - 1)
        visit(static_cast<std::size_t>(std::countr_zero(bits)));
}

/// Computes the zones' exact indoor areas.
std::vector<ZoneMetrics> zoneMetricsOf(const Environment& environment,
                                       const std::vector<Zone>& zones);

/// Sets the metrics by cells of report. \pre target, sensors and sets are set
void addCellMetrics(Coverage& coverage, const std::vector<Zone>& zones);

/// Boundaries of the indoor region and of its free floor, arcs included.
struct FloorCurves {
    std::vector<Curve> indoor, free;
};
FloorCurves floorCurvesOf(const Environment& environment, const std::vector<Region>& free_floor);

class FarHoles;

/// Builds the overlay, with or without depths, and sets the exact metrics of the report. \pre all
/// regions are known
/// \param holes of the free floor at the target's height
/// \param most_crossings of an overlay
/// \throws FormatError if an overlay has more
void addExactMetrics(Coverage& coverage, const Environment& environment, FarHoles& holes,
                     const std::vector<Zone>& zones, bool keep_depths, std::size_t most_crossings);

/// Sets only the shares of floor and zones, to the same values.
void addExactShares(Coverage& coverage, const Environment& environment, FarHoles& holes,
                    const std::vector<Zone>& zones, bool keep_depths, std::size_t most_crossings);

/// Returns part / whole, clamped to [0, 1] against rounding; 0 if `whole` is 0
double shareOf(double part, double whole);

}  // namespace ispace

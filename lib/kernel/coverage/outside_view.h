// SPDX-License-Identifier: GPL-3.0-or-later
// Views into a room from a sensor beside it: through doors of walls that rooms share, down from a
// gallery. They are computed once, with the bodies of both rooms, in the frame of the room that is
// seen, and then measured like the views of the room's own sensors.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "coverage/coverage.h"
#include "coverage/shadow_footprint.h"
#include "geom/curve.h"
#include "scene/sensor/sensor.h"

namespace ispace {

/// The view that a sensor has of a room in which it does not stand, through openings.
struct OutsideView {
    Sensor sensor;              ///< in the frame of the room that it sees
    std::vector<Curve> region;  ///< on the plane, at the requested density
    std::vector<Curve> whole;   ///< at any density
    /// Returns the cells that it sees at a density; without it those with their centre in the
    /// region.
    std::function<CellSet(const Grid& grid, double density)> cells = {};
};

/// Returns true for a sensor whose view into other rooms is known: one that sees by itself, in a
/// field of view with a closed form. Lasers scan their own room.
bool seesOutside(const Sensor& sensor);

/// Computes the regions of a view. \param caster of the bodies of both rooms and those between
/// \param sensor in the frame of the caster \param density see CoverageOptions
/// \param reach limit of the range, metres
OutsideView viewThrough(const ShadowCaster& caster, const Sensor& sensor, double plane,
                        double density, double reach);

/// Maps sensor and regions to the frame in which that of the view lies at `pose`, `lift` metres
/// above its floor.
OutsideView moved(OutsideView view, const Pose2& pose, double lift);

/// Measures a scene as measureCoverage() does, with the views of sensors that stand outside of its
/// room. Their indices follow those of the scene's own sensors.
Coverage measureWithOutside(const Scene& scene, RayScenes& worlds, const CoverageOptions& options,
                            std::span<const std::shared_ptr<const OutsideView>> outside,
                            Progress* progress = nullptr);

/// Returns the view by cells and in closed form, as measureCoverage() has it of a sensor of the
/// room. \param index see SensorView \param limits of the room, see SensorView::region
SensorView sensorViewOf(const OutsideView& view, std::size_t index, const Grid& grid,
                        const Box2& limits, const CoverageOptions& options);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of measureCoverage() for searches that measure many layouts of one room: the shares alone,
// and the change from a layout that was measured. Both return the values of the whole; they save
// cells, and the views of sensors that stay.
//
//     const Coverage after = measureChanged(scene, worlds, options, {&before_scene, &before});
#pragma once

#include <optional>

#include "coverage/coverage.h"
#include "coverage/visible_area.h"

namespace ispace {

/// Computes the exact shares of floor and zones and the sensors' regions as measureCoverage() does,
/// to the same values, but no cells, beams, pieces, pictures or classes of density. Empty if a
/// region or a share is not known exactly, and with receivers.
/// \param sight of an equal environment and the same plane, which may know regions; null: none
std::optional<Coverage> exactShares(const Scene& scene, RayScenes& worlds,
                                    const CoverageOptions& options,
                                    const VisibleArea* sight = nullptr);

/// A scene that was measured, with the same options.
struct MeasuredScene {
    const Scene* scene = nullptr;
    const Coverage* coverage = nullptr;
};

/// Returns the same as measureCoverage(). Takes the views of sensors that the scene has in common
/// with `before`, if their rooms share their data: those of changed sensors alone are computed.
Coverage measureChanged(const Scene& scene, RayScenes& worlds, const CoverageOptions& options,
                        const MeasuredScene& before);

}  // namespace ispace

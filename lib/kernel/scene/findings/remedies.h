// SPDX-License-Identifier: GPL-3.0-or-later
// Moves that resolve findings, found by trial: each candidate is applied, and the scene is built
// and checked again. Up to 133 candidates a record, each at the cost of checkScene() and of the
// elements that change. Deterministic.
//
//     const std::vector<Finding> findings = checkScene(scene);
//     for (const Remedy& remedy : remediesOf(scene, findings, {}, 3, devices))
//         proposals.push_back(remedy.text);
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "record/edit.h"
#include "scene/devices.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"

namespace ispace {

/// A move after which a scene has fewer findings.
struct Remedy {
    std::string text;  ///< "move l1 by (-1.05, 0.00) m"
    Edit edit;
    std::size_t resolved = 0;  ///< number of findings that it resolves
};

/// Finds the shortest move, in centimetres, of each record with a finding and a position of its
/// own: of those by up to 5 m in 16 directions, or into the room by the shortest way. It leaves the
/// scene with fewer findings, and none more of `paths`; each remedy is a change of the given scene.
/// Skips records without one. O(moves * scene), and at most a dozen calls of `paths` for a record.
/// \param findings all of the scene's by checkScene() \param most number of remedies
/// \param paths the number of further findings of a scene, as by checkCourses(); empty: none
std::vector<Remedy> remediesOf(const Scene& scene, std::span<const Finding> findings,
                               const FindingFilter& filter, std::size_t most,
                               const DeviceCatalogue& devices,
                               const std::function<std::size_t(const Scene&)>& paths = {});

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange: a room in one of the sites of LayoutCases, with its cells.
#pragma once

#include <cstddef>
#include <memory>

#include "arrange/arrange.h"
#include "arrange/layout_cases.h"
#include "base/cell_set.h"
#include "coverage/target.h"
#include "coverage/visible_area.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

namespace ispace {

/// The room of one case.
struct CaseRoom {
    /// \param room its index in the site \param number of the case \pre there are cases
    CaseRoom(Scene in, const ArrangeOptions& options, std::size_t room, std::size_t number);
    CaseRoom(const CaseRoom&) = delete;
    CaseRoom& operator=(const CaseRoom&) = delete;

    /// Returns the sensor as it is mounted in this case.
    [[nodiscard]] Sensor mounted(Sensor sensor) const;

    Scene scene;  ///< its sensors as they are mounted
    RayScenes worlds;
    VisibleArea sight;
    std::unique_ptr<const PoseErrors> errors;  ///< null: sensors stand as planned
    Target target;
    CellSet counted = CellSet();  ///< cells with weight
    std::size_t first = 0;        ///< its cells begin there among those of all cases
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Private to lib/engine/arrange: the cases of a robust search, each a room with its cells.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "arrange/arrange.h"
#include "base/cell_set.h"
#include "coverage/mounting.h"
#include "coverage/target.h"
#include "coverage/visible_area.h"
#include "scene/scene.h"
#include "trace/ray_world.h"

namespace ispace {

/// Errors of mounting in one case, drawn as mountedPose() does, but by the site instead of the
/// sensor: all candidates of a site share theirs.
class SiteErrors {
  public:
    /// Stores the reference.
    SiteErrors(const Environment& environment, const MountingTolerance& tolerance,
               std::uint64_t seed, std::uint64_t mounting)
        : environment_(&environment), tolerance_(tolerance), seed_(seed), mounting_(mounting) {}
    /// Returns the pose that a sensor planned for this pose gets.
    [[nodiscard]] Pose3 mounted(const Sensor& sensor) const;

  private:
    const Environment* environment_;
    MountingTolerance tolerance_;
    std::uint64_t seed_, mounting_;
};

/// The room of one case.
struct CaseRoom {
    /// \param number of the case: of the mounting or crowd
    CaseRoom(Scene in, const ArrangeOptions& options, std::uint64_t number);
    CaseRoom(const CaseRoom&) = delete;
    CaseRoom& operator=(const CaseRoom&) = delete;

    /// Returns the sensor as it is mounted in this case.
    [[nodiscard]] Sensor mounted(Sensor sensor) const;

    Scene scene;  ///< its sensors as they are mounted
    RayScenes worlds;
    VisibleArea sight;
    std::optional<SiteErrors> errors;
    Target target;
    CellSet counted = CellSet();  ///< cells with weight
    std::size_t first = 0;        ///< its cells begin there among those of all cases
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Sight between the storeys of a building, through shafts and over stairs. Views are in the frame
// of the storey that is seen.
//
//     const auto views = viewsBetweenStoreys(Coupling(building), {.plane = 1});
//     for (const StoreyView& one : views[0]) draw(one.view->region);  // the ground, from elsewhere
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "coverage/coverage.h"
#include "coverage/outside_view.h"
#include "env/environment.h"
#include "sense/detection.h"
#include "site/coupling.h"
#include "site/site_scene.h"
#include "trace/ray_world.h"

namespace ispace {

/// Returns true for a sensor that sees other storeys: by light, in more than its own level plane.
bool seesOtherStoreys(const Sensor& sensor);

/// Returns true if other fixed sensors of a storey, or in other poses, may see other storeys.
bool looksOtherwise(const Scene& before, const Scene& now);

/// The surroundings of each storey of a running building, see Coupling. It knows the other storeys
/// as they were at the start, without their robots and people, but for sensors that are set.
/// Thread-safe.
class RoomsAround {
  public:
    /// \param plane at which sensors of other storeys see robots and people
    explicit RoomsAround(const SiteScene& building, double plane = 0);
    /// Returns the surroundings of a storey whose scene may have changed; null if it is alone, and
    /// if the scene has neither sensors nor sonars. Scenes that follow each other with equal rooms
    /// share them.
    std::shared_ptr<const SurroundedRoom> around(std::size_t storey, const Scene& scene);
    /// Returns the fixed sensors of other storeys that see the plane of a storey, as in coverage,
    /// and the room that these and its own sensors see. Null without openings, unless a sensor lies
    /// in a slab.
    OutsideWatch outside(std::size_t storey, const Scene& scene);
    /// Sets the sensors of a storey to those of its scene after a change.
    void setSensors(std::size_t storey, const Scene& scene);
    /// Returns true if there are openings between storeys.
    [[nodiscard]] bool hasOpenings() const { return has_openings_; }

  private:
    /// A room, and the storey that it was built of.
    struct Known {
        Environment storey;
        std::shared_ptr<const SurroundedRoom> room;
    };

    std::shared_ptr<const SurroundedRoom> room(std::size_t storey, const Scene& scene);
    using SensorsByStorey = std::vector<std::vector<Sensor>>;
    [[nodiscard]] SensorsByStorey sensorsOutside(const SiteScene& building) const;

    SiteScene building_;
    double plane_;
    bool has_openings_;
    /// By the storey that they see; computed of `watching_`.
    std::shared_ptr<Lazy<SensorsByStorey>> outside_ = std::make_shared<Lazy<SensorsByStorey>>();
    std::shared_ptr<const SiteScene> watching_;  // with the sensors that are set
    std::mutex mutex_;
    std::vector<std::shared_ptr<const Known>> latest_;  // by storey
};

/// The view of a sensor into another storey.
struct StoreyView {
    std::size_t storey = 0;  ///< of the sensor
    std::size_t sensor = 0;  ///< in the sensors of its scene
    std::shared_ptr<const OutsideView> view;
};

/// Computes the views of rangers and cameras into other storeys, up to kSightBetweenStoreys: for
/// each storey those that see any of its plane, by storey and in the order of the sensors. A plane
/// on the floor is not seen from below. Views in equal surroundings are computed once and share
/// memory. Storeys without openings cost no time.
std::vector<std::vector<StoreyView>> viewsBetweenStoreys(const Coupling& coupling,
                                                         const CoverageOptions& options);

}  // namespace ispace

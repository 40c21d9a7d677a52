// SPDX-License-Identifier: GPL-3.0-or-later
// Sight between the storeys of a building, through shafts and over stairs.
#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "building/building_scene.h"
#include "coverage/coverage.h"
#include "coverage/outside_view.h"
#include "env/environment.h"
#include "geom/polygon.h"
#include "sense/detection.h"
#include "trace/ray_world.h"

namespace ispace {

/// Sensors see into other storeys up to this distance, metres.
constexpr double kSightBetweenStoreys = 50;

/// Most floors between a sensor and the storey that it sees.
constexpr std::size_t kSightThroughFloors = 16;

/// An opening in the floor of a storey, to the storey below.
struct FloorOpening {
    std::string passage;               ///< its id
    std::size_t below = 0, above = 0;  ///< storeys
    Polygon outline;                   ///< in the building, counter-clockwise
    /// Of stairs: the edge of the lowest step and that of the highest one, each from the right of
    /// those who go up to their left. Between them the steps block sight.
    std::vector<Segment2> flight = {};
};

/// Returns the openings of shafts and of straight stairs, in the order of the passages. Storeys
/// that are level have no opening between them.
std::vector<FloorOpening> floorOpenings(const BuildingScene& building);

/// Returns the scenes without the openings in their floors, and with the steps that begin on them:
/// the floor that one can stand on, which coverage and arrange count, and all bodies of the
/// surroundings that can hide it from sensors of the storey. Floor below steps counts: rays that
/// come from beside them meet it. The records are those of the storeys. Storeys that share a scene
/// share the result if their openings and steps are equal; storeys without openings keep their
/// scenes.
std::vector<std::shared_ptr<const Scene>> scenesOfFloors(const BuildingScene& building);

/// Square metres of a corner that remains of a floor that is all open, see scenesOfFloors().
constexpr double kNoFloor = 1e-5;
/// Returns false for the scene of such a floor.
bool hasFloor(const Scene& scene);

/// Returns the scene of a storey without the openings in its floor, in its records, too, so that
/// scenes that are made of them keep the openings.
std::shared_ptr<const Scene> openedScene(const BuildingScene& building, std::size_t storey);

/// Returns the room of the lowest of some storeys, with the bodies, floors and openings of the
/// others in their positions above it. A floor reaches down to the top of the storeys below it,
/// openings are closed at the sides in between, and outer walls reach up to the underside. Steps
/// are planes. \pre `storeys` ascend
Environment joinedRoom(const BuildingScene& building, std::span<const FloorOpening> openings,
                       std::span<const std::size_t> storeys);

/// Returns, for each storey, which others one reaches from it upwards through openings.
std::vector<std::vector<bool>> storeysAbove(std::size_t storeys,
                                            std::span<const FloorOpening> openings);

/// Returns the room of a storey in its frame, with openings in its floor and ceiling, and the
/// storeys above and below that its sensors may see through them, with robots and people or without
/// them, and the undersides of the floors above. Its floor ends at the openings, and so does its
/// indoor region. Empty for a storey without openings under the roof.
std::optional<Environment> roomWithSurroundings(const BuildingScene& building,
                                                std::span<const FloorOpening> openings,
                                                std::size_t storey, bool with_movers = true);

/// Returns true for a sensor that the surroundings of its room hide floor from: by light. Steps,
/// slabs and the sides of shafts stop level lasers, too.
bool meetsSurroundings(const Sensor& sensor);

/// Returns true for a sensor that sees other storeys: by light, in more than its own level plane.
bool seesOtherStoreys(const Sensor& sensor);

/// Returns true if other fixed sensors of a storey, or in other poses, may see other storeys.
bool looksOtherwise(const Scene& before, const Scene& now);

/// The storeys around each storey of a running building. It knows the other storeys as they were at
/// the start, without their robots and people, but for sensors that are set. Thread-safe.
class RoomsAround {
  public:
    /// \param plane at which sensors of other storeys see robots and people
    explicit RoomsAround(const BuildingScene& building, double plane = 0);
    /// Returns roomWithSurroundings() of a storey whose scene may have changed. Null if that is
    /// empty, and if no sensor of the scene meets surroundings. Scenes that follow each other
    /// with equal rooms share it.
    std::shared_ptr<const SurroundedRoom> around(std::size_t storey, const Scene& scene);
    /// Returns the fixed sensors of other storeys that see the plane of a storey, as in coverage,
    /// and the room that these and its own sensors see.
    OutsideWatch outside(std::size_t storey, const Scene& scene);
    /// Sets the sensors of a storey to those of its scene after a change.
    void setSensors(std::size_t storey, const Scene& scene);
    /// Returns true if there are openings between storeys.
    [[nodiscard]] bool hasOpenings() const { return !openings_.empty(); }

  private:
    /// A room, and the storey that it was built of.
    struct Known {
        Environment storey;
        std::shared_ptr<const SurroundedRoom> room;
    };

    std::shared_ptr<const SurroundedRoom> room(std::size_t storey, const Scene& scene);
    using SensorsByStorey = std::vector<std::vector<Sensor>>;
    [[nodiscard]] SensorsByStorey sensorsOutside(const BuildingScene& building) const;

    BuildingScene building_;
    double plane_;
    std::vector<FloorOpening> openings_;
    /// By the storey that they see; computed of `watching_`.
    std::shared_ptr<Lazy<SensorsByStorey>> outside_ = std::make_shared<Lazy<SensorsByStorey>>();
    std::shared_ptr<const BuildingScene> watching_;  // with the sensors that are set
    std::mutex mutex_;
    std::vector<std::shared_ptr<const Known>> latest_;  // by storey
};

/// Returns the room of a storey by itself, with the openings in its floor and ceiling and the
/// stairs that begin there. Empty for a storey without openings.
std::optional<Environment> roomWithOpenings(const BuildingScene& building,
                                            std::span<const FloorOpening> openings,
                                            std::size_t storey);

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
std::vector<std::vector<StoreyView>> viewsBetweenStoreys(const BuildingScene& building,
                                                         const CoverageOptions& options);

}  // namespace ispace

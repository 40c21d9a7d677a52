// SPDX-License-Identifier: GPL-3.0-or-later
// How the rooms of a building see each other: one answer for readings, measures and checks.
//
// Faults of a building are findings, not errors: an opening beyond the rooms, stairs in a wall or
// storeys that overlap give some surroundings, and checkBuilding() and findings() name the fault.
// Bodies around a room are a mesh in single precision: 100 m from the origin, corners are off by up
// to 4e-6 m.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/parallel.h"
#include "env/environment.h"
#include "geom/polygon.h"
#include "scene/findings/findings.h"
#include "scene/scene.h"
#include "site/site_scene.h"

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
    /// people that go up to their left. Between them the steps block sight.
    std::vector<Segment2> flight = {};
};

/// Returns the openings of shafts and of straight stairs, in the order of the passages. Storeys
/// that are level have no opening between them.
std::vector<FloorOpening> floorOpenings(const SiteScene& building);

/// Returns, for each storey, which others one reaches from it upwards through openings. O((openings
/// + storeys) * storeys). \pre storeys are sorted by height
std::vector<std::vector<bool>> storeysAbove(std::size_t storeys,
                                            std::span<const FloorOpening> openings);

/// Square metres of a corner that remains of a floor that is all open, see Coupling::floor().
constexpr double kNoFloor = 1e-5;
/// Returns false for the scene of such a floor.
bool hasFloor(const Scene& scene);

/// How the storeys of a building see each other: `scan`, `coverage`, `arrange`, `simrun` and
/// `envc --check` ask this class and no other.
///
/// Around a storey stand
/// - *steps* of straight stairs, an inclined plane without thickness from the lowest to the highest
///   edge; the floor below it is floor;
/// - *slabs*: the floor of a storey reaches down to the top of the highest storey below it, one
///   that shares floor area with it: to its height, or its walls if these are higher. Openings cut
///   it, and its sides are those of the shaft. A floor above no storey is a plane. Without an
///   opening to a storey, its slab is a ceiling all the same;
/// - *outer walls*, which reach up to the underside of the slab over them;
/// - *neighbours*: bodies, walls and floors of the storeys that one reaches through openings, over
///   at most kSightThroughFloors floors and kSightBetweenStoreys metres.
///
/// All kinds of sensors meet them: light and level lasers as well as sound, radio and radar. A
/// sensor within a slab is one within a wall: it is blind, and findings() names it.
///
/// Guarantees: for sensors of a storey that look at its own floor, floor() gives the same answer as
/// surroundings(), as it leaves out only bodies above or below all lines of sight. The same
/// building gives the same environments. Thread-safe; shares the scenes of the building, which are
/// those of the constructor's call. A room alone has no surroundings: floor() and surroundings()
/// return its own scene and environment.
///
/// Cost: the constructor takes O(passages). An environment is built at the first call and kept; it
/// holds the elements of its storey and one mesh of all that is around, and building it takes
/// O(n log n) for n corners of the storeys in it. A storey with neither openings nor a slab that
/// matters keeps its own environment, without a copy.
///
///     const Coupling coupling(building);
///     RayScenes worlds(*coupling.surroundings(storey));    // readings
///     measureCoverage(*coupling.floor(storey), ...);       // figures
///     for (const Finding& finding : coupling.findings(storey)) ...
class Coupling {
  public:
    explicit Coupling(const SiteScene& building);
    Coupling(const Coupling&) = delete;
    Coupling& operator=(const Coupling&) = delete;
    ~Coupling();

    [[nodiscard]] const SiteScene& building() const { return building_; }
    [[nodiscard]] std::span<const FloorOpening> openings() const { return openings_; }
    /// Returns true for a storey without openings under the roof: its room is all that it sees.
    [[nodiscard]] bool isAlone(std::size_t storey) const;

    /// Whether the robots and people of other storeys stand there, as at the start.
    enum class Movers { None, OfNeighbours };
    /// Returns the room of a storey, in its frame, with all that stands around it. Its floor ends
    /// at the openings, and so does its indoor region.
    [[nodiscard]] std::shared_ptr<const Environment> surroundings(
        std::size_t storey, Movers movers = Movers::None) const;

    /// Returns the scene of a storey with the part of surroundings() that may stand between its
    /// sensors and its floor. Records and ids are those of the storey. Storeys that share a scene
    /// share the result if equal things stand around them.
    /// \param highest a height up to which sight of the floor leads, besides that of the sensors: a
    ///        plane above the floor, sites of sensors to come
    [[nodiscard]] std::shared_ptr<const Scene> floor(std::size_t storey, double highest = 0) const;
    /// Returns those of all storeys.
    [[nodiscard]] std::vector<std::shared_ptr<const Scene>> floors(double highest = 0) const;
    /// Returns floor() for sensors at any height, with its bodies among its records, so that scenes
    /// that are made of these keep them.
    [[nodiscard]] std::shared_ptr<const Scene> recordedFloor(std::size_t storey) const;

    /// Returns the room of the lowest of some storeys, with the others above it: for views between
    /// storeys. \pre `storeys` ascend
    [[nodiscard]] Environment joined(std::span<const std::size_t> storeys) const;
    /// Returns the room of a storey by itself, with the openings in its floor and ceiling and the
    /// steps that begin there, for drawings. Empty for a storey without openings.
    [[nodiscard]] std::optional<Environment> opened(std::size_t storey) const;

    /// The floor of a storey as a body, in heights of the building, metres.
    struct Slab {
        double bottom = 0, top = 0;
    };
    [[nodiscard]] const Slab& slab(std::size_t storey) const;
    /// Returns the storey in whose slab a point lies, deeper than a millimetre.
    /// \param storey in whose frame the point is
    [[nodiscard]] std::optional<std::size_t> slabAround(std::size_t storey, Point3 point) const;
    /// Returns true for a position in a solid of the storey or in a slab, where a sensor is blind.
    [[nodiscard]] bool isInsideSolid(std::size_t storey, Point3 point) const;

    /// Returns the storeys whose slabs lie over a storey with no other between, lowest first:
    /// several, if they stand over separate parts of it.
    [[nodiscard]] std::vector<std::size_t> slabsAbove(std::size_t storey) const;

    /// Checks the sensors and tags of a storey against its surroundings. Errors, as in a wall: in a
    /// slab, and in the steps of stairs, less than a step below their plane. checkScene() checks
    /// the room itself. \param filter runs unless it leaves out "buried"
    [[nodiscard]] std::vector<Finding> findings(std::size_t storey,
                                                const FindingFilter& filter = {}) const;

  private:
    friend class RoomBuilder;
    struct Floors;

    [[nodiscard]] bool areStacked(std::size_t a, std::size_t b) const;
    [[nodiscard]] const std::vector<Slab>& slabs() const;
    /// Returns the slab of a storey as seen from above, in the building.
    [[nodiscard]] const std::vector<Region>& slabPlan(std::size_t storey) const;
    [[nodiscard]] std::vector<std::size_t> neighbours(std::size_t storey) const;
    [[nodiscard]] std::optional<std::string> stepsAround(std::size_t storey, Point3 point,
                                                         double& height) const;

    SiteScene building_;
    std::vector<FloorOpening> openings_;
    std::vector<std::vector<std::size_t>> openings_at_;  // below or above each storey, ascending
    std::vector<std::vector<bool>> above_;
    Lazy<std::vector<std::vector<bool>>> stacked_;  // by storeys
    Lazy<std::vector<Slab>> slabs_;
    std::vector<Lazy<std::vector<Region>>> slab_plans_;
    std::vector<Lazy<std::shared_ptr<const Environment>>> surroundings_, with_movers_;
    std::unique_ptr<Floors> floors_;
};

/// Returns the findings of a storey, those of its scene and those of its surroundings, with the id
/// of the storey before each message.
/// \param with_scene false: those of its surroundings alone
std::vector<Diagnostic> storeyFindings(const Coupling& coupling, std::size_t storey,
                                       const FindingFilter& filter, bool with_scene = true);
/// Returns those of all storeys as warnings, at most Diagnostics::kMax a storey.
/// \param chosen returns true for the whole ids of the records to check; unset: all
std::vector<Diagnostic> storeyWarnings(const Coupling& coupling, const FindingFilter& filter,
                                       const std::function<bool(const std::string&)>& chosen = {});

}  // namespace ispace

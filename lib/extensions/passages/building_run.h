// SPDX-License-Identifier: GPL-3.0-or-later
// The run of a building: a world for each room, and movers that go between them.
//
// Guarantees are those of World, room by room. Trips are decided before each step, in the order of
// ids, from the state that all worlds have then: they do not depend on threads. Between steps a
// mover is in one world, and a passage is entered only by the mover that has its turn there.
//
// Costs. Ways from all landings are found once for each size of movers: O(landings * cells). A
// mover that changes rooms changes the scenes of two worlds, which share the geometry of their
// rooms.
//
//     BuildingRun run(building, {.clock = {Clock::Kind::Fast}, .until = simSeconds(300)});
//     run.travel("ground/r1", {.points = {{1, {2, 3}}}});          // to storey 1
//     while (!run.simulation().finished())
//         run.simulation().run(WallTime::clock::now(), std::chrono::seconds(1));
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "cli/building_runs.h"
#include "extensions/passages/lift.h"
#include "sim/replay.h"
#include "sim/simulation.h"
#include "sim/world.h"
#include "sim/worlds.h"
#include "site/site_scene.h"

namespace ispace::passages {

/// A building that moves: a world for each storey, for each lift's cabin and for each flight of
/// stairs, all in lock step.
///
/// A mover is in one world at a time. It goes to another one as a change of both, between steps, so
/// that records and replays of a world hold all that happened there. Cabins and flights have the
/// coordinates of the building; flights are walked straight ahead, also those that turn. Ids of
/// movers and of the sensors on them are those across the building, as "ground/r1", wherever they
/// go; all other ids are plain.
///
/// Trips (see Worlds) take the fastest way by stairs and lifts. Movers wait beside a landing,
/// one queue for each lift, and enter one by one, those that leave first. A mover in a cabin stands
/// where it leaves a way out to those that get out before it.
///
/// The `trip` of a record begins with the run, with its `loop` and `pause`.
///
/// A mover with walk=wander wanders on a storey for one to three minutes, then goes to a random
/// point of another one, if it finds a way, and wanders there, until a command ends that.
///
/// People climb at kSpeedUp and kSpeedDown; a robot only with climbs=yes. A person weighs
/// kPersonMass (EN 81-20), a robot `mass`. The same building, options and commands give the same
/// bytes.
///
/// In a replay each world follows the record of its own, and lifts follow lifts.csv. \pre then
/// there are no trips, rides and calls
class BuildingRun final : public BuildingWorlds {
  public:
    static constexpr double kPersonMass = 75;

    /// \throws FormatError as World does, with the storey; for trips without a way; as Replay, for
    /// records of other steps, and if no mover is in any of them
    BuildingRun(const SiteScene& building, const BuildingRunOptions& options);
    ~BuildingRun() override;
    /// Returns the errors about trips of records that would keep a run from beginning: no way
    /// leads there, or no floor is there. Empty if movers overlap.
    static std::vector<Diagnostic> tripFindings(const SiteScene& building);
    BuildingRun(const BuildingRun&) = delete;
    BuildingRun& operator=(const BuildingRun&) = delete;

    /// Returns the simulation that leads all others.
    [[nodiscard]] Simulation& simulation();
    /// Returns the reason why a lift does not go to a storey, or "".
    [[nodiscard]] std::string stopRefusal(std::string_view lift, std::string_view storey) const;
    /// Returns the worlds in the order of rooms().
    [[nodiscard]] const World& world(std::size_t room) const;
    /// Name of the file of lifts in a record.
    static constexpr const char* kLiftFile = "lifts.csv";

    [[nodiscard]] const Replay* replay(std::size_t room) const override;
    /// See BuildingScript. \pre it follows none yet
    void follow(std::string_view script, const std::string& file) override;
    void recordLifts(const std::string& folder) override;
    [[nodiscard]] std::span<const RunRoom> rooms() const override;
    [[nodiscard]] std::optional<std::size_t> roomOf(std::string_view mover) const override;
    [[nodiscard]] std::string whereText(std::size_t room) const override;
    /// A flight of stairs is at the height of the storey below it.
    [[nodiscard]] RoomFrame frameOf(std::size_t room) const override;
    [[nodiscard]] std::vector<PassageOutline> passageOutlines(std::size_t room) const override;
    [[nodiscard]] std::vector<PlannedPath> plannedPaths(std::size_t room) const override;
    TripAnswer travel(const std::string& mover, TripPlan plan) override;
    TripAnswer ride(const std::string& mover, std::string_view lift,
                    std::string_view storey) override;
    std::string endTrip(const std::string& mover, Outcome outcome) override;
    void abandonTrip(const std::string& mover) override;
    std::string place(const std::string& mover, const std::optional<RoomPoint>& at,
                      std::optional<Angle> heading) override;
    void restart() override;
    std::string call(std::string_view lift, std::string_view storey) override;
    std::string hold(std::string_view lift, std::string_view storey) override;
    [[nodiscard]] std::vector<LiftState> lifts() const override;
    [[nodiscard]] std::span<const TripEnd> tripEnds() const override;
    void onMove(Observer observer) override;

  private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace ispace::passages

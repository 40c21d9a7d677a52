// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/arrange: maps the rooms of a site to a weighted coverage problem and its
// solutions back to sensors.
//
// The problem knows cells, whole weights and candidates (search/problem.h); rooms, poses and shares
// stay here. In one room, and in rooms with equal cells, the weights are those of integerWeights():
// exact for decimals of a few digits. Cells of unequal rooms count by area, as whole numbers with a
// sum of about 2^32 (2^25 if sensors may fail), rounded down: a share is at most rounding() too
// small, a part in 2^32 (2^25) for each cell at most, and bounds of shares have it added.
//
// Receivers of ultrasound cover in fours: each of them has multiplicity 1, all other sensors 4, and
// a cell requires 4 for each sensor of the redundancy. Without receivers both are 1.
//
//     CoverageModel model(site, groups, options, progress);
//     const SearchResult found = search(model.problem(), model.searchOptions(), progress);
//     const std::vector<Placement> sensors = model.placementsOf(found.best.chosen);
//     const double bound = model.shareBound(found.bound);
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arrange/arrange.h"
#include "arrange/candidate_generator.h"
#include "arrange/room_model.h"
#include "arrange/search/problem.h"
#include "arrange/search/worst_case.h"
#include "arrange/sensor_group.h"
#include "arrange/site.h"
#include "arrange/tried_pose.h"
#include "base/cell_set.h"
#include "base/error.h"
#include "coverage/coverage.h"
#include "geom/point.h"
#include "raster/grid.h"
#include "scene/scene.h"

namespace ispace {

/// Cells of the search's grid that one sensor sees, and the multiplicity that it adds there.
struct CountedView {
    CellSet cells;
    int multiplicity = 1;
};

/// A sensor at a pose in a room of the site.
struct SiteSensor {
    std::size_t room = 0;
    Sensor sensor;
};

/// Maps the rooms of a site with unplaced sensors to a weighted coverage problem, and solutions
/// back to poses.
///
/// Equal sensors are one kind of the problem, with candidates by the options' strategy in all rooms
/// in which they may stand. The cells of the rooms follow each other; those of one room alone have
/// the weights of options.weights, those of several count by area, too. Standing sensors add to the
/// multiplicity, also of floor that they see in other rooms, as candidates do.
///
/// Rooms of one scene without goals of their own share a RoomModel, and their candidates are made
/// once. For one thread at a time: also const members prepare levels of rooms. They use all cores.
class CoverageModel {
  public:
    /// Builds all candidates. Stores references.
    /// \throws UnmetError if a kind has no valid site, the budget buys no sensor or all weights are
    ///         0, UsageError if the candidates do not fit in memory, or cannot be refined as asked
    CoverageModel(const ArrangeSite& site, const std::vector<SensorGroup>& groups,
                  const ArrangeOptions& options, Progress& progress);
    ~CoverageModel();
    CoverageModel(const CoverageModel&) = delete;
    CoverageModel& operator=(const CoverageModel&) = delete;

    [[nodiscard]] const ArrangeSite& site() const { return site_; }
    [[nodiscard]] const std::vector<SensorGroup>& groups() const { return groups_; }
    [[nodiscard]] const ArrangeOptions& options() const { return options_; }
    [[nodiscard]] const Problem& problem() const { return problem_; }
    [[nodiscard]] const std::vector<SensorClass>& kinds() const { return kinds_; }
    /// Returns the name of a kind in the site: that of one kept to a room begins with it.
    [[nodiscard]] std::string nameOf(const SensorClass& kind) const {
        return kind.room ? site_.rooms[*kind.room].id + '/' + kind.id : kind.id;
    }
    /// Returns the model of a room. \pre it has one, see hasRoom()
    [[nodiscard]] const RoomModel& room(std::size_t room) const { return *rooms_[room].model; }
    [[nodiscard]] RoomModel& room(std::size_t room) { return *rooms_[room].model; }
    [[nodiscard]] bool hasRoom(std::size_t room) const { return rooms_[room].model != nullptr; }
    /// Returns the model of a room alone.
    [[nodiscard]] const RoomModel& only() const { return *rooms_.front().model; }
    [[nodiscard]] RoomModel& only() { return *rooms_.front().model; }
    /// Returns rooms in parts, in order: candidates of one see no cells of another. Equal parts
    /// have an equal `alike`.
    struct Part {
        std::vector<std::size_t> rooms;
        std::size_t alike = 0;  ///< the first part with equal rooms and standing sensors
    };
    [[nodiscard]] std::vector<Part> parts() const;
    /// Returns the range of the problem's cells of a room.
    [[nodiscard]] CellBlock cellsOfRoom(std::size_t room) const;

    /// Returns false if progress said to stop before all candidates were built.
    [[nodiscard]] bool isComplete() const { return is_complete_; }
    /// Returns the number of candidates of all kinds.
    [[nodiscard]] std::size_t candidates() const;
    [[nodiscard]] std::size_t bytes() const;
    /// Returns the search options, with the memory that the candidates leave.
    [[nodiscard]] SearchOptions searchOptions() const;

    /// Returns the problem of the worst case. \pre ArrangeOptions::cases are set
    [[nodiscard]] const WorstCaseProblem& cases() const { return cases_; }
    /// Returns the values of these sensors in the cases. \pre as cases()
    [[nodiscard]] CaseShares sharesInCases(std::span<const CountedView> views,
                                           std::span<const Placement> sensors) const;
    /// Returns the search of ArrangeOptions::objective; null: coverage.
    [[nodiscard]] const ObjectiveSearch* objective() const { return objective_.get(); }
    /// Returns true if the search maximises the worst case; its values are those of worstCase().
    [[nodiscard]] bool isWorstCase() const {
        const LayoutCases* const cases = options_.cases.get();
        return cases != nullptr && cases->isWorst() && cases->failures() != 0;
    }

    /// Converts a value of the search to a share of the total weight. Weights of several rooms are
    /// areas rounded down to whole numbers, so that the share is at most rounding() too small.
    [[nodiscard]] double share(std::uint64_t value) const;
    [[nodiscard]] double rounding() const { return rounding_; }
    /// Returns an upper bound of the share for a bound of the value.
    [[nodiscard]] double shareBound(std::uint64_t bound) const {
        return std::min(1.0, share(bound) + rounding_);
    }
    /// Returns the share of the weight that these views and standing sensors cover, unrounded.
    [[nodiscard]] double shareOf(std::span<const CountedView> views) const;
    /// Returns that of chosen candidates, of which the search says this value.
    [[nodiscard]] double shareOf(const std::vector<Choice>& chosen, std::uint64_t value) const;
    /// Returns the smallest value that is at least this share, up to rounding().
    [[nodiscard]] std::uint64_t valueFor(double share) const;
    /// Returns the weights of the cells that standing sensors leave uncovered; 0 for the others.
    [[nodiscard]] std::vector<std::uint32_t> weightsLeft() const;

    [[nodiscard]] Pose3 poseOf(const Choice& choice) const {
        return sets_[choice.kind]->pose(choice.candidate);
    }
    [[nodiscard]] std::size_t roomOf(const Choice& choice) const {
        return sets_[choice.kind]->roomOf(choice.candidate);
    }
    /// Returns the position of a candidate in the site.
    [[nodiscard]] Point3 positionOf(const Choice& choice) const;
    /// Returns the sensors at the poses of the chosen candidates.
    [[nodiscard]] std::vector<Placement> placementsOf(const std::vector<Choice>& chosen) const;
    /// Computes the cells of the search's grid that each sensor sees, anew and not from candidates:
    /// the poses may be any. Deterministic for any number of threads.
    [[nodiscard]] std::vector<CountedView> viewsOf(std::span<const SiteSensor> sensors) const;
    [[nodiscard]] std::vector<CountedView> viewsOf(std::span<const Placement> placements) const;
    /// As valueOf() of the sensors with these views.
    [[nodiscard]] std::uint64_t valueOf(std::span<const CountedView> views) const;
    /// Returns the cells of weight that these views and standing sensors serve as often as
    /// required.
    [[nodiscard]] CellSet servedBy(std::span<const CountedView> views) const;
    /// Returns true if these views and the standing coverage, which counts as one part, are
    /// connected, see Problem::is_connected. O(views * cells)
    [[nodiscard]] bool isConnected(std::span<const CountedView> views) const;
    /// Spreads choices that add no value.
    /// \pre the choices have a value: else they may be some of the many that the required
    /// multiplicity takes
    void spreadRedundant(std::vector<Choice>& chosen) const;
    /// Returns every candidate with the share of the total weight that it would add to the standing
    /// coverage and, for a laser, its slice area (eq. 4.4) by the thesis' scan of the pose.
    [[nodiscard]] std::vector<TriedPose> triedPoses(const std::vector<Choice>& chosen);
    /// Orders chosen sensors, the one that adds most to those before it first, and returns the gain
    /// of the candidates for each of them. O(sensors * runs of all candidates) time, and a pose for
    /// each candidate and sensor in memory.
    [[nodiscard]] std::vector<GainMap> gainMaps(std::vector<Choice> chosen) const;
    /// Returns an upper bound of the value of these numbers of sensors at any poses; `most` by
    /// kind.
    [[nodiscard]] std::uint64_t maxFromAnyPlace(const std::vector<int>& most) const;

  private:
    /// Cells of a room's model, which follow each other in the problem, too.
    struct Copy {
        CellBlock own;
        std::size_t first = 0;  ///< in the problem
    };
    /// A room of the site. Its cells stand in the problem several times if sensors may fail; those
    /// of cases lie apart.
    struct Room {
        std::shared_ptr<RoomModel> model;  ///< null: left out; equal rooms share it
        std::vector<Copy> copies = {{}};
        std::size_t cells = 0;
        std::vector<bool> seen = {};  ///< other rooms of which its candidates see cells
    };
    /// The cells of another room that the candidates of a site see.
    struct CellsBeyond {
        std::size_t room = 0, in = 0;  ///< in: the case
        CellParts parts;               ///< by candidate
    };
    class Joiner;

    void mustBeAffordable() const;
    void setUnits();
    void addRooms();
    /// Lets each element of a demand need as many sensors as it says.
    void setNeeds();
    void setAreas(std::vector<double> areas);
    /// Adds the floor that standing sensors see in other rooms in a case.
    void countStandingBeyond(std::size_t number, std::span<const SiteSensor> standing);
    [[nodiscard]] std::string nothingText() const;
    /// Sets the cells of all cases, and their weights.
    void stackCases();
    void stackRooms();
    void stackFailures();
    void addKinds(Progress& progress);
    /// Sets the regions in which coverage is to be connected: parts().
    void addRegions();
    [[nodiscard]] std::unique_ptr<PosedCandidates> candidatesOf(const SensorClass& kind,
                                                                Progress& progress);
    /// Returns true if the cells of the problem are those of one room's model.
    [[nodiscard]] bool hasCellsOfRoom() const {
        return rooms_.size() == 1 && site_.sight == nullptr &&
               rooms_.front().copies.size() <= viewCases();
    }
    /// Returns true if sensors of one room may count in others.
    [[nodiscard]] bool joinsRooms() const;
    /// Returns true if sensors of a kind may stand in a room.
    [[nodiscard]] bool mayStand(const SensorClass& kind, std::size_t room) const;
    /// Returns the number of cases in which sensors see different cells, else 1.
    [[nodiscard]] std::size_t viewCases() const { return std::max<std::size_t>(1, view_cases_); }
    /// Returns a sensor as it is mounted in a case.
    [[nodiscard]] Sensor mountedIn(std::size_t number, std::size_t room, Sensor sensor) const;
    [[nodiscard]] const RoomSight& sightIn(std::size_t number) const {
        return case_sights_.empty() ? *site_.sight : *case_sights_[number];
    }
    [[nodiscard]] const Grid& gridIn(std::size_t number, std::size_t room) const {
        const RoomModel& model = *rooms_[room].model;
        return view_cases_ == 0 ? model.target().grid : model.cases()[number]->target.grid;
    }
    /// Returns where the cells of a room in a case stand.
    [[nodiscard]] std::span<const Copy> copiesIn(std::size_t number, std::size_t room) const {
        const std::vector<Copy>& all = rooms_[room].copies;
        return view_cases_ == 0 ? std::span(all) : std::span(&all[number], 1);
    }
    [[nodiscard]] bool sees(const RoomSight& sight, std::size_t from, const Sensor& sensor,
                            std::size_t to) const;
    [[nodiscard]] TriedPose tried(const std::string& sensor, const Choice& choice,
                                  double value) const;
    /// Adds the cells of other rooms that a sensor sees in a case, with all copies of them.
    void addBeyond(std::size_t number, std::size_t room, const Sensor& sensor,
                   CellSet& cells) const;
    /// Returns the sensors that stand in a case, limited to the floor that they cover.
    [[nodiscard]] std::vector<SiteSensor> standingIn(const SiteCase& site) const;
    /// Returns true if the cases are sites.
    [[nodiscard]] bool hasSites() const { return options_.cases && !options_.cases->failures(); }

    const ArrangeSite& site_;
    const std::vector<SensorGroup>& groups_;
    const ArrangeOptions& options_;
    std::vector<SensorClass> kinds_;
    int unit_ = 1;  ///< multiplicity of sensors other than receivers
    std::vector<Room> rooms_;
    WorstCaseProblem cases_;
    std::size_t view_cases_ = 0;  ///< cases in which views differ; 0 without
    std::vector<std::shared_ptr<const RoomSight>> case_sights_;
    std::vector<std::string> standing_ids_;  ///< of cases_.standing
    Problem problem_;
    std::uint64_t total_ = 0;
    std::vector<double> areas_;  ///< weights of the cells of several rooms, not rounded
    double rounding_ = 0;        ///< share
    std::unique_ptr<const ObjectiveSearch> objective_;
    std::vector<std::unique_ptr<PosedCandidates>> sets_;
    bool is_complete_ = true;
};

/// Returns an upper bound of the cells of the grid that one such sensor sees of a level plane, in
/// any pose: the area within d, half a cell's diagonal, of a region that contains its view, over
/// the area of a cell. For a connected part of the plane with area A and outline L that is at most
/// A + L d + pi d^2 (Steiner's formula). A and L are bounded by those
/// - of its sector for a laser that does not sweep; a tilted or rolled laser covers no more, as its
///   sector is seen from above, which lengthens no line and enlarges no area;
/// - of the disc of its range for swept lasers, receivers and spherical rangers: all points they
///   see of a plane lie within range;
/// - for pinholes of any plane section of the view pyramid down to the depth of the range, and of
///   the disc through the farthest point in view, which for depth sensors is a corner of the
///   picture, beyond the range. The area of a section is the root of the sum of squares of the
///   areas of its three projections, here at most the rectangle and two triangles of the pyramid;
///   its outline, as of any convex figure, is at most pi times its diameter.
std::uint64_t maxCellsInView(const SensorModel& device, const Grid& grid);

/// Returns an upper bound of the value of sensors at any poses: the standing coverage and the
/// heaviest other cells, as many as these sensors can see together. `in_view` holds the maximum
/// number of cells that a sensor of each kind of the problem sees, `most` the maximum number of
/// sensors; with a budget, those with the most cells per cost count first, the last one in part.
std::uint64_t maxFromAnyPlace(const Problem& problem, std::span<const std::uint64_t> in_view,
                              std::span<const int> most);

class CoverageModel;
struct CountedView;

/// Finds choices that can all be left out without loss of value or of connection, ascending; later
/// choices are dropped first. O(choices * cells / 64 + runs)
std::vector<std::size_t> idleChoices(const Problem& problem, std::span<const Choice> chosen);

/// The same for the views of placed sensors; returns their indices.
std::vector<std::size_t> idleViews(const CoverageModel& model, std::span<const CountedView> views);

/// Spreads idle choices: moves each in turn to the site farthest from all other sensors, among
/// those that see any weight, with the heading that sees most of the rarely seen cells. Connected
/// coverage stays connected. `standing`: positions of standing sensors.
void spreadRedundant(const Problem& problem, std::span<const Point3> standing,
                     const std::function<Point3(const Choice&)>& position_of,
                     std::vector<Choice>& chosen);

}  // namespace ispace

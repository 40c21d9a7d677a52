// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/arrange: generates candidates and searches for arrangements. Uses coverage, trace and
// below; TBB and CGAL inside.
//
// Arranging takes four steps. A strategy proposes sites, each with headings (strategy.h), and rules
// reject some of them (placement_rules.h). The cells that a sensor sees from each remaining pose
// are computed once (candidate.h). Their choice is a weighted coverage problem without geometry
// (search/search.h), to which coverage_model.h maps rooms and sensors. On request sensors then
// leave their candidates (refine.h).
//
// Guarantees. `coverage` and `area` of a result are those that `coverage` prints for the written
// layout, on its grid, with the same plane and pixel density. No layout of the same candidates has
// a value above `bound`, for as many sensors or the same budget; poses between candidates may,
// unless refining moved sensors or a Prover found a bound over all poses. The result depends on
// input, options and seed alone, for any number of threads and shards, unless progress says stop:
// then it is the best layout so far, and `is_complete` is false.
//
// Costs. The views of candidates take most of the time and memory: sites * headings views, 4 bytes
// for a run of cells. Candidates and the tree of Exact share options.max_bytes.
//
// Metres; poses are in the frame of their room.
//
//     const std::vector<SensorGroup> groups = groupsToPlace(scene, specs, devices, false);
//     ArrangeOptions options;                  // as arrange(1) without options
//     options.target = 0.95;                   // fewest sensors that see 95 % of the floor
//     const Arrangement found = arrange(scene, groups, options, progress);
//     if (found.is_reached) write(layoutDocument(parts, nullptr, groups, found));
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "arrange/demand.h"
#include "arrange/layout_cases.h"
#include "arrange/layout_objective.h"
#include "arrange/placement_rules.h"
#include "arrange/prover.h"
#include "arrange/search/search.h"
#include "arrange/sensor_group.h"
#include "arrange/site.h"
#include "arrange/tried_pose.h"
#include "base/cell_set.h"
#include "base/error.h"
#include "base/message.h"
#include "coverage/target.h"
#include "scene/scene.h"

namespace ispace {

/// How candidate sites are proposed; each strategy is a row in arrange/strategy.cc.
enum class Strategy {
    Grid,    ///< the thesis' Ordinary Grid
    Random,  ///< its Hierarchical Random
    Wall,    ///< its Along Wall
    Medial,  ///< the medial axis of the free floor
    List,    ///< the sites of a list
    All,     ///< a lattice, and along all walls and objects on the floor
};
/// Returns the word of the command line and of results.
std::string_view nameOf(Strategy strategy);
/// Returns true for Ordinary Grid, Hierarchical Random and Along Wall.
bool isOfThesis(Strategy strategy);

/// Surface or structure that carries a sensor.
enum class MountOn { Floor, Wall, Frame, Ceiling };
constexpr MountOn kMounts[] = {MountOn::Floor, MountOn::Wall, MountOn::Frame, MountOn::Ceiling};
std::string_view nameOf(MountOn mount);

/// Density of the candidates of Strategy::All, of the medial axis and of frames.
struct CandidateDensity {
    double lattice_step = 0.25, wall_step = 0.25;  ///< metres
    int headings = 16;
};

/// Distance of candidates along walls from the wall, metres.
constexpr double kOffWall = 0.02;
/// Distance of a ceiling mount from the ceiling, metres.
constexpr double kBelowCeiling = 0.05;
/// Height at which overhead kinds hang on walls, metres; less in lower rooms.
constexpr double kOnWall = 2.4, kBelowWallTop = 0.1;

/// Heights, tilts and floor of the sensors to be placed. Lengths are metres.
struct MountRules {
    /// Empty: the ceiling for overhead kinds (walls with Strategy::Wall), the floor for all others.
    std::optional<MountOn> on = {};
    std::vector<double> heights = {};  ///< to choose from; empty: the defaults of the mount
    /// Choices for sensors without a given tilt; empty: the defaults of the mount.
    std::vector<Angle> tilts = {};
    double clearance = 0;  ///< least distance from walls and objects, see SiteRules
    std::vector<NamedZone> keep_out = {}, keep_in = {};
    std::vector<Pose3> forbidden = {};  ///< candidates that are left out
};

struct Arrangement;

/// A search, apart from rooms and sensors. The defaults are those of arrange(1).
struct ArrangeOptions {
    Strategy strategy = Strategy::All;
    std::optional<int> x, y;      ///< Grid: interior lines; default by eq. (4.1) and (4.2)
    std::optional<int> headings;  ///< directions per site; 8, or those of `density`
    int first_places = 20, more_places = 5;  ///< Random: R1 and R2
    std::optional<double> scope;             ///< Random: of R2; default max range / seg
    double dist = 0.05;                      ///< Wall: from the wall
    int times = 21;                          ///< Wall: sites per wall
    CandidateDensity density;
    std::vector<Site> list;  ///< List, of a room alone
    MountRules mount;

    SearchOptions search;
    bool refine = false;  ///< see mustBeRefinable() for sensors that cannot be refined
    FloorWeights weights;
    int redundancy = 1;  ///< a cell is covered if this many sensors see it
    bool is_connected = false;
    std::shared_ptr<const LayoutCases> cases;          ///< null: the site as it is, alone
    std::shared_ptr<const LayoutObjective> objective;  ///< null: coverage
    std::vector<UnseenFloor> unseen;
    MakeCoverRule cover_rule;  ///< empty: each sensor covers the cells that it sees
    /// Returns poses of a layout that must not stand, such as those of cameras that see unseen
    /// floor between the centres of cells: the search is repeated without these candidates until
    /// there are none. Empty: all may stand. \param found a layout of the site
    std::function<std::vector<RoomPose>(const ArrangeSite& site, const std::vector<SensorGroup>&,
                                        const Arrangement& found)>
        rejected;
    /// Counts instead of the floor; the zones, weights and cells above then do not. Null: none.
    /// Of several rooms: that of any of them, which says what is asked; see RoomGoals.
    std::shared_ptr<const Demand> demand;
    std::optional<double> target;  ///< share to reach at minimum cost
    /// Proves over more poses than the candidates; null: the bound of the search is enough.
    std::shared_ptr<const Prover> prover;
    std::optional<double> budget;  ///< limit of the sum of costs
    bool wants_curve = false, wants_trace = false, wants_gains = false;
    int alternatives = 0;  ///< number of further layouts, see Arrangement::alternatives

    double plane = 0;                 ///< height at which all sensors but level lasers cover
    double pixel_density = 0;         ///< least pixels per metre where a camera covers; 0: no limit
    std::optional<CellChoice> cells;  ///< during the search, see searchCells()
    std::size_t max_bytes = std::size_t{8} << 30U;  ///< of candidates and of the tree of Exact
    /// During the search, a laser in a slice covers the contour of beams with this step, the
    /// thesis' "reso"; 0: the laser's step. Empty: its whole visible area.
    std::optional<Angle> beam_step;
    /// The thesis' Insider Judge: sensors stand indoors, and only the indoor floor counts. Without
    /// it, sensors may stand anywhere in the rectangle around the room, all of which counts (fig.
    /// 4.8).
    bool indoor_only = true;
    /// Looks only at floor that standing sensors leave uncovered, which is faster. A sensor without
    /// a gain then stands anywhere, and connections are not known.
    bool is_for_gain_alone = false;
    std::uint64_t seed = 0;  ///< of random sites, and of starts of swaps
};

/// Returns true if each sensor has separate candidates, and so forms a separate kind: Hierarchical
/// Random draws candidates per sensor, unless the search finds the number of sensors.
bool drawsForEach(const ArrangeOptions& options);

/// Returns the cells of the search: options.cells if set; 100 x 100 with the thesis' strategies;
/// else those of a report, but fewer in a large room to keep the search fast.
CellChoice searchCells(const ArrangeOptions& options);

/// The coverage of a number of sensors.
struct CurvePoint {
    int sensors = 0;
    double value = 0;  ///< share covered by the best layout found
    double bound = 1;  ///< upper bound for layouts of these candidates
};

/// The gain of the candidates of one sensor of a layout.
struct GainMap {
    std::string sensor;                  ///< its id, across the site
    std::vector<Placement> before = {};  ///< sensors that are placed already
    /// The candidates of its kind, each with the share of the total weight that it would add to
    /// those, and to the standing sensors.
    std::vector<TriedPose> poses = {};
};

/// Sensors of one model nearer than both count as the same in alternatives.
constexpr double kApart = 1;  ///< metres
constexpr Angle kTurnedApart = Angle::degrees(30);

/// Poses of the sensors and their coverage.
struct Arrangement {
    std::vector<Placement> sensors;  ///< by group
    double coverage = 0;             ///< as `coverage` reports coverage.grid for the whole layout
    double area = 0;                 ///< total effective area by cells, m2, eq. (4.6)
    /// Share of the total weight; empty if it equals the coverage.
    std::optional<double> value;
    bool is_value_by_cells = false;  ///< value and coverage differ by the cells of the search alone
    /// Upper bound of `value` (or coverage) over all choices of the search or, if refining moved
    /// sensors off their candidates, over these sensors at any poses.
    double bound = 1;
    double candidate_value = 0, candidate_bound = 1;  ///< before refining
    double rounding = 0;                              ///< in the bound: a gap up to this is none
    bool is_refined = false;                          ///< refining was asked for
    std::size_t candidates = 0, bytes = 0;            ///< of all kinds
    Grid grid;                                        ///< the cells while searching one room
    std::size_t cells = 0;                            ///< number of those of all rooms
    CellSet served = CellSet();  ///< elements of ArrangeOptions::demand, if any
    bool is_complete = true;     ///< false: cut by time or a signal

    /// Number of sensors left unplaced, for lack of candidates or of candidates that keep coverage
    /// connected.
    std::size_t unplaced = 0;
    double cost = 0;         ///< of the placed sensors
    bool has_costs = false;  ///< costs differ from 1
    /// With a target: whether it is reached, and a lower bound of the cost of reaching it.
    bool is_reached = true;
    std::optional<double> least;
    bool is_exhausted = false;  ///< even all candidates together do not reach the target
    /// With a target of the whole floor: the exact area covered, as a share of the indoor area;
    /// empty if no closed form is known. Less than 100 % misses that target, though all cells are
    /// covered; other targets count cells.
    std::optional<double> exact_share;
    std::optional<double> free_share;    ///< with it: the free floor, as a share of the indoor area
    std::shared_ptr<const Proof> proof;  ///< of ArrangeOptions::prover

    /// With ArrangeOptions::objective `value` is a share of this much, in a unit of its own.
    std::optional<double> whole;

    /// With ArrangeOptions::cases, of the written poses; the bound is that of the worst case, or of
    /// the mean.
    std::optional<CaseShares> cases;

    /// Ids of sensors, across the site, that can all be removed without loss of value.
    std::vector<std::string> idle;

    /// A room of several.
    struct InRoom {
        std::string id;
        std::size_t sensors = 0;  ///< placed here
        double coverage = 0;      ///< share of its floor
        bool has_floor = true;    ///< false: all of it is open, and it is left out
    };
    std::vector<InRoom> rooms;  ///< empty for a room alone

    std::vector<CurvePoint> curve;
    std::vector<TriedPose> tried;
    /// One for each sensor, on its candidate, in the order of greedy search among the sensors.
    std::vector<GainMap> gains;
    /// Further layouts of candidates, the best first, each without a sensor within kApart and
    /// kTurnedApart of some sensor of every layout before it. `bound` is that of all layouts.
    std::vector<Arrangement> alternatives;
    /// Exact weighted area, m2. Equal if refining found no improvement: all sensors then stand on
    /// candidates.
    double refined_before = 0, refined_after = 0;
};

/// Adds the groups' sensors to those that stand in the rooms of a site already. Rooms that do not
/// see each other are searched apart where that is exact, see searchParts(); else the cells of all
/// rooms are one problem. Counts, budget, target and required multiplicities are those of the site.
///
/// Builds candidates by options.strategy for each kind of sensor, weighs the target's cells by
/// options.weights, then runs search() or minimumCostCover(), and refine() if asked. `mps`:
/// receives the model before the search. A shard (options.search.share) stores its steps in
/// the job results and returns an arrangement without sensors.
/// What the options ask of a room (weights, zones, rules of views) is taken from its goals; those
/// of the options say whether it is asked of any room.
///
/// A target that is not reached is a result (is_reached), not an error. If options.rejected names
/// sensors of a layout, the search is repeated without their candidates, up to 100 times. Sensors
/// without gain stand apart from the others; their ids are in `idle`.
///
/// Once progress says stop, candidates are still made for some sites, within about 0.4 s, so that
/// most interrupted searches return a layout.
/// \throws UnmetError if a kind has no valid site, all floor weighs 0 or the budget buys no sensor,
///         UsageError if the candidates do not fit in memory, for sensors that cannot be refined,
///         or for options that need one room; FormatError naming stored results that are cut off
Arrangement arrange(const ArrangeSite& site, const std::vector<SensorGroup>& groups,
                    const ArrangeOptions& options, Progress& progress, std::ostream* mps = nullptr);
/// As above, for a room alone: siteOf() of it.
Arrangement arrange(const Scene& scene, const std::vector<SensorGroup>& groups,
                    const ArrangeOptions& options, Progress& progress, std::ostream* mps = nullptr);

/// Returns the site of a room alone, with what the options ask of it. Stores the reference.
ArrangeSite siteOf(const Scene& scene, const ArrangeOptions& options);

/// Returns the option that needs one room, "--proof art"; "" if all of these hold for several.
std::string needsOneRoom(const ArrangeOptions& options);

/// Contents of a layout besides the arrangement.
struct LayoutParts {
    History history;
    std::string environment_file;  ///< "" if unnamed
    std::string environment_digest;
    std::string strategy, optimize;
    std::string objective = {};  ///< "" for coverage
    /// Returns a record of a room, with this id, as it stands in the layout; empty: as it is.
    std::function<Record(std::size_t room, Record record, const std::string& id)> whole = {};
};

/// Builds a `.3dm`: the `environment` record, the records of `before` (if any) with its pending
/// sensors placed, the new sensors, the `result`. The record of a pending sensor stays where it
/// stands in the file, so that a diff of both layouts shows poses and the result alone. Figures of
/// the result are rounded, poses are exact.
Document layoutDocument(const LayoutParts& parts, const Document* before,
                        const std::vector<SensorGroup>& groups, const Arrangement& arrangement);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// lib/arrange: candidates and arranging. Uses cover, solve and below; TBB and CGAL inside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

#include "arrange/placement_rules.h"
#include "arrange/search/search.h"
#include "arrange/sensor_group.h"
#include "arrange/tried_pose.h"
#include "base/error.h"
#include "base/message.h"
#include "coverage/target.h"
#include "scene/scene.h"

namespace ispace {

/// How places are proposed; each strategy is a row in arrange/strategy.h.
enum class Strategy {
    Grid,    ///< the thesis' Ordinary Grid
    Random,  ///< its Hierarchical Random
    Wall,    ///< its Along Wall
    Medial,  ///< the medial axis of the free floor
    List,    ///< the places of a list
    All,     ///< a lattice, and along everything that stands on the floor
};
/// The words of the command line and of results.
std::string_view nameOf(Strategy strategy);
/// True for Ordinary Grid, Hierarchical Random and Along Wall.
bool isOfThesis(Strategy strategy);

/// What a sensor is mounted on.
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
/// Where kinds that hang overhead hang on walls, metres; less in lower rooms.
constexpr double kOnWall = 2.4, kBelowWallTop = 0.1;

struct MountRules {
    /// Nothing: the ceiling for kinds that hang overhead (with Strategy::Wall walls), the floor for
    /// all others.
    std::optional<MountOn> on = {};
    std::vector<double> heights = {};  ///< to choose from; empty: those of the mount
    /// To choose from, for sensors without a tilt of their own; empty: those of the mount.
    std::vector<Angle> tilts = {};
    double clearance = 0;
    std::vector<NamedZone> keep_out = {}, keep_in = {};
};

struct ArrangeOptions {
    Strategy strategy = Strategy::All;
    std::optional<int> x, y;      ///< Grid: interior lines; default by eq. (4.1) and (4.2)
    std::optional<int> headings;  ///< directions a place; 8, or those of `density`
    int first_places = 20, more_places = 5;  ///< Random: R1 and R2
    std::optional<double> scope;             ///< Random: of R2; default max range / seg
    double dist = 0.05;                      ///< Wall: from the wall
    int times = 21;                          ///< Wall: places a wall
    CandidateDensity density;
    std::vector<Site> list;  ///< List
    MountRules mount;

    SearchOptions search;
    bool refine = false;
    FloorWeights weights;
    int redundancy = 1;  ///< a cell is covered if this many sensors see it
    bool is_connected = false;
    std::optional<double> target;  ///< share to reach at minimum cost
    std::optional<double> budget;
    bool wants_curve = false, wants_trace = false;

    double plane = 0;          ///< height of what rangers, cameras and receivers cover
    double pixel_density = 0;  ///< cameras cover where they have so many pixels a metre; 0: all
    std::optional<CellChoice> cells;                ///< while searching, see searchCells()
    std::size_t max_bytes = std::size_t{8} << 30U;  ///< of candidates and of the tree of Exact
    /// While searching, a laser in a slice sees what lies within the contour of beams so far apart,
    /// the thesis' "reso"; 0: its own. None: all that is in its view.
    std::optional<Angle> beam_step;
    /// The thesis' Insider Judge: sensors stand indoors, and indoor floor counts. Without it the
    /// whole rectangle about the room is open to sensors and counts (fig. 4.8).
    bool judges_inside = true;
    std::uint64_t seed = 0;
};

/// True if each sensor has candidates of its own: Hierarchical Random draws anew for each, unless
/// the search finds their number. Each sensor is then a kind of its own.
bool drawsForEach(const ArrangeOptions& options);

/// Cells while searching: options.cells if set; with the thesis' strategies its 100 x 100; else
/// those of the room, but in a large room fewer than a report has, to keep the search quick.
CellChoice searchCells(const ArrangeOptions& options);

/// The coverage of a number of sensors.
struct CurvePoint {
    int sensors = 0;
    double value = 0;  ///< share covered by the best layout found
    double bound = 1;  ///< no layout of these candidates covers more
};

/// The sensors at their places, and what they cover.
struct Arrangement {
    std::vector<Placement> sensors;  ///< by group
    double coverage = 0;             ///< as `coverage` reports coverage.grid for the whole layout
    double area = 0;                 ///< total effective area by cells, m2, eq. (4.6)
    /// Share of the total weight; not set where it equals the coverage.
    std::optional<double> value;
    /// Upper bound of `value` (or coverage) over all that the search could choose or, if refining
    /// moved sensors off their candidates, over these sensors at any places.
    double bound = 1;
    double candidate_value = 0, candidate_bound = 1;  ///< before refining
    bool is_refined = false;                          ///< refining was asked for
    std::size_t candidates = 0, bytes = 0;            ///< of all kinds
    Grid grid;                                        ///< the cells while searching
    bool is_complete = true;                          ///< false: cut by time or a signal

    /// Sensors left unplaced, for lack of candidates or of candidates that keep coverage connected.
    std::size_t unplaced = 0;
    double cost = 0;         ///< of the sensors placed
    bool has_costs = false;  ///< they differ from 1
    /// With a target: whether it is reached, and a lower bound of the cost of reaching it.
    bool is_reached = true;
    std::optional<double> least;
    bool is_exhausted = false;  ///< not reached, not even by all candidates together

    /// Ids of sensors that, all together, add nothing to the others' value.
    std::vector<std::string> idle;

    std::vector<CurvePoint> curve;
    std::vector<TriedPose> tried;
    /// Exact weighted area, m2; equal if refining found nothing better: then all stand on
    /// candidates.
    double refined_before = 0, refined_after = 0;
};

/// Places the groups' sensors beside those that the scene has placed already.
///
/// Makes candidates by options.strategy for each kind of sensor, weighs the target's cells by
/// options.weights, then runs search() or minimumCostCover(), and refine() if asked. `mps`:
/// receives the model before the search. A shard (options.search.share) stores its steps and
/// returns an arrangement without sensors. \throws UnmetError if a kind has no valid
/// place or nothing may be bought, UsageError if the candidates do not fit in memory
Arrangement arrange(const Scene& scene, const std::vector<SensorGroup>& groups,
                    const ArrangeOptions& options, Progress& progress, std::ostream* mps = nullptr);

/// What goes into a layout besides the arrangement.
struct LayoutParts {
    History history;
    std::string environment_file;  ///< "" if there is none to name
    std::string environment_digest;
    std::string strategy, optimize;
};

/// A `.3dm`: the `environment` record, the records of `before` (if any) with its pending sensors
/// placed, the new sensors, the `result`.
Document layoutDocument(const LayoutParts& parts, const Document* before,
                        const std::vector<SensorGroup>& groups, const Arrangement& arrangement);

}  // namespace ispace

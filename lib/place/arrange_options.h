// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cover/target.h"
#include "place/sites.h"
#include "solve/search.h"

namespace ispace {

/// How places are proposed; each has its row in place/strategy.h.
enum class Strategy {
    Grid,    ///< the thesis' Ordinary Grid
    Random,  ///< its Hierarchical Random
    Wall,    ///< its Along Wall
    Medial,  ///< the medial axis of the free floor
    List,    ///< places that somebody gives
    All,     ///< a lattice, and along everything that stands
};
constexpr Optimizer kOptimizers[] = {Optimizer::Greedy, Optimizer::Swap, Optimizer::Exact};
/// The words of the command line and of results.
std::string_view nameOf(Strategy strategy);
std::string_view nameOf(Optimizer optimizer);
/// True for Ordinary Grid, Hierarchical Random and Along Wall.
bool isOfThesis(Strategy strategy);

/// What a sensor is fixed to.
enum class MountOn { Floor, Wall, Frame, Ceiling };
constexpr MountOn kMounts[] = {MountOn::Floor, MountOn::Wall, MountOn::Frame, MountOn::Ceiling};
std::string_view nameOf(MountOn mount);

/// Density of the candidates of Strategy::All, of the medial axis and of frames.
struct CandidateDensity {
    double lattice_step = 0.25, wall_step = 0.25;  ///< metres
    int headings = 16;
};

/// How far candidates along walls keep from them, metres.
constexpr double kOffWall = 0.02;
/// How far below the ceiling a sensor hangs.
constexpr double kBelowCeiling = 0.05;

struct MountRules {
    MountOn on = MountOn::Floor;
    std::vector<double> heights =
        {};                         ///< to choose from; none: kScanHeight, or as the mount has it
    std::vector<Angle> tilts = {};  ///< to choose from, where the sensor does not say
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
    FloorWeights worth;
    int redundancy = 1;  ///< floor counts if so many sensors see it
    bool is_connected = false;
    std::optional<double> target;  ///< share that is to be reached with the fewest sensors
    std::optional<double> budget;
    bool wants_curve = false, wants_trace = false;

    double plane = 0;                                ///< height of what rangers and receivers cover
    std::optional<CellChoice> cells;                 ///< while searching; see searchCells()
    std::size_t most_bytes = std::size_t{8} << 30U;  ///< of candidates and of the tree of Exact
    std::uint64_t seed = 0;
};

/// Cells while searching: those asked for; with the thesis' strategies its 100 x 100; else those of
/// the room, in a large one fewer than a report has, so that a search stays quick.
CellChoice searchCells(const ArrangeOptions& options);

}  // namespace ispace

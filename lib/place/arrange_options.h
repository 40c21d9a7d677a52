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

/// How places are proposed; each strategy is a row in place/strategy.h.
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

}  // namespace ispace

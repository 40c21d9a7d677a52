// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cover/grid.h"
#include "layout/scene.h"
#include "trace/worlds.h"

namespace ispace {

/// What is to be covered: the cells of a grid over the limits.
struct Target {
    Grid grid;
    double height = kScanHeight;  ///< at which free floor is judged
    CellSet indoor;               ///< centre strictly inside the indoor region
    CellSet free;                 ///< indoor and not in a solid at `height`
};
/// Most cells of a grid.
constexpr int kMostCells = 10'000'000;
/// \throws UsageError unless columns and rows are at least 1 and make at most kMostCells
Target makeTarget(const Environment& environment, int columns, int rows, double height);

/// A figure by cells and in closed form; one that is not computed is empty (null in JSON).
struct Figure {
    std::optional<double> grid, exact;
};

struct SensorFigures {
    std::string id, model;             ///< model "" for a bare sensor
    double slice_area = 0;             ///< eq. (4.4), m2
    std::optional<double> exact_area;  ///< m2
    double marginal_area = 0;          ///< lost if this sensor is removed, by cells, m2
};

/// The figures of DESIGN's `coverage --json`.
struct CoverageReport {
    std::string digest;
    Box2 limits;
    int columns = 0, rows = 0;
    double height = 0;
    double indoor_area = 0, free_area = 0;  ///< exact, m2
    std::vector<SensorFigures> sensors;
    Figure total_effective_area;     ///< eq. (4.6), m2; all cells, indoor or not
    Figure coverage;                 ///< eq. (4.7), fraction of the indoor cells
    Figure free_coverage;            ///< fraction of the free cells
    std::vector<double> redundancy;  ///< [k]: share of indoor cells seen by exactly k sensors;
                                     ///< all 0 where no cell is indoor
};

/// Report and the cells behind it, for the map.
struct Coverage {
    CoverageReport report;
    Target target;
    std::vector<CellSet> seen;              ///< per sensor
    std::vector<std::vector<float>> beams;  ///< per sensor, as of castBeams
};

/// Measures the placed lasers of a scene. Deterministic for any number of threads.
/// \throws UsageError as makeTarget
Coverage measureCoverage(const Scene& scene, Worlds& worlds, int columns, int rows, double height);

/// By how many of the sets each cell of the grid is held: the redundancy of a cell.
std::vector<std::uint32_t> timesSeen(const Grid& grid, const std::vector<CellSet>& seen);

/// Share of target cells that a union covers: eq. (4.7) on cells; 0 where the target is empty.
double coveredShare(const CellSet& covered, const CellSet& target);

/// One JSON object and a newline, schema ispace-coverage/1.
std::string coverageJson(const CoverageReport& report);
/// The same for people, a few aligned lines.
std::string coverageText(const CoverageReport& report);

}  // namespace ispace

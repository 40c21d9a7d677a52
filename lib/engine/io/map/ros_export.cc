// SPDX-License-Identifier: GPL-3.0-or-later
// A room as a map of cells. Floor is painted by the middles of cells, then every line is checked:
// where it passes between two free middles, the nearer cell is occupied. So walls thinner than a
// cell stay closed for planners that move between side neighbours, and walls thicker than a cell do
// not grow.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/number.h"
#include "drawing/plan/elements.h"
#include "io/exporters.h"
#include "io/map/ros_map_text.h"
#include "raster/grid.h"

namespace ispace {

namespace {

constexpr char kFree = static_cast<char>(254), kOccupied = 0, kUnknown = static_cast<char>(205);
constexpr int kRim = 4;                              ///< cells around the room, unknown or occupied
constexpr double kFinest = 0.001, kCoarsest = 1000;  // as readRosMap() accepts

/// The multiple of `size` at or below `value`, in short decimals: -2.05, not -2.0500000000000003.
double multipleBelow(double value, double size) {
    return std::round(std::floor(value / size) * size * 1e9) / 1e9;
}

/// Returns a resolution of one or two digits, at least `times` coarser.
double coarserResolution(double resolution, double times) {
    const double least = resolution * times;
    const double digit = std::pow(10, std::floor(std::log10(least)) - 1);
    return std::ceil(least / digit) * digit;
}

}  // namespace

Grid rosMapCells(const Box2& box, double resolution) {
    if (!(resolution >= kFinest && resolution <= kCoarsest))
        throw UsageError("a map of " + formatDouble(resolution) +
                         " m a cell cannot be written, wanted " + formatDouble(kFinest) + " to " +
                         formatDouble(kCoarsest));
    const auto [low, high] = box.expanded(kRim * resolution);
    const Point2 origin{multipleBelow(low.x, resolution), multipleBelow(low.y, resolution)};
    const double columns = std::ceil((high.x - origin.x) / resolution);
    const double rows = std::ceil((high.y - origin.y) / resolution);
    const double too_many = std::max(std::max(columns, rows) / kMaxMapSide,
                                     std::sqrt(columns * rows / static_cast<double>(kMaxMapCells)));
    if (too_many > 1)
        throw UsageError("a map of " + formatFixed(columns, 0) + " x " + formatFixed(rows, 0) +
                         " cells cannot be written, at most " + std::to_string(kMaxMapSide) +
                         " each way and " + std::to_string(kMaxMapCells) +
                         " in all: take a resolution of " +
                         formatDouble(coarserResolution(resolution, too_many)) + " m");
    return gridOf(origin, resolution, static_cast<int>(columns), static_cast<int>(rows));
}

namespace {

/// Paints cells directly into the bytes of the picture, top row first.
class MapPainter {
  public:
    explicit MapPainter(const Grid& grid) : grid_(grid) {
        pgm_ = "P5\n" + std::to_string(grid.columns) + ' ' + std::to_string(grid.rows) + "\n255\n";
        header_ = pgm_.size();
        pgm_.resize(
            header_ + static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows),
            kUnknown);
    }

    void addFloor(const Regions& indoor) {
        fill(runsWithin(grid_, curvesOf(indoor)), kFree);
        indoor.forEachEdge([this](const Segment2& edge) { addMiddlesOn(edge); });
    }

    void addSolid(const Polygon& solid) {
        fill(runsWithin(grid_, std::span(&solid, 1)), kOccupied);
        forEachEdge(solid, [this](const Segment2& edge) { addMiddlesOn(edge); });
    }

    /// To be called after all solids: a line without a painted cell occupies the nearer cell.
    void addLine(const Segment2& line) {
        for (const CellPair& pair : crossingsOf(line))
            if (isFree(pair.near_column, pair.near_row) && isFree(pair.far_column, pair.far_row))
                *cell(pair.near_column, pair.near_row) = kOccupied;
    }

    /// Occupies a cell for a body that may lie between the centres of cells.
    void addSmall(const Polygon& body) {
        bool has_cells = false;
        forEachEdge(body, [&](const Segment2& edge) {
            has_cells = has_cells || !crossingsOf(edge).empty();
        });
        const Point2 middle = grid_.toCells(bounds(body).center());
        const auto column = static_cast<std::int64_t>(std::clamp(std::round(middle.x), -1.0, 1e9));
        const auto row = static_cast<std::int64_t>(std::clamp(std::round(middle.y), -1.0, 1e9));
        if (!has_cells && isFree(column, row)) *cell(column, row) = kOccupied;
    }

    /// Unknown cells that touch free ones, at a side or a corner, are occupied.
    void closeRim() {
        for (int row = 0; row < grid_.rows; ++row) {
            const char* const begin = cell(0, row);
            const char* const end = begin + grid_.columns;
            for (const char* at = std::find(begin, end, kFree); at != end;) {
                const char* const stop = std::find_if(at, end, [](char c) { return c != kFree; });
                closeAround(row, static_cast<int>(at - begin), static_cast<int>(stop - begin) - 1);
                at = std::find(stop, end, kFree);
            }
        }
    }

    [[nodiscard]] std::string take() { return std::move(pgm_); }

  private:
    [[nodiscard]] char* cell(std::int64_t column, std::int64_t row) {
        return pgm_.data() + header_ + (grid_.rows - 1 - row) * grid_.columns + column;
    }
    [[nodiscard]] bool isFree(std::int64_t column, std::int64_t row) {
        return column >= 0 && row >= 0 && column < grid_.columns && row < grid_.rows &&
               *cell(column, row) == kFree;
    }

    const std::vector<CellPair>& crossingsOf(const Segment2& segment) {
        crossings_.clear();
        appendCrossings(segment, grid_, crossings_);
        return crossings_;
    }

    void fill(const std::vector<RowRun>& runs, char value) {
        for (const RowRun& run : runs)
            std::fill(cell(run.first, run.row), cell(run.last, run.row) + 1, value);
    }

    void addMiddlesOn(const Segment2& edge) {
        for (const CellPair& pair : crossingsOf(edge))
            if (pair.near_column == pair.far_column && pair.near_row == pair.far_row &&
                isFree(pair.near_column, pair.near_row))
                *cell(pair.near_column, pair.near_row) = kOccupied;
    }

    void closeAround(int row, int first, int last) {
        const int left = std::max(first - 1, 0), right = std::min(last + 1, grid_.columns - 1);
        for (int r = std::max(row - 1, 0); r <= std::min(row + 1, grid_.rows - 1); ++r)
            std::replace(cell(left, r), cell(right, r) + 1, kUnknown, kOccupied);
    }

    const Grid& grid_;
    std::string pgm_;
    std::size_t header_ = 0;
    std::vector<CellPair> crossings_;
};

}  // namespace

ExportedFiles writeRosMap(const Scene& scene, double height, double resolution,
                          const std::string& image_name) {
    const Regions& indoor = scene.environment.indoor();
    const Grid grid = rosMapCells(bounds(indoor), resolution);
    Slice slice = scene.environment.slice(height);
    // Solids circumscribe curves; the inscribed ones occupy no cell beside the curve itself.
    slice.solids = inscribedSolids(slice);
    MapPainter painter(grid);
    painter.addFloor(indoor);
    for (const Polygon& solid : slice.solids) painter.addSolid(solid);
    slice.forEachLine([&](const Segment2& line) { painter.addLine(line); });
    indoor.forEachEdge([&](const Segment2& edge) { painter.addLine(edge); });
    for (const Polygon& solid : slice.solids) painter.addSmall(solid);
    for (const Region& part : indoor.parts)
        for (const Polygon& hole : part.holes) painter.addSmall(hole);
    painter.closeRim();

    ExportedFiles files;
    files.product =
        rosMapYaml({.image = image_name, .resolution = resolution, .origin = grid.limits.low});
    files.beside = painter.take();
    return files;
}

}  // namespace ispace

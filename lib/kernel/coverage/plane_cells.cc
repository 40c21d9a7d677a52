// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of a plane by rays. A cell gets a ray if its centre is in some view, which is decided for
// blocks of 8 x 8 cells at once, halved where a view is unsure, or by the table of turned views.
// Rays of several rows are cast together, as packets need many; bands of rows run in parallel, and
// each view's runs are joined in the order of the bands.
#include "coverage/plane_cells.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "coverage/held_views.h"
#include "sense/scan.h"

namespace ispace {

namespace {

/// The part of a plane that may be in view.
struct Reach {
    Point3 origin;
    double distance = 0;  ///< maximum distance of a point in view, on the plan

    /// Empty if the plane, `drop` above or below, is out of range.
    static std::optional<Reach> of(Point3 origin, double range, double drop) {
        constexpr double kSlack = 1 + 1e-6;  // ranges are compared as float32
        if (!withinRange(std::fabs(drop), range)) return std::nullopt;
        return Reach{origin, kSlack * std::sqrt(std::max(0.0, range * range - drop * drop))};
    }
    /// Returns the part of the window that is in reach.
    [[nodiscard]] CellWindow within(const Grid& grid, CellWindow window) const {
        const auto limit = [this](const GridAxis& axis, double middle, int& first, int& end) {
            const int in_reach = axis.firstNotBelow(middle - distance);
            first = std::max(first, in_reach);
            end = std::min(end, axis.firstAbove(middle + distance, in_reach));
        };
        limit(GridAxis::rowsOf(grid), origin.y, window.first_row, window.end_row);
        limit(GridAxis::columnsOf(grid), origin.x, window.first_column, window.end_column);
        return window;
    }
};

/// The target of a cell's ray, and the views that contain it.
struct CellTarget {
    Point3 place;
    std::uint64_t held = 0;  ///< bit k: in view k
};

/// Runs of cells that each view sees, from seen cells in ascending order.
class RunsByView {
  public:
    /// \param counted runs go on over cells that do not count; null: all count
    RunsByView(std::size_t views, const CountedCells* counted) : runs_(views), counted_(counted) {}

    /// Adds a cell to the runs of these views.
    void add(std::uint32_t cell, std::uint64_t views) {
        if ((counted_ != nullptr ? counted_->next(end_) : end_) != cell) close(open_);
        close(open_ & ~views);
        for (std::uint64_t bits = views & ~open_; bits != 0; bits &= bits - 1)
            runs_[static_cast<std::size_t>(std::countr_zero(bits))].push_back({cell, cell});
        open_ = views;
        end_ = cell + 1;
    }
    /// Ends all runs and returns those of a view.
    const std::vector<CellRun>& of(std::size_t view) {
        close(open_);
        return runs_[view];
    }

  private:
    void close(std::uint64_t views) {
        open_ &= ~views;
        for (; views != 0; views &= views - 1)
            runs_[static_cast<std::size_t>(std::countr_zero(views))].back().end = end_;
    }

    std::vector<std::vector<CellRun>> runs_;
    const CountedCells* counted_;
    std::uint64_t open_ = 0;  // views whose last run ends at end_
    std::uint32_t end_ = 0;
};

/// Tests the cells row by row. `target_of(center, column, row)` returns the CellTarget of a cell.
template <typename TargetOf>
class RowLook {
  public:
    RowLook(const Grid& grid, const RayWorld& mesh, const Reach& reach, const TargetOf& target_of,
            const ViewScope& scope)
        : grid_(grid),
          columns_(GridAxis::columnsOf(grid)),
          mesh_(mesh),
          reach_(reach),
          target_of_(target_of),
          scope_(scope) {}

    /// Appends the cells of a row that each view sees to its runs, at the latest with finish().
    /// Rays are cast to many cells at a time: rows of views are short.
    void add(int row, RunsByView& runs) {
        constexpr std::size_t kAtOnce = 512;
        findTargets(row);
        if (targets_.size() >= kAtOnce) finish(runs);
    }
    void finish(RunsByView& runs) {
        if (targets_.empty()) return;
        if (scope_.known != nullptr)
            addKnown(runs);
        else
            addSeen(runs);
        cells_.clear();
        targets_.clear();
        held_.clear();
    }

  private:
    void addSeen(RunsByView& runs) {
        seen_.resize(targets_.size());
        mesh_.query(reach_.origin, targets_, seen_);
        for (std::size_t i = 0; i < targets_.size(); ++i)
            if (seen_[i] != 0 || targets_[i] == reach_.origin) runs.add(cells_[i], held_[i]);
    }
    /// Casts rays to cells that are not known yet.
    void addKnown(RunsByView& runs) {
        unknown_cells_.clear();
        unknown_.clear();
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            if (scope_.known->tested.test(cells_[i])) continue;
            unknown_cells_.push_back(cells_[i]);
            unknown_.push_back(targets_[i]);
        }
        seen_.resize(unknown_.size());
        if (!unknown_.empty()) mesh_.query(reach_.origin, unknown_, seen_);
        for (std::size_t i = 0; i < unknown_.size(); ++i) {
            scope_.known->tested.set(unknown_cells_[i]);
            if (seen_[i] != 0 || unknown_[i] == reach_.origin)
                scope_.known->seen.set(unknown_cells_[i]);
        }
        for (std::size_t i = 0; i < targets_.size(); ++i)
            if (scope_.known->seen.test(cells_[i])) runs.add(cells_[i], held_[i]);
    }
    /// Appends the cells of the row that lie in any view.
    void findTargets(int row) {
        const double y = grid_.rowCenter(row), dy = y - reach_.origin.y;
        if (!(std::fabs(dy) <= reach_.distance)) return;
        const double half = std::sqrt(reach_.distance * reach_.distance - dy * dy);
        const int in_reach = columns_.firstNotBelow(reach_.origin.x - half);
        const CellWindow& window = scope_.window;
        const int first = std::max(in_reach, window.first_column);
        const int end =
            std::min(columns_.firstAbove(reach_.origin.x + half, in_reach), window.end_column);
        const auto next = [&](int column) {
            if (scope_.counted == nullptr || column >= end) return column;
            const std::size_t at = grid_.cell(column, row);
            return column +
                   static_cast<int>(scope_.counted->next(static_cast<std::uint32_t>(at)) - at);
        };
        const auto is_hidden = [&](int column) {
            if (scope_.known == nullptr) return false;
            const std::size_t at = grid_.cell(column, row);
            return scope_.known->tested.test(at) && !scope_.known->seen.test(at);
        };
        int from = next(first), last = end - 1;
        while (from < end && is_hidden(from)) from = next(from + 1);
        while (last > from && is_hidden(last)) --last;
        if (from >= end) return;
        if constexpr (requires { target_of_.aim(row, from, last + 1); })
            target_of_.aim(row, from, last + 1);
        for (int column = from; column <= last; column = next(column + 1)) {
            if (is_hidden(column)) continue;
            const CellTarget target = target_of_({columns_.center(column), y}, column, row);
            if (target.held == 0) continue;
            cells_.push_back(static_cast<std::uint32_t>(grid_.cell(column, row)));
            targets_.push_back(target.place);
            held_.push_back(target.held);
        }
    }

    const Grid& grid_;
    GridAxis columns_;
    const RayWorld& mesh_;
    Reach reach_;
    TargetOf target_of_;
    ViewScope scope_;
    std::vector<std::uint32_t> cells_, unknown_cells_;
    std::vector<Point3> targets_, unknown_;
    std::vector<std::uint64_t> held_;
    std::vector<std::uint8_t> seen_;
};

/// Appends a part for each view. Bands of rows run in parallel.
template <typename TargetOf>
void addParts(const Grid& grid, const RayWorld& mesh, const Reach& reach, std::size_t views,
              const TargetOf& target_of, CellParts& parts, const ViewScope& scope = {}) {
    constexpr int kCellsOfBand = 1 << 16;
    const int rows = std::max(1, kCellsOfBand / grid.columns);
    const auto bands = static_cast<std::size_t>((grid.rows + rows - 1) / rows);
    std::vector<RunsByView> runs(bands, RunsByView(views, scope.counted));
    const auto look = [&](std::size_t band) {
        // Bands that run in parallel share no words of cells.
        ViewScope own = scope;
        if (bands > 1) own.known = nullptr;
        RowLook<TargetOf> row_look(grid, mesh, reach, target_of, own);
        const int first = static_cast<int>(band) * rows;
        for (int row = std::max(first, scope.window.first_row);
             row < std::min({first + rows, grid.rows, scope.window.end_row}); ++row)
            row_look.add(row, runs[band]);
        row_look.finish(runs[band]);
    };
    if (bands == 1)
        look(0);
    else
        tbb::parallel_for(std::size_t{0}, bands, look);
    for (std::size_t k = 0; k < views; ++k) {
        for (RunsByView& of_band : runs) {
            const std::vector<CellRun>& added = of_band.of(k);
            parts.runs.insert(parts.runs.end(), added.begin(), added.end());
        }
        parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
    }
}

/// The targets on a level plane. Finds the views that hold them by blocks of cells, halved until
/// all of a block is inside or outside of each view: O(edges of the views * log(block)) tests.
class ViewTargets {
  public:
    /// Tests no cells outside the window. \pre it lies in the grid
    ViewTargets(const Grid& grid, const HeldViews& views, double height, const CellWindow& window)
        : columns_(GridAxis::columnsOf(grid)),
          rows_(GridAxis::rowsOf(grid)),
          views_(views),
          height_(height),
          window_(window) {}

    CellTarget operator()(Point2 center, int column, int row) {
        if (row < first_row_ || row >= end_row_) findStrip(row);
        return {{center.x, center.y, height_}, held_[index(column, row)]};
    }

  private:
    static constexpr int kBlock = 8;  // cells of its side, a power of two

    void findStrip(int row) {
        first_row_ = row;
        end_row_ = std::min(row + kBlock, window_.end_row);
        held_.resize(static_cast<std::size_t>(window_.end_column - window_.first_column) *
                     static_cast<std::size_t>(end_row_ - first_row_));
        for (int column = window_.first_column; column < window_.end_column; column += kBlock)
            settle(column, row, kBlock, views_.all(), 0);
    }
    /// Stores the views of a block, `held` and some of the `unsure` ones.
    void settle(int column, int row, int size, std::uint64_t unsure, std::uint64_t held) {
        const int end_column = std::min(column + size, window_.end_column);
        const int end_row = std::min(row + size, end_row_);
        if (column >= end_column || row >= end_row) return;
        const Point2 low{columns_.center(column), rows_.center(row)};
        if (size == 1) {
            held |= views_.holding({low.x, low.y, height_}, unsure);
            unsure = 0;
        } else {
            const Vec2 half =
                0.5 * (Point2{columns_.center(end_column - 1), rows_.center(end_row - 1)} - low);
            const Point2 center = low + half;
            const auto verdict = views_.decide({center.x, center.y, height_}, half, unsure);
            held |= verdict.held;
            unsure = verdict.unsure;
        }
        if (unsure == 0) {
            for (int r = row; r < end_row; ++r)
                std::fill_n(held_.begin() + static_cast<std::ptrdiff_t>(index(column, r)),
                            end_column - column, held);
            return;
        }
        for (const int r : {row, row + size / 2})
            for (const int c : {column, column + size / 2}) settle(c, r, size / 2, unsure, held);
    }
    [[nodiscard]] std::size_t index(int column, int row) const {
        return static_cast<std::size_t>((row - first_row_) *
                                            (window_.end_column - window_.first_column) +
                                        column - window_.first_column);
    }

    GridAxis columns_, rows_;
    const HeldViews& views_;
    double height_;
    CellWindow window_;
    int first_row_ = 0, end_row_ = 0;  // of the strip
    std::vector<std::uint64_t> held_;
};

/// The same targets by the table of the views. Tests single points near the edges of views.
class TurnedTargets {
  public:
    TurnedTargets(const Grid& grid, const HeldViews& views, const TurnedViews& turned, Point2 foot,
                  double height, const CellWindow& window)
        : columns_(GridAxis::columnsOf(grid)),
          rows_(GridAxis::rowsOf(grid)),
          views_(views),
          turned_(turned),
          foot_(foot),
          height_(height),
          row_(static_cast<std::size_t>(std::max(0, window.end_column - window.first_column))) {}

    /// Prepares for columns [first, end) of a row.
    void aim(int row, int first, int end) {
        first_ = first;
        turned_.find(columns_.center(first) - foot_.x, columns_.extent / columns_.count,
                     rows_.center(row) - foot_.y,
                     std::span(row_).first(static_cast<std::size_t>(end - first)));
    }

    CellTarget operator()(Point2 center, int column, int /*row*/) const {
        const HeldViews::Verdict& verdict = *row_[static_cast<std::size_t>(column - first_)];
        const Point3 place{center.x, center.y, height_};
        if (verdict.unsure == 0) return {place, verdict.held};
        return {place, verdict.held | views_.holding(place, verdict.unsure)};
    }

  private:
    GridAxis columns_, rows_;
    const HeldViews& views_;
    const TurnedViews& turned_;
    Point2 foot_;
    double height_;
    int first_ = 0;  // column of the row
    std::vector<const HeldViews::Verdict*> row_;
};

/// A laser that scans in one tilted plane covers the floor below or above that plane.
void addScan(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, CellParts& parts) {
    const Point3 origin = sensor.pose.position;
    const Laser& laser = sensor.as<Laser>();
    const ScanPlane plane(sensor.pose);
    const auto reach = Reach::of(origin, laser.max_range, 0);
    if (plane.up() == 0 || !reach) return;  // upright: a line, as seen from above
    const BearingWindow window(laser);
    addParts(
        grid, mesh, *reach, 1,
        [&](Point2 center, int, int) {
            const Point3 target{center.x, center.y, plane.heightAt(center)};
            const Vec3 way = target - origin;
            const bool is_held = target.z >= 0 &&
                                 withinRange(std::sqrt(dot(way, way)), laser.max_range) &&
                                 window.holds(plane.frame().toLocal(target));
            return CellTarget{target, is_held ? 1U : 0U};
        },
        parts);
}

void addSweep(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, double height,
              CellParts& parts) {
    const Point3 origin = sensor.pose.position;
    const double range = sensor.as<Laser>().max_range;
    const auto reach = Reach::of(origin, range, height - origin.z);
    if (!reach) return;
    const SweptScan scan(sensor);
    addParts(
        grid, mesh, *reach, 1,
        [&](Point2 center, int, int) {
            const Point3 target{center.x, center.y, height};
            const Vec3 way = target - origin;
            const bool is_held =
                withinRange(std::sqrt(dot(way, way)), range) && scan.passes(target);
            return CellTarget{target, is_held ? 1U : 0U};
        },
        parts);
}

}  // namespace

CellWindow CellWindow::of(const Grid& grid, const CellSet& cells) {
    CellWindow window{grid.rows, 0, grid.columns, 0};
    cells.forEach([&](std::size_t cell) {
        const int row = static_cast<int>(cell) / grid.columns;
        const int column = static_cast<int>(cell) % grid.columns;
        window.first_row = std::min(window.first_row, row);
        window.end_row = std::max(window.end_row, row + 1);
        window.first_column = std::min(window.first_column, column);
        window.end_column = std::max(window.end_column, column + 1);
    });
    return window;
}

void cellsByView(const Grid& grid, const RayWorld& mesh, std::span<const FieldOfView> views,
                 double height, CellParts& parts, const ViewScope& scope) {
    parts.runs.clear();
    parts.first.assign(1, 0);
    for (std::size_t begin = 0; begin < views.size(); begin += HeldViews::kMax) {
        const auto some = views.subspan(begin, std::min(HeldViews::kMax, views.size() - begin));
        const Point3 origin = some[0].frame.origin;
        const auto reach = Reach::of(origin, some[0].farthest(), height - origin.z);
        if (!reach) {
            parts.first.insert(parts.first.end(), some.size(), 0);
            continue;
        }
        const HeldViews held(some);
        ViewScope near = scope;
        near.window = reach->within(grid, scope.window);
        if (scope.turned != nullptr)
            addParts(
                grid, mesh, *reach, some.size(),
                TurnedTargets(grid, held, *scope.turned, origin.onFloor(), height, near.window),
                parts, near);
        else
            addParts(grid, mesh, *reach, some.size(), ViewTargets(grid, held, height, near.window),
                     parts, near);
    }
}

std::optional<TurnedViews> turnedViews(const FieldOfView& ahead, std::span<const Angle> headings,
                                       double height, const Grid& grid) {
    if (headings.empty() || headings.size() > HeldViews::kMax) return std::nullopt;
    const auto reach =
        Reach::of(ahead.frame.origin, ahead.farthest(), height - ahead.frame.origin.z);
    if (!reach) return std::nullopt;
    const double most = std::hypot(grid.limits.width(), grid.limits.depth());
    return TurnedViews(ahead, headings, height, std::min(reach->distance, most));
}

CellSet cellsOnPlane(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, double height,
                     const CountedCells* counted, KnownSight* known) {
    CellParts parts;
    parts.first.assign(1, 0);
    if (const auto view = fieldOfView(sensor))
        cellsByView(grid, mesh, {&*view, 1}, height, parts, {.counted = counted, .known = known});
    else if (sensor.as<Laser>().sweep == SweepAxis::None)
        addScan(grid, mesh, sensor, parts);
    else
        addSweep(grid, mesh, sensor, height, parts);
    return parts.size() == 0 ? CellSet(grid.size()) : cellsOf(parts, 0, grid.size());
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of level views by scanlines: the outline is filled exactly (Scanline), rows are cut at the
// range as withinRange() compares it, and at each limit by its cotangent; within 1e-6 columns of a
// centre the limit's cross product decides. O(query + rows * limits + runs).
#include "coverage/sector_cells.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <span>

#include "base/per_thread.h"
#include "base/simd.h"
#include "scene/sensor/field_of_view.h"

namespace ispace {

namespace {

/// Factor by which the range is extended for cells, so that those at the maximum range do not lie
/// on the outline of the view.
constexpr double kBeyondRange = 1 + 1e-6;

/// Calls visit(Point2) for the corners of a polygon that contains the view and, apart from it, only
/// points beyond the maximum range: arcs become the tangents at their ends. Neighbours may be
/// equal.
template <typename Visit>
void forEachCorner(const VisibleRegion& region, Visit visit) {
    for (const VisibilityEdge& edge : region.edges) {
        visit(edge.from);
        if (edge.line == VisibilityEdge::kArc) {
            const Vec2 a = edge.from - region.viewpoint, b = edge.to - region.viewpoint;
            const double r2 = region.max_range * region.max_range;
            // The intersection of the tangents: on a + b, at t with t (a + b) a = r2.
            visit(region.viewpoint + (r2 / (r2 + dot(a, b))) * (a + b));
        }
        visit(edge.to);
    }
}

/// A direction between two parts, and its line: a cell's centre is at or beyond it if cross(unit,
/// offset) >= 0, in the half (above, below) of the limit.
struct Limit {
    Angle angle;
    Vec2 unit;
    double cotangent = 0;

    explicit Limit(Angle of) : angle(of), unit(unitVector(of)), cotangent(unit.x / unit.y) {}
    [[nodiscard]] bool isPassed(Vec2 offset) const { return cross(unit, offset) >= 0; }
};

/// Limits first, first + 1, ..., end - 1, counter-clockwise.
struct LimitRange {
    std::size_t first = 0, end = 0;
};

/// Columns of a row that belong to a part, up to before `end`.
struct Stretch {
    std::size_t part = 0;
    int end = 0;
};

/// A run of cells that belong to a part.
struct PartRun {
    CellRun cells;
    std::size_t part = 0;
};

/// Rasterises the views of one position after another and reuses the memory.
class SectorRaster {
  public:
    void run(const Grid& grid, const LevelViews& views, Point2 place, double max_range,
             std::span<const Angle> limits, CellParts& parts);

  private:
    void setLimits(std::span<const Angle> limits);
    void rasterise(const LevelViews& views);
    void cutAtRange();
    void takeCentre();
    void cutAt(std::size_t limit, int begin, int end);
    void splitRow(int row);
    void addRow(int row);
    void takeParts(CellParts& parts);
    /// Returns the part of the directions just before a limit.
    [[nodiscard]] std::size_t partBefore(std::size_t limit) const {
        return (limit == 0 ? limits_.size() : limit) - 1;
    }

    [[nodiscard]] std::uint64_t* wordsOf(int row) {
        return words_.data() + static_cast<std::size_t>(row) * scan_.wordsPerRow();
    }
    [[nodiscard]] std::uint32_t cellAt(int row, int column) const {
        return static_cast<std::uint32_t>(
            grid_.cell(scan_.firstColumn() + column, scan_.firstRow() + row));
    }
    /// Returns the offset of a cell's centre from the viewpoint.
    [[nodiscard]] Vec2 offsetOf(int row, int column) const {
        return {x_axis_.center(scan_.firstColumn() + column) - place_.x,
                dy_[static_cast<std::size_t>(row)]};
    }
    /// Converts x to a fractional column of the window.
    [[nodiscard]] double columnAt(double x) const {
        return x_axis_.position(x) - scan_.firstColumn();
    }
    /// Returns the first column beyond a position, clamped to the columns.
    [[nodiscard]] int firstBeyond(double position) const {
        return static_cast<int>(std::max(-1.0, std::min(position, scan_.columns() - 1.0)) + 1);
    }
    /// Below the viewpoint the first column past a limit, above it the first column before it.
    [[nodiscard]] int cutOf(std::size_t limit, int row) const {
        return cuts_[limit * dy_.size() + static_cast<std::size_t>(row)];
    }
    /// Calls visit(column) for the cells of a row in columns [begin, end); it may clear them.
    template <typename Visit>
    void forEachCell(int row, int begin, int end, Visit visit);
    void clear(int row, int column) {
        wordsOf(row)[column / 64] &= ~(std::uint64_t{1} << (static_cast<unsigned>(column) % 64));
    }

    Grid grid_;
    GridAxis x_axis_;
    Point2 place_;
    double max_range_ = 0, slack_ = 0;

    std::vector<Limit> limits_;
    LimitRange below_, above_;  // limits below 0 degrees, and between 0 and 180
    VisibleRegion region_;
    Scanline scan_;
    std::vector<std::uint64_t> words_;     // bits of the seen cells
    std::vector<double> dy_;               // offsets of the rows' middles from the viewpoint
    int level_begin_ = 0, level_end_ = 0;  // rows level with the viewpoint: one or zero
    std::vector<int> cuts_;                // by limit and row
    std::vector<Stretch> stretches_;       // of one row; the last one ends it
    std::vector<PartRun> runs_;            // ascending
    std::optional<std::uint32_t> centre_;
};

/// Returns the bits of a row's word i for columns [begin, end).
std::uint64_t bitsOf(int i, int begin, int end) {
    const int low = std::max(begin - 64 * i, 0), high = std::min(end - 64 * i, 64);
    if (low >= high) return 0;
    return (~std::uint64_t{0} << low) & (~std::uint64_t{0} >> (64 - high));
}

template <typename Visit>
void SectorRaster::forEachCell(int row, int begin, int end, Visit visit) {
    for (int i = begin / 64; 64 * i < end; ++i)
        for (std::uint64_t bits = wordsOf(row)[i] & bitsOf(i, begin, end); bits != 0;
             bits &= bits - 1)
            visit(64 * i + std::countr_zero(bits));
}

void SectorRaster::run(const Grid& grid, const LevelViews& views, Point2 place, double max_range,
                       std::span<const Angle> limits, CellParts& parts) {
    grid_ = grid;
    x_axis_ = GridAxis::columnsOf(grid);
    place_ = place;
    max_range_ = max_range;
    setLimits(limits);
    rasterise(views);
    cutAtRange();
    takeCentre();
    cuts_.resize(limits_.size() * dy_.size());
    for (std::size_t i = below_.first; i < below_.end; ++i) cutAt(i, 0, level_begin_);
    for (std::size_t i = above_.first; i < above_.end; ++i) cutAt(i, level_end_, scan_.rows());
    stretches_.resize(limits_.size() + 2);
    runs_.assign(1, {{0, 0}, limits_.size() + 1});  // before all others
    for (int row = 0; row < scan_.rows(); ++row) {
        splitRow(row);
        addRow(row);
    }
    if (centre_) runs_.push_back({{*centre_, *centre_ + 1}, limits_.size()});
    takeParts(parts);
}

/// Sorts the runs by part; within a part they stay ascending.
void SectorRaster::takeParts(CellParts& parts) {
    const std::span<const PartRun> runs = std::span(runs_).subspan(1);
    parts.first.assign(limits_.size() + 3, 0);
    for (const PartRun& run : runs) ++parts.first[run.part + 2];
    for (std::size_t i = 2; i < parts.first.size(); ++i) parts.first[i] += parts.first[i - 1];
    parts.runs.resize(runs.size());
    // The end of a part so far is the beginning of the next, once all are there.
    for (const PartRun& run : runs) parts.runs[parts.first[run.part + 1]++] = run.cells;
    parts.first.pop_back();
}

void SectorRaster::setLimits(std::span<const Angle> limits) {
    const auto is_same = [](Angle angle, const Limit& limit) { return angle == limit.angle; };
    if (std::equal(limits.begin(), limits.end(), limits_.begin(), limits_.end(), is_same)) return;
    assert(std::is_sorted(limits.begin(), limits.end()));
    limits_.clear();
    for (const Angle limit : limits) limits_.emplace_back(limit);
    const auto first_from = [&](Angle angle) {
        return static_cast<std::size_t>(std::lower_bound(limits.begin(), limits.end(), angle) -
                                        limits.begin());
    };
    const std::size_t zero = first_from(Angle());
    below_ = {0, zero};
    above_ = {zero + (zero < limits.size() && limits[zero] == Angle() ? 1 : 0),
              first_from(Angle::degrees(180))};
}

/// Rasterises the cells strictly inside the outline of the view, within the bounds of the range.
void SectorRaster::rasterise(const LevelViews& views) {
    views.query(place_, kBeyondRange * max_range_, region_);
    Box2 box;
    forEachCorner(region_, [&box](Point2 corner) { box.add(corner); });
    const double reach = kBeyondRange * max_range_;
    box.low = {std::max(box.low.x, place_.x - reach), std::max(box.low.y, place_.y - reach)};
    box.high = {std::min(box.high.x, place_.x + reach), std::min(box.high.y, place_.y + reach)};
    scan_.reset(grid_, box);
    slack_ = x_axis_.slack(std::abs(place_.x));
    bool has_last = false;
    Point2 last;
    const auto go_to = [&](Point2 corner) {
        if (has_last && last != corner) scan_.add({last, corner});
        last = corner;
        has_last = true;
    };
    forEachCorner(region_, go_to);
    if (!region_.edges.empty()) go_to(region_.edges.front().from);
    scan_.takeInside(words_);
    for (const Polygon& solid : views.level().solidsTouching(place_)) {
        Scanline closed(grid_, box);
        forEachEdge(solid, [&closed](const Segment2& edge) { closed.add(edge); });
        closed.removeClosed(words_);
    }
    dy_.resize(static_cast<std::size_t>(scan_.rows()));
    for (std::size_t row = 0; row < dy_.size(); ++row)
        dy_[row] = grid_.rowCenter(scan_.firstRow() + static_cast<int>(row)) - place_.y;
}

void SectorRaster::cutAtRange() {
    constexpr double kUnsure = 1e-6;  // ranges are compared as float32
    const auto square = [](double x) { return x * x; };
    const double outer2 = square((1 + kUnsure) * max_range_);
    const double inner2 = square((1 - kUnsure) * max_range_);
    const double middle = columnAt(place_.x), per_metre = x_axis_.perMetre();
    const int columns = scan_.columns();
    for (int row = 0; row < scan_.rows(); ++row) {
        const double dy2 = square(dy_[static_cast<std::size_t>(row)]);
        const double outer = per_metre * std::sqrt(std::max(0.0, outer2 - dy2));
        const int begin = firstBeyond(middle - outer - slack_);
        const int end = firstBeyond(middle + outer + slack_);
        std::uint64_t* words = wordsOf(row);
        for (int i = 0; 64 * i < columns; ++i)
            words[i] &= dy2 <= outer2 ? bitsOf(i, begin, end) : 0;
        int sure_begin = end, sure_end = end;
        if (dy2 < inner2) {
            const double inner = per_metre * std::sqrt(inner2 - dy2);
            sure_begin = firstBeyond(middle - inner + slack_);
            sure_end = std::max(sure_begin, firstBeyond(middle + inner - slack_));
        }
        const auto settle = [&](int column) {
            if (!withinRange(length(offsetOf(row, column)), max_range_)) clear(row, column);
        };
        if (begin < sure_begin) forEachCell(row, begin, sure_begin, settle);
        if (sure_end < end) forEachCell(row, sure_end, end, settle);
    }
}

/// Finds the row level with the viewpoint, and the cell centred at it.
void SectorRaster::takeCentre() {
    const auto [begin, end] = std::equal_range(dy_.begin(), dy_.end(), 0.0);
    level_begin_ = static_cast<int>(begin - dy_.begin());
    level_end_ = static_cast<int>(end - dy_.begin());
    centre_.reset();
    const double at = columnAt(place_.x);
    for (int row = level_begin_; row < level_end_ && !limits_.empty(); ++row)
        forEachCell(row, firstBeyond(at - slack_ - 1), firstBeyond(at + slack_ + 1),
                    [&](int column) {
                        if (offsetOf(row, column).x != 0) return;
                        clear(row, column);
                        centre_ = cellAt(row, column);
                    });
}

/// Computes the first columns beyond middle + dy * slope; returns true if one of these is within
/// `slack` of a column's centre.
ISPACE_SIMD_CLONES bool cutRows(const double* dy, int rows, double middle, double slope,
                                double most, double slack, int* cuts) {
    int unsure = 0;
    for (int row = 0; row < rows; ++row) {
        const double at = middle + dy[row] * slope;
        const double up = at < -0.5 ? -0.5 : at;
        const double next = (up > most ? most : up) + 1;
        cuts[row] = static_cast<int>(next);
        const double rest = next - static_cast<double>(cuts[row]);
        unsure |= static_cast<int>(rest <= slack) | static_cast<int>(rest >= 1 - slack);
    }
    return unsure != 0;
}

/// Computes where a limit cuts rows [begin, end), all above or all below the viewpoint: by its
/// cotangent, and by the limit's exact test if the cut is too near to a centre.
void SectorRaster::cutAt(std::size_t limit, int begin, int end) {
    constexpr double kUnsure = 1e-6;  // columns: far above rounding errors
    const Limit& at = limits_[limit];
    const bool is_below = at.unit.y < 0;
    const double slope = x_axis_.perMetre() * at.cotangent, middle = columnAt(place_.x);
    const double slack = slack_ + kUnsure, most = scan_.columns() - 0.5;
    int* cuts = cuts_.data() + limit * dy_.size();
    const double* dy = dy_.data();
    const bool is_unsure =
        cutRows(dy + begin, end - begin, middle, slope, most, slack, cuts + begin);
    for (int row = begin; is_unsure && row < end; ++row) {
        const double position = middle + dy[row] * slope;
        const int last = firstBeyond(position + slack);
        cuts[row] = firstBeyond(position - slack);
        while (cuts[row] < last && at.isPassed(offsetOf(row, cuts[row])) != is_below) ++cuts[row];
    }
    // Limits that rounding merges into one line keep their order.
    if (limit == (is_below ? below_ : above_).first) return;
    const int* before = cuts - dy_.size();
    for (int row = begin; row < end; ++row)
        cuts[row] = is_below ? std::max(cuts[row], before[row]) : std::min(cuts[row], before[row]);
}

/// Splits the columns of a row among the parts. Below the viewpoint columns rise counter-clockwise,
/// above it they fall; all cells of a level row on one side of it have the same direction exactly:
/// 180 or 0 degrees.
void SectorRaster::splitRow(int row) {
    Stretch* next = stretches_.data();
    std::size_t last = limits_.empty() ? 0 : partBefore(above_.first);
    if (row < level_begin_ && !limits_.empty()) {
        last = partBefore(below_.first);
        for (std::size_t limit = below_.first; limit < below_.end; last = limit++)
            *next++ = {last, cutOf(limit, row)};
    } else if (row < level_end_) {
        const int middle = x_axis_.firstNotBelow(place_.x) - scan_.firstColumn();
        if (!limits_.empty()) *next++ = {limits_.size() - 1, middle};
    } else {
        for (std::size_t limit = above_.end; limit-- > above_.first;)
            *next++ = {limit, cutOf(limit, row)};
    }
    *next = {last, scan_.columns()};
}

void SectorRaster::addRow(int row) {
    const std::uint64_t* words = wordsOf(row);
    const std::uint32_t row_cell = cellAt(row, 0);
    const Stretch* stretch = stretches_.data();
    for (int i = 0; 64 * i < scan_.columns(); ++i)
        for (std::uint64_t bits = words[i]; bits != 0;) {
            const int low = std::countr_zero(bits), first = 64 * i + low;
            while (stretch->end <= first) ++stretch;
            const int end = std::min(first + std::countr_one(bits >> low), stretch->end);
            const PartRun run{{row_cell + static_cast<std::uint32_t>(first),
                               row_cell + static_cast<std::uint32_t>(end)},
                              stretch->part};
            // One branch, as the next part often begins where a run ends.
            const bool goes_on = static_cast<int>(runs_.back().cells.end == run.cells.first) &
                                 static_cast<int>(runs_.back().part == run.part);
            if (goes_on)
                runs_.back().cells.end = run.cells.end;
            else
                runs_.push_back(run);
            bits = end - 64 * i == 64 ? 0 : bits & (~std::uint64_t{0} << (end - 64 * i));
        }
}

}  // namespace

std::optional<Sector> sectorOf(const Laser& laser, Angle heading) {
    const Angle slack = Angle::degrees(1e-9), span = laser.sweptSpan() + 2 * slack;
    if (span >= Angle::degrees(360)) return std::nullopt;
    const Angle first = heading + laser.first - slack;
    return Sector{wrapped(first), wrapped(first + span)};
}

void cellsBySector(const Grid& grid, const LevelViews& views, Point2 place, double max_range,
                   std::span<const Angle> limits, CellParts& parts) {
    perThread<SectorRaster, SectorRaster>().run(grid, views, place, max_range, limits, parts);
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/sector_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "cover/sector_limits.h"
#include "cover/sight_outline.h"
#include "raster/grid.h"
#include "sensor/field_of_view.h"

namespace ispace {

namespace {

/// Where the zone near to a group of limits begins and ends in a row.
struct Cut {
    int begin = 0, end = 0;
};

/// Rasterises what places see, one after another, in the same memory.
class SectorRaster {
  public:
    void run(const Grid& grid, const SliceSight& sight, Point2 place, double max_range,
             std::span<const Angle> limits, CellParts& parts);

  private:
    struct Piece {
        std::size_t part;
        CellRun run;
    };

    void rasterise(const SliceSight& sight);
    void cutAtRange();
    void findLevelRows();
    void takeCentre();
    void cutAtGroup(std::size_t group, int begin, int end);
    void settleNear(std::size_t group, int row);
    void settleLevelRow(int row);
    void addParts();
    void addLower(std::size_t group, std::size_t part);
    void addUpper(std::size_t group, std::size_t part);
    void addPieces(std::size_t part, std::size_t& next);
    void addRow(int row, int begin, int end);
    void addRun(CellRun run);

    [[nodiscard]] std::uint64_t* wordsOf(int row) {
        return words_.data() + static_cast<std::size_t>(row) * scan_.wordsPerRow();
    }
    [[nodiscard]] std::uint32_t cellAt(int row, int column) const {
        return static_cast<std::uint32_t>(
            grid_.cell(scan_.firstColumn() + column, scan_.firstRow() + row));
    }
    /// Of a cell's centre from the place.
    [[nodiscard]] Vec2 offsetOf(int row, int column) const {
        return {x_axis_.center(scan_.firstColumn() + column) - place_.x,
                dy_[static_cast<std::size_t>(row)]};
    }
    /// Where a coordinate is among the columns of the window.
    [[nodiscard]] double columnAt(double x) const {
        return x_axis_.position(x) - scan_.firstColumn();
    }
    /// The first column beyond a position, from 0 to the number of columns.
    [[nodiscard]] int firstBeyond(double position) const {
        return static_cast<int>(std::max(-1.0, std::min(position, scan_.columns() - 1.0)) + 1);
    }
    [[nodiscard]] const Cut& cutOf(std::size_t group, int row) const {
        return cuts_[group * dy_.size() + static_cast<std::size_t>(row)];
    }
    /// Calls visit(column) for the cells of a row in columns [begin, end); it may clear them.
    template <typename Visit>
    void forEachCell(int row, int begin, int end, Visit visit);
    template <typename Visit>
    void forEachRunOf(int row, int begin, int end, Visit visit);
    void clear(int row, int column) {
        wordsOf(row)[column / 64] &= ~(std::uint64_t{1} << (static_cast<unsigned>(column) % 64));
    }

    Grid grid_;
    GridAxis x_axis_;
    Point2 place_;
    double max_range_ = 0, slack_ = 0;
    CellParts* parts_ = nullptr;
    std::size_t part_begin_ = 0;  // its first run

    SectorLimits limits_;
    VisibleRegion region_;
    Scanline scan_;
    std::vector<std::uint64_t> words_;     // what is seen, and not yet in a piece
    std::vector<double> dy_;               // of the rows' middles from the place
    int level_begin_ = 0, level_end_ = 0;  // rows as good as level with the place
    std::vector<Cut> cuts_;                // by group, by row
    std::vector<Piece> pieces_;            // cells that were settled one by one
    std::vector<CellRun> centre_;
};

/// The bits of a row's word i that stand for columns [begin, end).
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

/// The same for runs of cells, visit(CellRun); what goes on in the next word is two runs.
template <typename Visit>
void SectorRaster::forEachRunOf(int row, int begin, int end, Visit visit) {
    if (begin >= end) return;
    const std::uint64_t* words = wordsOf(row);
    for (int i = begin / 64; 64 * i < end; ++i) {
        std::uint64_t bits = words[i] & bitsOf(i, begin, end);
        while (bits != 0) {
            const int first = std::countr_zero(bits);
            const int count = std::countr_one(bits >> first);
            const std::uint32_t cell = cellAt(row, 64 * i + first);
            visit(CellRun{cell, cell + static_cast<std::uint32_t>(count)});
            bits = first + count == 64 ? 0 : bits & (~std::uint64_t{0} << (first + count));
        }
    }
}

void SectorRaster::run(const Grid& grid, const SliceSight& sight, Point2 place, double max_range,
                       std::span<const Angle> limits, CellParts& parts) {
    grid_ = grid;
    x_axis_ = GridAxis::columnsOf(grid);
    place_ = place;
    max_range_ = max_range;
    parts_ = &parts;
    limits_.set(limits);
    pieces_.clear();
    centre_.clear();
    parts.runs.clear();
    parts.first.assign(1, 0);
    rasterise(sight);
    cutAtRange();
    findLevelRows();
    if (limits_.parts() == 0) {
        part_begin_ = 0;
        for (int row = 0; row < scan_.rows(); ++row) addRow(row, 0, scan_.columns());
        parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
        return;
    }
    takeCentre();
    cuts_.resize(limits_.groups().size() * dy_.size());
    const auto cut = [&](const LimitsOfHalf& half, int begin, int end) {
        for (std::size_t i = half.first; i < half.first + half.count; ++i)
            cutAtGroup(i, begin, end);
    };
    cut(limits_.lower(), 0, level_begin_);
    cut(limits_.upper(), level_end_, scan_.rows());
    for (int row = level_begin_; row < level_end_; ++row) settleLevelRow(row);
    addParts();
}

/// Cells strictly inside the outline of what is seen, within a box about the range.
void SectorRaster::rasterise(const SliceSight& sight) {
    sight.query(place_, kBeyondRange * max_range_, region_);
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
    for (const Polygon& solid : sight.solidsTouching(place_)) {
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

/// Those in which directions come so near to 0 or 180 degrees that limits there matter.
void SectorRaster::findLevelRows() {
    double reach = 0;
    if (!dy_.empty() && scan_.columns() > 0)
        reach = std::max(std::abs(offsetOf(0, 0).x), std::abs(offsetOf(0, scan_.columns() - 1).x));
    const double most = 8 * kNearLimit * reach;
    const auto begin = std::lower_bound(dy_.begin(), dy_.end(), -most);
    const auto end = std::upper_bound(begin, dy_.end(), most);
    level_begin_ = static_cast<int>(begin - dy_.begin());
    level_end_ = static_cast<int>(end - dy_.begin());
}

void SectorRaster::takeCentre() {
    for (int row = level_begin_; row < level_end_; ++row) {
        if (dy_[static_cast<std::size_t>(row)] != 0) continue;
        const double at = columnAt(place_.x);
        forEachCell(row, firstBeyond(at - slack_ - 1), firstBeyond(at + slack_ + 1),
                    [&](int column) {
                        if (offsetOf(row, column).x != 0) return;
                        clear(row, column);
                        centre_.push_back({cellAt(row, column), cellAt(row, column) + 1});
                    });
    }
}

/// Finds where a group of limits crosses rows [begin, end), and settles the cells near to it.
void SectorRaster::cutAtGroup(std::size_t group, int begin, int end) {
    const double per_metre = x_axis_.perMetre(), middle = columnAt(place_.x);
    const LimitGroup& at = limits_.groups()[group];
    // Columns rise counter-clockwise below the place, and clockwise above it.
    const bool is_upper = at.unit.y > 0;
    const double left = per_metre * (is_upper ? at.beyond : at.before);
    const double right = per_metre * (is_upper ? at.before : at.beyond);
    Cut* cuts = cuts_.data() + group * dy_.size();
    const double* dy = dy_.data();
    int widest = 0;
    for (int row = begin; row < end; ++row) {
        cuts[row] = {firstBeyond(middle - slack_ + dy[row] * left),
                     firstBeyond(middle + slack_ + dy[row] * right)};
        widest = std::max(widest, cuts[row].end - cuts[row].begin);
    }
    if (widest == 0) return;
    for (int row = begin; row < end; ++row) settleNear(group, row);
}

void SectorRaster::settleNear(std::size_t group, int row) {
    const Cut cut = cutOf(group, row);
    if (cut.begin >= cut.end) return;
    forEachCell(row, cut.begin, cut.end, [&](int column) {
        const std::uint32_t cell = cellAt(row, column);
        pieces_.push_back({limits_.partNear(group, offsetOf(row, column)), {cell, cell + 1}});
        clear(row, column);
    });
}

void SectorRaster::settleLevelRow(int row) {
    const int columns = scan_.columns();
    if (dy_[static_cast<std::size_t>(row)] != 0) {
        forEachCell(row, 0, columns, [&](int column) {
            const std::uint32_t cell = cellAt(row, column);
            pieces_.push_back({limits_.partOf(offsetOf(row, column)), {cell, cell + 1}});
        });
        return;
    }
    // All cells of a side lie in the very same direction.
    const std::size_t left = limits_.partOf({-1, 0}), right = limits_.partOf({1, 0});
    const int middle =
        std::clamp(x_axis_.firstNotBelow(place_.x) - scan_.firstColumn(), 0, columns);
    forEachRunOf(row, 0, middle, [&](CellRun run) { pieces_.push_back({left, run}); });
    forEachRunOf(row, middle, columns, [&](CellRun run) { pieces_.push_back({right, run}); });
}

void SectorRaster::addParts() {
    const auto before = [](const Piece& a, const Piece& b) {
        return a.part < b.part || (a.part == b.part && a.run.first < b.run.first);
    };
    if (!std::is_sorted(pieces_.begin(), pieces_.end(), before))
        std::sort(pieces_.begin(), pieces_.end(), before);
    std::size_t next = 0, group = 0;
    for (std::size_t part = 0; part < limits_.parts(); ++part) {
        part_begin_ = parts_->runs.size();
        if (part + 1 == limits_.groups()[group].end) {  // it goes on to the next group
            addLower(group, part);
            addUpper(group++, part);
        }
        addPieces(part, next);
        parts_->first.push_back(static_cast<std::uint32_t>(parts_->runs.size()));
    }
    part_begin_ = parts_->runs.size();
    for (const CellRun run : centre_) addRun(run);
    parts_->first.push_back(static_cast<std::uint32_t>(parts_->runs.size()));
}

/// The cells of the part after a group of limits in the rows below the place.
void SectorRaster::addLower(std::size_t group, std::size_t part) {
    const LimitsOfHalf& half = limits_.lower();
    const std::size_t end = half.first + half.count;
    const bool is_first = part == half.first_part;
    const bool is_after = half.first <= group && group < end;
    if (!is_first && !is_after) return;
    for (int row = 0; row < level_begin_; ++row) {
        if (is_first)
            addRow(row, 0, half.count > 0 ? cutOf(half.first, row).begin : scan_.columns());
        if (is_after)
            addRow(row, cutOf(group, row).end,
                   group + 1 < end ? cutOf(group + 1, row).begin : scan_.columns());
    }
}

/// The same above it, where columns fall counter-clockwise.
void SectorRaster::addUpper(std::size_t group, std::size_t part) {
    const LimitsOfHalf& half = limits_.upper();
    const std::size_t end = half.first + half.count;
    const bool is_first = part == half.first_part;
    const bool is_after = half.first <= group && group < end;
    if (!is_first && !is_after) return;
    for (int row = level_end_; row < scan_.rows(); ++row) {
        if (is_after)
            addRow(row, group + 1 < end ? cutOf(group + 1, row).end : 0, cutOf(group, row).begin);
        if (is_first) addRow(row, half.count > 0 ? cutOf(half.first, row).end : 0, scan_.columns());
    }
}

/// Those of a part, which begin with piece `next`, put in their places among its runs.
void SectorRaster::addPieces(std::size_t part, std::size_t& next) {
    if (next == pieces_.size() || pieces_[next].part != part) return;
    std::vector<CellRun>& runs = parts_->runs;
    const std::size_t middle = runs.size();
    for (; next < pieces_.size() && pieces_[next].part == part; ++next)
        runs.push_back(pieces_[next].run);
    const auto at = [&runs](std::size_t i) {
        return runs.begin() + static_cast<std::ptrdiff_t>(i);
    };
    std::inplace_merge(at(part_begin_), at(middle), runs.end(),
                       [](const CellRun& a, const CellRun& b) { return a.first < b.first; });
    std::size_t count = part_begin_;
    for (std::size_t i = part_begin_; i < runs.size(); ++i) {
        if (count > part_begin_ && runs[count - 1].end == runs[i].first)
            runs[count - 1].end = runs[i].end;
        else
            runs[count++] = runs[i];
    }
    runs.resize(count);
}

void SectorRaster::addRow(int row, int begin, int end) {
    forEachRunOf(row, begin, end, [this](CellRun run) { addRun(run); });
}

void SectorRaster::addRun(CellRun run) {
    std::vector<CellRun>& runs = parts_->runs;
    if (runs.size() > part_begin_ && runs.back().end == run.first)
        runs.back().end = run.end;
    else
        runs.push_back(run);
}

}  // namespace

void cellsBySector(const Grid& grid, const SliceSight& sight, Point2 place, double max_range,
                   std::span<const Angle> limits, CellParts& parts) {
    thread_local SectorRaster raster;  // for its memory
    raster.run(grid, sight, place, max_range, limits, parts);
}

}  // namespace ispace

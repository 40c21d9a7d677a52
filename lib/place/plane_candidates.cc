// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/plane_candidates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "sensor/field_of_view.h"

namespace ispace {

namespace {

/// Views answered together: one bit of a word each.
constexpr std::size_t kTogether = 64;

/// Answers which views see the cells of a row.
class RowQuery {
  public:
    RowQuery(const Grid& grid, const RayWorld& mesh, std::span<const FieldOfView> views,
             double height, double reach)
        : grid_(grid), mesh_(mesh), views_(views), height_(height), reach_(reach) {}

    /// Adds what each view sees of a row to its runs.
    void add(int row, std::span<std::vector<CellRun>> runs) {
        findTargets(row);
        if (targets_.empty()) return;
        const Point3 origin = views_[0].frame.origin;
        seen_.resize(targets_.size());
        mesh_.look(origin, targets_, seen_);
        for (std::size_t i = 0; i < targets_.size(); ++i) {
            if (seen_[i] == 0 && targets_[i] != origin) continue;
            for (std::uint64_t bits = held_[i]; bits != 0; bits &= bits - 1)
                addCell(runs[static_cast<std::size_t>(std::countr_zero(bits))], cells_[i]);
        }
    }

  private:
    /// Those of the row's cells that are in some view.
    void findTargets(int row) {
        cells_.clear();
        targets_.clear();
        held_.clear();
        const Point3 origin = views_[0].frame.origin;
        const double y = grid_.rowCenter(row), dy = y - origin.y;
        if (!(std::abs(dy) <= reach_)) return;
        const double half = std::sqrt(reach_ * reach_ - dy * dy);
        const int end = std::min(grid_.columns, columnAt(origin.x + half) + 2);
        for (int column = std::max(0, columnAt(origin.x - half) - 1); column < end; ++column) {
            const Point3 target{grid_.columnCenter(column), y, height_};
            std::uint64_t held = 0;
            for (std::size_t k = 0; k < views_.size(); ++k)
                if (views_[k].holds(target)) held |= std::uint64_t{1} << k;
            if (held == 0) continue;
            cells_.push_back(static_cast<std::uint32_t>(grid_.cell(column, row)));
            targets_.push_back(target);
            held_.push_back(held);
        }
    }
    /// About where a coordinate is, with one column to spare on each side.
    [[nodiscard]] int columnAt(double x) const {
        const double at = (x - grid_.limits.low.x) * (grid_.columns / grid_.limits.width());
        return static_cast<int>(std::clamp(std::floor(at), -1.0, grid_.columns + 1.0));
    }
    static void addCell(std::vector<CellRun>& runs, std::uint32_t cell) {
        if (!runs.empty() && runs.back().end == cell)
            ++runs.back().end;
        else
            runs.push_back({cell, cell + 1});
    }

    const Grid& grid_;
    const RayWorld& mesh_;
    std::span<const FieldOfView> views_;
    double height_, reach_;
    std::vector<std::uint32_t> cells_;
    std::vector<Point3> targets_;
    std::vector<std::uint64_t> held_;  // bit k: in view k
    std::vector<std::uint8_t> seen_;
};

}  // namespace

void cellsByView(const Grid& grid, const RayWorld& mesh, std::span<const FieldOfView> views,
                 double height, CellParts& parts) {
    parts.runs.clear();
    parts.first.assign(1, 0);
    for (std::size_t begin = 0; begin < views.size(); begin += kTogether) {
        const auto some = views.subspan(begin, std::min(kTogether, views.size() - begin));
        const double range = some[0].farthest();
        const double drop = std::abs(height - some[0].frame.origin.z);
        // Greatest distance on the plan; range tests are those of float32.
        const double reach = (1 + 1e-6) * std::sqrt(std::max(0.0, range * range - drop * drop));
        const bool is_in_range = withinRange(drop, range);
        RowQuery query(grid, mesh, some, height, reach);
        std::vector<std::vector<CellRun>> runs(some.size());
        for (int row = 0; is_in_range && row < grid.rows; ++row) query.add(row, runs);
        for (const std::vector<CellRun>& of_view : runs) {
            parts.runs.insert(parts.runs.end(), of_view.begin(), of_view.end());
            parts.first.push_back(static_cast<std::uint32_t>(parts.runs.size()));
        }
    }
}

}  // namespace ispace

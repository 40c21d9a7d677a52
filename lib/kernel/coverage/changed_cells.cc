// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/changed_cells.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "env/body.h"
#include "env/mesh.h"

namespace ispace {

namespace {

/// About bodies, metres: more than rays and meshes are rounded by.
constexpr double kMargin = 1e-3;

/// The part of the plane in the shadow of a box: the hull of its plan, enlarged from the eye's foot
/// by a range of factors.
class Shadow {
  public:
    Shadow(const Box2& plan, Point2 foot, double least, double most) {
        for (const double factor : {least, most})
            for (const Point2 corner : {plan.low, Point2{plan.high.x, plan.low.y}, plan.high,
                                        Point2{plan.low.x, plan.high.y}})
                corners_[count_++] = foot + factor * (corner - foot);
        std::sort(corners_.begin(), corners_.end(), [](Point2 a, Point2 b) { return a.y < b.y; });
    }

    [[nodiscard]] double low() const { return corners_.front().y; }
    [[nodiscard]] double high() const { return corners_.back().y; }
    /// Returns the ends of the shadow along the line at this y: those of all lines that join two
    /// corners. \pre low() <= y <= high()
    [[nodiscard]] std::pair<double, double> along(double y) const {
        double left = HUGE_VAL, right = -HUGE_VAL;
        for (std::size_t i = 0; i < corners_.size() && corners_[i].y <= y; ++i)
            for (std::size_t k = corners_.size(); k-- > i && corners_[k].y >= y;) {
                const Point2 a = corners_[i], b = corners_[k];
                const double share = b.y > a.y ? (y - a.y) / (b.y - a.y) : 0;
                const double x = a.x + share * (b.x - a.x);
                left = std::min({left, x, b.y > a.y ? x : b.x});
                right = std::max({right, x, b.y > a.y ? x : b.x});
            }
        return {left, right};
    }

  private:
    std::array<Point2, 8> corners_;
    std::size_t count_ = 0;
};

double distanceTo(const Box2& box, Point2 p) {
    return std::hypot(std::max({box.low.x - p.x, 0.0, p.x - box.high.x}),
                      std::max({box.low.y - p.y, 0.0, p.y - box.high.y}));
}

/// Joins runs that overlap. \pre each lies in one row
std::vector<CellRun> joined(std::vector<CellRun> runs) {
    std::sort(runs.begin(), runs.end(),
              [](const CellRun& a, const CellRun& b) { return a.first < b.first; });
    std::vector<CellRun> all;
    for (const CellRun& run : runs)
        if (!all.empty() && run.first < all.back().end)
            all.back().end = std::max(all.back().end, run.end);
        else
            all.push_back(run);
    return all;
}

std::vector<CellRun> allRows(const Grid& grid) {
    std::vector<CellRun> runs;
    runs.reserve(static_cast<std::size_t>(grid.rows));
    for (int row = 0; row < grid.rows; ++row)
        runs.push_back({static_cast<std::uint32_t>(grid.cell(0, row)),
                        static_cast<std::uint32_t>(grid.cell(0, row) +
                                                   static_cast<std::size_t>(grid.columns))});
    return runs;
}

}  // namespace

std::optional<ChangedBodies> ChangedBodies::between(const Environment& before,
                                                    const Environment& after) {
    const auto changes = after.changesSince(before);
    if (!changes) return std::nullopt;
    ChangedBodies found;
    const auto add = [&found](const Body& body) {
        Bounds bounds{.plan = {}, .bottom = HUGE_VAL, .top = -HUGE_VAL};
        for (const Mesh& mesh : meshesOf(body, Surfaces::Solid))
            for (const Point3& vertex : mesh.vertices) {
                bounds.plan.add(vertex.onFloor());
                bounds.bottom = std::min(bounds.bottom, vertex.z);
                bounds.top = std::max(bounds.top, vertex.z);
            }
        for (const Prism& prism : body.prisms) {
            if (!prism.curve) continue;
            bounds.plan.add(prism.curve->box().low);
            bounds.plan.add(prism.curve->box().high);
        }
        if (bounds.plan.empty()) return;
        found.bodies_.push_back(
            {bounds.plan.expanded(kMargin), bounds.bottom - kMargin, bounds.top + kMargin});
    };
    for (const std::size_t i : changes->removed) add(before.elements()[i].body);
    for (const std::size_t i : changes->added) add(after.elements()[i].body);
    return found;
}

bool ChangedBodies::meet(const Box2& part) const {
    return std::any_of(bodies_.begin(), bodies_.end(),
                       [&part](const Bounds& body) { return body.plan.meets(part); });
}

std::vector<CellRun> ChangedBodies::shadowsOn(const Grid& grid, Point3 eye, double height) const {
    const Point2 foot = eye.onFloor();
    const GridAxis columns = GridAxis::columnsOf(grid), rows = GridAxis::rowsOf(grid);
    std::vector<CellRun> runs;
    for (const Bounds& body : bodies_) {
        const double near = distanceTo(body.plan, foot);
        if (near < kMargin) return allRows(grid);
        // The ways to the plane pass the heights of the body in these parts of their lengths.
        double first = 0, last = 1;
        if (const double drop = eye.z - height; drop != 0) {
            const double at_top = (eye.z - body.top) / drop,
                         at_bottom = (eye.z - body.bottom) / drop;
            first = std::max(0.0, std::min(at_top, at_bottom));
            last = std::min(1.0, std::max(at_top, at_bottom));
        } else if (height < body.bottom || height > body.top) {
            continue;
        }
        if (first > last) continue;
        Box2 all = grid.limits;
        all.add(foot);
        const double beyond = std::hypot(all.width(), all.depth()) / near + 1;
        const double most = first > 0 ? std::min(1 / first, beyond) : beyond;
        const Shadow shadow(body.plan, foot, std::min(1 / last, most), most);
        const int end_row = rows.firstAbove(shadow.high());
        for (int row = rows.firstNotBelow(shadow.low()); row < end_row; ++row) {
            const auto [left, right] = shadow.along(rows.center(row));
            const int begin = columns.firstNotBelow(left);
            const int end = columns.firstAbove(right, begin);
            if (begin < end)
                runs.push_back({static_cast<std::uint32_t>(grid.cell(begin, row)),
                                static_cast<std::uint32_t>(grid.cell(end - 1, row) + 1)});
        }
    }
    return joined(std::move(runs));
}

CellChanges changesIn(std::span<const CellRun> where, const Grid& grid, const RayWorld& mesh,
                      const FieldOfView& view, double height, const CellSet& before) {
    const Point3 eye = view.frame.origin;
    CellChanges changes;
    std::vector<std::uint32_t> cells;
    std::vector<Point3> targets;
    std::vector<std::uint8_t> seen;
    for (const CellRun& run : where) {
        cells.clear();
        targets.clear();
        for (std::uint32_t cell = run.first; cell < run.end; ++cell) {
            const Point2 center = grid.center(cell);
            const Point3 target{center.x, center.y, height};
            if (!view.holds(target)) continue;
            cells.push_back(cell);
            targets.push_back(target);
        }
        seen.assign(targets.size(), 0);
        if (!targets.empty()) mesh.query(eye, targets, seen);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const bool is_seen = seen[i] != 0 || targets[i] == eye;
            if (is_seen == before.test(cells[i])) continue;
            (is_seen ? changes.gained : changes.lost).push_back(cells[i]);
        }
    }
    return changes;
}

}  // namespace ispace

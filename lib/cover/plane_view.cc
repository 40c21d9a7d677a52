// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/plane_view.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "cover/plane_sweep.h"
#include "sensor/field_of_view.h"

namespace ispace {

namespace {

/// Columns whose centres may lie within `half` of x, with one to spare on each side: [first, last).
struct Span {
    int first, last;
};
Span columnsNear(const Grid& grid, double x, double half) {
    const double per_metre = grid.columns / grid.limits.width();
    const auto column = [&grid, per_metre](double place) {
        const double raw = (place - grid.limits.low.x) * per_metre;
        return static_cast<int>(std::clamp(std::floor(raw), -1.0, grid.columns + 1.0));
    };
    return {std::max(0, column(x - half) - 1), std::min(grid.columns, column(x + half) + 2)};
}

/// What all rows of cells have in common.
struct Sight {
    const Grid& grid;
    const RayWorld& mesh;
    Point3 origin;
    double reach;  ///< on the plan: no farther place is in view
};

/// The cells of a row whose target is in sight. `target_of(center)` is where to look for a cell's
/// sake, or nothing if that is out of view.
template <typename TargetOf>
std::vector<std::uint32_t> seenInRow(const Sight& sight, TargetOf target_of, int row) {
    const Grid& grid = sight.grid;
    // Range tests are those of float32.
    constexpr double kSlack = 1 + 1e-6;
    const double y = grid.rowCenter(row), dy = y - sight.origin.y, reach = kSlack * sight.reach;
    if (!(std::fabs(dy) <= reach)) return {};
    const Span columns = columnsNear(grid, sight.origin.x, std::sqrt(reach * reach - dy * dy));
    std::vector<std::uint32_t> cells;
    std::vector<Point3> targets;
    for (int column = columns.first; column < columns.last; ++column) {
        const std::optional<Point3> target = target_of(Point2{grid.columnCenter(column), y});
        if (!target) continue;
        cells.push_back(static_cast<std::uint32_t>(grid.cell(column, row)));
        targets.push_back(*target);
    }
    if (cells.empty()) return {};
    std::vector<std::uint8_t> seen(targets.size());
    sight.mesh.look(sight.origin, targets, seen);
    std::size_t count = 0;
    for (std::size_t i = 0; i < cells.size(); ++i)
        if (seen[i] != 0 || targets[i] == sight.origin) cells[count++] = cells[i];
    cells.resize(count);
    return cells;
}

template <typename TargetOf>
CellSet cellsInSight(const Sight& sight, TargetOf target_of) {
    std::vector<std::vector<std::uint32_t>> rows(static_cast<std::size_t>(sight.grid.rows));
    tbb::parallel_for(0, sight.grid.rows, [&](int row) {
        rows[static_cast<std::size_t>(row)] = seenInRow(sight, target_of, row);
    });
    CellSet cells(sight.grid.size());
    for (const auto& row : rows)
        for (const std::uint32_t cell : row) cells.set(cell);
    return cells;
}

/// Greatest distance on the plan of what is `range` away, `drop` above or below; nothing if the
/// plane is out of range.
std::optional<double> planReach(double range, double drop) {
    if (!withinRange(std::fabs(drop), range)) return std::nullopt;
    return std::sqrt(std::max(0.0, range * range - drop * drop));
}

CellSet cellsInView(const Grid& grid, const RayWorld& mesh, const FieldOfView& view,
                    double height) {
    const Point3 origin = view.frame.origin;
    const auto reach = planReach(view.farthest(), height - origin.z);
    if (!reach) return CellSet(grid.size());
    return cellsInSight({grid, mesh, origin, *reach},
                        [&view, height](Point2 center) -> std::optional<Point3> {
                            const Point3 target{center.x, center.y, height};
                            if (!view.holds(target)) return std::nullopt;
                            return target;
                        });
}

CellSet cellsOfScan(const Grid& grid, const RayWorld& mesh, const Sensor& sensor) {
    const ScanPlane plane(sensor.pose);
    if (plane.up() == 0) return CellSet(grid.size());  // seen from above, a line
    const Point3 origin = sensor.pose.position;
    const double range = sensor.as<Laser>().max_range;
    const BearingWindow window(sensor.as<Laser>());
    return cellsInSight({grid, mesh, origin, range}, [&](Point2 center) -> std::optional<Point3> {
        const Point3 target{center.x, center.y, plane.heightAt(center)};
        const Vec3 way = target - origin;
        if (target.z < 0 || !withinRange(std::sqrt(dot(way, way)), range) ||
            !window.holds(plane.frame().toLocal(target)))
            return std::nullopt;
        return target;
    });
}

CellSet cellsOfSweep(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, double height) {
    const SweptScan scan(sensor);
    const Point3 origin = sensor.pose.position;
    const double range = sensor.as<Laser>().max_range;
    const auto reach = planReach(range, height - origin.z);
    if (!reach) return CellSet(grid.size());
    return cellsInSight({grid, mesh, origin, *reach}, [&](Point2 center) -> std::optional<Point3> {
        const Point3 target{center.x, center.y, height};
        const Vec3 way = target - origin;
        if (!withinRange(std::sqrt(dot(way, way)), range) || !scan.passes(target))
            return std::nullopt;
        return target;
    });
}

}  // namespace

CellSet cellsSeen(const Grid& grid, const RayWorld& mesh, const Sensor& sensor, double height) {
    if (const auto view = fieldOfView(sensor)) return cellsInView(grid, mesh, *view, height);
    return sensor.as<Laser>().sweep == SweepAxis::None ? cellsOfScan(grid, mesh, sensor)
                                                       : cellsOfSweep(grid, mesh, sensor, height);
}

}  // namespace ispace

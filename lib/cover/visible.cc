// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/visible.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace ispace {

namespace {

/// One rule for every range test, on the float that Entry keeps, so that a place looked at with a
/// longer range gives the same fan.
bool withinRange(double distance, double max_range) {
    return static_cast<float>(distance) <= static_cast<float>(max_range);
}

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

/// What is looked at in one row of cells.
struct Row {
    std::vector<std::uint32_t> cells;
    std::vector<Point3> targets;
    std::vector<std::uint8_t> seen;

    void add(std::size_t cell, Point3 target) {
        cells.push_back(static_cast<std::uint32_t>(cell));
        targets.push_back(target);
    }
    void look(const RayWorld& world, Point3 origin) {
        seen.resize(targets.size());
        if (!targets.empty()) world.look(origin, targets, seen);
    }
};

std::vector<VisibleCells::Entry> visibleInRow(const Grid& grid, const RayWorld& world,
                                              Point3 origin, double max_range, int row) {
    std::vector<VisibleCells::Entry> entries;
    const double dy = grid.rowCenter(row) - origin.y;
    if (!withinRange(std::abs(dy), max_range)) return entries;
    const Span columns = columnsNear(grid, origin.x, max_range);
    Row batch;
    for (int column = columns.first; column < columns.last; ++column) {
        const Point2 center{grid.columnCenter(column), grid.rowCenter(row)};
        if (withinRange(distance(origin.onFloor(), center), max_range))
            batch.add(grid.cell(column, row), {center.x, center.y, origin.z});
    }
    batch.look(world, origin);
    for (std::size_t i = 0; i < batch.cells.size(); ++i) {
        const Vec2 offset = batch.targets[i].onFloor() - origin.onFloor();
        const auto far = static_cast<float>(length(offset));
        if (batch.seen[i] == 0 && far != 0) continue;
        entries.push_back({batch.cells[i], far, directionOf(offset.x, offset.y).degrees()});
    }
    return entries;
}

/// Where a scan plane that is not level passes above or below the floor.
struct ScanPlane {
    explicit ScanPlane(const Pose3& pose)
        : origin(pose.position),
          forward(pose.beam(Angle::degrees(0))),
          left(pose.beam(Angle::degrees(90))),
          up(forward.x * left.y - forward.y * left.x) {}

    /// Height of the plane over a place. \pre up is not 0
    [[nodiscard]] double heightAt(Point2 p) const {
        const double nx = forward.y * left.z - forward.z * left.y;
        const double ny = forward.z * left.x - forward.x * left.z;
        return origin.z - (nx * (p.x - origin.x) + ny * (p.y - origin.y)) / up;
    }
    [[nodiscard]] Angle bearingOf(Vec3 offset) const {
        return directionOf(dot(offset, forward), dot(offset, left));
    }

    Point3 origin;
    Vec3 forward, left;
    double up;  ///< vertical part of the normal; 0 if the plane stands upright
};

std::vector<std::uint32_t> seenInRow(const Grid& grid, const RayWorld& world, const Laser& laser,
                                     const ScanPlane& plane, int row) {
    const double dy = grid.rowCenter(row) - plane.origin.y;
    if (!withinRange(std::abs(dy), laser.max_range)) return {};
    const Span columns = columnsNear(grid, plane.origin.x, laser.max_range);
    Row batch;
    for (int column = columns.first; column < columns.last; ++column) {
        const Point2 center{grid.columnCenter(column), grid.rowCenter(row)};
        const Point3 target{center.x, center.y, plane.heightAt(center)};
        const Vec3 offset = target - plane.origin;
        if (target.z >= 0 && withinRange(length(offset), laser.max_range) &&
            (target == plane.origin || laser.sees(plane.bearingOf(offset))))
            batch.add(grid.cell(column, row), target);
    }
    batch.look(world, plane.origin);
    std::vector<std::uint32_t> cells;
    for (std::size_t i = 0; i < batch.cells.size(); ++i)
        if (batch.seen[i] != 0 || batch.targets[i] == plane.origin) cells.push_back(batch.cells[i]);
    return cells;
}

}  // namespace

VisibleCells visibleCells(const Grid& grid, const RayWorld& world, Point3 origin,
                          double max_range) {
    std::vector<std::vector<VisibleCells::Entry>> rows(static_cast<std::size_t>(grid.rows));
    tbb::parallel_for(0, grid.rows, [&](int row) {
        rows[static_cast<std::size_t>(row)] = visibleInRow(grid, world, origin, max_range, row);
    });
    VisibleCells visible;
    std::size_t count = 0;
    for (const auto& row : rows) count += row.size();
    visible.entries.reserve(count);
    for (const auto& row : rows)
        visible.entries.insert(visible.entries.end(), row.begin(), row.end());
    return visible;
}

CellSet cellsInFan(const Grid& grid, const VisibleCells& visible, const Laser& laser,
                   Angle heading) {
    CellSet cells(grid.size());
    for (const VisibleCells::Entry& entry : visible.entries)
        if (withinRange(static_cast<double>(entry.distance), laser.max_range) &&
            (entry.distance == 0 || laser.sees(Angle::degrees(entry.direction) - heading)))
            cells.set(entry.cell);
    return cells;
}

CellSet cellsSeen(const Grid& grid, const RayWorld& world, const PlacedLaser& sensor) {
    const Pose3& pose = sensor.pose;
    if (pose.isLevel()) {
        const VisibleCells visible =
            visibleCells(grid, world, pose.position, sensor.laser.max_range);
        return cellsInFan(grid, visible, sensor.laser, pose.heading);
    }
    CellSet cells(grid.size());
    const ScanPlane plane(pose);
    if (plane.up == 0) return cells;  // seen from above, an upright plane is a line
    std::vector<std::vector<std::uint32_t>> rows(static_cast<std::size_t>(grid.rows));
    tbb::parallel_for(0, grid.rows, [&](int row) {
        rows[static_cast<std::size_t>(row)] = seenInRow(grid, world, sensor.laser, plane, row);
    });
    for (const auto& row : rows)
        for (const std::uint32_t cell : row) cells.set(cell);
    return cells;
}

}  // namespace ispace

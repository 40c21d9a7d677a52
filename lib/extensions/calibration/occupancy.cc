// SPDX-License-Identifier: GPL-3.0-or-later
// Odds are sums of constant changes (kHit, kPassed) and are clamped: the order of the scans counts,
// as in every clamped map, and equal logs give equal maps. Four bytes a cell while the map is made,
// at most 1e9 cells.
#include "extensions/calibration/occupancy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "extensions/reality/log.h"

namespace ispace::calibration {

namespace {

/// Changes of the log odds by a return and by a beam that passes, and their bounds: a person in one
/// scan is erased by the next ones, a wall is not erased by single beams beside it.
constexpr float kHit = 0.85F, kPassed = -0.4F, kMostOdds = 5, kLeastOdds = -4;

/// Log odds of occupied cells (probability 0.65, as of map_server), and of free ones: at least one
/// beam more passed than returned.
constexpr float kOccupied = 0.62F, kFree = -0.3F;

/// Cells around all returns.
constexpr int kMargin = 4;

bool returns(const PosedScan& scan, float range) {
    return std::isfinite(range) && range > 0 && range < scan.max_range;
}

/// Calls visit(end) for each return.
template <typename Visit>
void forEachReturn(const PosedScan& scan, Visit visit) {
    for (std::size_t k = 0; k < scan.ranges.size(); ++k) {
        if (!returns(scan, scan.ranges[k])) continue;
        const Angle bearing = scan.first + static_cast<double>(k) * scan.step;
        visit(scan.pose.position +
              static_cast<double>(scan.ranges[k]) * unitVector(scan.pose.heading + bearing));
    }
}

/// Calls visit(x, y) for each cell that the line from a to b, in cells, crosses, in order
/// (Amanatides and Woo, A fast voxel traversal algorithm for ray tracing, 1987).
template <typename Visit>
void forEachCell(Point2 a, Point2 b, Visit visit) {
    const Vec2 way = b - a;
    int x = static_cast<int>(std::floor(a.x)), y = static_cast<int>(std::floor(a.y));
    const int end_x = static_cast<int>(std::floor(b.x)), end_y = static_cast<int>(std::floor(b.y));
    const int step_x = way.x > 0 ? 1 : -1, step_y = way.y > 0 ? 1 : -1;
    const double infinity = std::numeric_limits<double>::infinity();
    const double across_x = way.x == 0 ? infinity : std::abs(1 / way.x);
    const double across_y = way.y == 0 ? infinity : std::abs(1 / way.y);
    double next_x = way.x == 0 ? infinity : (x + (step_x > 0 ? 1 : 0) - a.x) / way.x;
    double next_y = way.y == 0 ? infinity : (y + (step_y > 0 ? 1 : 0) - a.y) / way.y;
    int left = std::abs(end_x - x) + std::abs(end_y - y);
    visit(x, y);
    while (left-- > 0) {
        if ((next_x < next_y && x != end_x) || y == end_y) {
            x += step_x;
            next_x += across_x;
        } else {
            y += step_y;
            next_y += across_y;
        }
        visit(x, y);
    }
}

}  // namespace

CellMap occupancyOf(std::span<const PosedScan> scans, double resolution, const std::string& file,
                    const WorkLimit& limit) {
    Box2 box;
    for (const PosedScan& scan : scans) {
        bool any = false;
        forEachReturn(scan, [&](Point2 end) {
            box.add(end);
            any = true;
        });
        if (any) box.add(scan.pose.position);
    }
    if (box.empty()) throw FormatError(Diagnostic{file, 0, 0, "no scan with a pose has a return"});
    const Point2 low{(std::floor(box.low.x / resolution) - kMargin) * resolution,
                     (std::floor(box.low.y / resolution) - kMargin) * resolution};
    const double columns = std::ceil((box.high.x - low.x) / resolution) + kMargin;
    const double rows = std::ceil((box.high.y - low.y) / resolution) + kMargin;
    constexpr double kMostCells = 1e9;
    if (!(columns * rows <= kMostCells))
        throw FormatError(Diagnostic{
            file, 0, 0,
            "the log spans " + formatFixed(columns * resolution, 0) + " x " +
                formatFixed(rows * resolution, 0) + " m, more than 1e9 cells of " +
                formatDouble(resolution) + " m: wanted a --resolution above " +
                formatFixed(
                    std::ceil(100 * resolution * std::sqrt(columns * rows / kMostCells)) / 100, 2) +
                " m"});
    const int width = static_cast<int>(columns), height = static_cast<int>(rows);
    checkCellMap(width, height, resolution, file, limit);

    CellMap map{MapCells(width, height), MapCells(width, height), resolution, {low, {}}};
    std::vector<float> odds(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
    const auto add = [&](int x, int y, float change) {
        float& cell = odds[map.free.index(x, y)];
        cell = std::clamp(cell + change, kLeastOdds, kMostOdds);
    };
    for (const PosedScan& scan : scans) {
        const Point2 origin = map.inCells(scan.pose.position);
        forEachReturn(scan, [&](Point2 end_point) {
            const Point2 end = map.inCells(end_point);
            const int end_x = static_cast<int>(std::floor(end.x));
            const int end_y = static_cast<int>(std::floor(end.y));
            forEachCell(origin, end, [&](int x, int y) {
                const int left = std::abs(x - end_x) + std::abs(y - end_y);
                if (left != 1) add(x, y, left == 0 ? kHit : kPassed);
            });
        });
    }
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float value = odds[map.free.index(x, y)];
            if (value < kFree) map.free.insert(x, y);
            if (value > kOccupied) map.occupied.insert(x, y);
        }
    return map;
}

Document readLogRoom(std::string_view bytes, const std::string& name, const ImportOptions& options,
                     const Schemas& schemas) {
    reality::Log log = reality::parseLog(bytes, name);
    std::vector<PosedScan> scans;
    std::size_t tilted = 0, lost = 0;
    for (reality::LogScan& scan : log.scans) {
        const std::optional<Pose3> pose = scan.poses.best();
        if (!pose) {
            ++lost;
        } else if (!pose->isLevel()) {
            ++tilted;
        } else {
            scans.push_back({{pose->position.onFloor(), pose->heading},
                             scan.first,
                             scan.step,
                             scan.max_range,
                             std::move(scan.ranges)});
        }
    }
    if (scans.empty())
        throw FormatError(Diagnostic{
            displayName(name), 0, 0,
            "no level scan of the log has a pose: a room is learned by lasers that move, and "
            "--calibrate finds the poses of fixed ones"});
    ImportOptions chosen = options;
    const double cell = options.resolution.value_or(kLearnedCell);
    if (!chosen.clean) chosen.clean = 3 * cell;
    ImportRecords out(schemas, name, chosen);
    if (lost > 0) out.note(countText(lost, "scan") + " without a pose left out");
    if (tilted > 0) out.note(countText(tilted, "scan") + " that are not level left out");
    const std::string file = displayName(name);
    writeCellMap(occupancyOf(scans, cell, file, options.max_work),
                 {file, "the scans of the log see no floor"}, chosen, out);
    return out.take();
}

}  // namespace ispace::calibration

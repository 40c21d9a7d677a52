// SPDX-License-Identifier: GPL-3.0-or-later
// Cells that sensors see in other storeys. A cell counts if the line from its centre to the eye
// passes each floor between within an opening, and not nearer than a micrometre to its rim.
#include "site/storey_sight.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>
#include <variant>

#include "coverage/outside_view.h"
#include "coverage/plane_cells.h"
#include "geom/predicates.h"
#include "geom/visibility/visibility.h"
#include "scene/sensor/field_of_view.h"

namespace ispace {

namespace {

/// Points closer to the rim of an opening lie on it, metres: poses are rounded in files.
constexpr double kRim = 1e-6;

bool isWellInside(const Polygon& outline, Point2 p) {
    if (locate(outline, p) != Side::Inside) return false;
    for (std::size_t i = 0; i < outline.size(); ++i)
        if (distance(p, Segment2{outline[i], outline[(i + 1) % outline.size()]}) < kRim)
            return false;
    return true;
}

}  // namespace

StoreySight::StoreySight(const Coupling& coupling, double plane)
    : coupling_(coupling),
      building_(coupling.building()),
      plane_(plane),
      bounds_(building_, coupling.openings()),
      rooms_(building_.scenes.size()) {}

bool StoreySight::maySee(std::size_t from, const Sensor& sensor, std::size_t to) const {
    const auto& storeys = building_.document.storeys;
    if (!seesOutside(sensor)) return false;
    const double rise = storeys[to].floor - storeys[from].floor;
    if (std::fabs(rise) > kSightBetweenStoreys || (rise > 0 && !(plane_ > kRayEpsilon)))
        return false;
    const std::vector<std::size_t> between = bounds_.between(from, to);
    return !between.empty() && bounds_.maySee(between, from, to, sensor, plane_);
}

/// Returns rows and columns with all cells that are seen through openings of all these floors.
CellWindow StoreySight::windowThrough(const Grid& grid, Point3 eye, std::span<const Passed> floors,
                                      double plane) {
    CellWindow window{0, grid.rows, 0, grid.columns};
    for (const Passed& floor : floors) {
        const double share = (floor.height - eye.z) / (plane - eye.z);
        if (!(share > 0)) continue;
        Box2 box;
        for (const Polygon& outline : floor.outlines)
            for (const Point2 p : outline)
                box.add(eye.onFloor() + (1 / share) * (p - eye.onFloor()));
        if (box.empty()) return {0, 0, 0, 0};
        box = box.expanded(kRim);
        const GridAxis rows = GridAxis::rowsOf(grid), columns = GridAxis::columnsOf(grid);
        window.first_row = std::max(window.first_row, rows.firstNotBelow(box.low.y));
        window.end_row = std::min(window.end_row, rows.firstAbove(box.high.y));
        window.first_column = std::max(window.first_column, columns.firstNotBelow(box.low.x));
        window.end_column = std::min(window.end_column, columns.firstAbove(box.high.x));
    }
    return window;
}

/// In the frame of the storey that is seen.
std::vector<StoreySight::Passed> StoreySight::floorsBetween(std::size_t from,
                                                            std::size_t to) const {
    const auto& storeys = building_.document.storeys;
    const std::vector<std::size_t> between = bounds_.between(from, to);
    const auto is_here = [&](std::size_t storey) {
        return std::find(between.begin(), between.end(), storey) != between.end();
    };
    std::map<double, std::vector<Polygon>> floors;
    for (const FloorOpening& opening : coupling_.openings()) {
        const double floor = storeys[opening.above].floor;
        if (!is_here(opening.above) || floor <= storeys[between.front()].floor) continue;
        Polygon outline = opening.outline;
        for (Point2& p : outline) p = inStorey(storeys[to], p);
        floors[floor - storeys[to].floor].push_back(std::move(outline));
    }
    std::vector<Passed> passed;
    passed.reserve(floors.size());
    for (auto& [height, outlines] : floors) passed.push_back({height, std::move(outlines)});
    return passed;
}

void StoreySight::look(std::size_t from, std::span<const Sensor> turned, std::size_t to,
                       const Grid& grid, CellParts& parts) const {
    const Storey& own = building_.document.storeys[from];
    const Storey& seen = building_.document.storeys[to];
    parts.runs.clear();
    parts.first.assign(turned.size() + 2, 0);
    const Point3 at = turned.front().pose.position;
    if (coupling_.isInsideSolid(from, at)) return;
    const Pose2 seen_from_own{inStorey(seen, own.building_from_storey.position),
                              own.building_from_storey.heading - seen.building_from_storey.heading};
    std::vector<FieldOfView> views;
    for (const Sensor& sensor : turned) {
        OutsideView view = moved({sensor, {}, {}}, seen_from_own, own.floor - seen.floor);
        std::visit(
            [](auto& model) { model.max_range = std::min(model.max_range, kSightBetweenStoreys); },
            view.sensor.model);
        views.push_back(*fieldOfView(view.sensor));
    }
    // Only through openings of all floors between, not past the outlines of floors.
    const Point3 eye = views.front().frame.origin;
    const std::vector<Passed> floors = floorsBetween(from, to);
    const CellWindow window = windowThrough(grid, eye, floors, plane_);
    if (window.first_row >= window.end_row || window.first_column >= window.end_column) return;
    const auto& room = rooms_[to].get(
        [&] { return std::make_shared<const SurroundedRoom>(*coupling_.surroundings(to)); });
    cellsByView(grid, room->mesh(), views, plane_, parts, {.window = window});
    const auto is_in_frame = [&](std::size_t cell) {
        const Point2 place = grid.center(cell);
        return std::all_of(floors.begin(), floors.end(), [&](const Passed& floor) {
            const double share = (floor.height - eye.z) / (plane_ - eye.z);
            const Point2 p = eye.onFloor() + share * (place - eye.onFloor());
            return std::any_of(floor.outlines.begin(), floor.outlines.end(),
                               [p](const Polygon& outline) { return isWellInside(outline, p); });
        });
    };
    enum class Framed : std::uint8_t { Unknown, Yes, No };
    std::vector<Framed> known(grid.size());  // several views hold a cell
    const auto is_framed = [&](std::size_t cell) {
        if (known[cell] == Framed::Unknown)
            known[cell] = is_in_frame(cell) ? Framed::Yes : Framed::No;
        return known[cell] == Framed::Yes;
    };
    CellParts framed;
    framed.first.push_back(0);
    for (std::size_t part = 0; part < parts.size(); ++part) {
        for (std::uint32_t r = parts.first[part]; r < parts.first[part + 1]; ++r)
            for (std::uint32_t cell = parts.runs[r].first; cell < parts.runs[r].end; ++cell) {
                if (!is_framed(cell)) continue;
                if (framed.runs.size() > framed.first.back() && framed.runs.back().end == cell)
                    ++framed.runs.back().end;
                else
                    framed.runs.push_back({cell, cell + 1});
            }
        framed.first.push_back(static_cast<std::uint32_t>(framed.runs.size()));
    }
    parts = std::move(framed);
}

CellSet StoreySight::cells(std::size_t from, Sensor sensor, std::size_t to, const Grid& grid,
                           double density) const {
    sensor.mount.reset();
    sensor.person.reset();
    if (Camera* const camera = std::get_if<Camera>(&sensor.model); camera != nullptr && density > 0)
        *camera = withDensity(*camera, density);
    if (!maySee(from, sensor, to)) return CellSet(grid.size());
    CellParts parts;
    look(from, {&sensor, 1}, to, grid, parts);
    return parts.runs.empty() ? CellSet(grid.size()) : cellsOf(parts, 0, grid.size());
}

}  // namespace ispace

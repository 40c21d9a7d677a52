// SPDX-License-Identifier: GPL-3.0-or-later
// A piece of furniture that moves changes a view only in its shadow before and after, seen from the
// lens. Cells there are cast anew, all others keep their state, but for level lasers and sensors
// above the piece, whose views are computed anew; counts of sensors by cell are changed, read, and
// changed back. Not safe for several threads at once: the counts are shared.
#include "extensions/advice/suggested_moves.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <utility>
#include <variant>

#include "arrange/sensor_group.h"
#include "coverage/changed_cells.h"
#include "coverage/visible_area.h"
#include "env/level.h"
#include "scene/sensor/ultrasound.h"
#include "sense/scan.h"

namespace ispace::advice {

namespace {

/// Errors of cells along the outlines of shadows cancel out but for some.
constexpr double kShadowErrorCells = 16;

CellChanges changesBetween(const CellSet& before, const CellSet& after) {
    CellChanges changes;
    const auto list = [](const CellSet& some, const CellSet& others) {
        CellSet rest = some;
        rest -= others;
        std::vector<std::uint32_t> cells;
        rest.forEach(
            [&cells](std::size_t cell) { cells.push_back(static_cast<std::uint32_t>(cell)); });
        return cells;
    };
    changes.gained = list(after, before);
    changes.lost = list(before, after);
    return changes;
}

Sensor withDensityOf(Sensor sensor, double density) {
    if (auto* camera = std::get_if<Camera>(&sensor.model)) *camera = withDensity(*camera, density);
    return sensor;
}

}  // namespace

bool MoveTrials::areKnown(const Scene& scene, const Coverage& coverage,
                          const SuggestOptions& options) {
    if (!options.requirements.empty() || !options.facing.empty() || !options.privacy.empty())
        return false;
    const bool are_own =
        std::all_of(coverage.sensors.begin(), coverage.sensors.end(),
                    [&](const SensorView& view) { return view.index < scene.sensors.size(); });
    return are_own && options.measure.cells_by == CellRule::Region;
}

MoveTrials::MoveTrials(const Scene& scene, const Coverage& coverage, const SuggestOptions& options)
    : scene_(scene), plane_(options.measure.plane) {
    const Environment& environment = scene.environment;
    target_ = coverage.target;
    cell_ = target_.grid.cellArea();
    if (coverage.report.coverage.exact) error_ = kShadowErrorCells * cell_;
    const VisibleArea sight(environment, plane_);
    times_.resize(target_.grid.size());
    heard_.resize(target_.grid.size());
    views_.reserve(coverage.sensors.size());
    for (const SensorView& view : coverage.sensors)
        addView(withDensityOf(scene.sensors[view.index], options.measure.density), sight,
                view.cells);
}

void MoveTrials::addView(const Sensor& sensor, const VisibleArea& sight, const CellSet& cells) {
    const Point3 place = sensor.pose.position;
    Box2 reach = sight.boxOf(sensor);
    reach.add(place.onFloor());
    const bool is_buried =
        !scansSlice(sensor) && sight.levelAt(place.z)->isInsideSolid(place.onFloor());
    const bool is_partial = isPartial(sensor.model);
    cells.forEach([&](std::size_t cell) { ++(is_partial ? heard_ : times_)[cell]; });
    views_.push_back({sensor, reach, is_partial, is_buried, &cells});
}

bool MoveTrials::isCovered(std::size_t cell) const {
    return times_[cell] > 0 || heard_[cell] >= static_cast<std::int32_t>(kMinReceivers);
}

std::optional<double> MoveTrials::gainIn(const Environment& changed) {
    const auto bodies = ChangedBodies::between(scene_.environment, changed);
    if (!bodies) return std::nullopt;
    std::vector<const View*> near;
    for (const View& view : views_)
        if (bodies->meet(view.reach)) near.push_back(&view);
    RayScenes worlds(changed);
    const VisibleArea sight(changed, plane_, &worlds);
    for (const View* const view : near) sight.prepare(view->sensor);
    std::vector<CellChanges> changes(near.size());
    tbb::parallel_for(std::size_t{0}, near.size(), [&](std::size_t i) {
        tbb::this_task_arena::isolate([&] {
            const View& view = *near[i];
            const Point3 eye = view.sensor.pose.position;
            const auto field = fieldOfView(view.sensor);
            const bool is_local = !scansSlice(view.sensor) && field &&
                                  !bodies->meet(Box2{eye.onFloor(), eye.onFloor()});
            if (!is_local)
                changes[i] = changesBetween(*view.cells, sight.cellsOf(target_.grid, view.sensor));
            else if (!view.is_buried)
                changes[i] =
                    changesIn(bodies->shadowsOn(target_.grid, eye, plane_), target_.grid,
                              sight.meshFor(view.sensor.model), *field, plane_, *view.cells);
        });
    });
    std::vector<std::uint32_t> touched;
    for (const CellChanges& one : changes)
        for (const auto& cells : {one.gained, one.lost})
            touched.insert(touched.end(), cells.begin(), cells.end());
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    const auto covered = [&] {
        return std::count_if(touched.begin(), touched.end(), [this](std::uint32_t cell) {
            return target_.indoor.test(cell) && isCovered(cell);
        });
    };
    const auto apply = [&](int by) {
        for (std::size_t i = 0; i < near.size(); ++i) {
            std::vector<std::int32_t>& counts = near[i]->is_partial ? heard_ : times_;
            for (const std::uint32_t cell : changes[i].gained) counts[cell] += by;
            for (const std::uint32_t cell : changes[i].lost) counts[cell] -= by;
        }
    };
    const auto before = covered();
    apply(1);
    const auto after = covered();
    apply(-1);
    return cell_ * static_cast<double>(after - before);
}

}  // namespace ispace::advice

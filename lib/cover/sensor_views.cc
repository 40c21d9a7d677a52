// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/metrics.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>

#include "base/error.h"
#include "cover/sight.h"
#include "sense/scan.h"
#include "sense/ultrasound.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

SensorView viewOf(const Sensor& sensor, std::size_t index) {
    return {.kind = &kindOf(sensor.model),
            .index = index,
            .id = sensor.id,
            .model = deviceName(sensor.model),
            .pose = sensor.pose,
            .max_range = maxRange(sensor.model)};
}

/// Cells whose centre lies in the polygon through the sensor and the ends of its beams, seen from
/// above; a beam without return ends at max_range (thesis, section 4.5.2). `beams` as of castBeams.
CellSet cellsAmongBeams(const Grid& grid, const Sensor& sensor, std::span<const float> beams) {
    const Point3 origin = sensor.pose.position;
    Polygon outline;
    outline.reserve(beams.size() + 1);
    for (std::size_t k = 0; k < beams.size(); ++k) {
        const double range = std::min(static_cast<double>(beams[k]), sensor.as<Laser>().max_range);
        const Vec3 beam = sensor.pose.beam(sensor.as<Laser>().bearing(static_cast<int>(k)));
        outline.push_back((origin + range * beam).onFloor());
    }
    if (sensor.as<Laser>().span() < Angle::degrees(360)) outline.push_back(origin.onFloor());
    const std::vector<Polygon> curves = {std::move(outline)};
    return cellsWithin(grid, curves);
}

/// Fills in the views of a scene's sensors.
class Viewer {
  public:
    Viewer(const Scene& scene, Worlds& worlds, const Grid& grid, const CoverageOptions& options)
        : scene_(scene), worlds_(worlds), grid_(grid), options_(options) {}

    std::vector<SensorView> run() {
        makeViews();
        tbb::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t i) {
            // Whoever waits for others in here does not begin with another sensor.
            tbb::this_task_arena::isolate([&] { look(views_[i]); });
        });
        return std::move(views_);
    }

  private:
    void makeViews() {
        for (std::size_t i = 0; i < scene_.sensors.size(); ++i) {
            const Sensor& sensor = scene_.sensors[i];
            if (!kindOf(sensor.model).perceives) continue;
            views_.push_back(viewOf(sensor, i));
            if (sensor.is<Laser>()) worlds_.prepare(sensor.pose);
            sight_.prepare(sensor);
        }
        std::stable_sort(views_.begin(), views_.end(),
                         [&](const SensorView& a, const SensorView& b) {
                             return sensorOf(a).model.index() < sensorOf(b).model.index();
                         });
    }
    [[nodiscard]] const Sensor& sensorOf(const SensorView& view) const {
        return scene_.sensors[view.index];
    }

    [[nodiscard]] bool isBuried(const Sensor& sensor) const {
        const Point3 place = sensor.pose.position;
        return sight_.levelAt(place.z)->isBuried(place.onFloor());
    }

    void look(SensorView& view) const {
        const Sensor& sensor = sensorOf(view);
        const Laser* laser = std::get_if<Laser>(&sensor.model);
        if (laser != nullptr) view.beams = castBeams(worlds_.at(sensor.pose), sensor);
        // Beams are those of one scan: of a sweep they outline nothing.
        const bool by_beams = laser != nullptr && options_.cells_by == CellRule::Beams &&
                              laser->sweep == SweepAxis::None;
        view.cells = by_beams && (scansSlice(sensor) || !isBuried(sensor))
                         ? cellsAmongBeams(grid_, sensor, view.beams)
                         : sight_.cellsOf(grid_, sensor);
        if (!options_.exact) return;
        try {
            view.region = sight_.regionOf(sensor);
        } catch (const FormatError&) {
            view.region.reset();  // more shadows than can be laid over each other
        }
    }

    const Scene& scene_;
    Worlds& worlds_;
    const Grid& grid_;
    const CoverageOptions& options_;
    Sight sight_{scene_.environment, options_.plane, &worlds_};
    std::vector<SensorView> views_;
};

/// Where at least kMinReceivers hear.
SeenSet heardByEnough(const std::vector<const SensorView*>& receivers, const Grid& grid) {
    SeenSet set;
    set.cells = CellSet(grid.size());
    std::vector<std::uint16_t> heard(grid.size());
    for (const SensorView* view : receivers)
        view->cells.forEach([&](std::size_t cell) {
            if (++heard[cell] == kMinReceivers) set.cells.set(cell);
        });
    set.region = regionHeardByEnough(receivers);
    return set;
}

}  // namespace

std::vector<SensorView> viewsOf(const Scene& scene, Worlds& worlds, const Grid& grid,
                                const CoverageOptions& options) {
    return Viewer(scene, worlds, grid, options).run();
}

std::optional<std::vector<Curve>> regionHeardByEnough(
    std::span<const SensorView* const> receivers) {
    std::vector<Layer> layers;
    layers.reserve(receivers.size());
    for (const SensorView* view : receivers) {
        if (!view->region) return std::nullopt;
        layers.push_back({.curves = *view->region});
    }
    try {
        return Overlay(layers).curves([](const LayerLabel& label) {
            return label.count >= static_cast<std::int32_t>(kMinReceivers);
        });
    } catch (const FormatError&) {
        return std::nullopt;
    }
}

std::vector<SeenSet> setsOf(const std::vector<SensorView>& views, const Grid& grid) {
    std::vector<SeenSet> sets;
    std::vector<const SensorView*> receivers;
    for (const SensorView& view : views) {
        if (view.isPartial())
            receivers.push_back(&view);
        else
            sets.push_back({view.cells, view.region});
    }
    if (!receivers.empty()) sets.push_back(heardByEnough(receivers, grid));
    return sets;
}

}  // namespace ispace

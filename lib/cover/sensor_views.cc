// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/sensor_views.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <map>
#include <memory>

#include "base/error.h"
#include "cover/plane_view.h"
#include "cover/visible.h"
#include "sense/scan.h"
#include "sense/ultrasound.h"
#include "sense/warnings.h"
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

/// Fills in the views of a scene's sensors.
class Viewer {
  public:
    Viewer(const Scene& scene, Worlds& worlds, const Grid& grid, const CoverageOptions& options)
        : scene_(scene), worlds_(worlds), grid_(grid), options_(options) {}

    std::vector<SensorView> run() {
        makeViews();
        std::vector<std::size_t> on_planes;
        std::map<double, std::vector<std::size_t>> by_height;
        for (std::size_t i = 0; i < views_.size(); ++i) {
            if (scansSlice(sensorOf(views_[i])))
                by_height[views_[i].pose.position.z].push_back(i);
            else
                on_planes.push_back(i);
        }
        lookInSlices({by_height.begin(), by_height.end()});
        lookAtPlanes(on_planes);
        return std::move(views_);
    }

  private:
    using Level = std::pair<double, std::vector<std::size_t>>;

    void makeViews() {
        for (std::size_t i = 0; i < scene_.sensors.size(); ++i) {
            const Sensor& sensor = scene_.sensors[i];
            if (!kindOf(sensor.model).perceives) continue;
            views_.push_back(viewOf(sensor, i));
            if (sensor.is<Laser>()) worlds_.prepare(sensor.pose);
        }
        std::stable_sort(views_.begin(), views_.end(),
                         [&](const SensorView& a, const SensorView& b) {
                             return sensorOf(a).model.index() < sensorOf(b).model.index();
                         });
    }
    [[nodiscard]] const Sensor& sensorOf(const SensorView& view) const {
        return scene_.sensors[view.index];
    }

    /// Each thread holds one slice after another, however many heights there are. All lines of a
    /// slice are kept, near a sensor or not, so that what one sees depends on no other, to the bit.
    void lookInSlices(const std::vector<Level>& levels) {
        tbb::parallel_for(std::size_t{0}, levels.size(), [&](std::size_t k) {
            const auto& [height, members] = levels[k];
            const SliceSight sight(scene_.environment.slice(height));
            // Whoever waits for the others here does not begin with another slice.
            tbb::this_task_arena::isolate([&, &members = members] {
                tbb::parallel_for(std::size_t{0}, members.size(),
                                  [&](std::size_t i) { lookInSlice(views_[members[i]], sight); });
            });
        });
    }

    /// Beams are those of one scan: of a sweep they outline nothing.
    [[nodiscard]] bool byBeams(const Sensor& sensor) const {
        return options_.cells_by == CellRule::Beams && sensor.as<Laser>().sweep == SweepAxis::None;
    }

    void lookInSlice(SensorView& view, const SliceSight& sight) const {
        const Sensor& sensor = sensorOf(view);
        view.beams = castBeams(worlds_.at(sensor.pose), sensor);
        view.cells = byBeams(sensor) ? cellsAmongBeams(grid_, sensor, view.beams)
                                     : cellsSeen(grid_, sight, sensor);
        if (options_.exact) view.region = regionSeen(sight, sensor);
    }

    void lookAtPlanes(const std::vector<std::size_t>& members) {
        if (members.empty()) return;
        for (const std::size_t i : members) worlds_.prepareMesh(views_[i].kind->stopped_by);
        std::unique_ptr<const ShadowCaster> shadows;
        if (options_.exact) shadows = std::make_unique<ShadowCaster>(scene_.environment);
        SolidJudge judge(scene_.environment);
        std::vector<char> is_buried(members.size());
        for (std::size_t i = 0; i < members.size(); ++i)
            is_buried[i] = judge.isInside(views_[members[i]].pose.position) ? 1 : 0;
        tbb::parallel_for(std::size_t{0}, members.size(), [&](std::size_t i) {
            SensorView& view = views_[members[i]];
            lookAtPlane(view);
            if (is_buried[i] != 0) {  // it sees nothing, as in a slice
                view.cells = CellSet(grid_.size());
                if (shadows != nullptr) view.region.emplace();
                return;
            }
            if (shadows != nullptr) addRegion(view, *shadows);
        });
    }

    void lookAtPlane(SensorView& view) const {
        const double plane = options_.plane;
        const Sensor& sensor = sensorOf(view);
        if (sensor.is<Laser>()) {
            view.beams = castBeams(worlds_.at(sensor.pose), sensor);
            if (byBeams(sensor)) {
                view.cells = cellsAmongBeams(grid_, sensor, view.beams);
                return;
            }
        }
        view.cells = cellsSeen(grid_, worlds_.mesh(view.kind->stopped_by), sensor, plane);
    }

    void addRegion(SensorView& view, const ShadowCaster& shadows) const {
        try {
            view.region = shadows.regionSeen(sensorOf(view), options_.plane);
        } catch (const FormatError&) {
            view.region.reset();  // more shadows than can be laid over each other
        }
    }

    const Scene& scene_;
    Worlds& worlds_;
    const Grid& grid_;
    const CoverageOptions& options_;
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

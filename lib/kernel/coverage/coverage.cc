// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/coverage.h"

#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <map>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "base/error.h"
#include "base/number.h"
#include "coverage/exact_shares.h"
#include "coverage/far_holes.h"
#include "coverage/metrics.h"
#include "coverage/outside_view.h"
#include "coverage/pixel_density.h"
#include "coverage/visible_area.h"
#include "env/level.h"
#include "geom/arrangement.h"
#include "geom/curve_clip.h"
#include "geom/overlay/overlay.h"
#include "raster/contour.h"
#include "scene/sensor/ultrasound.h"
#include "sense/scan.h"
#include "trace/ray_world.h"

namespace ispace {

std::uint32_t maxMultiplicity(const Coverage& coverage,
                              const std::vector<std::uint32_t>& cell_times) {
    if (!coverage.overlay) return *std::max_element(cell_times.begin(), cell_times.end());
    std::int32_t most = 0;
    for (const Overlay::Edge& edge : coverage.overlay->edges())
        most = std::max({most, edge.left.count, edge.right.count});
    return static_cast<std::uint32_t>(most);
}

std::vector<Region> viewRegions(const SensorView& view, const Grid& grid) {
    if (!view.region) return cellRegions(grid, view.cells);
    std::vector<Curve> whole = *view.region;
    whole.insert(whole.end(), view.beyond.begin(), view.beyond.end());
    const Overlay overlay(std::vector<Layer>{{.curves = std::move(whole)}});
    return withArcAreas(overlay,
                        overlay.regions([](const LayerLabel& label) { return label.count > 0; }));
}

std::vector<Region> seenBy(const Coverage& coverage, std::uint32_t times,
                           const std::vector<std::uint32_t>& cell_times) {
    if (coverage.overlay)
        return withArcAreas(*coverage.overlay,
                            coverage.overlay->regions([times](const LayerLabel& label) {
                                return label.count == static_cast<std::int32_t>(times) &&
                                       (label.marks & kIndoorMark) != 0;
                            }));
    const Target& target = coverage.target;
    CellSet cells(target.grid.size());
    target.indoor.forEach([&](std::size_t cell) {
        if (cell_times[cell] == times) cells.set(cell);
    });
    return cellRegions(target.grid, cells);
}

void setRegion(std::optional<std::vector<Curve>> region, const Box2& limits, SensorView& view) {
    view.region.reset();
    view.beyond = {};
    if (!region) return;
    CutCurves cut = cutAlong(*region, limits);
    view.region = std::move(cut.inside);
    view.beyond = std::move(cut.outside);
}

std::optional<std::vector<Curve>> regionHeardByEnough(std::span<const SensorView* const> receivers,
                                                      std::size_t most_crossings) {
    std::vector<Layer> layers;
    layers.reserve(receivers.size());
    for (const SensorView* view : receivers) {
        if (!view->region) return std::nullopt;
        layers.push_back({.curves = *view->region});
    }
    try {
        const Overlay overlay(layers, {},
                              {.label = {}, .add_area = {}, .most_crossings = most_crossings});
        return overlay.curves([](const LayerLabel& label) {
            return label.count >= static_cast<std::int32_t>(kMinReceivers);
        });
    } catch (const FormatError&) {
        return std::nullopt;
    }
}

namespace {

SensorView viewOf(const Sensor& sensor, std::size_t index) {
    return {.kind = &kindOf(sensor.model),
            .index = index,
            .id = sensor.id,
            .model = deviceName(sensor.model),
            .pose = sensor.pose,
            .max_range = maxRange(sensor.model)};
}

/// Returns the cells with their centre in the polygon through the sensor and the ends of its beams,
/// seen from above; a beam without return ends at max_range (thesis, section 4.5.2). `beams` as
/// castBeams returns them.
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

/// Runs both functions, in parallel if threads are free. A thread that waits for tasks in one does
/// not start the other: it may hold a lock that these tasks need.
template <typename F, typename G>
void runBoth(F f, G g) {
    tbb::parallel_invoke([&] { tbb::this_task_arena::isolate(f); },
                         [&] { tbb::this_task_arena::isolate(g); });
}

/// Returns a range that no level laser reaches.
double reachOfScans(const Scene& scene) {
    constexpr double kBeyond = 1.001;
    double reach = 0;
    for (const Sensor& sensor : scene.sensors)
        if (scansSlice(sensor)) reach = std::max(reach, kBeyond * maxRange(sensor.model));
    return reach;
}

/// Returns the crossings that an overlay of views may have: views of sensors in reach of each
/// other and in the light of hundreds of things cross by squares and cubes of their numbers, those
/// of a building by some hundreds each.
std::size_t mostCrossings(const CoverageOptions& options, const Slice& slice, const Scene& scene) {
    constexpr std::size_t kForAny = 500'000, kPerSensor = 2000, kPerLine = 200;
    if (options.max_work) return static_cast<std::size_t>(*options.max_work);
    const auto sensors =
        std::count_if(scene.sensors.begin(), scene.sensors.end(),
                      [](const Sensor& sensor) { return kindOf(sensor.model).perceives; });
    std::size_t lines = slice.sheets.size();
    for (const Polygon& solid : slice.solids) lines += solid.size();
    return kForAny + kPerSensor * static_cast<std::size_t>(sensors) + kPerLine * lines;
}

/// Returns the edges that all views may have together: each takes the memory of several crossings.
std::size_t mostEdges(std::size_t most_crossings) { return most_crossings / 4; }

/// Computes the view of each laser, ranger and receiver of a scene, in this order, in parallel.
/// Without exact regions if those of all views have more than `most_edges` together: hundreds of
/// sensors that see the shadows of hundreds of things.
class Viewer {
  public:
    /// \param only_regions computes neither cells, beams nor classes of density
    /// \param known of an equal environment, see exactShares()
    /// \param before a scene with views to take over, see measureChanged()
    Viewer(const Scene& scene, RayScenes& worlds, const Grid& grid, const CoverageOptions& options,
           std::size_t most_edges, bool only_regions = false, const VisibleArea* known = nullptr,
           const MeasuredScene& before = {})
        : scene_(scene),
          worlds_(worlds),
          grid_(grid),
          options_(options),
          most_(most_edges),
          only_regions_(only_regions),
          known_(known) {
        const bool is_same_room =
            before.scene != nullptr &&
            &before.scene->environment.elements() == &scene.environment.elements();
        if (!is_same_room) return;
        for (const SensorView& view : before.coverage->sensors)
            if (view.index < before.scene->sensors.size() && view.cells.size() == grid.size())
                before_.emplace(view.id, KnownView{&before.scene->sensors[view.index], &view});
    }

    /// \param progress receives each view; null: none
    std::vector<SensorView> run(Progress* progress = nullptr) {
        makeViews();
        if (progress != nullptr)
            progress->begin("views of sensors", static_cast<std::int64_t>(views_.size()));
        // Sorted by height, so that each level is built once.
        std::map<double, std::vector<std::size_t>> at_height;
        for (std::size_t i = 0; i < views_.size(); ++i)
            at_height[sensorOf(views_[i]).pose.position.z].push_back(i);
        const std::vector<std::pair<double, std::vector<std::size_t>>> groups(at_height.begin(),
                                                                              at_height.end());
        if (groups.empty()) return std::move(views_);
        const auto first = sight_.levelAt(groups.front().first);
        runBoth([&] { prepareWorlds(); }, [&] { prepareSight(*first, groups.front().second); });
        tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t k) {
            // A thread that waits in here does not start another level or sensor.
            tbb::this_task_arena::isolate([&] {
                const auto level = sight_.levelAt(groups[k].first);
                tbb::parallel_for(std::size_t{0}, groups[k].second.size(), [&](std::size_t i) {
                    tbb::this_task_arena::isolate([&] { look(views_[groups[k].second[i]]); });
                    if (progress != nullptr) progress->advance(1);
                });
            });
        });
        if (hasTooManyEdges())
            for (SensorView& view : views_) {
                view.region.reset();
                view.beyond = {};
            }
        tbb::parallel_for(std::size_t{0}, views_.size(), [&](std::size_t i) {
            const Sensor& sensor = sensorOf(views_[i]);
            if (sensor.is<Camera>() && !only_regions_ && views_[i].classes.empty())
                tbb::this_task_arena::isolate([&] { addClasses(views_[i], sensor); });
        });
        return std::move(views_);
    }

    [[nodiscard]] bool hasTooManyEdges() const { return edges_ > most_; }

  private:
    void makeViews() {
        for (std::size_t i = 0; i < scene_.sensors.size(); ++i) {
            const Sensor& sensor = scene_.sensors[i];
            if (!kindOf(sensor.model).perceives) continue;
            views_.push_back(viewOf(sensor, i));
        }
        std::stable_sort(views_.begin(), views_.end(),
                         [&](const SensorView& a, const SensorView& b) {
                             return kindRank(sensorOf(a).model) < kindRank(sensorOf(b).model);
                         });
    }
    void prepareWorlds() {
        if (only_regions_) return;
        for (const SensorView& view : views_) {
            const Sensor& sensor = sensorOf(view);
            if (sensor.is<Laser>()) worlds_.prepare(sensor.pose);
            sight_.prepare(sensor);
        }
    }
    /// Builds the index of views for level sensors at a height; others build theirs on demand.
    void prepareSight(const Level& level, const std::vector<std::size_t>& views) const {
        const bool is_used = std::any_of(views.begin(), views.end(), [&](std::size_t i) {
            return scansSlice(sensorOf(views_[i]));
        });
        if (!is_used) return;
        try {
            level.prepareSight();
        } catch (const FormatError&) {
            return;  // later calls report the error again
        }
    }
    [[nodiscard]] const Sensor& sensorOf(const SensorView& view) const {
        return scene_.sensors[view.index];
    }

    [[nodiscard]] bool isInsideSolid(const Sensor& sensor) const {
        const Point3 place = sensor.pose.position;
        return sight_.levelAt(place.z)->isInsideSolid(place.onFloor());
    }

    /// Returns the view of an equal sensor before; null without one.
    [[nodiscard]] const SensorView* viewBefore(const Sensor& sensor) const {
        const auto known = before_.find(sensor.id);
        if (known == before_.end()) return nullptr;
        return seeAlike(*known->second.sensor, sensor) ? known->second.view : nullptr;
    }

    void look(SensorView& view) {
        Sensor sensor = sensorOf(view);
        if (const SensorView* const same = viewBefore(sensor)) {
            const std::size_t index = view.index;
            view = *same;
            view.index = index;
            countEdges(view);
            return;
        }
        if (auto* camera = std::get_if<Camera>(&sensor.model)) {
            *camera = withDensity(*camera, options_.density);
            view.max_range = camera->max_range;
        }
        if (only_regions_) {
            addRegion(view, sensor);
            return;
        }
        const Laser* laser = std::get_if<Laser>(&sensor.model);
        if (laser != nullptr) view.beams = castBeams(worlds_.at(sensor.pose), sensor);
        // The beams of one scan are required: those of a sweep outline no polygon.
        const bool by_beams = laser != nullptr && options_.cells_by == CellRule::Beams &&
                              laser->sweep == SweepAxis::None;
        view.cells = by_beams && (scansSlice(sensor) || !isInsideSolid(sensor))
                         ? cellsAmongBeams(grid_, sensor, view.beams)
                         : sight_.cellsOf(grid_, sensor);
        view.cells.crop();
        if (options_.exact) addRegion(view, sensor);
    }

    void addRegion(SensorView& view, const Sensor& sensor) {
        if (hasTooManyEdges()) return;
        setRegion(regionOf(sensor), scene_.environment.limits(), view);
        countEdges(view);
    }

    void countEdges(const SensorView& view) {
        if (!view.region) return;
        for (const Curve& curve : *view.region) edges_ += curve.size();
        for (const Curve& curve : view.beyond) edges_ += curve.size();
    }

    [[nodiscard]] std::optional<std::vector<Curve>> withinLimits(
        std::optional<std::vector<Curve>> region) const {
        if (region) region = cutAlong(*region, scene_.environment.limits()).inside;
        return region;
    }

    [[nodiscard]] std::optional<std::vector<Curve>> regionOf(const Sensor& sensor) const {
        try {
            const bool is_known = known_ != nullptr && !scansSlice(sensor);
            return (is_known ? *known_ : sight_).regionOf(sensor);
        } catch (const FormatError&) {
            return std::nullopt;  // too many crossings for an overlay
        }
    }

    void addClasses(SensorView& view, const Sensor& whole) const {
        Sensor sensor = whole;
        auto& camera = std::get<Camera>(sensor.model);
        camera = withDensity(camera, options_.density);
        CoveredSet seen{view.cells, view.region};
        if (options_.density > 0) {
            seen.cells = sight_.cellsOf(grid_, whole);
            if (options_.exact && !hasTooManyEdges()) seen.region = withinLimits(regionOf(whole));
        }
        const FloorDensity density(camera, sensor.pose, options_.plane);
        try {
            view.classes = classesOf(density, grid_, seen);
        } catch (const FormatError&) {
            seen.region.reset();
            view.classes = classesOf(density, grid_, seen);
        }
    }

    const Scene& scene_;
    RayScenes& worlds_;
    const Grid& grid_;
    const CoverageOptions& options_;
    std::size_t most_;
    bool only_regions_;
    const VisibleArea* known_;
    struct KnownView {
        const Sensor* sensor;
        const SensorView* view;
    };
    std::unordered_map<std::string_view, KnownView> before_;  // by ids
    std::atomic<std::size_t> edges_ = 0;  // of all regions, or of enough of them to be too many
    VisibleArea sight_{scene_.environment, options_.plane, &worlds_, reachOfScans(scene_)};
    std::vector<SensorView> views_;
};

/// Returns the region heard by at least kMinReceivers receivers.
CoveredSet heardByEnough(const std::vector<const SensorView*>& receivers, const Grid& grid,
                         std::size_t most_crossings) {
    CoveredSet set;
    set.cells = CellSet(grid.size());
    std::vector<std::uint16_t> heard(grid.size());
    for (const SensorView* view : receivers)
        view->cells.forEach([&](std::size_t cell) {
            if (++heard[cell] == kMinReceivers) set.cells.set(cell);
        });
    set.region = regionHeardByEnough(receivers, most_crossings);
    return set;
}

/// Returns the covered sets of these views: one for each laser and ranger, then one for all
/// receivers.
std::vector<CoveredSet> setsOf(const std::vector<SensorView>& views, const Grid& grid,
                               std::size_t most_crossings) {
    std::vector<const SensorView*> receivers, others;
    for (const SensorView& view : views) (view.isPartial() ? receivers : others).push_back(&view);
    std::vector<CoveredSet> sets(others.size());
    tbb::parallel_for(std::size_t{0}, sets.size(), [&](std::size_t i) {
        sets[i] = {others[i]->cells, others[i]->region};
    });
    if (!receivers.empty()) sets.push_back(heardByEnough(receivers, grid, most_crossings));
    return sets;
}

SensorMetrics metricsOf(const Scene& scene, const SensorView& view, const Grid& grid,
                        double plane) {
    SensorMetrics metrics{.id = view.id, .model = view.model, .kind = view.kind};
    if (const auto* laser = std::get_if<Laser>(&scene.sensors[view.index].model))
        metrics.slice_area = sliceArea(*laser, view.beams);
    if (view.region) {
        metrics.area.exact = std::max(0.0, signedArea(*view.region));
        metrics.outside = std::max(0.0, signedArea(view.beyond));
    }
    if (const auto* camera = std::get_if<Camera>(&scene.sensors[view.index].model))
        metrics.picture = pictureMetricsOf(FloorDensity(*camera, view.pose, plane), grid,
                                           view.pose.position.onFloor(), view);
    return metrics;
}

/// Memory: two bits a sensor and cell, one of the view and one of the covered set.
void mustFit(const Scene& scene, const Grid& grid) {
    constexpr double kMaxBytes = 8e9;
    const auto sensors =
        std::count_if(scene.sensors.begin(), scene.sensors.end(),
                      [](const Sensor& sensor) { return kindOf(sensor.model).perceives; });
    const double bytes = static_cast<double>(sensors) * static_cast<double>(grid.size()) / 4;
    if (bytes > kMaxBytes)
        throw UsageError("cells of all sensors take " + formatFixed(bytes / 1e9, 1) +
                         " GB: use fewer cells");
}

/// Computes the exact metrics, or stores the reason why they are missing.
void tryExactMetrics(Coverage& coverage, const Environment& environment, FarHoles& holes,
                     const std::vector<Zone>& zones, bool keep_depths, std::size_t most_crossings) {
    std::string& missing = coverage.report.exact_missing;
    if (!missing.empty()) return;
    for (const SensorView& view : coverage.sensors)
        if (!view.region) {
            missing = "what " + view.id + " sees is known by cells only";
            return;
        }
    for (const CoveredSet& set : coverage.sets)
        if (!set.region) {
            missing = "what enough receivers hear is known by cells only";
            return;
        }
    try {
        addExactMetrics(coverage, environment, holes, zones, keep_depths, most_crossings);
    } catch (const FormatError& error) {
        missing = error.diagnostics().front().message;
    }
}

/// Computes the area beyond the limits that any sensor sees; empty if a region is not known.
std::optional<double> outsideOf(const std::vector<SensorView>& views, std::size_t most_crossings) {
    std::vector<Layer> layers;
    std::vector<SensorView> receivers;
    for (const SensorView& view : views) {
        if (!view.region) return std::nullopt;
        if (view.beyond.empty()) continue;
        if (view.isPartial())
            receivers.emplace_back().region = view.beyond;
        else
            layers.push_back({.curves = view.beyond});
    }
    if (receivers.size() >= kMinReceivers) {
        std::vector<const SensorView*> all;
        all.reserve(receivers.size());
        for (const SensorView& view : receivers) all.push_back(&view);
        auto heard = regionHeardByEnough(all, most_crossings);
        if (!heard) return std::nullopt;
        layers.push_back({.curves = std::move(*heard)});
    }
    if (layers.empty()) return 0;
    if (layers.size() == 1) return std::max(0.0, signedArea(layers.front().curves));
    double area = 0;
    try {
        forEachArea(
            layers,
            [&area](const LayerLabel& label, double part) {
                if (label.count > 0) area += part;
            },
            most_crossings);
    } catch (const FormatError&) {
        return std::nullopt;
    }
    return std::max(0.0, area);
}

/// Labels of the two layouts' layers, kept apart by their numbers.
constexpr std::int64_t kThisNumber = 1, kOtherNumber = std::int64_t{1} << 32;

void addLayers(const Coverage& coverage, std::int64_t number, std::vector<Layer>& layers) {
    for (const CoveredSet& set : coverage.sets)
        layers.push_back({.curves = *set.region, .number = number});
}

void compareExactly(const Coverage& coverage, const Coverage& other, const Regions& indoor,
                    Comparison& comparison) {
    std::vector<Layer> layers;
    layers.reserve(coverage.sets.size() + other.sets.size() + 1);
    addLayers(coverage, kThisNumber, layers);
    addLayers(other, kOtherNumber, layers);
    layers.push_back({.curves = curvesWithArcs(indoor), .counts = false, .marks = kIndoorMark});
    double gained = 0, lost = 0;
    try {
        forEachArea(layers, [&](const LayerLabel& label, double area) {
            if (label.count == 0 || (label.marks & kIndoorMark) == 0) return;
            if (label.numbers < kOtherNumber) gained += area;
            if (label.numbers % kOtherNumber == 0) lost += area;
        });
    } catch (const FormatError&) {
        return;  // each layout fits an overlay, but not both together
    }
    comparison.gained.exact = std::max(0.0, gained);
    comparison.lost.exact = std::max(0.0, lost);
}

/// Appends the views from outside and restores the order of views, by kind.
void addOutside(std::span<const std::shared_ptr<const OutsideView>> outside, std::size_t own,
                const CoverageOptions& options, Coverage& coverage, const Grid& grid,
                const Scene& scene) {
    if (outside.empty()) return;
    for (std::size_t i = 0; i < outside.size(); ++i)
        coverage.sensors.push_back(
            sensorViewOf(*outside[i], own + i, grid, scene.environment.limits(), options));
    std::stable_sort(coverage.sensors.begin(), coverage.sensors.end(),
                     [&](const SensorView& a, const SensorView& b) {
                         return kindRank(scene.sensors[a.index].model) <
                                kindRank(scene.sensors[b.index].model);
                     });
}

/// \param scene with the sensors outside after its own
Coverage measure(const Scene& scene, const Scene& own, RayScenes& worlds,
                 const CoverageOptions& options,
                 std::span<const std::shared_ptr<const OutsideView>> outside,
                 const MeasuredScene& before = {}, Progress* progress = nullptr) {
    const Environment& environment = scene.environment;
    Coverage coverage;
    const Grid grid = gridOver(environment.limits(), options.cells);
    mustFit(scene, grid);
    const auto level = environment.level(options.height);
    CoverageReport& report = coverage.report;
    std::optional<FarHoles> holes;
    const std::size_t most_crossings = mostCrossings(options, level->slice(), scene);
    runBoth(
        [&] {
            const std::size_t most_edges = mostEdges(most_crossings);
            Viewer viewer(own, worlds, grid, options, most_edges, false, nullptr, before);
            coverage.sensors = viewer.run(progress);
            if (viewer.hasTooManyEdges())
                report.exact_missing = "outlines of views have more than " +
                                       std::to_string(most_edges) + " edges (`--max-work " +
                                       std::to_string(2 * most_crossings) + "` allows more)";
        },
        [&] {
            coverage.target = makeTarget(environment, options.cells, options.height);
            report.free_area = totalArea(level->freeFloor());
            if (options.exact)
                holes.emplace(environment.indoor(), level->freeFloor(), level->slice().sheets);
            static_cast<void>(scene.digest());  // cached, in parallel with the views
        });
    // Steps of about the same cost with many sensors.
    constexpr std::int64_t kSteps = 4;
    if (progress != nullptr) progress->begin("areas of views", kSteps);
    const auto step = [progress] {
        if (progress != nullptr) progress->advance(1);
    };
    addOutside(outside, own.sensors.size(), options, coverage, grid, scene);
    coverage.sets = setsOf(coverage.sensors, grid, most_crossings);
    step();

    report.digest = scene.digest();
    report.limits = environment.limits();
    report.grid = grid;
    report.height = options.height;
    report.plane = options.plane;
    report.density = options.density;
    report.indoor_area = environment.indoor().area();
    report.sensors.reserve(coverage.sensors.size());
    for (const SensorView& view : coverage.sensors)
        report.sensors.push_back(metricsOf(scene, view, grid, options.plane));
    const std::vector<Zone> zones = zonesOf(environment);
    report.zones = zoneMetricsOf(environment, zones);
    if (options.exact) report.outside = outsideOf(coverage.sensors, most_crossings);
    step();
    if (holes)
        tryExactMetrics(coverage, environment, *holes, zones, options.keep_depths, most_crossings);
    step();
    addCellMetrics(coverage, zones);
    addDensities(coverage, environment, level->freeFloor(), zones, options.whole_densities);
    if (options.parallax) addParallax(coverage, environment, *options.parallax);
    step();
    if (progress != nullptr) progress->end();
    return coverage;
}

}  // namespace

Coverage measureCoverage(const Scene& scene, RayScenes& worlds, const CoverageOptions& options,
                         Progress* progress) {
    return measure(scene, scene, worlds, options, {}, {}, progress);
}

Coverage measureChanged(const Scene& scene, RayScenes& worlds, const CoverageOptions& options,
                        const MeasuredScene& before) {
    return measure(scene, scene, worlds, options, {}, before);
}

std::optional<Coverage> exactShares(const Scene& scene, RayScenes& worlds,
                                    const CoverageOptions& options, const VisibleArea* sight) {
    if (!options.exact) return std::nullopt;
    const Environment& environment = scene.environment;
    Coverage coverage;
    const auto level = environment.level(options.height);
    CoverageReport& report = coverage.report;
    coverage.target.grid = report.grid = gridOver(environment.limits(), options.cells);
    coverage.target.height = options.height;
    const std::size_t most_crossings = mostCrossings(options, level->slice(), scene);
    coverage.sensors =
        Viewer(scene, worlds, report.grid, options, mostEdges(most_crossings), true, sight).run();
    for (const SensorView& view : coverage.sensors) {
        if (view.isPartial() || !view.region) return std::nullopt;
        coverage.sets.push_back({CellSet(), view.region});
        SensorMetrics& metrics =
            report.sensors.emplace_back(SensorMetrics{.id = view.id, .model = view.model});
        metrics.kind = view.kind;
        metrics.area.exact = std::max(0.0, signedArea(*view.region));
    }
    FarHoles holes(environment.indoor(), level->freeFloor(), level->slice().sheets);
    report.free_area = totalArea(level->freeFloor());
    report.digest = scene.digest();
    report.limits = environment.limits();
    report.height = options.height;
    report.plane = options.plane;
    report.density = options.density;
    report.indoor_area = environment.indoor().area();
    const std::vector<Zone> zones = zonesOf(environment);
    report.zones = zoneMetricsOf(environment, zones);
    try {
        addExactShares(coverage, environment, holes, zones, options.keep_depths, most_crossings);
    } catch (const FormatError&) {
        return std::nullopt;
    }
    return coverage;
}

Coverage measureWithOutside(const Scene& scene, RayScenes& worlds, const CoverageOptions& options,
                            std::span<const std::shared_ptr<const OutsideView>> outside,
                            Progress* progress) {
    if (outside.empty()) return measureCoverage(scene, worlds, options, progress);
    Scene joined = scene;
    for (const auto& view : outside) joined.sensors.push_back(view->sensor);
    return measure(joined, scene, worlds, options, outside, {}, progress);
}

void compare(Coverage& coverage, const Coverage& other, const Regions& indoor,
             const std::string& name) {
    assert(coverage.target.grid == other.target.grid);
    Comparison comparison{.name = name, .coverage = other.report.coverage};
    const double cell_area = coverage.target.grid.cellArea();
    const CellSet& inside = coverage.target.indoor;
    const auto area_without = [&](CellSet cells, const CellSet& without) {
        cells -= without;
        return static_cast<double>(countCommon(cells, inside)) * cell_area;
    };
    const CellSet mine = coveredCells(coverage), theirs = coveredCells(other);
    comparison.gained.grid = area_without(mine, theirs);
    comparison.lost.grid = area_without(theirs, mine);
    if (coverage.overlay && other.overlay) compareExactly(coverage, other, indoor, comparison);
    coverage.report.comparison = comparison;
}

std::vector<std::uint32_t> timesSeen(const Coverage& coverage) {
    std::vector<std::uint32_t> times(coverage.target.grid.size());
    for (const CoveredSet& set : coverage.sets)
        set.cells.forEach([&times](std::size_t cell) { ++times[cell]; });
    return times;
}

CellSet coveredCells(const Coverage& coverage) {
    CellSet covered(coverage.target.grid.size());
    for (const CoveredSet& set : coverage.sets) covered |= set.cells;
    return covered;
}

std::optional<double> coveredShare(const CellSet& covered, const CellSet& target) {
    const std::size_t all = target.count();
    if (all == 0) return std::nullopt;
    return static_cast<double>(countCommon(covered, target)) / static_cast<double>(all);
}

}  // namespace ispace

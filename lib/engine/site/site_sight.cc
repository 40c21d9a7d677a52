// SPDX-License-Identifier: GPL-3.0-or-later
// Views between storeys, each computed once.
//
// A view is the shadow region of a sensor in the joined room of all storeys between (coverage's
// ShadowCaster), cut by the outlines of the openings, projected from the eye to the plane: floor
// that is seen past the rim of a floor does not count. Sensors in equal surroundings, to the
// nanometre, share a view. Several rooms are computed at once; the order of views is that of
// storeys and sensors.
#include "site/site_sight.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "base/parallel.h"
#include "coverage/shadow_footprint.h"
#include "geom/overlay/overlay.h"
#include "site/opening_bounds.h"
#include "trace/ray_world.h"

namespace ispace {

namespace {

/// Heights and positions of surroundings that differ by less are equal, metres.
constexpr double kEqualWithin = 1e-9;

/// Numbers that are equal for storeys in equal surroundings.
using SurroundingsKey = std::vector<std::int64_t>;

std::int64_t rounded(double value) { return std::llround(value / kEqualWithin); }

/// Searches the views between the storeys, then computes each once.
class StoreyViews {
  public:
    StoreyViews(const Coupling& coupling, const CoverageOptions& options)
        : coupling_(coupling),
          building_(coupling.building()),
          options_(options),
          openings_(coupling.openings()),
          bounds_(building_, openings_) {
        for (const auto& scene : building_.scenes) {
            const auto [at, is_new] = sensors_.try_emplace(scene.get());
            if (!is_new) continue;
            for (std::size_t i = 0; i < scene->sensors.size(); ++i)
                if (seesOutside(scene->sensors[i])) at->second.push_back(i);
        }
    }

    std::vector<std::vector<StoreyView>> run() {
        const std::size_t count = building_.scenes.size();
        for (std::size_t from = 0; from < count; ++from)
            for (std::size_t to = 0; to < count; ++to)
                if (const auto between = bounds_.between(from, to); !between.empty())
                    search(between, from, to);
        compute();
        std::vector<std::vector<StoreyView>> views(building_.scenes.size());
        for (const Use& use : uses_)
            if (const Job& job = jobs_[use.job]; job.view != nullptr)
                views[use.to].push_back({use.from, job.sensor, job.view});
        for (auto& of_storey : views)
            std::stable_sort(
                of_storey.begin(), of_storey.end(),
                [](const StoreyView& a, const StoreyView& b) { return a.storey < b.storey; });
        return views;
    }

  private:
    /// A view to compute: of a sensor of one storey into another one of some storeys.
    struct Job {
        std::vector<std::size_t> storeys;  // an example of those in such surroundings
        std::size_t from = 0, to = 0, sensor = 0;
        std::shared_ptr<const OutsideView> view = {};
    };
    struct Use {
        std::size_t from, to, job;
    };

    [[nodiscard]] double floorOf(std::size_t storey) const {
        return building_.document.storeys[storey].floor;
    }

    /// Adds the views of the sensors of a storey into another one. \param between storeys through
    /// which sight leads, ends included
    void search(const std::vector<std::size_t>& between, std::size_t from, std::size_t to) {
        const double rise = floorOf(to) - floorOf(from);
        const auto& sensors = sensors_.at(building_.scenes[from].get());
        if (sensors.empty() || std::fabs(rise) > 2 * kSightBetweenStoreys) return;
        if (rise > 0 && !(options_.plane > kRayEpsilon)) return;
        std::optional<std::size_t> kind;
        for (const std::size_t sensor : sensors) {
            if (!bounds_.maySee(between, from, to, building_.scenes[from]->sensors[sensor],
                                options_.plane) ||
                coupling_.isInsideSolid(from,
                                        building_.scenes[from]->sensors[sensor].pose.position))
                continue;
            if (!kind) kind = kindOfSurroundings(between);
            const auto place = [&](std::size_t storey) {
                return std::find(between.begin(), between.end(), storey) - between.begin();
            };
            const auto [at, is_new] =
                known_.try_emplace({*kind, place(from), place(to), sensor}, jobs_.size());
            if (is_new) jobs_.push_back({between, from, to, sensor});
            uses_.push_back({from, to, at->second});
        }
    }

    /// Returns a number that is the same for storeys with equal rooms, distances and openings.
    std::size_t kindOfSurroundings(std::span<const std::size_t> storeys) {
        const Storey& base = building_.document.storeys[storeys.front()];
        SurroundingsKey numbers;
        const auto add_point = [&](Point2 p) {
            const Point2 local = inStorey(base, p);
            numbers.push_back(rounded(local.x));
            numbers.push_back(rounded(local.y));
        };
        for (const std::size_t i : storeys) {
            const Storey& storey = building_.document.storeys[i];
            const auto room = rooms_.try_emplace(building_.scenes[i].get(), rooms_.size()).first;
            numbers.push_back(static_cast<std::int64_t>(room->second));
            numbers.push_back(rounded(storey.floor - base.floor));
            numbers.push_back(rounded(building_.height(i)));
            add_point(storey.building_from_storey.position);
            add_point(storey.building_from_storey * Point2{1, 0});
        }
        for (const FloorOpening& opening : openings_) {
            const auto place = [&](std::size_t storey) {
                return std::find(storeys.begin(), storeys.end(), storey);
            };
            if (place(opening.below) == storeys.end() || place(opening.above) == storeys.end())
                continue;
            numbers.push_back(place(opening.below) - storeys.begin());
            numbers.push_back(place(opening.above) - storeys.begin());
            numbers.push_back(static_cast<std::int64_t>(opening.flight.size()));
            for (const Point2 corner : opening.outline) add_point(corner);
        }
        return kinds_.try_emplace(std::move(numbers), kinds_.size()).first->second;
    }

    /// Computes the views; those in one joined room follow each other among the jobs.
    void compute() {
        std::map<std::vector<std::size_t>, std::vector<std::size_t>> by_room;
        for (std::size_t i = 0; i < jobs_.size(); ++i) by_room[jobs_[i].storeys].push_back(i);
        const std::vector<std::pair<std::vector<std::size_t>, std::vector<std::size_t>>> rooms(
            by_room.begin(), by_room.end());
        parallelChunks(true, rooms.size(), [&](std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k) {
                const auto& [storeys, jobs] = rooms[k];
                const ShadowCaster caster(coupling_.joined(storeys));
                for (const std::size_t job : jobs) look(caster, jobs_[job]);
            }
        });
    }

    /// Computes a view in the frame of the lowest of the storeys, then moves it to its own:
    /// buildings of like storeys need it once.
    void look(const ShadowCaster& caster, Job& job) const {
        const Storey& base = building_.document.storeys[job.storeys.front()];
        const Storey& from = building_.document.storeys[job.from];
        const Storey& to = building_.document.storeys[job.to];
        Sensor sensor = building_.scenes[job.from]->sensors[job.sensor];
        sensor.mount.reset();
        sensor.person.reset();
        const auto toward = [](const Storey& frame, const Storey& of) {
            return Pose2{inStorey(frame, of.building_from_storey.position),
                         of.building_from_storey.heading - frame.building_from_storey.heading};
        };
        const OutsideView standing =
            moved({sensor, {}, {}}, toward(base, from), from.floor - base.floor);
        OutsideView view =
            viewThrough(caster, standing.sensor, to.floor - base.floor + options_.plane,
                        options_.density, kSightBetweenStoreys);
        if (view.whole.empty()) return;
        const bool is_one = view.region == view.whole;
        view.whole = framed(std::move(view.whole), standing.sensor.pose.position, job);
        view.region = is_one ? view.whole
                             : framed(std::move(view.region), standing.sensor.pose.position, job);
        if (view.whole.empty()) return;
        job.view = std::make_shared<const OutsideView>(
            moved(std::move(view), toward(to, base), base.floor - to.floor));
    }

    /// Returns the part of a region that is seen through openings of all floors between, not past
    /// the outlines of floors. \param eye in the frame of the lowest storey
    [[nodiscard]] std::vector<Curve> framed(std::vector<Curve> region, Point3 eye,
                                            const Job& job) const {
        const Storey& base = building_.document.storeys[job.storeys.front()];
        const double plane = floorOf(job.to) - base.floor + options_.plane;
        std::map<double, std::uint64_t> marks;  // of floors
        std::vector<Layer> layers = {{.curves = std::move(region), .counts = false, .marks = 1}};
        std::uint64_t all = 1;
        for (const FloorOpening& opening : openings_) {
            const auto is_here = [&](std::size_t storey) {
                return std::find(job.storeys.begin(), job.storeys.end(), storey) !=
                       job.storeys.end();
            };
            if (!is_here(opening.above) || floorOf(opening.above) <= base.floor) continue;
            const double height = floorOf(opening.above) - base.floor;
            const auto mark = marks.try_emplace(height, std::uint64_t{2} << marks.size()).first;
            all |= mark->second;
            Polygon outline = opening.outline;
            for (Point2& p : outline) {
                const Point2 foot = eye.onFloor();
                p = foot + (plane - eye.z) / (height - eye.z) * (inStorey(base, p) - foot);
            }
            layers.push_back(
                {.curves = {curveOf(outline)}, .counts = false, .marks = mark->second});
        }
        return Overlay(layers).curves(
            [all](const LayerLabel& label) { return label.marks == all; });
    }

    const Coupling& coupling_;
    const SiteScene& building_;
    const CoverageOptions& options_;
    std::span<const FloorOpening> openings_;
    OpeningBounds bounds_;
    std::map<const Scene*, std::vector<std::size_t>> sensors_;  // that see outside
    std::map<const Scene*, std::size_t> rooms_;                 // numbers of rooms
    std::map<SurroundingsKey, std::size_t> kinds_;
    std::map<std::tuple<std::size_t, std::ptrdiff_t, std::ptrdiff_t, std::size_t>, std::size_t>
        known_;  // jobs
    std::vector<Job> jobs_;
    std::vector<Use> uses_;
};

}  // namespace

std::vector<std::vector<StoreyView>> viewsBetweenStoreys(const Coupling& coupling,
                                                         const CoverageOptions& options) {
    return StoreyViews(coupling, options).run();
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of 5 to 50 cm stand for exact regions. A view's error grows with its outline, which passes
// more of smaller cells: 8 cells, times the root of 0.18 m by their edge, were rarely exceeded in
// furnished rooms. The bound is measured, not proven, and may hide a change that gains little more
// than it.
//
// Sights are kept by place: headings of one place share their rays, and poses that were looked at
// once are looked up. Poses of one sensor run side by side; sums are by pose, so that figures do
// not depend on the number of threads.
#include "extensions/advice/coarse_sight.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "arrange/candidate_generator.h"
#include "extensions/camerarules/layout_privacy.h"
#include "scene/sensor/ultrasound.h"

namespace ispace::advice {

namespace {

constexpr double kLeastEdge = 0.05, kMostEdge = 0.5;
/// Errors of cells along an outline cancel out, but where an edge of a field of view runs through
/// centres, which counts them all: measured in furnished rooms, views rarely have so many more, and
/// never twice as many more, cells of kUsualEdge than were counted.
constexpr double kViewErrorCells = 8, kUsualEdge = 0.18;

double edgeFor(const Box2& limits, CoarseSight::Cells cells) {
    return std::clamp(std::sqrt(limits.width() * limits.depth() / static_cast<double>(cells)),
                      kLeastEdge, kMostEdge);
}

/// Outlines pass more of smaller cells.
double errorOf(double cell) {
    return kViewErrorCells * cell * std::sqrt(std::max(1.0, kUsualEdge / std::sqrt(cell)));
}

}  // namespace

CoarseSight::CoarseSight(const Environment& environment, const SuggestOptions& options, Cells cells)
    : worlds_(environment),
      sight_(environment, options.measure.plane, &worlds_),
      target_(makeTarget(environment, CellSize{edgeFor(environment.limits(), cells)},
                         options.measure.height)),
      cell_(target_.grid.cellArea()),
      error_(errorOf(cell_)) {
    for (const camerarules::PrivacyRule& rule : options.privacy)
        private_.push_back(
            {rule.density,
             someOf(unseenCells(camerarules::unseenFloor(rule, environment), target_))});
}

CoarseSight::Some CoarseSight::someOf(CellSet cells) const {
    CountedCells counted(cells);
    const CellWindow window = CellWindow::of(target_.grid, cells);
    return {std::move(cells), std::move(counted), window};
}

bool CoarseSight::estimates(const SuggestOptions& options) {
    return options.requirements.empty() && options.facing.empty();
}

void CoarseSight::look(std::span<const Sensor> sensors) {
    seen_.clear();
    times_.assign(target_.grid.size(), 0);
    heard_.assign(target_.grid.size(), 0);
    for (const Sensor& sensor : sensors) {
        if (!kindOf(sensor.model).perceives) continue;
        const CellSet& cells = viewsOf({&sensor, 1}).front()->cells;
        std::vector<std::uint32_t>& counts = isPartial(sensor.model) ? heard_ : times_;
        cells.forEach([&counts](std::size_t cell) { ++counts[cell]; });
        seen_.insert_or_assign(sensor.id, cells);
    }
}

void CoarseSight::count(const Sensor& moving) {
    const auto own = seen_.find(moving.id);
    CellSet counted = target_.indoor;
    const bool is_partial = isPartial(moving.model);
    target_.indoor.forEach([&](std::size_t cell) {
        const std::uint32_t mine = own != seen_.end() && own->second.test(cell) ? 1 : 0;
        const std::uint32_t times = times_[cell] - (is_partial ? 0 : mine);
        const std::uint32_t heard = heard_[cell] - (is_partial ? mine : 0);
        // A receiver covers the floor that is one short of enough.
        const bool is_open = is_partial ? heard + 1 == kMinReceivers : heard < kMinReceivers;
        if (times > 0 || !is_open) counted.reset(cell);
    });
    counted_ = someOf(std::move(counted));
}

CoarseSight::View CoarseSight::viewOf(const Sensor& sensor) const {
    return {sensor, sight_.cellsOf(target_.grid, sensor), privateOf(sensor)};
}

double CoarseSight::privateOf(const Sensor& sensor) const {
    double required = 0;
    if (!sensor.is<Camera>()) return required;
    for (const Private& rule : private_) {
        Sensor camera = sensor;
        camera.model = withDensity(sensor.as<Camera>(), rule.density);
        const CellSet cells = sight_.cellsOf(target_.grid, camera, &rule.cells.counted);
        required -= cell_ * static_cast<double>(countCommon(cells, rule.cells.set));
    }
    return required;
}

double CoarseSight::privateOf(std::span<const Sensor> sensors) const {
    double required = 0;
    for (const Sensor& sensor : sensors) {
        if (!sensor.is<Camera>()) continue;
        sight_.prepare(sensor);
        required += privateOf(sensor);
    }
    return required;
}

namespace {

constexpr std::size_t kMost = 50'000;  // views that are kept

std::tuple<double, double, double> keyOf(const Pose3& pose) {
    return {pose.position.x, pose.position.y, pose.heading.degrees()};
}

}  // namespace

std::vector<const CoarseSight::View*> CoarseSight::viewsOf(std::span<const Sensor> sensors) {
    if (views_.size() + sensors.size() > kMost) views_.clear();
    std::vector<const View*> views(sensors.size());
    std::vector<std::size_t> fresh;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const auto [first, last] = views_.equal_range(keyOf(sensors[i].pose));
        const auto known = std::find_if(
            first, last, [&](const auto& one) { return seeAlike(one.second.sensor, sensors[i]); });
        if (known != last)
            views[i] = &known->second;
        else
            fresh.push_back(i);
    }
    if (fresh.empty()) return views;
    sight_.prepare(sensors[fresh.front()]);
    std::vector<View> made(fresh.size());
    tbb::parallel_for(std::size_t{0}, fresh.size(), [&](std::size_t k) {
        // A thread that waits for rows of cells in here must not begin with another pose.
        tbb::this_task_arena::isolate([&] { made[k] = viewOf(sensors[fresh[k]]); });
    });
    for (std::size_t k = 0; k < fresh.size(); ++k)
        views[fresh[k]] =
            &views_.emplace(keyOf(sensors[fresh[k]].pose), std::move(made[k]))->second;
    return views;
}

std::vector<KnownSight*> CoarseSight::knownFrom(const Sensor& sensor,
                                                std::span<const Pose3> poses) {
    constexpr std::size_t kMostPlaces = 2'000;
    std::vector<KnownSight*> known(poses.size());
    if (scansSlice(sensor)) return known;
    if (known_from_.size() + poses.size() > kMostPlaces) known_from_.clear();
    const Surfaces surfaces = kindOf(sensor.model).stopped_by;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const auto& [x, y, z] = poses[i].position;
        KnownSight* const own =
            &known_from_.try_emplace({surfaces, x, y, z}, target_.grid.size()).first->second;
        if (std::find(known.begin(), known.end(), own) == known.end()) known[i] = own;
    }
    return known;
}

void CoarseSight::addSeen(const Sensor& sensor, std::span<const Pose3> poses, const Some& cells,
                          std::span<double> floor) {
    const std::vector<KnownSight*> known = knownFrom(sensor, poses);
    std::vector<FieldOfView> views;
    views.reserve(poses.size());
    for (const Pose3& pose : poses)
        if (const auto view = fieldOfView({sensor.id, sensor.model, pose})) views.push_back(*view);
    const bool is_one_place = std::all_of(poses.begin(), poses.end(), [&](const Pose3& pose) {
        return pose.position == poses.front().position;
    });
    const Sensor first{sensor.id, sensor.model, poses.front()};
    const Point3 place = first.pose.position;
    if (is_one_place && !scansSlice(first) && views.size() == poses.size()) {
        if (sight_.levelAt(place.z)->isInsideSolid(place.onFloor())) return;
        CellParts parts;
        cellsByView(target_.grid, sight_.meshFor(sensor.model), views, sight_.plane(), parts,
                    {.window = cells.window, .counted = &cells.counted, .known = known[0]});
        for (std::size_t i = 0; i < poses.size(); ++i)
            floor[i] += cell_ * static_cast<double>(
                                    countCommon(cellsOf(parts, i, target_.grid.size()), cells.set));
        return;
    }
    tbb::parallel_for(std::size_t{0}, poses.size(), [&](std::size_t i) {
        // A thread that waits for rows of cells in here must not begin with another pose.
        tbb::this_task_arena::isolate([&] {
            const Sensor moved{sensor.id, sensor.model, poses[i]};
            const CellSet seen = sight_.cellsOf(target_.grid, moved, &cells.counted, known[i]);
            floor[i] += cell_ * static_cast<double>(countCommon(seen, cells.set));
        });
    });
}

std::vector<FloorGain> CoarseSight::at(const Sensor& sensor, std::span<const Pose3> poses) {
    sight_.prepare(sensor);
    std::vector<double> gained(poses.size());
    addSeen(sensor, poses, *counted_, gained);
    std::vector<FloorGain> gains(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) gains[i].gained = gained[i];
    if (!sensor.is<Camera>() || private_.empty()) return gains;
    if (private_seen_.size() + poses.size() > kMost) private_seen_.clear();
    std::vector<std::size_t> fresh;
    std::vector<Pose3> fresh_poses;
    for (std::size_t i = 0; i < poses.size(); ++i) {
        const Sensor moved{sensor.id, sensor.model, poses[i]};
        const auto [first, last] = private_seen_.equal_range(keyOf(poses[i]));
        const auto known = std::find_if(
            first, last, [&](const auto& one) { return seeAlike(one.second.sensor, moved); });
        if (known != last) {
            gains[i].required = known->second.required;
        } else {
            fresh.push_back(i);
            fresh_poses.push_back(poses[i]);
        }
    }
    std::vector<double> seen(fresh.size());
    for (const Private& rule : private_) {
        if (fresh.empty()) break;
        addSeen({sensor.id, withDensity(sensor.as<Camera>(), rule.density), sensor.pose},
                fresh_poses, rule.cells, seen);
    }
    for (std::size_t k = 0; k < fresh.size(); ++k) {
        gains[fresh[k]].required = -seen[k];
        private_seen_.emplace(
            keyOf(fresh_poses[k]),
            Known{Sensor{sensor.id, sensor.model, fresh_poses[k]}, gains[fresh[k]].required});
    }
    return gains;
}

FloorGain CoarseSight::whole(std::span<const Sensor> sensors) {
    FloorGain sum;
    CellSet seen(target_.grid.size());
    std::vector<std::uint32_t> heard(target_.grid.size());
    for (const Sensor& sensor : sensors) {
        if (!kindOf(sensor.model).perceives) continue;
        const View& view = *viewsOf({&sensor, 1}).front();
        sum.required += view.required;
        const CellSet& cells = view.cells;
        if (!isPartial(sensor.model))
            seen |= cells;
        else
            cells.forEach([&](std::size_t cell) {
                if (++heard[cell] == kMinReceivers) seen.set(cell);
            });
    }
    sum.gained = cell_ * static_cast<double>(countCommon(seen, target_.indoor));
    return sum;
}

}  // namespace ispace::advice

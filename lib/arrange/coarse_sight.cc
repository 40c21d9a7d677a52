// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/coarse_sight.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "arrange/candidate_generator.h"
#include "coverage/camera_rules.h"
#include "scene/sensor/ultrasound.h"

namespace ispace {

namespace {

constexpr double kCells = 4'000;  // about so many
constexpr double kLeastEdge = 0.1, kMostEdge = 0.5;
/// Errors of cells along an outline cancel out, but where an edge of a field of view runs through
/// centres, which counts them all: measured in furnished rooms, views rarely have so many more, and
/// never twice as many more, cells than were counted.
constexpr double kCellsOfError = 8;

double edgeFor(const Box2& limits) {
    return std::clamp(std::sqrt(limits.width() * limits.depth() / kCells), kLeastEdge, kMostEdge);
}

}  // namespace

CoarseSight::CoarseSight(const Environment& environment, const SuggestOptions& options)
    : worlds_(environment),
      sight_(environment, options.measure.plane, &worlds_),
      target_(
          makeTarget(environment, CellSize{edgeFor(environment.limits())}, options.measure.height)),
      cell_(target_.grid.cellArea()),
      error_(kCellsOfError * cell_),
      counted_(target_.indoor) {
    for (const PrivacyRule& rule : options.privacy)
        private_.push_back({rule.density, privateCells(rule, environment, target_)});
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
    counted_ = target_.indoor;
    const bool is_partial = isPartial(moving.model);
    target_.indoor.forEach([&](std::size_t cell) {
        const std::uint32_t mine = own != seen_.end() && own->second.test(cell) ? 1 : 0;
        const std::uint32_t times = times_[cell] - (is_partial ? 0 : mine);
        const std::uint32_t heard = heard_[cell] - (is_partial ? mine : 0);
        // A receiver covers the floor that is one short of enough.
        const bool is_open = is_partial ? heard + 1 == kMinReceivers : heard < kMinReceivers;
        if (times > 0 || !is_open) counted_.reset(cell);
    });
}

CoarseSight::View CoarseSight::viewOf(const Sensor& sensor) const {
    View view{sensor, sight_.cellsOf(target_.grid, sensor)};
    if (!sensor.is<Camera>()) return view;
    for (const Private& rule : private_) {
        Sensor camera = sensor;
        camera.model = withDensity(sensor.as<Camera>(), rule.density);
        view.required -= cell_ * static_cast<double>(
                                     countCommon(sight_.cellsOf(target_.grid, camera), rule.cells));
    }
    return view;
}

std::vector<const CoarseSight::View*> CoarseSight::viewsOf(std::span<const Sensor> sensors) {
    const auto key_of = [](const Pose3& pose) {
        return std::tuple(pose.position.x, pose.position.y, pose.heading.degrees());
    };
    constexpr std::size_t kMost = 10'000;
    if (views_.size() + sensors.size() > kMost) views_.clear();
    std::vector<const View*> views(sensors.size());
    std::vector<std::size_t> fresh;
    for (std::size_t i = 0; i < sensors.size(); ++i) {
        const auto [first, last] = views_.equal_range(key_of(sensors[i].pose));
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
            &views_.emplace(key_of(sensors[fresh[k]].pose), std::move(made[k]))->second;
    return views;
}

std::vector<FloorGain> CoarseSight::at(const Sensor& sensor, std::span<const Pose3> poses) {
    std::vector<Sensor> moved(poses.size(), sensor);
    for (std::size_t i = 0; i < poses.size(); ++i) moved[i].pose = poses[i];
    std::vector<FloorGain> gains;
    gains.reserve(poses.size());
    for (const View* const view : viewsOf(moved)) gains.push_back(gainOf(*view));
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

}  // namespace ispace

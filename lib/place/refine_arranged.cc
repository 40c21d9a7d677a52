// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/refine_arranged.h"

#include <algorithm>
#include <cstddef>

namespace ispace {

namespace {

constexpr double kApart = 0.05;  // metres

bool areApart(const std::vector<ArrangedSensor>& before, const std::vector<Pose3>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i)
        for (std::size_t k = 0; k < i; ++k) {
            const double least =
                std::min(kApart, length(before[i].pose.position - before[k].pose.position));
            if (length(poses[i].position - poses[k].position) < least) return false;
        }
    return true;
}

}  // namespace

std::vector<ArrangedSensor> movedTo(std::vector<ArrangedSensor> sensors,
                                    const std::vector<Pose3>& poses) {
    for (std::size_t i = 0; i < poses.size(); ++i) sensors[i].pose = poses[i];
    return sensors;
}

Refined refineArranged(SceneProblem& model, const std::vector<ArrangedSensor>& sensors,
                       std::uint64_t least, Progress& progress) {
    std::vector<Movable> movables;
    movables.reserve(sensors.size());
    for (const ArrangedSensor& sensor : sensors)
        movables.push_back({sensor.id, model.groups()[sensor.group].model, sensor.pose,
                            &model.judgeAt(sensor.pose.position.z)});
    const auto refined = [&](const std::function<bool(const std::vector<Pose3>&)>& accept) {
        const RefineOptions refining{.demand = model.options().redundancy,
                                     .plane = model.options().plane};
        return refine(model.scene(), movables, model.options().worth, refining, accept, progress);
    };
    const auto is_kept = [&](const std::vector<Pose3>& poses) {
        const Coverage coverage = model.coverageOf(movedTo(sensors, poses));
        return model.valueOf(coverage) >= least &&
               (!model.options().is_connected || model.isConnected(coverage));
    };
    const auto is_apart = [&](const std::vector<Pose3>& poses) { return areApart(sensors, poses); };
    Refined best = refined(is_apart);
    // What is best in truth may be a cell less on the grid by which results are compared, or hang
    // together no more: then each step is judged by that.
    if (!is_kept(best.poses))
        best = refined(
            [&](const std::vector<Pose3>& poses) { return is_apart(poses) && is_kept(poses); });
    return best;
}

}  // namespace ispace

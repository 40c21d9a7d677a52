// SPDX-License-Identifier: GPL-3.0-or-later
#include "place/tried_poses.h"

#include <tbb/parallel_for.h>

#include <cstdint>
#include <span>

#include "sense/scan.h"

namespace ispace {

namespace {

void addSliceAreas(Worlds& worlds, const Laser& laser, std::span<TriedPose> poses) {
    for (const TriedPose& tried : poses) worlds.prepare(tried.pose);
    tbb::parallel_for(std::size_t{0}, poses.size(), [&](std::size_t i) {
        const Sensor placed{"", laser, poses[i].pose};
        poses[i].slice_area = sliceArea(laser, castBeams(worlds.at(placed.pose), placed));
    });
}

}  // namespace

std::vector<TriedPose> triedPoses(SceneProblem& model, const std::vector<Choice>& chosen) {
    const Problem& problem = model.problem();
    const WeightSums prices(model.weightsLeft());
    std::vector<TriedPose> all;
    all.reserve(model.candidates());
    for (std::size_t k = 0; k < problem.kinds.size(); ++k) {
        const CandidateSet& set = *problem.kinds[k].candidates;
        const SensorClass& kind = model.kinds()[k];
        std::vector<std::uint32_t> values(set.size());
        set.weighAll(prices, values);
        const double part = static_cast<double>(problem.kinds[k].multiplicity) / problem.required;
        const std::size_t first = all.size();
        for (std::size_t i = 0; i < set.size(); ++i)
            all.push_back({kind.id, model.poseOf({k, i}), part * model.share(values[i]), false});
        for (const Choice& choice : chosen)
            if (choice.kind == k) all[first + choice.candidate].is_chosen = true;
        if (const auto* laser = std::get_if<Laser>(&kind.model))
            addSliceAreas(model.worlds(), *laser, std::span(all).subspan(first));
    }
    return all;
}

}  // namespace ispace

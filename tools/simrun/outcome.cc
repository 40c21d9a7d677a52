// SPDX-License-Identifier: GPL-3.0-or-later
#include "simrun/outcome.h"

#include <vector>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

std::unique_ptr<Progress> progressOf(Simulation& simulation, const SimrunOptions& options) {
    if (!options.until) return std::make_unique<SilentProgress>();
    auto progress = makeProgress("simrun", options.common.progress, options.common.quiet);
    progress->begin("steps", (*options.until + options.step - SimTime(1)) / options.step);
    simulation.onStep([bar = progress.get()] { bar->advance(1); });
    return progress;
}

void report(const Simulation& simulation, const SimrunOptions& options) {
    const World& world = simulation.world();
    talk(options.common, "simrun",
         std::to_string(world.steps()) + " steps, t=" + formatSimTime(world.time()));
    if (const auto& [steps, late, most, own] = simulation.lateness(); steps > 0)
        talk(options.common, "simrun",
             std::to_string(late) + " of " + std::to_string(steps) +
                 " steps began more than a step late, the latest by " + formatMilliseconds(most) +
                 " s, the program itself at work for " + formatMilliseconds(own) + " s of that");
    if (const SimTime lost = simulation.lost(); lost > SimTime(0))
        talk(options.common, "simrun",
             "the world could not keep up: the clock gave up " + formatMilliseconds(lost) + " s");
}

void conclude(const ExpectationJudge& judge, const SimrunOptions& options, const SceneInput& input,
              JunitFile& junit) {
    const std::vector<RunVerdict> verdicts = judge.verdicts();
    std::vector<JunitCase> cases;
    cases.reserve(verdicts.size());
    for (const RunVerdict& verdict : verdicts)
        cases.push_back(
            {.name = verdict.expectation,
             .outcome = verdict.is_met ? JunitCase::Outcome::Met : JunitCase::Outcome::Unmet,
             .message = verdict.reason,
             .time = verdict.time});
    junit.write(baseName(input.environment_operand), cases);
    if (const std::string unmet = unmetText(verdicts); !unmet.empty()) throw UnmetError(unmet);
    if (!verdicts.empty())
        talk(options.common, "simrun", "all " + std::to_string(verdicts.size()) + " met");
}

}  // namespace ispace

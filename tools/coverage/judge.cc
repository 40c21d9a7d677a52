// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/judge.h"

#include "base/number.h"
#include "layout/check_scene.h"
#include "sense/ultrasound.h"

namespace ispace {

std::vector<Diagnostic> sensorFindings(const Scene& scene) {
    std::vector<Diagnostic> found =
        sceneWarnings(scene, {.checks = {"unplaced", "outside", "buried"}});
    if (const std::size_t count = sensorsOf<Receiver>(scene).size();
        count > 0 && count < kMinReceivers)
        found.push_back(
            {.file = "",
             .message = "ultrasound covers nothing: at least " + std::to_string(kMinReceivers) +
                        " receivers have to hear a tag, here are " + std::to_string(count),
             .severity = Severity::Warning});
    return found;
}

std::string largeCellsText(const CoverageOptions& options, const Grid& grid) {
    const double edge = roundSignificant(grid.limits.width() / grid.columns);
    if (!std::holds_alternative<RoomCells>(options.cells) || edge <= kRoomCell) return "";
    return "the room is large: cells are " + formatDouble(edge) + " m instead of " +
           formatDouble(kRoomCell) + " m (--cell M makes them smaller)";
}

std::vector<JunitCase> judge(std::span<const Requirement> requirements, const Coverage& coverage,
                             const std::string& name) {
    std::vector<JunitCase> verdicts;
    verdicts.reserve(requirements.size());
    for (const Requirement& requirement : requirements) {
        const auto [is_met, text] = checkRequirement(requirement, coverage);
        verdicts.push_back({.name = name + requirementText(requirement),
                            .outcome = is_met ? JunitCase::Outcome::Met : JunitCase::Outcome::Unmet,
                            .message = text});
    }
    return verdicts;
}

std::string unmetText(std::span<const JunitCase> verdicts) {
    std::string text;
    for (const JunitCase& verdict : verdicts)
        if (verdict.outcome == JunitCase::Outcome::Unmet)
            text.append(text.empty() ? "" : "; ").append(verdict.message);
    return text;
}

}  // namespace ispace

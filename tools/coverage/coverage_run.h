// SPDX-License-Identifier: GPL-3.0-or-later
// Computes coverage of one scene or many, judges requirements, and writes maps.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arrange/tried_pose.h"
#include "cli/batch.h"
#include "cli/operands.h"
#include "coverage/coverage.h"
#include "coverage/coverage_options.h"
#include "coverage/presence.h"
#include "coverage/requirement.h"
#include "coverage/run_coverage.h"
#include "report/camera_rules_report.h"
#include "report/objective_report.h"
#include "report/robustness_report.h"
#include "report/suggestion_report.h"
#include "scene/findings/findings.h"

namespace ispace {

/// Random mountings and crowds of --perturb and --crowd.
constexpr int kSamples = 100;

/// All results, and the comparison if requested.
struct Measured {
    Coverage coverage;
    std::optional<Coverage> other;
};

/// \param other the scene of --compare, null without
/// \throws FormatError if that is another room
Measured measure(const CoverageToolOptions& options, const Scene& scene, const Scene* other);

/// Computes the coverage of a recorded run; nullopt without --run.
std::optional<RunCoverage> measureRecordedRun(const CoverageToolOptions& options,
                                              const Scene& scene);

/// Reads the poses of --trace, from stdin only if no other input is.
/// \param named as SceneInput::named
std::vector<TriedPose> readTried(const CoverageToolOptions& options,
                                 const std::vector<std::string>& named);
/// Returns the poses of a room alone, or of the storey that it is.
/// \throws UsageError for a trace of a building without them
std::vector<TriedPose> triedInRoom(const CoverageToolOptions& options, const std::string& storey,
                                   std::vector<TriedPose> tried);

/// Measures --presence; empty without it.
std::optional<Presence> presenceOf(const CoverageToolOptions& options, const Scene& scene);

/// Finds the changes of --suggest; nullopt without it. \param coverage of the scene
/// \param signal receives the signal that ended the search early; afterwards TERM and INT are
/// ignored: write what is there, and endBySignal()
std::optional<Advice> suggest(const CoverageToolOptions& options, const SceneInput& input,
                              const Coverage& coverage, int& signal);

/// Computes the results of --perturb, --failures and --crowd; nullopt without all. \param coverage
/// of the scene \throws UsageError as worstFailures() UnmetError as CrowdFloor
std::optional<Robustness> robustnessOf(const CoverageToolOptions& options, const Scene& scene,
                                       const Coverage& coverage);

/// Computes the results of --facing and --privacy; nullopt without both. \throws UsageError for
/// unknown zones
std::optional<CameraRules> cameraRulesOf(const CoverageToolOptions& options, const Scene& scene,
                                         const Coverage& coverage);

/// Computes the results of --path and --localise; nullopt without both. \throws UsageError for
/// unknown zones
std::optional<ObjectiveFigures> objectivesOf(const CoverageToolOptions& options, const Scene& scene,
                                             const Coverage& coverage);

/// Returns a verdict for each rule that requires something.
std::vector<JunitCase> judge(const CameraRules& rules);
std::vector<JunitCase> judge(std::span<const JudgedRule> rules);

/// Writes the map to -o, with its accompanying file. \pre there is a format
void writeProduct(const CoverageToolOptions& options, const SceneInput& input,
                  const Measured& measured);

/// Returns the findings about the sensors, robots and people of a scene.
std::vector<Diagnostic> sensorFindings(const Scene& scene);
/// Selects those of checkScene() among them.
FindingFilter sensorChecks();
/// Returns a warning of too few ultrasound receivers; empty if there are none or enough.
std::optional<Diagnostic> receiverFinding(const Scene& scene);

/// Returns a sentence if cells are larger than usual by default, else "".
std::string largeCellsText(const CoverageOptions& options, const Grid& grid);

/// Returns one verdict for each requirement, with the measured value as its message; `name`
/// precedes the requirement's text. \pre mustHaveZone()
std::vector<JunitCase> judge(std::span<const Requirement> requirements, const Coverage& coverage,
                             const std::string& name = "");

/// Likewise for requirements of presence. \throws UsageError for an unknown person
std::vector<JunitCase> judge(std::span<const PresenceRequirement> requirements,
                             const Presence& presence);

/// Joins unmet requirements into a message; "" if all are met.
std::string unmetText(std::span<const JunitCase> verdicts);

/// Warns of the sensors and the size of the cells, and measures. \throws as measure() and
/// mustHaveZone()
Measured measureScene(const CoverageToolOptions& options, const SceneInput& input,
                      const Scene* other);

}  // namespace ispace

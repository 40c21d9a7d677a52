// SPDX-License-Identifier: GPL-3.0-or-later
// What coverage measures of one scene, and the file it draws or writes of it.
// What coverage says about a scene and of what is required of it, for one scene or many.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "cli/batch.h"
#include "cli/operands.h"
#include "coverage/coverage.h"
#include "coverage/coverage_options.h"
#include "coverage/requirement.h"
#include "coverage/run_coverage.h"

namespace ispace {

/// Everything measured, and compared if that is wanted.
struct Measured {
    Coverage coverage;
    std::optional<Coverage> other;
};

/// \param other the scene of --compare, null without
/// \throws FormatError if that is another room
Measured measure(const CoverageToolOptions& options, const Scene& scene, const Scene* other);

/// What the layout saw of a recorded run; nothing without --run.
std::optional<RunCoverage> lookAtRun(const CoverageToolOptions& options, const Scene& scene);

/// Writes the map to -o, with what stands beside it. \pre there is a format
void writeProduct(const CoverageToolOptions& options, const SceneInput& input,
                  const Measured& measured);

/// The findings about the sensors, robots and people of a scene.
std::vector<Diagnostic> sensorFindings(const Scene& scene);

/// A sentence where nobody asked for cells and they are not as small as usual, else "".
std::string largeCellsText(const CoverageOptions& options, const Grid& grid);

/// One verdict for each requirement, its message a sentence of what was found; `name` is put before
/// the requirement's text. \pre mustHaveZone()
std::vector<JunitCase> judge(std::span<const Requirement> requirements, const Coverage& coverage,
                             const std::string& name = "");

/// What is not met, joined for a message; "" if all is.
std::string unmetText(std::span<const JunitCase> verdicts);

/// What became of one scene of a list.
struct SceneOutcome {
    std::string report = "null\n";           ///< one line; each scene has its own
    std::vector<std::string> messages = {};  ///< for stderr, without tool and place
    std::vector<JunitCase> verdicts = {};
    bool failed = false;

    /// For checkpoints: lines, the report first.
    [[nodiscard]] std::string text() const;
    static SceneOutcome fromText(std::string_view text);
};

/// Measures all scenes of a list in this process, and writes their reports in its order.
/// \throws UnmetError if one falls short of what is required, FormatError if one failed; both once
///         all are done
void runBatch(const CoverageToolOptions& options);

}  // namespace ispace

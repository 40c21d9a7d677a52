// SPDX-License-Identifier: GPL-3.0-or-later
// What coverage says about a scene and of what is required of it, for one scene or many.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/junit.h"
#include "cover/coverage.h"
#include "cover/requirement.h"

namespace ispace {

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

}  // namespace ispace

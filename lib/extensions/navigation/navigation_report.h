// SPDX-License-Identifier: GPL-3.0-or-later
// Figures of navigation as text and JSON, and requirements on them.
#pragma once

#include <string>

#include "extensions/navigation/navigation_metrics.h"

namespace ispace::navigation {

/// All that is found about a robot's run.
struct NavigationJudgement {
    std::string run;    ///< base name
    std::string robot;  ///< id
    std::string room;   ///< of the goal, in a building; else ""
    NavigationGoal goal;
    NavigationFigures figures;
};

/// A figure that --require names: `spl=0.8` wants at least, `stops=2` at most so much.
struct NavigationRequirement {
    std::string figure;
    double bound = 0;
    std::string text;  ///< as given
};
/// \throws UsageError for another figure, which lists them, or a bad number
NavigationRequirement parseNavigationRequirement(const std::string& text);
/// Returns "stops is 3, required is at most 2 (stops=2)" if the requirement is not met, else "". An
/// unknown figure meets none, but for the least distance to people where there are none.
std::string unmetText(const NavigationRequirement& requirement,
                      const NavigationJudgement& judgement);

/// Writes an object and a newline, schema ispace-navigation/1.
std::string navigationJson(const NavigationJudgement& judgement);
/// Writes aligned lines for people.
std::string navigationText(const NavigationJudgement& judgement);

}  // namespace ispace::navigation

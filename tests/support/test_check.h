// SPDX-License-Identifier: GPL-3.0-or-later
// For tests of scene checks: the findings of checkScene() as text.
#pragma once

#include <string>

#include "scene/findings/findings.h"
#include "support/test_layout.h"

namespace ispace::testing {

inline std::string check(const Scene& made) {
    std::string text;
    for (const Finding& finding : checkScene(made)) text += finding.diagnostic().text() + '\n';
    return text;
}

/// Returns the findings on these records in a room of 8 by 6 with its corner at the origin.
inline std::string check(const std::string& room, const std::string& layout = "") {
    const std::string lines = "ispace id=room at=4,3 size=8,6\n" + room;
    return check(layout.empty() ? scene(lines) : scene(lines, layout));
}

}  // namespace ispace::testing

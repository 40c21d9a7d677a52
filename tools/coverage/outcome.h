// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/junit.h"

namespace ispace {

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

}  // namespace ispace

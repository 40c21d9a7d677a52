// SPDX-License-Identifier: GPL-3.0-or-later
// lib/cli: option tables, operands, progress bar, runTool. The only folder that prints. Uses all
// of the library and CLI11.
#pragma once

#include <functional>
#include <string>

namespace ispace {

/// What `--help` and `--version` ask for: text for stdout, exit status 0.
struct TextRequested {
    std::string text;
};

/// Runs a tool's body, prints what it throws to stderr, one line an error, and returns the exit
/// status: 0 done; 1 bad data or failed I/O; 2 usage; 3 a stated requirement not met. A closed
/// pipe ends the process silently.
int runTool(const std::string& tool, const std::function<void()>& body);

}  // namespace ispace

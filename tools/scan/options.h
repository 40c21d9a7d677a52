// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cli/command_line.h"

namespace ispace {

struct ScanToolOptions {
    CommonOptions common;
    std::vector<std::string> operands;
    std::string format = "jsonl";
    bool any_environment = false;
};

/// The command line of scan, kept for its history line.
class ScanCommand {
  public:
    /// Opens no file. \throws UsageError, TextRequested
    ScanCommand(int argc, const char* const* argv);
    [[nodiscard]] const ScanToolOptions& options() const { return options_; }
    [[nodiscard]] std::string historyLine(const std::vector<std::string>& operands) const {
        return line_.historyLine(operands);
    }

  private:
    ScanToolOptions options_;
    CommandLine line_;
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "cli/command_line.h"
#include "place/arrangement.h"

namespace ispace {

struct ArrangeToolOptions {
    CommonOptions common;
    std::vector<std::string> operands;
    std::vector<std::string> sensors;  ///< MODEL[,KEY=VALUE…][:COUNT]
    std::string strategy;
    ArrangeOptions search;
    bool any_environment = false;
};

/// The command line of arrange, kept for its history line, whose operands are known only once
/// they are read.
class ArrangeCommand {
  public:
    /// Opens no file. \throws UsageError, TextRequested
    ArrangeCommand(int argc, const char* const* argv);
    [[nodiscard]] const ArrangeToolOptions& options() const { return options_; }
    [[nodiscard]] std::string historyLine(const std::vector<std::string>& operands) const {
        return line_.historyLine(operands);
    }

  private:
    ArrangeToolOptions options_;
    CommandLine line_;
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/command_line.h"

namespace ispace {

/// An option `P,Q` (or `P` for both): cells over the limits, at most 10 000 a side.
void addGridOption(CommandLine& line, const std::string& name, int& columns, int& rows,
                   const std::string& help);

/// `--any-environment`: go on where the digest in LAYOUT is another than ENV's.
void addAnyEnvironmentOption(CommandLine& line, bool& any_environment);

}  // namespace ispace

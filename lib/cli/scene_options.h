// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "cli/command_line.h"

namespace ispace {

/// `--grid P,Q`: cells over the limits, at most 10 000 a side.
void addGridOption(CommandLine& line, int& columns, int& rows);

/// `--any-environment`: go on where the digest in LAYOUT is another than ENV's.
void addAnyEnvironmentOption(CommandLine& line, bool& any_environment);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>

#include "cli/command_line.h"
#include "cover/target.h"

namespace ispace {

/// What --grid and --cell say.
struct CellWords {
    std::optional<CellCount> grid;
    std::optional<double> cell;

    /// Nothing where neither is given. \throws UsageError for both
    [[nodiscard]] std::optional<CellChoice> choice() const;
};
/// Declares `--grid P[,Q]`, at most 10 000 a side, and `--cell M`; `purpose`: what cells are for.
void addCellOptions(CommandLine& line, CellWords& words, const std::string& purpose);

/// `--any-environment`: go on where the digest in LAYOUT is another than ENV's.
void addAnyEnvironmentOption(CommandLine& line, bool& any_environment);

}  // namespace ispace

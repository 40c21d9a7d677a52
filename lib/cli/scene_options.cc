// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/scene_options.h"

#include "base/error.h"
#include "base/number.h"

namespace ispace {

namespace {

CellCount readCount(const std::string& text) {
    constexpr std::int64_t kMostASide = 10000;
    const auto comma = text.find(',');
    const auto p = parseInteger(text.substr(0, comma));
    const auto q = comma == std::string::npos ? p : parseInteger(text.substr(comma + 1));
    if (!p || !q || *p < 1 || *q < 1 || *p > kMostASide || *q > kMostASide)
        throw UsageError('`' + text + "` is not P or P,Q with whole numbers from 1 to " +
                         std::to_string(kMostASide));
    return {static_cast<int>(*p), static_cast<int>(*q)};
}

}  // namespace

std::optional<CellChoice> CellWords::choice() const {
    if (grid && cell)
        throw UsageError("--grid and --cell both say how large cells are: give one of them");
    if (grid) return *grid;
    if (cell) return CellSize{*cell};
    return std::nullopt;
}

void addCellOptions(CommandLine& line, CellWords& words, const std::string& purpose) {
    line.parsed(
        "--grid", "P[,Q]", [&words](const std::string& text) { words.grid = readCount(text); },
        "P x Q cells over the limits " + purpose, Enters::History);
    line.meters("--cell", words.cell, 0.0001, 1000,
                "square cells of this size instead, e.g. 2cm (default: at most 0.1 m, larger in "
                "huge buildings)",
                Enters::History);
    line.renamed("--reso", "give cells as --grid P,Q or --cell M");
}

void addAnyEnvironmentOption(CommandLine& line, bool& any_environment) {
    line.flag("--any-environment", any_environment,
              "go on if LAYOUT was made for another ENV than this one", Enters::History);
}

}  // namespace ispace

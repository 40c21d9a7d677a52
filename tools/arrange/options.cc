// SPDX-License-Identifier: GPL-3.0-or-later
#include "arrange/options.h"

#include "base/error.h"
#include "cli/scene_options.h"

namespace ispace {

ArrangeCommand::ArrangeCommand(int argc, const char* const* argv)
    : line_("arrange", "ENV [LAYOUT]",
            "Place sensors in a room: those of LAYOUT without a place, and those of --sensor. "
            "Writes a layout (.3dm).") {
    ArrangeToolOptions& o = options_;
    line_.operands(o.operands, 2);
    line_.texts("--sensor", "MODEL[,KEY=VALUE...][:COUNT]", o.sensors,
                "place COUNT sensors of a device or a bare kind, e.g. urg-04lx:3 or "
                "laser,range=4,fov=180:3",
                Enters::History);
    line_.choice("--strategy", o.strategy, {"grid"},
                 "how places are searched; grid: crossings of X by Y lines over the limits",
                 Enters::History);
    constexpr int kMostLines = 10000, kMostHeadings = 3600;
    line_.count("-X", "N", o.search.x, 1, kMostLines,
                "interior grid lines across x (default: 5 per maximum range)", Enters::History);
    line_.count("-Y", "N", o.search.y, 1, kMostLines,
                "interior grid lines across y (default: 5 per maximum range)", Enters::History);
    line_.count("--deg", "N", o.search.headings, 1, kMostHeadings,
                "headings a place, 360/N degrees apart, the first 0", Enters::History);
    addGridOption(line_, "--reso", o.search.columns, o.search.rows,
                  "cells over the limits while searching");
    addAnyEnvironmentOption(line_, o.any_environment);
    addCommonOptions(line_, o.common, "write the layout there (default: stdout)");
    line_.parse(argc, argv);
    (void)outputFormat("", o.common.output, {"3dm"});  // refuses the suffix of another format
    if (o.strategy.empty())
        throw UsageError(
            "no strategy given: this version has --strategy grid (see arrange --help)");
}

}  // namespace ispace

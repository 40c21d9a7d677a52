// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/options.h"

#include "base/error.h"
#include "base/number.h"
#include "cli/scene_options.h"

namespace ispace {

namespace {

MapFormat mapFormat(const std::string& name) {
    if (name == "svg") return MapFormat::Svg;
    return name == "pdf" ? MapFormat::Pdf : MapFormat::Png;
}

}  // namespace

CoverageToolOptions parseCoverageOptions(int argc, const char* const* argv) {
    CoverageToolOptions o;
    CommandLine line("coverage", "[ENV] [LAYOUT]",
                     "Measure what the placed sensors see and draw it. Without LAYOUT read it from "
                     "stdin unless ENV holds placed sensors. The report goes to stdout.");
    line.operands(o.operands, 2);
    line.flag("--json", o.json, "the report as JSON", Enters::Nothing);
    addGridOption(line, "--grid", o.columns, o.rows, "cells over the limits that figures count");
    line.meters("--height", o.height, 0, 1000, "height at which free floor is judged",
                Enters::History);
    const auto take_share = [&o](const std::string& text) {
        o.require = parseShare(text);
        if (!o.require) throw UsageError('`' + text + "` is no share: write 95% or 0.95");
        o.require_text = formatPercent(*o.require);
    };
    line.parsed("--require", "SHARE", take_share,
                "exit with 3 if the coverage is below this, e.g. 95% or 0.95", Enters::History);
    line.choice("--to", o.to, {"png", "svg", "pdf"},
                "format of the map (default: suffix of FILE, else png)", Enters::History);
    constexpr int kNarrowest = 200, kWidest = 10000;
    line.count("--width", "PIXELS", o.map.width, kNarrowest, kWidest, "width of the map",
               Enters::History);
    addAnyEnvironmentOption(line, o.any_environment);
    addCommonOptions(line, o.common, "draw the map there (default: no map)");
    line.parse(argc, argv);

    o.draw = line.given("--output");
    if (o.draw && o.common.output == "-")
        throw UsageError("the report goes to stdout: give the map a file (-o map.png)");
    if (!o.draw && !o.to.empty()) throw UsageError("--to is the format of the map: give -o FILE");
    o.map.format = mapFormat(outputFormat(o.to, o.common.output, {"png", "svg", "pdf"}));
    return o;
}

}  // namespace ispace

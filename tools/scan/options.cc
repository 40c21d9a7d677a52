// SPDX-License-Identifier: GPL-3.0-or-later
#include "scan/options.h"

#include "cli/scene_options.h"

namespace ispace {

ScanCommand::ScanCommand(int argc, const char* const* argv)
    : line_("scan", "[ENV] [LAYOUT]",
            "Simulate one reading of every placed sensor. Without LAYOUT read it from stdin unless "
            "ENV holds placed sensors.") {
    ScanToolOptions& o = options_;
    line_.operands(o.operands, 2);
    std::string to;
    line_.choice("--to", to, {"jsonl"}, "format of the readings (default jsonl)", Enters::History);
    addAnyEnvironmentOption(line_, o.any_environment);
    addCommonOptions(line_, o.common, "write the readings there (default: stdout)");
    line_.parse(argc, argv);
    o.format = outputFormat(to, o.common.output, {"jsonl"});
}

}  // namespace ispace

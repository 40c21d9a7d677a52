// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/scene_options.h"

#include "base/error.h"
#include "base/number.h"

namespace ispace {

void addGridOption(CommandLine& line, const std::string& name, int& columns, int& rows,
                   const std::string& help) {
    constexpr std::int64_t kMostCells = 10000;
    const auto take = [&columns, &rows](const std::string& text) {
        const auto comma = text.find(',');
        const auto p = parseInteger(text.substr(0, comma));
        const auto q = comma == std::string::npos ? p : parseInteger(text.substr(comma + 1));
        if (!p || !q || *p < 1 || *q < 1 || *p > kMostCells || *q > kMostCells)
            throw UsageError('`' + text + "` is not P or P,Q with whole numbers from 1 to " +
                             std::to_string(kMostCells));
        columns = static_cast<int>(*p);
        rows = static_cast<int>(*q);
    };
    line.parsed(name, "P[,Q]", take, help + " (default 100,100)", Enters::History);
}

void addAnyEnvironmentOption(CommandLine& line, bool& any_environment) {
    line.flag("--any-environment", any_environment,
              "go on if LAYOUT was made for another ENV than this one", Enters::History);
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/number.h"
#include "cover/coverage_files.h"

namespace ispace {

std::string coverageCsv(const Coverage& coverage) {
    const Target& target = coverage.target;
    const std::vector<std::uint32_t> times = timesSeen(coverage);
    std::string text = "column,row,x,y,indoor,free,seen\n";
    const auto columns = static_cast<std::size_t>(target.grid.columns);
    for (std::size_t cell = 0; cell < target.grid.size(); ++cell) {
        const Point2 center = target.grid.center(cell);
        text += std::to_string(cell % columns);
        text += ',';
        text += std::to_string(cell / columns);
        text += ',';
        appendDouble(text, tidy(center.x));
        text += ',';
        appendDouble(text, tidy(center.y));
        text += target.indoor.test(cell) ? ",1" : ",0";
        text += target.free.test(cell) ? ",1," : ",0,";
        text += std::to_string(times[cell]);
        text += '\n';
    }
    return text;
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "base/number.h"
#include "base/utf8.h"
#include "cover/coverage.h"

namespace ispace {

namespace {

std::string metres(double value) { return formatFixed(value, 2); }
std::string area(double value) { return formatFixed(value, 2) + " m2"; }
std::string percent(double share) { return formatFixed(100 * share, 2) + "%"; }
std::string percent(const std::optional<double>& share) { return share ? percent(*share) : "-"; }

/// Columns as wide as their longest cell, two blanks apart; `right` names those of numbers.
std::string aligned(const std::vector<std::vector<std::string>>& rows, const std::string& right) {
    std::vector<std::size_t> widths(right.size());
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
    std::string text;
    for (const auto& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string blanks(widths[i] - row[i].size(), ' ');
            if (i > 0) line += "  ";
            line += right[i] == 'r' ? blanks + row[i] : row[i] + blanks;
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

std::string redundancyText(const std::vector<double>& redundancy) {
    std::size_t end = redundancy.size();
    while (end > 1 && redundancy[end - 1] == 0) --end;
    std::string text;
    for (std::size_t k = 0; k < end; ++k)
        text += (k == 0 ? "" : ", ") + std::to_string(k) + ": " + percent(redundancy[k]);
    return text;
}

std::string sensorTable(const std::vector<SensorFigures>& sensors) {
    std::vector<std::vector<std::string>> rows = {{"sensor", "model", "slice area", "marginal"}};
    for (const SensorFigures& sensor : sensors)
        rows.push_back({printable(sensor.id), sensor.model.empty() ? "-" : printable(sensor.model),
                        area(sensor.slice_area), area(sensor.marginal_area)});
    return aligned(rows, "llrr");
}

}  // namespace

std::string coverageText(const CoverageReport& report) {
    const Box2& limits = report.limits;
    std::string text = aligned(
        {{"environment", printable(report.digest)},
         {"limits", "x " + metres(limits.low.x) + " to " + metres(limits.high.x) + " m, y " +
                        metres(limits.low.y) + " to " + metres(limits.high.y) + " m"},
         {"grid", std::to_string(report.columns) + " x " + std::to_string(report.rows) + " cells"},
         {"indoor area", area(report.indoor_area)},
         {"free floor", area(report.free_area) + " at " + metres(report.height) + " m"},
         {"total effective area",
          report.total_effective_area.grid ? area(*report.total_effective_area.grid) : "-"},
         {"coverage", percent(report.coverage.grid) + " of the indoor cells"},
         {"free coverage", percent(report.free_coverage.grid) + " of the free cells"},
         {"seen by", redundancyText(report.redundancy)}},
        "ll");
    if (report.sensors.empty())
        text += "\nno sensor is placed\n";
    else
        text += "\n" + sensorTable(report.sensors);
    return text + "\nfigures by cells, areas of floor exact; exact coverage is not computed\n";
}

}  // namespace ispace

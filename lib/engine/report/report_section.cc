// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/report_section.h"

#include <algorithm>
#include <cstddef>

#include "base/number.h"
#include "report/coverage_report.h"
#include "scene/sensor/density_classes.h"

namespace ispace {

void join(ReportParts& parts, const ReportParts& more) {
    parts.insert(parts.end(), more.begin(), more.end());
    std::stable_sort(parts.begin(), parts.end(),
                     [](const auto& a, const auto& b) { return a->rank() < b->rank(); });
}

std::string judgedAtText(const CoverageReport& report) {
    std::string text;
    if (report.density > 0) {
        text = " with " + formatDouble(report.density) + " pixels a metre or more";
        const auto& classes = densityClasses();
        for (std::size_t i = 0; i < classes.size(); ++i)
            if (classes[i].pixels_per_metre == report.density) text += " (" + classNames(i) + ")";
    }
    if (report.plane > 0) text += ", " + formatFixed(report.plane, 2) + " m above the floor";
    return text;
}

std::string facesJudgedAtText(const CoverageReport& report) {
    return report.plane > 0 ? judgedAtText(report) : judgedAtText(report) + ", judged on the floor";
}

std::string outcomeText(bool is_met, const std::string& finding) {
    return std::string(is_met ? "met" : "not met") + (finding.empty() ? "." : "; " + finding + ".");
}

}  // namespace ispace

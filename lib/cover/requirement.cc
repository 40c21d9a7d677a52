// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/requirement.h"

#include <algorithm>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace {

namespace {

double shareOfText(std::string_view text) {
    if (const auto share = parseShare(text)) return *share;
    throw UsageError('`' + std::string(text) +
                     "` is no share: write 95% or 0.95, free:95%, zone:NAME=95%");
}

/// With all digits where two do not show that a share is below another.
std::string percent(double share, double required) {
    const std::string text = formatFixed(100 * share, 2);
    return text == formatFixed(100 * required, 2) ? formatPercent(roundSignificant(share))
                                                  : text + "%";
}

/// What a requirement is about.
struct Subject {
    std::string what;
    Metric share;
    double area = 0;
};

Subject subjectOf(const Requirement& requirement, const CoverageReport& report) {
    switch (requirement.of) {
        case Requirement::Of::Free:
            return {"free coverage", report.free_coverage, report.free_area};
        case Requirement::Of::Zone: {
            const ZoneMetrics& zone = *std::find_if(
                report.zones.begin(), report.zones.end(),
                [&requirement](const ZoneMetrics& one) { return one.id == requirement.zone; });
            return {"coverage of zone " + printable(zone.id), zone.coverage, zone.area};
        }
        case Requirement::Of::Indoor:
            break;
    }
    return {"coverage", report.coverage, report.indoor_area};
}

/// With more digits where two would be 0.00.
std::string squareMetres(double area) { return formatFixed(area, area < 0.01 ? 6 : 2) + " m2"; }

}  // namespace

Requirement parseRequirement(std::string_view text) {
    constexpr std::string_view kFree = "free:", kZone = "zone:";
    if (text.starts_with(kFree))
        return {Requirement::Of::Free, "", shareOfText(text.substr(kFree.size()))};
    if (!text.starts_with(kZone)) return {Requirement::Of::Indoor, "", shareOfText(text)};
    // A name may have an equals sign, a share has none.
    const auto equals = text.rfind('=');
    if (equals == std::string_view::npos || equals == kZone.size())
        throw UsageError('`' + std::string(text) + "` is no requirement: write zone:NAME=95%");
    return {Requirement::Of::Zone, std::string(text.substr(kZone.size(), equals - kZone.size())),
            shareOfText(text.substr(equals + 1))};
}

void mustHaveZone(const Requirement& requirement, const Environment& environment) {
    if (requirement.of != Requirement::Of::Zone) return;
    std::vector<std::string> known;
    for (const Element& element : environment.elements())
        if (element.record.keyword() == "zone") known.push_back(element.id);
    if (std::find(known.begin(), known.end(), requirement.zone) != known.end()) return;
    throw UsageError("the room has no zone `" + printable(requirement.zone) + '`' +
                     didYouMean(requirement.zone, known));
}

Verdict checkRequirement(const Requirement& requirement, const CoverageReport& report) {
    constexpr double kExactError = 1e-7;
    const auto [what, metric, area] = subjectOf(requirement, report);
    if (!metric.exact && !metric.grid)
        return {false, what +
                           " is not known: no centre of a cell lies there, and exact figures are "
                           "missing; use smaller cells (--cell)"};
    const double share = metric.exact ? *metric.exact : *metric.grid;
    std::string text = what + " is " + percent(share, requirement.share) +
                       (metric.exact ? " (exact)" : " (by cells)");
    const std::string required = formatPercent(requirement.share);
    if (share >= requirement.share - (metric.exact ? kExactError : 0))
        return {true, text + ", as required (" + required + ")"};
    text += ", below the required " + required;
    if (area <= 0) return {false, text + ": it has no floor in the room"};
    text += ": " + squareMetres((requirement.share - share) * area) + " are missing";
    if (requirement.of == Requirement::Of::Zone || report.unseen.empty()) return {false, text};
    const UnseenSpot& spot = report.unseen.front();
    return {false, text + "; the largest unseen spot has " + squareMetres(spot.area) + " around (" +
                       formatFixed(spot.place.x, 2) + ", " + formatFixed(spot.place.y, 2) + ")"};
}

}  // namespace ispace

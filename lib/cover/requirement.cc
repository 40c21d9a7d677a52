// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/requirement.h"

#include <algorithm>

#include "base/error.h"
#include "base/number.h"
#include "base/suggest.h"
#include "base/utf8.h"

namespace ispace {

namespace {

double shareOfText(std::string_view text) {
    if (const auto share = parseShare(text)) return *share;
    throw UsageError('`' + std::string(text) +
                     "` is no share: write 95% or 0.95, free:95%, zone:NAME=95%");
}

const ZoneFigures& zoneNamed(const std::string& id, const CoverageReport& report) {
    const auto found = std::find_if(report.zones.begin(), report.zones.end(),
                                    [&id](const ZoneFigures& zone) { return zone.id == id; });
    if (found != report.zones.end()) return *found;
    std::vector<std::string> known;
    known.reserve(report.zones.size());
    for (const ZoneFigures& zone : report.zones) known.push_back(zone.id);
    throw UsageError("the room has no zone `" + printable(id) + '`' + didYouMean(id, known));
}

/// With all digits where two do not show that a share is below another.
std::string percent(double share, double required) {
    const std::string text = formatFixed(100 * share, 2);
    return text == formatFixed(100 * required, 2) ? formatPercent(share) : text + "%";
}

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

std::string shortfall(const Requirement& requirement, const CoverageReport& report) {
    double share = report.coverage.grid.value_or(0), area = report.indoor_area;
    std::string what = "coverage";
    if (requirement.of == Requirement::Of::Free) {
        share = report.free_coverage.grid.value_or(0);
        area = report.free_area;
        what = "free coverage";
    } else if (requirement.of == Requirement::Of::Zone) {
        const ZoneFigures& zone = zoneNamed(requirement.zone, report);
        share = zone.coverage.grid.value_or(0);
        area = zone.area;
        what = "coverage of zone " + printable(zone.id);
    }
    if (share >= requirement.share) return "";
    what += " is " + percent(share, requirement.share) + ", below the required " +
            formatPercent(requirement.share);
    if (area <= 0) return what + ": it has no floor in the room";
    what += ": " + formatFixed((requirement.share - share) * area, 2) + " m2 are missing";
    if (requirement.of == Requirement::Of::Zone || report.unseen.empty()) return what;
    const UnseenSpot& spot = report.unseen.front();
    return what + "; the largest unseen spot has " + formatFixed(spot.area, 2) + " m2 around (" +
           formatFixed(spot.place.x, 2) + ", " + formatFixed(spot.place.y, 2) + ")";
}

}  // namespace ispace

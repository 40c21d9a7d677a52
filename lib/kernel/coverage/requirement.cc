// SPDX-License-Identifier: GPL-3.0-or-later
#include "coverage/requirement.h"

#include <algorithm>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "geom/arrangement.h"

namespace ispace {

namespace {

double shareOfText(std::string_view text) {
    if (const auto share = parseShare(text)) return *share;
    for (const std::string_view rule : {"facing", "privacy"})
        if (text.starts_with(rule))
            throw UsageError('`' + std::string(text) + "` is no requirement of floor: give --" +
                             std::string(rule) +
                             (rule == "facing" ? " ZONE,DEG=95%" : " ZONE,DENSITY"));
    throw UsageError('`' + std::string(text) +
                     "` is no share: write 95% or 0.95, free:95%, zone:NAME=95%, identify:95%");
}

RequiredFigure densityFigure(const Requirement& requirement, const CoverageReport& report) {
    const std::size_t index = *requirement.density;
    const auto of = [index](const std::vector<Metric>& metrics) {
        return metrics.empty() ? Metric{.grid = 0, .exact = 0} : metrics[index];
    };
    const std::string name(className(index, requirement.standard));
    switch (requirement.of) {
        case Requirement::Of::Free:
            return {"free coverage to " + name, of(report.densities.free), report.free_area};
        case Requirement::Of::Zone: {
            const ZoneMetrics& zone = report.zones[zoneIndex(requirement, report)];
            return {"coverage to " + name + " of zone " + printable(zone.id), of(zone.densities),
                    zone.area};
        }
        case Requirement::Of::Indoor:
            break;
    }
    return {"coverage to " + name, of(report.densities.indoor), report.indoor_area};
}

/// Finds the largest piece of the required floor that no camera sees at the required density; empty
/// if unknown.
std::optional<UncoveredSpot> largestWithout(const Requirement& requirement,
                                            const Coverage& coverage) {
    if (coverage.density_overlays.empty() || !coverage.are_densities_whole) return std::nullopt;
    std::uint64_t wanted = requirement.of == Requirement::Of::Free ? kFreeMark : kIndoorMark;
    std::size_t pass = 0;
    if (requirement.of == Requirement::Of::Zone) {
        const std::size_t zone = zoneIndex(requirement, coverage.report);
        wanted |= densityZoneMark(zone);
        pass = zone / kDensityZones;
    }
    const Overlay& overlay = coverage.density_overlays[pass];
    const std::vector<Region> pieces = overlay.regions([&](const LayerLabel& label) {
        return (label.marks & wanted) == wanted &&
               (label.marks & classMark(*requirement.density)) == 0;
    });
    if (pieces.empty()) return std::nullopt;
    const std::vector<double> areas = overlay.areasOf(pieces);
    const auto largest =
        static_cast<std::size_t>(std::max_element(areas.begin(), areas.end()) - areas.begin());
    return UncoveredSpot{interiorPoint(pieces[largest]), areas[largest]};
}

/// Formats an area, with more digits if two would be 0.00.
std::string squareMetres(double area) { return formatFixed(area, area < 0.01 ? 6 : 2) + " m2"; }

}  // namespace

std::string percentBeside(double share, double required) {
    const std::string text = formatFixed(100 * share, 2);
    return text == formatFixed(100 * required, 2) ? formatPercent(roundSignificant(share))
                                                  : text + "%";
}

Requirement parseRequirement(std::string_view text) {
    const auto colon = text.find(':');
    if (const auto found =
            colon == std::string_view::npos ? std::nullopt : findClass(text.substr(0, colon))) {
        const std::string rest(text.substr(colon + 1));
        const bool names_zone = rest.find('=') != std::string::npos && !rest.starts_with("zone:");
        Requirement requirement = parseRequirement(names_zone ? "zone:" + rest : rest);
        if (requirement.density) throw UsageError('`' + std::string(text) + "` has two classes");
        requirement.density = found->index;
        requirement.standard = found->standard;
        return requirement;
    }
    constexpr std::string_view kFree = "free:", kZone = "zone:";
    if (text.starts_with(kFree))
        return {Requirement::Of::Free, "", shareOfText(text.substr(kFree.size()))};
    if (!text.starts_with(kZone)) return {Requirement::Of::Indoor, "", shareOfText(text)};
    // A name may contain an equals sign, a share does not.
    const auto equals = text.rfind('=');
    if (equals == std::string_view::npos || equals == kZone.size())
        throw UsageError('`' + std::string(text) + "` is no requirement: write zone:NAME=95%");
    return {Requirement::Of::Zone, std::string(text.substr(kZone.size(), equals - kZone.size())),
            shareOfText(text.substr(equals + 1))};
}

std::string requirementText(const Requirement& requirement) {
    std::string text;
    if (requirement.density)
        text.append(className(*requirement.density, requirement.standard)) += ':';
    if (requirement.of == Requirement::Of::Free) text += "free:";
    if (requirement.of == Requirement::Of::Zone) text += "zone:" + requirement.zone + '=';
    return text + formatPercent(requirement.share);
}

std::string requirementPhrase(const Requirement& requirement) {
    std::string text = formatPercent(requirement.share) + " of ";
    text += requirement.of == Requirement::Of::Zone   ? "zone " + printable(requirement.zone)
            : requirement.of == Requirement::Of::Free ? "the free floor"
                                                      : "the indoor floor";
    if (!requirement.density) return text;
    const std::string pixels =
        formatDouble(densityClasses()[*requirement.density].pixels_per_metre);
    return text.append(" at ")
        .append(className(*requirement.density, requirement.standard))
        .append(" (" + pixels + " px/m)");
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

std::size_t zoneIndex(const Requirement& requirement, const CoverageReport& report) {
    const auto found =
        std::find_if(report.zones.begin(), report.zones.end(),
                     [&requirement](const ZoneMetrics& one) { return one.id == requirement.zone; });
    return static_cast<std::size_t>(found - report.zones.begin());
}

RequiredFigure figureOf(const Requirement& requirement, const CoverageReport& report) {
    if (requirement.density) return densityFigure(requirement, report);
    switch (requirement.of) {
        case Requirement::Of::Free:
            return {"free coverage", report.free_coverage, report.free_area};
        case Requirement::Of::Zone: {
            const ZoneMetrics& zone = report.zones[zoneIndex(requirement, report)];
            return {"coverage of zone " + printable(zone.id), zone.coverage, zone.area};
        }
        case Requirement::Of::Indoor:
            break;
    }
    return {"coverage", report.coverage, report.indoor_area};
}

Verdict checkRequirement(const Requirement& requirement, const Coverage& coverage) {
    const CoverageReport& report = coverage.report;
    const auto [what, metric, area] = figureOf(requirement, report);
    if (!metric.exact && !metric.grid)
        return {false, what +
                           " is not known: no centre of a cell lies there, and exact figures are "
                           "missing; use smaller cells (--cell)"};
    const double share = metric.exact ? *metric.exact : *metric.grid;
    std::string text = what + " is " + percentBeside(share, requirement.share) +
                       (metric.exact ? " (exact)" : " (by cells)");
    const std::string required = formatPercent(requirement.share);
    const double margin = share - requirement.share;
    if (share >= requirement.share - (metric.exact ? kExactError : 0))
        return {true, text + ", as required (" + required + ")", 0, margin};
    text += ", below the required " + required;
    if (area <= 0) return {false, text + ": it has no floor in the room", 0, margin};
    const double missing = (requirement.share - share) * area;
    text += ": " + squareMetres(missing) + " are missing";
    std::optional<UncoveredSpot> largest;
    if (requirement.density)
        largest = largestWithout(requirement, coverage);
    else if (requirement.of != Requirement::Of::Zone && !report.unseen.empty())
        largest = report.unseen.front();
    if (!largest) return {false, text, missing, margin};
    const UncoveredSpot& spot = *largest;
    return {false,
            text + "; the largest " + (requirement.density ? "such" : "unseen") + " spot has " +
                squareMetres(spot.area) + " around (" + formatFixed(spot.place.x, 2) + ", " +
                formatFixed(spot.place.y, 2) + ")",
            missing, margin};
}

}  // namespace ispace

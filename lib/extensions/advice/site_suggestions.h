// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions for buildings: searched storey by storey, and judged by the floor of all storeys.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "extensions/advice/suggestion.h"
#include "extensions/advice/suggestion_report.h"
#include "extensions/camerarules/site_rules.h"
#include "site/site_coverage.h"
#include "site/site_scene.h"

namespace ispace::advice {

/// Returns the scenes with the ids of all records across the building; null for a storey that
/// shares its scene and the openings in its floor with one below.
std::vector<std::shared_ptr<const Scene>> wholeScenes(const SiteScene& building);

/// Finds the changes of one storey, without the openings in its floor, by suggestChanges(), which
/// may add sensors like those of other storeys: with ids across the building, which added sensors
/// have, too, but with the gains of the storey by itself. Rules of cameras are those of the storey,
/// see rulesOfStorey(); requirements are ignored. \param whole wholeScenes() \pre that of the
/// storey is not null
std::vector<Suggestion> suggestForStorey(const SiteScene& building, std::size_t storey,
                                         std::span<const std::shared_ptr<const Scene>> whole,
                                         const SuggestOptions& options, Progress& progress);

/// Returns the building after edits of one storey, see suggestForStorey().
SiteScene editedStorey(const SiteScene& building, std::size_t storey, const Scene& whole,
                       std::span<const Edit> edits);

/// Finds changes of a measured building that would help, the one with the largest gain first; then
/// those that save a sensor or its cost: those of suggestForStorey() on each storey, of storeys
/// that share a scene and openings on the lowest. Gains and shares are of the floor of the whole
/// building, by measureSite(), so the floor counts that sensors see on other storeys. Rules of
/// cameras come first, by the floor that cameras of a storey miss in it; changes by which the
/// building misses more are left out. Together joins those of all storeys with such rules, if they
/// meet all; the floor that requirements of coverage miss then is its `unmet`. \param coverage of
/// the building, by options.measure
std::vector<Suggestion> suggestForSite(const SiteScene& building, const SiteCoverage& coverage,
                                       const SuggestOptions& options, Progress& progress);

/// Finds suggestForSite(), of a room alone suggestChanges(), and whether they fall short of the
/// rules, of a room alone also of the requirements. \param devices that may stand in for sensors
Advice adviceFor(const SiteScene& building, const SiteCoverage& coverage,
                 const SuggestOptions& options, const DeviceCatalogue& devices, Progress& progress);

}  // namespace ispace::advice

// SPDX-License-Identifier: GPL-3.0-or-later
// The page of a layout in one room, and its parts that pages of buildings have, too.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "cli/report_group.h"
#include "coverage/coverage.h"
#include "extensions/pages/material.h"
#include "report/coverage_report.h"
#include "report/page.h"
#include "scene/scene.h"

namespace ispace::pages {

struct CoveragePageInput {
    /// Media for which maps are drawn: those of others are blank.
    enum class Media { Any, Screen, Paper };

    const Scene& scene;
    const Coverage& coverage;
    std::string name;     ///< base name of ENV; "" from stdin
    std::string command;  ///< as in histories
    std::vector<JudgedRequirement> requirements = {};
    ReportParts parts = {};
    std::vector<PageSection> more = {};  ///< of the tool that writes the page, after the map
    Media media = Media::Any;
    PageCover cover = {};
    Paper paper = Paper::A4;
    PriceList prices = {};
    std::vector<Diagnostic> findings = {};  ///< about sensors, such as one outside of the room
    Progress* progress = nullptr;           ///< of the pictures; null: silent
};

/// Returns what the sections add to the page, in their order.
std::vector<PageAdditions> additionsOf(const ReportParts& parts, const PageSubject& subject);
/// Returns the word for the page in its title: that of a section, or "coverage".
std::string titleOf(std::span<const PageAdditions> additions);

/// Tells how much of the floor the sensors see, how much of it two or more see, on which share
/// cameras identify people, and the largest spot of free floor that none sees.
/// \param sensors number of those that see the floor
PageText sightText(const CoverageReport& report, std::size_t sensors);

/// Tells of findings about sensors, as messages do.
std::vector<PageText> findingTexts(const std::vector<Diagnostic>& findings);

/// Builds the tables of zones and of the densities of cameras; empty without either.
std::vector<PageBlock> zoneTables(const CoverageReport& report);
/// Builds the table of the floor that each sensor sees, sees alone, and shares with others.
/// \param scene whose floor is measured
PageTable sensorsTable(const Scene& scene, const Coverage& coverage);
/// Builds the section on methods and their limits.
PageSection methodsSection(const CoverageReport& report);
/// Returns the records of placed sensors, robots and people as text.
std::string layoutText(const Scene& scene);

/// Builds the table of requirements, with margins in percentage points.
PageTable requirementsTable(std::span<const JudgedRequirement> requirements);

/// Builds the report of a layout: summary, map, requirements, zones, suggestions, the sheet of its
/// installer, pictures, material, methods; commands and records stand in appendices. With a cover
/// each camera has a sheet.
ReportPage coveragePage(const CoveragePageInput& input);

}  // namespace ispace::pages

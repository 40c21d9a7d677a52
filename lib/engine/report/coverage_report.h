// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/report: coverage and runs as text, tables and JSON, maps, pages and pictures for
// people.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "coverage/presence.h"
#include "coverage/run_coverage.h"
#include "report/camera_rules_report.h"
#include "report/objective_report.h"
#include "report/robustness_report.h"
#include "report/suggestion_report.h"

namespace ispace {

/// Parts of a report besides coverage; null: not requested.
struct ReportParts {
    const RunCoverage* run = nullptr;
    const Advice* advice = nullptr;
    const Robustness* robustness = nullptr;
    const CameraRules* rules = nullptr;
    const Presence* presence = nullptr;
    const ObjectiveFigures* objectives = nullptr;
};

/// A room of the site that a report is about.
struct ReportedRoom {
    std::string id;  ///< "" of a room alone
    const CoverageReport* report = nullptr;
};

/// Writes one JSON object and a newline, schema ispace-coverage/1, with a member for each part: the
/// report of a room alone, which is a site of one.
std::string coverageJson(const CoverageReport& report, const ReportParts& parts = {});
/// Writes a room of several so: without `rooms`, as an item of `storeys`.
std::string storeyJson(const CoverageReport& report, const ReportParts& parts);
/// Writes the member `rooms`: what differs from room to room.
void writeRooms(JsonWriter& json, std::span<const ReportedRoom> rooms);
/// Writes the members about the floor of a room, or of all rooms together, from `height` to
/// `comparison`.
void writeFloor(JsonWriter& json, const CoverageReport& report);
/// Writes the members of the parts, in the order of coverageJson().
void writeParts(JsonWriter& json, const ReportParts& parts);
/// Writes the member `comparison`.
void writeComparison(JsonWriter& json, const Comparison& comparison);

/// Writes the report as aligned lines of text.
std::string coverageText(const CoverageReport& report);
/// Writes the parts as they follow coverageText().
std::string partsText(const ReportParts& parts);
/// Writes a table of the comparison, an empty line before it. \param now coverage of this layout
std::string comparisonText(const Comparison& other, const Metric& now);

/// A row of a table in text.
using TextRow = std::vector<std::string>;

/// Aligns columns to their longest cell, two blanks apart; `sides` has an r for each column that is
/// aligned right, its last letter applies to all further columns.
std::string aligned(const std::vector<TextRow>& rows, const std::string& sides);

/// Formats a share with so many decimals: 0.974 is "97.40%" with two.
std::string percentText(double share, int decimals = 2);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// lib/engine/report: coverage and runs as text, tables and JSON, maps, pages and pictures for
// people.
//
// Text rounds for reading, JSON to twelve significant digits (roundSignificant()). An unknown
// metric is null in JSON and left out of text. Tables show figures by cells, exact ones and the
// difference side by side, so that a reader sees the error of the cells. Equal reports give equal
// bytes.
//
//     std::cout << coverageText(coverage.report);
//     writeAll("report.json", coverageJson(coverage.report));
#pragma once

#include <span>
#include <string>
#include <vector>

#include "coverage/coverage.h"
#include "report/report_section.h"
#include "report/text_table.h"

namespace ispace {

/// A room of the site that a report is about.
struct ReportedRoom {
    std::string id;  ///< "" of a room alone
    const CoverageReport* report = nullptr;
};

/// Writes one JSON object and a newline, schema ispace-coverage/1, with the members of its
/// sections: the report of a room alone, which is a site of one.
std::string coverageJson(const CoverageReport& report, const ReportParts& parts = {});
/// Writes a room of several so: without `rooms`, as an item of `storeys`.
std::string storeyJson(const CoverageReport& report, const ReportParts& parts);
/// Writes the member `rooms`: what differs from room to room.
void writeRooms(JsonWriter& json, std::span<const ReportedRoom> rooms);
/// Writes the members about the floor of a room, or of all rooms together, from `height` to
/// `comparison`.
void writeFloor(JsonWriter& json, const CoverageReport& report);
/// Writes the members of the sections.
void writeParts(JsonWriter& json, const ReportParts& parts);
/// Writes the member `comparison`.
void writeComparison(JsonWriter& json, const Comparison& comparison);

/// Writes the report as aligned lines of text.
std::string coverageText(const CoverageReport& report);
/// Writes the sections as they follow coverageText().
std::string partsText(const ReportParts& parts);
/// Writes a table of the comparison, an empty line before it. \param now coverage of this layout
std::string comparisonText(const Comparison& other, const Metric& now);

}  // namespace ispace

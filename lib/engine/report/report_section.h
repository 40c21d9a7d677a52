// SPDX-License-Identifier: GPL-3.0-or-later
// Sections of reports besides the floor: a run, suggestions, rules of cameras. A report knows its
// sections by this interface alone, so an extension adds a section without a change of the report.
// Names of members in JSON are unique in a report; sections of equal rank keep the order in which
// they were added.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/json_writer.h"
#include "report/page.h"

namespace ispace {

class MapLayer;
struct Coverage;
struct CoverageReport;
struct Scene;

/// What a page is about: a room, or a site of several storeys; `Storey` is a part of its page.
struct PageSubject {
    enum class Of { Room, Storey, Site };
    Of of = Of::Room;
    const CoverageReport& report;        ///< of the room or storey; of a site the first storey's
    const Scene* scene = nullptr;        ///< what was measured; null: of a site
    const Coverage* coverage = nullptr;  ///< likewise
};

/// What a section adds to a page, by the place where it stands.
struct PageAdditions {
    std::string title = {};                    ///< of the page in place of "coverage": "run"
    std::vector<PageText> sight = {};          ///< in the summary, after what the sensors see
    std::vector<PageText> judged = {};         ///< in the summary, after the requirements
    std::string caption = {};                  ///< of the map of a storey, in place of its own
    std::vector<PageBlock> tables = {};        ///< after the tables of a storey, or of all storeys
    std::vector<PageSection> figures = {};     ///< before what describes the installation
    std::vector<PageSection> closing = {};     ///< at the end of the figures
    std::vector<PageSection> appendices = {};  ///< before the records
};

/// A section of a report about a room, or a site of several storeys. It writes what it was made of,
/// which outlives it.
///
///     class NoiseSection final : public ReportSection {
///       public:
///         explicit NoiseSection(const Noise& noise) : noise_(noise) {}
///         std::string_view name() const override { return "noise"; }
///         int rank() const override { return 45; }
///         void writeJson(JsonWriter& json) const override { json.key("noise").value(noise_.db); }
///         std::string text() const override { return "noise: ...\n"; }
///     ...
class ReportSection {
  public:
    ReportSection() = default;
    ReportSection(const ReportSection&) = delete;
    ReportSection& operator=(const ReportSection&) = delete;
    virtual ~ReportSection() = default;
    [[nodiscard]] virtual std::string_view name() const = 0;  ///< unique in a report
    /// Returns its place among the sections: those of lower rank come first.
    [[nodiscard]] virtual int rank() const = 0;
    /// Writes its members of the report, between those of the floor and the end of the object.
    virtual void writeJson(JsonWriter& json) const = 0;
    /// Returns lines that follow those of the floor; "" for none.
    [[nodiscard]] virtual std::string text() const = 0;
    [[nodiscard]] virtual PageAdditions page(const PageSubject& /*subject*/) const { return {}; }
    /// Returns what the map of the floor shows of it; null for the floor alone. The layer lives as
    /// long as the section.
    [[nodiscard]] virtual const MapLayer* mapLayer() const { return nullptr; }
};

/// The sections of a report, by rank.
using ReportParts = std::vector<std::shared_ptr<const ReportSection>>;

/// Adds sections, and sorts all by rank; equal ones keep their order.
void join(ReportParts& parts, const ReportParts& more);

/// Returns "met; 87.20% of 4.00 m2 is seen." of a requirement.
std::string outcomeText(bool is_met, const std::string& finding);

/// Returns " with 250 pixels a metre or more (identify), 1.60 m above the floor" of what was asked
/// for; "" for any sight of the floor itself.
std::string judgedAtText(const CoverageReport& report);
/// The same of rules of faces, which are not on the floor: ", judged on the floor" tells so.
std::string facesJudgedAtText(const CoverageReport& report);

}  // namespace ispace

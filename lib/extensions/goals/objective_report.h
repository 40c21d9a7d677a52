// SPDX-License-Identifier: GPL-3.0-or-later
// Ways that are seen least and errors of positions, as a section of the report of coverage.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/goals/least_seen_path.h"
#include "extensions/goals/localisation.h"
#include "report/report_section.h"

namespace ispace::goals {

/// Results of --path and --localise.
struct ObjectiveFigures {
    std::vector<LeastSeenPath> ways;
    std::optional<Localisation> localisation;
};

/// A figure with its name.
struct NamedFigure {
    std::string name;     ///< "way from entrance to vault"
    std::string finding;  ///< "seen for 2.40 of 13.20 m at least"
};

/// Returns the figures in words, those of ways first.
std::vector<NamedFigure> namedFigures(const ObjectiveFigures& figures);

/// Ways that are seen least, and errors of positions: members `paths` and `localisation`, a line
/// for each figure, and the ways on the map. It owns the figures.
class ObjectivesSection final : public ReportSection {
  public:
    explicit ObjectivesSection(ObjectiveFigures figures);
    ~ObjectivesSection() override;
    [[nodiscard]] std::string_view name() const override { return "objectives"; }
    [[nodiscard]] int rank() const override { return 20; }
    void writeJson(JsonWriter& json) const override;
    [[nodiscard]] std::string text() const override;
    [[nodiscard]] PageAdditions page(const PageSubject& subject) const override;
    [[nodiscard]] const MapLayer* mapLayer() const override;

  private:
    ObjectiveFigures figures_;
    std::unique_ptr<const MapLayer> layer_;
};

}  // namespace ispace::goals

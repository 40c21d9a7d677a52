// SPDX-License-Identifier: GPL-3.0-or-later
// The section of reports about a recorded run.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "extensions/runs/run_coverage.h"
#include "report/report_section.h"

namespace ispace::runs {

/// How robots and people were seen in a recorded run: member `run`, tables of text, and their ways
/// on the map. Of a storey without robots and people it has the member alone.
class RunSection final : public ReportSection {
  public:
    explicit RunSection(const RunCoverage& run, bool is_of_storey = false);
    ~RunSection() override;
    [[nodiscard]] std::string_view name() const override { return "run"; }
    [[nodiscard]] int rank() const override { return 40; }
    void writeJson(JsonWriter& json) const override;
    [[nodiscard]] std::string text() const override;
    [[nodiscard]] PageAdditions page(const PageSubject& subject) const override;
    [[nodiscard]] const MapLayer* mapLayer() const override;

  private:
    const RunCoverage& run_;
    bool is_silent_;
    std::unique_ptr<const MapLayer> layer_;
};

}  // namespace ispace::runs

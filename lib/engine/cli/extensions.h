// SPDX-License-Identifier: GPL-3.0-or-later
// The extensions of a build, sorted by what they contribute, for the tools. See cli/extension.h.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "cli/arrange_group.h"
#include "cli/coverage_group.h"
#include "cli/drawing_group.h"
#include "cli/extension.h"
#include "cli/import_group.h"
#include "cli/objective_extension.h"
#include "cli/option_group.h"
#include "cli/proof_extension.h"
#include "cli/record_group.h"
#include "cli/report_group.h"
#include "cli/run_bridge.h"
#include "cli/run_judge.h"
#include "server/client_role.h"

namespace ispace {

/// What an extension that a build lacks would bring.
struct MissingOffer {
    std::string_view extension;
    /// A tool (`name` is its option), or "record", "format", "export", "objective", "proof",
    /// "report", "drawing" (of a "run"), "requirement", "line", of scripts, or "run" ("building").
    std::string_view owner;
    std::string_view name;
};

/// The extensions of a build, sorted by what they contribute; each list is in their order, and ends
/// with rows for what the build lacks, which name the extension to users that ask for it.
class Extensions {
  public:
    /// Calls add() of each extension.
    Extensions(std::span<const Extension> built, std::span<const MissingOffer> missing);

    /// Names in alphabetical order.
    [[nodiscard]] const std::vector<std::string_view>& names() const { return names_; }
    [[nodiscard]] const std::vector<ToolExtension>& options() const { return options_; }
    [[nodiscard]] const std::vector<ObjectiveRow>& objectives() const { return objectives_; }
    [[nodiscard]] const std::vector<ArrangeRow>& arrange() const { return arrange_; }
    [[nodiscard]] const std::vector<CoverageRow>& coverage() const { return coverage_; }
    [[nodiscard]] const std::vector<ImportRow>& imports() const { return imports_; }
    [[nodiscard]] const std::vector<RecordRow>& records() const { return records_; }
    [[nodiscard]] const std::vector<ReportRow>& reports() const { return reports_; }
    [[nodiscard]] const std::vector<DrawingRow>& drawings() const { return drawings_; }
    [[nodiscard]] const std::vector<ProofRow>& proofs() const { return proofs_; }
    [[nodiscard]] const std::vector<MakeJudge>& judges() const { return judges_; }
    [[nodiscard]] const std::vector<BridgeRow>& bridges() const { return bridges_; }
    [[nodiscard]] const std::vector<MakeRoleService>& roles() const { return roles_; }
    [[nodiscard]] const BuildingRuns& buildings() const { return buildings_; }

  private:
    std::vector<std::string_view> names_;
    std::vector<ToolExtension> options_;
    std::vector<ObjectiveRow> objectives_;
    std::vector<ArrangeRow> arrange_;
    std::vector<CoverageRow> coverage_;
    std::vector<ImportRow> imports_;
    std::vector<RecordRow> records_;
    std::vector<ReportRow> reports_;
    std::vector<DrawingRow> drawings_;
    std::vector<ProofRow> proofs_;
    std::vector<MakeJudge> judges_;
    std::vector<BridgeRow> bridges_;
    std::vector<MakeRoleService> roles_;
    BuildingRuns buildings_;
};

}  // namespace ispace

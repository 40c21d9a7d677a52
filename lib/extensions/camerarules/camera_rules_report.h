// SPDX-License-Identifier: GPL-3.0-or-later
// Outcomes of rules of cameras in words: for reports of coverage and arrange, as a table and as
// members of JSON. A text names the rule as the option gives it, and the area or share that
// decides.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "extensions/camerarules/camera_rules.h"
#include "report/report_section.h"

namespace ispace::camerarules {

/// Results of --facing and --privacy.
struct CameraRules {
    std::vector<FacingResult> facing;
    std::vector<PrivacyResult> privacy;
};

/// A rule with its outcome.
struct JudgedRule {
    std::string rule;  ///< "facing entrance within 45 degrees of 180", "privacy of desk1"
    bool is_met = false;
    bool is_required = true;
    std::string plain = {};  ///< `rule` for a client, "faces at the door Front"; "": as it is
    std::string finding;     ///< "87.20% of 4.00 m2 is seen", "0.52 m2 is seen by c1, c2"
};

/// Returns the rules in the order of the results, those of facing first.
std::vector<JudgedRule> judgedRules(const CameraRules& rules);

/// Builds the table of rules of cameras.
PageTable rulesTable(std::string caption, std::span<const JudgedRule> rules);

/// Rules of cameras in a room, which it owns: members `facing` and `privacy`, a line for each rule.
class RulesSection final : public ReportSection {
  public:
    explicit RulesSection(CameraRules rules) : rules_(std::move(rules)) {}
    [[nodiscard]] std::string_view name() const override { return "rules"; }
    [[nodiscard]] int rank() const override { return 10; }
    void writeJson(JsonWriter& json) const override;
    [[nodiscard]] std::string text() const override;
    [[nodiscard]] PageAdditions page(const PageSubject& subject) const override;

  private:
    CameraRules rules_;
};

}  // namespace ispace::camerarules

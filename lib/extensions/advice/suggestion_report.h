// SPDX-License-Identifier: GPL-3.0-or-later
// Suggestions in words: the section of the report of coverage, with the command of each change.
//
// Gains are square metres of indoor floor, shares those of all of it. The commands quote ids for a
// shell.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "extensions/advice/suggestion.h"
#include "report/report_section.h"

namespace ispace::advice {

/// Suggestions for a scene, and the beginning of the command that changes it (editCommand()).
struct Advice {
    std::vector<Suggestion> suggestions;
    std::string command;
    bool has_fixed = true;  ///< some sensor stands by itself: others like it may be added
    bool is_short = false;  ///< requirements fail, and no suggestion meets all of them
    bool is_cut = false;    ///< time or a signal ended the search: others may help more
};

/// Told with Advice::is_short.
constexpr const char* kShortAdvice =
    "no short list of changes was found that meets all requirements";

/// Told with Advice::is_cut.
constexpr const char* kCutAdvice = "cut short: other changes were not tried, and may help more";

/// Returns the gain of a change: "+3.20 m2, to 85.71%; saves 120", and
/// for requirements "; 1.20 m2 less are missing" or "; meets all requirements".
std::string gainText(const Suggestion& suggestion);

/// Changes that help: member `suggestions`, a line with the gain and one with the command of each.
class AdviceSection final : public ReportSection {
  public:
    explicit AdviceSection(const Advice& advice) : advice_(advice) {}
    [[nodiscard]] std::string_view name() const override { return "suggestions"; }
    [[nodiscard]] int rank() const override { return 60; }
    void writeJson(JsonWriter& json) const override;
    [[nodiscard]] std::string text() const override;
    [[nodiscard]] PageAdditions page(const PageSubject& subject) const override;

  private:
    const Advice& advice_;
};

}  // namespace ispace::advice

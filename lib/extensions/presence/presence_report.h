// SPDX-License-Identifier: GPL-3.0-or-later
// Presence as a section of the report of coverage: JSON, text and page tell the same figures.
#pragma once

#include <string>
#include <string_view>

#include "extensions/presence/presence.h"
#include "report/report_section.h"

namespace ispace::presence {

/// The share of people's ways that sensors of motion detect: member `presence`, a table each of
/// people and sensors.
class PresenceSection final : public ReportSection {
  public:
    explicit PresenceSection(const Presence& presence) : presence_(presence) {}
    [[nodiscard]] std::string_view name() const override { return "presence"; }
    [[nodiscard]] int rank() const override { return 50; }
    void writeJson(JsonWriter& json) const override;
    [[nodiscard]] std::string text() const override;
    [[nodiscard]] PageAdditions page(const PageSubject& subject) const override;

  private:
    const Presence& presence_;
};

}  // namespace ispace::presence

// SPDX-License-Identifier: GPL-3.0-or-later
// Mountings, failures and crowds as a section of the report of coverage.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/robustness/failures.h"
#include "extensions/robustness/figure_samples.h"
#include "extensions/robustness/mounting.h"
#include "report/report_section.h"

namespace ispace::robustness {

/// Coverage under errors of mounting, failures and among people, as far as it was requested.
struct Robustness {
    std::vector<Requirement> requirements;
    MountingTolerance tolerance = {};
    std::optional<SampledFigures> mounting = {};  ///< within the tolerance
    enum class CrowdOf { Random, Scene, Run };
    CrowdOf crowd_of = CrowdOf::Random;
    int people = 0;                            ///< of a random crowd
    std::optional<SampledFigures> crowd = {};  ///< with people in the room
    int failures = 0;                          ///< number of sensors that fail; 0: not requested
    std::vector<FigureLoss> losses = {};
};

/// Coverage under errors of mounting, failures and among people: members `mounting`, `failures` and
/// `crowd`, tables of figures, and a line for each requirement.
class RobustnessSection final : public ReportSection {
  public:
    explicit RobustnessSection(const Robustness& robustness) : robustness_(robustness) {}
    [[nodiscard]] std::string_view name() const override { return "robustness"; }
    [[nodiscard]] int rank() const override { return 30; }
    void writeJson(JsonWriter& json) const override;
    [[nodiscard]] std::string text() const override;
    [[nodiscard]] PageAdditions page(const PageSubject& subject) const override;

  private:
    const Robustness& robustness_;
};

/// "mounted within 0.05 m and 3 degrees, 100 times"
std::string mountingText(const Robustness& robustness);
/// "with 10 people at random, 100 times"
std::string crowdText(const Robustness& robustness);
/// "any 2 sensors fail"
std::string failuresText(int count);
/// Returns heads and rows of the tables, for text and pages; a single sample has no quantiles.
/// \param has_error adds the standard error of the mean
std::vector<std::vector<std::string>> spreadRows(const SampledFigures& sampled,
                                                 bool has_error = false);
std::vector<std::vector<std::string>> failureRows(const Robustness& robustness);
/// Returns a sentence for each requirement: "90% is met by 87 of 100 mountings", "90% is met by
/// any failure", "90% is not met without l2", "90% is met by 80 of 100 crowds".
std::vector<std::string> robustRequirements(const Robustness& robustness);

}  // namespace ispace::robustness

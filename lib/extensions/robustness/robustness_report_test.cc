// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/robustness/robustness_report.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ispace::robustness {
namespace robustness_report_test {

TEST(RobustnessReport, ACrowdOfOneMomentHasNoQuantiles) {
    Robustness robustness;
    robustness.crowd_of = Robustness::CrowdOf::Scene;
    robustness.requirements = {parseRequirement("90%")};
    robustness.crowd = SampledFigures{1, {{{}, "coverage", 0.95, true, {0.8}}}, {0}};
    EXPECT_EQ(spreadRows(*robustness.crowd),
              (std::vector<std::vector<std::string>>{{"", "planned", "measured"},
                                                     {"coverage", "95.00%", "80.00%"}}));
    EXPECT_EQ(robustRequirements(robustness),
              std::vector<std::string>{"90% is not met with the people of the scene"});
    robustness.crowd->met = {1};
    EXPECT_EQ(robustRequirements(robustness),
              std::vector<std::string>{"90% is met with the people of the scene"});
}

}  // namespace robustness_report_test
}  // namespace ispace::robustness

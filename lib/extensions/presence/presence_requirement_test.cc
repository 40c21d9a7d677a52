// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/presence/presence_requirement.h"

#include <gtest/gtest.h>

#include "base/error.h"

namespace ispace::presence {
namespace presence_requirement_test {

Presence someone() {
    return {{{"anna", 20, 0.75, 3}, {"bo", 0, 0, 0}, {"a=b", 10, 1, 0}}, {"", 30, 0.8333, 3}, {}};
}

Verdict check(std::string_view text) {
    return checkRequirement(parsePresenceRequirement(text).value(), someone());
}

TEST(PresenceRequirement, IsParsed) {
    EXPECT_EQ(parsePresenceRequirement("presence:95%"), (PresenceRequirement{"", 0.95}));
    EXPECT_EQ(parsePresenceRequirement("presence:0.5"), (PresenceRequirement{"", 0.5}));
    EXPECT_EQ(parsePresenceRequirement("presence:anna=50%"), (PresenceRequirement{"anna", 0.5}));
    EXPECT_EQ(parsePresenceRequirement("presence:a=b=50%"), (PresenceRequirement{"a=b", 0.5}));
    for (const char* other : {"95%", "zone:presence=95%", "presence", "free:3%"})
        EXPECT_FALSE(parsePresenceRequirement(other)) << other;
    for (const char* bad :
         {"presence:", "presence:95", "presence:=95%", "presence:anna=", "presence:anna"})
        EXPECT_THROW(parsePresenceRequirement(bad), UsageError) << bad;
    for (const char* text : {"presence:95%", "presence:anna=50%"})
        EXPECT_EQ(requirementText(parsePresenceRequirement(text).value()), text);
}

TEST(PresenceRequirement, IsOfAllOrOfAPerson) {
    EXPECT_TRUE(check("presence:80%").is_met);
    EXPECT_FALSE(check("presence:84%").is_met);
    EXPECT_TRUE(check("presence:anna=75%").is_met) << "the end is included";
    EXPECT_TRUE(check("presence:a=b=100%").is_met);
    EXPECT_EQ(check("presence:anna=90%").text,
              "presence of anna is 75.00% of the ways, below the required 90%: 3.00 m are missing; "
              "the longest undetected part has 3.00 m");
    EXPECT_EQ(check("presence:80%").text, "presence is 83.33% of the ways, as required (80%)");
    EXPECT_FALSE(check("presence:bo=0%").is_met);
    EXPECT_EQ(check("presence:bo=10%").text, "presence of bo is not known: there is no way");
}

TEST(PresenceRequirement, NamesPeopleInsteadOfAnUnknownOne) {
    const auto message = [](std::string_view text, const Presence& presence) -> std::string {
        try {
            checkRequirement(parsePresenceRequirement(text).value(), presence);
        } catch (const UsageError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(message("presence:ana=10%", someone()),
              "--presence has no person `ana`, did you mean `anna`?");
    EXPECT_EQ(message("presence:human=10%", someone()),
              "--presence has no person `human`; there is anna, bo, a=b");
    EXPECT_EQ(message("presence:human=10%", {}), "--presence has no person `human`: there is none");
    Presence crowd;
    for (int i = 1; i <= 20; ++i) crowd.people.push_back({"wanderer" + std::to_string(i), 1, 1, 0});
    const std::string many = message("presence:h=10%", crowd);
    EXPECT_TRUE(many.ends_with(", wanderer12 and 8 more")) << many;
}

}  // namespace presence_requirement_test
}  // namespace ispace::presence

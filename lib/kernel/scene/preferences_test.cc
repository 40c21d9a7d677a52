// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/preferences.h"

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"
#include "support/test_layout.h"

namespace ispace {
namespace preferences_test {

Preferences preferred(const std::string& text) {
    const Scene scene =
        testing::scene("ispace size=6,6\n", "human id=ann tag=42 prefers=" + text + "\n");
    return preferencesOf(scene.records.back());
}

TEST(Preferences, AreRead) {
    EXPECT_EQ(preferred("light:300;temp:21").lux, 300);
    EXPECT_EQ(preferred("light:300;temp:21").celsius, 21);
    EXPECT_EQ(preferred("temp:-5.5").celsius, -5.5);
    EXPECT_EQ(preferred("temp:19").lux, std::nullopt);
}

TEST(Preferences, AreRefusedWithHints) {
    const auto refusal = [](const std::string& text) {
        try {
            preferred(text);
        } catch (const FormatError& error) {
            return error.diagnostics().front().message;
        }
        return std::string();
    };
    EXPECT_EQ(refusal("lihgt:300"),
              "`prefers`: `lihgt:300` is no preference, wanted light:LUX or temp:CELSIUS, did you "
              "mean `light`?");
    EXPECT_EQ(refusal("light:-1"), "`prefers`: `light:-1`: wanted a number from 0 to 1000000");
    EXPECT_EQ(refusal("temp:warm"), "`prefers`: `temp:warm`: wanted a number from -100 to 100");
    EXPECT_EQ(refusal("temp:20;temp:21"), "`prefers`: `temp` is given twice");
    for (const char* const bad : {"light", "light:300;", ";", "light:", "temp:nan"})
        EXPECT_NE(refusal(bad), "") << bad;
}

}  // namespace preferences_test
}  // namespace ispace

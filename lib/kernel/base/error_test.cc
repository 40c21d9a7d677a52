// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/error.h"

#include <gtest/gtest.h>

namespace ispace {
namespace error_test {

TEST(Diagnostic, NamesWhatPlaceItHas) {
    EXPECT_EQ((Diagnostic{"room.env", 14, 7, "wall has zero length"}).text(),
              "room.env:14:7: error: wall has zero length");
    EXPECT_EQ((Diagnostic{"room.env", 14, 0, "x"}).text(), "room.env:14: error: x");
    EXPECT_EQ((Diagnostic{"room.env", 0, 7, "x"}).text(), "room.env: error: x");
    EXPECT_EQ((Diagnostic{"", 0, 0, "x"}).text(), "error: x");
}

TEST(Diagnostics, KeepsTwentyAndCountsTheRest) {
    Diagnostics findings;
    EXPECT_NO_THROW(findings.throwIfAny());
    for (int i = 1; i <= 23; ++i) findings.add({"f", i, 1, "x"});
    try {
        findings.throwIfAny();
        FAIL();
    } catch (const FormatError& error) {
        ASSERT_EQ(error.diagnostics().size(), 20U);
        EXPECT_STREQ(error.what(), "f:1:1: error: x");
        EXPECT_EQ(error.diagnostics().back().text(), "f:20:1: error: x (3 more errors not shown)");
    }
}

TEST(Diagnostics, TakesOverCaughtErrors) {
    Diagnostics findings;
    findings.add({"f", 1, 1, "a"});
    findings.add(FormatError({{"g", 2, 2, "b"}, {"g", 3, 3, "c"}}));
    EXPECT_FALSE(findings.empty());
    EXPECT_FALSE(findings.full());
    try {
        findings.throwIfAny();
        FAIL();
    } catch (const FormatError& error) {
        ASSERT_EQ(error.diagnostics().size(), 3U);
        EXPECT_EQ(error.diagnostics()[2].text(), "g:3:3: error: c");
    }
}

TEST(DisplayName, StandardInputHasAName) {
    EXPECT_EQ(displayName("-"), "stdin");
    EXPECT_EQ(displayName("a"), "a");
}

}  // namespace error_test
}  // namespace ispace

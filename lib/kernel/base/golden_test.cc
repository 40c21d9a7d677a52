// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/golden.h"

#include <gtest/gtest.h>

namespace ispace {
namespace golden_test {

bool same(std::string_view expected, std::string_view actual, Tolerance tolerance = {0.01, 0}) {
    return textDifference(expected, actual, tolerance).empty();
}

TEST(TextDifference, NumbersAgreeWithinTheTolerance) {
    EXPECT_TRUE(same("at=1.00,2", "at=1.005,2.0"));
    EXPECT_TRUE(same("(4.1, -2).", "(4.105, -2.001)."));
    EXPECT_FALSE(same("at=1.00,2", "at=1.02,2"));
    EXPECT_FALSE(same("at=1", "at=-1"));
    EXPECT_TRUE(same("1000", "1009", {0, 0.01}));
    EXPECT_FALSE(same("1000", "1011", {0, 0.01}));
    EXPECT_TRUE(same("97.4%", "97.405%"));
}

TEST(TextDifference, WordsWithDigitsAreNoNumbers) {
    EXPECT_FALSE(same("sha256:1234ab", "sha256:1234ac"));
    EXPECT_FALSE(same("5cm", "5.001cm"));
    EXPECT_FALSE(same("id=l1", "id=l2"));
    EXPECT_FALSE(same("null", "nan"));
    EXPECT_FALSE(same("1", "inf"));
}

TEST(TextDifference, BlanksLinesAndLengthCount) {
    EXPECT_TRUE(same("", ""));
    EXPECT_FALSE(same("", "a"));
    EXPECT_FALSE(same("a", ""));
    EXPECT_FALSE(same("a\n", "a"));
    EXPECT_FALSE(same("a b", "a  b"));
    EXPECT_FALSE(same("1,2", "1,2,3"));
    EXPECT_NE(textDifference("a\nb\n", "a\nc\n", {}).find("line 2"), std::string::npos);
}

TEST(WithoutHistory, DropsOnlyTheLinesAfterTheMagicLine) {
    EXPECT_EQ(withoutHistory("#env 1\n# envc a\n# envc b\nwall\n# note\n"),
              "#env 1\nwall\n# note\n");
    EXPECT_EQ(withoutHistory("#3dm 1\n# x"), "#3dm 1\n");
    EXPECT_EQ(withoutHistory("# note\nwall\n"), "# note\nwall\n");
    EXPECT_EQ(withoutHistory(""), "");
}

TEST(WithoutHistory, EmptiesTheListInJson) {
    EXPECT_EQ(withoutHistory(R"({"a":1,"history":["x ]","\"]"],"seed":0})"),
              R"({"a":1,"history":[],"seed":0})");
    EXPECT_EQ(withoutHistory(R"({"history":[)"), R"({"history":[)");
}

}  // namespace golden_test
}  // namespace ispace

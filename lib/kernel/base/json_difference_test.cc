// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_writer.h"

#include <gtest/gtest.h>

namespace ispace {
namespace json_difference_test {

using Lines = std::vector<std::string>;

Lines differences(std::string_view expected, std::string_view actual,
                  const std::vector<std::string>& ignored = {}) {
    return jsonDifferences(expected, actual, {1e-6, 1e-9}, ignored).value_or(Lines{"no JSON"});
}

TEST(JsonDifference, NamesKeyValuesAndTolerance) {
    EXPECT_EQ(differences(R"({"coverage":{"exact":0.9168,"grid":0.5}})",
                          R"({"coverage":{"exact":0.8582,"grid":0.5000005}})"),
              Lines{"coverage.exact: 0.9168 → 0.8582 (±1e-6)"});
    EXPECT_EQ(differences(R"({"a":[1,{"b":"x"}]})", R"({"a":[1,{"b":"y"}]})"),
              Lines{R"(a.1.b: "x" → "y")"});
    EXPECT_EQ(differences(R"({"a":null})", R"({"a":1})"), Lines{"a: null → 1"});
    EXPECT_EQ(differences("[1e6]", "[1000001]"), Lines{"0: 1000000 → 1000001 (±0.001)"});
}

TEST(JsonDifference, OrderAndBlanksDoNotCount) {
    EXPECT_EQ(differences(R"({"a":1,"b":[2]})", "{ \"b\": [2.0],\n \"a\": 1 }"), Lines{});
}

TEST(JsonDifference, NamesMissingValues) {
    EXPECT_EQ(differences(R"({"a":[1,2]})", R"({"a":[1],"b":{"c":3}})"),
              (Lines{"a.1: 2 → missing", "b: missing → an object"}));
}

TEST(JsonDifference, LeavesIgnoredKeysOut) {
    const char* a = R"({"digest":"x","sensors":[{"id":"l1","model":"m"}]})";
    const char* b = R"({"digest":"y","sensors":[{"id":"l2","model":"n"}]})";
    EXPECT_EQ(differences(a, b).size(), 3U);
    EXPECT_EQ(differences(a, b, {"digest", "model"}), Lines{R"(sensors.0.id: "l1" → "l2")"});
    EXPECT_EQ(differences(a, b, {"digest", "sensors.*.model"}),
              Lines{R"(sensors.0.id: "l1" → "l2")"});
    EXPECT_EQ(differences(a, b, {"d*", "sensors"}), Lines{});
    EXPECT_EQ(differences(a, b, {"sensors", "gest"}), Lines{R"(digest: "x" → "y")"});
}

TEST(JsonDifference, ComparesLines) {
    EXPECT_EQ(differences("{\"t\":1}\n{\"t\":2}\n", "{\"t\":1}\n{\"t\":3}\n{\"t\":4}\n"),
              (Lines{"line 2: t: 2 → 3 (±1e-6)", "line 3: missing → an object"}));
    EXPECT_EQ(differences("{\"t\":1}\n{\"t\":2}\n", "{\"t\":1}\n{\"t\":3}\n", {"t"}), Lines{});
}

TEST(JsonDifference, IsForJsonAlone) {
    for (const char* text : {"", "1000\n", "#env 1\n", "{\"a\":1", "97.4%"})
        EXPECT_FALSE(jsonDifferences("{}", text, {}, {})) << text;
}

}  // namespace json_difference_test
}  // namespace ispace

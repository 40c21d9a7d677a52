// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/json_writer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace ispace {
namespace json_writer_test {

TEST(JsonWriter, PutsCommasBetweenValues) {
    JsonWriter json;
    json.beginObject().key("a").value(1).key("b").beginArray();
    json.value(1.5).value(true).beginArray().endArray().beginObject().endObject().null();
    json.endArray().key("c").beginObject().key("d").value("x").endObject().endObject();
    EXPECT_EQ(json.text(), R"({"a":1,"b":[1.5,true,[],{},null],"c":{"d":"x"}})");
    EXPECT_EQ(json.take(), R"({"a":1,"b":[1.5,true,[],{},null],"c":{"d":"x"}})");
}

TEST(JsonWriter, WritesListsAndWhatIsMissing) {
    JsonWriter json;
    json.beginArray().value(std::vector<double>{1, 0.1}).value(std::vector<int>{});
    json.value(std::optional<double>()).value(std::optional<double>(2));
    json.value(std::numeric_limits<std::int64_t>::min()).endArray();
    EXPECT_EQ(json.text(), "[[1,0.1],[],null,2,-9223372036854775808]");
}

TEST(JsonWriter, NumbersAreShortestAndFinite) {
    JsonWriter json;
    json.beginArray().value(0.1).value(0.1F).value(-0.0).value(1e300);
    json.value(std::nan("")).value(std::numeric_limits<double>::infinity());
    json.value(-std::numeric_limits<float>::infinity()).endArray();
    EXPECT_EQ(json.text(), "[0.1,0.1,0,1e+300,null,null,null]");
}

TEST(JsonWriter, EscapesTexts) {
    JsonWriter json;
    json.beginObject().key("a\"b").value(std::string_view("\\ / \n \t \r \x01 \0 \x7f", 15));
    json.endObject();
    EXPECT_EQ(json.text(), "{\"a\\\"b\":\"\\\\ / \\n \\t \\u000d \\u0001 \\u0000 \x7f\"}");
}

std::string quoted(std::string_view text) { return JsonWriter().value(text).text(); }

TEST(JsonWriter, KeepsUtf8AndReplacesWhatIsNot) {
    EXPECT_EQ(quoted("h\xc3\xb6he \xe2\x82\xac \xf0\x9f\x98\x80"),
              "\"h\xc3\xb6he \xe2\x82\xac \xf0\x9f\x98\x80\"");
    const std::string sign = "\xef\xbf\xbd";
    EXPECT_EQ(quoted("a\xffz"), "\"a" + sign + "z\"");
    EXPECT_EQ(quoted("\xc3"), '"' + sign + '"') << "cut off";
    EXPECT_EQ(quoted("\xc0\xaf"), '"' + sign + sign + '"') << "overlong";
    EXPECT_EQ(quoted("\xed\xa0\x80"), '"' + sign + sign + sign + '"') << "surrogate";
    EXPECT_EQ(quoted("\xf4\x90\x80\x80"), '"' + sign + sign + sign + sign + '"') << "too large";
}

}  // namespace json_writer_test
}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "record/schema.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/test_schemas.h"

namespace ispace {

namespace schema_test {

KeySpec sizeKey() {
    KeySpec key = testKey("size", KeyType::Tuple, Unit::Length);
    key.help = "length,width[,height]";
    key.min_count = 2;
    key.max_count = 3;
    key.default_value = Tuple{1.2, 0.8};
    key.lower = 0;
    key.lower_open = true;
    key.upper = 1e6;
    return key;
}

TEST(Manual, NamesValuesBoundsAndDefaults) {
    KeySpec kind = testKey("kind", KeyType::Choice);
    kind.help = "-what it is";
    kind.choices = {"plain", "two-tone"};
    KeySpec tilt = testKey("tilt", KeyType::Number, Unit::Angle);
    tilt.lower = -90;
    tilt.upper = 90;
    tilt.required = true;
    const Schema schema{
        "desk", RecordType::Other, "a desk", {testKey("id", KeyType::Word), sizeKey(), kind, tilt}};
    EXPECT_EQ(manualOf(schema),
              ".SS desk\nA desk.\n"
              ".TP\n.BR size= \"\\fIM,M[,M]\\fR\"\nlength,width[,height].\nAbove 0.\n"
              "Default: 1.2,0.8.\n"
              ".TP\n.BR kind= \"\\fIplain|two\\-tone\\fR\"\n\\-what it is.\n"
              ".TP\n.BR tilt= \"\\fIDEG\\fR\"\nHelp on tilt.\nAt least \\-90, at most 90.\n"
              "Must be given.\n");
}

TEST(Manual, PutsRecordsInTheirPlace) {
    const std::string page = expandManual(".TH X\n@RECORDS wall other@\n.SH END\n", testSchemas());
    EXPECT_TRUE(page.starts_with(".TH X\n.SS fence\n")) << page;
    EXPECT_NE(page.find(".SS desk\n"), std::string::npos);
    EXPECT_EQ(page.find(".SS laser\n"), std::string::npos);
    EXPECT_TRUE(page.ends_with(".SH END\n"));
    const std::string own =
        expandManual(".TH X\n@RECORDS wall other@\n.SS desk\nOf oak.\n", testSchemas());
    EXPECT_EQ(own.find(".SS desk\n"), own.rfind(".SS desk\n"));
    EXPECT_THROW(expandManual("@RECORDS walls@\n", testSchemas()), FormatError);
}

}  // namespace schema_test

}  // namespace ispace

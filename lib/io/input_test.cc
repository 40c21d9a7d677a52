// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/input.h"

#include <gtest/gtest.h>

#include <random>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "layout/schemas.h"
#include "record/text.h"

namespace ispace {
namespace {

using namespace std::string_literals;

Document parse(std::string_view bytes) { return parseDocument(bytes, "room", {}, sceneSchemas()); }

std::string errorOf(std::string_view bytes) {
    try {
        parse(bytes);
    } catch (const FormatError& error) {
        return error.what();
    }
    return "no error";
}

TEST(Input, ToldApartByContent) {
    EXPECT_EQ(parse("#env 1\ndesk at=1,2\n").records.size(), 1U);
    EXPECT_EQ(parse("#3dm 1\nlaser at=1,2\n").kind, DocumentKind::Layout);
    EXPECT_EQ(parse("desk: {at: [1, 2]}\n").records.front().keyword(), "desk");
    EXPECT_EQ(parse("# a comment\n\n- desk: {at: [1, 2]}\n").records.size(), 1U);
    EXPECT_EQ(parse("\xEF\xBB\xBF#env 1\ndesk at=1,2\n").records.size(), 1U);
}

TEST(Input, SaysWhatItWanted) {
    const std::string wanted = "wanted GLB, `#env 1`, `#3dm 1`, YAML or a ROS map";
    EXPECT_EQ(errorOf(""), "room: error: empty input: " + wanted);
    EXPECT_EQ(errorOf(" \n\r\n"), "room: error: empty input: " + wanted);
    for (const std::string& junk :
         {"\x7f\x45LF\x02\x01\x00"s, "\xff\xfe\x23\x00"s, "a\x01"s, "\x00"s})
        EXPECT_EQ(errorOf(junk), "room: error: not an environment or layout: " + wanted);
    EXPECT_EQ(errorOf("P5\n2 2\n255\nabcd"),
              "room: error: not an environment or layout but a PGM picture: name the map.yaml that "
              "goes with it");
    EXPECT_EQ(errorOf("\x89PNG\r\n\x1a\n"),
              "room: error: not an environment or layout but a PNG picture");
}

TEST(Input, RecordsWithoutMagicLine) {
    const std::string hint =
        "a record before the magic line: the first line must be `#env 1` or `#3dm 1`";
    EXPECT_EQ(errorOf("desk at=1,2\n"), "room:1:1: error: " + hint);
    EXPECT_EQ(errorOf("# my room\n\n  unknown key=1 other=2\n"), "room:3:1: error: " + hint);
    EXPECT_EQ(errorOf("ispace\n"), "room:1:1: error: " + hint);
    // What looks like YAML is left to its reader.
    EXPECT_EQ(errorOf("desk: at=1,2\n").find(hint), std::string::npos);
    EXPECT_EQ(errorOf("- desk: {at: \"1=2\"}\n").find(hint), std::string::npos);
    EXPECT_EQ(errorOf("just words\n").find(hint), std::string::npos);
}

TEST(Input, FilesThatAreNotThere) {
    EXPECT_THROW(readDocument("/nonexistent/room.env", {}, sceneSchemas()), std::system_error);
    EXPECT_THROW(readDocument(ISPACE_BINARY_DIR, {}, sceneSchemas()), std::system_error);
}

TEST(Input, RandomBytesAreErrors) {
    std::mt19937_64 random(5);
    const std::vector<std::string> starts{"",     "glTF", "#env 1\n",           "#3dm 1\n",
                                          "P5\n", "- ",   "image: resolution: "};
    for (int i = 0; i < 4000; ++i) {
        std::string bytes = starts[static_cast<std::size_t>(i) % starts.size()];
        for (std::size_t n = 1 + random() % 60; n > 0; --n) bytes += static_cast<char>(random());
        EXPECT_THROW(parse(bytes + '\x02'), FormatError);
    }
}

}  // namespace
}  // namespace ispace

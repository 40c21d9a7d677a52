// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/importers.h"

#include <gtest/gtest.h>

#include <random>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "record/text.h"
#include "scene/placement_schemas.h"
#include "support/test_paths.h"

namespace ispace {
namespace input_test {

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
    const std::string wanted = "wanted GLB, YAML, `#3dm 1`, `#env 1`, a ROS map or a picture";
    EXPECT_EQ(errorOf(""), "room: error: empty input: " + wanted);
    EXPECT_EQ(errorOf(" \n\r\n"), "room: error: empty input: " + wanted);
    for (const std::string& junk :
         {"\x7f\x45LF\x02\x01\x00"s, "\xff\xfe\x23\x00"s, "a\x01"s, "\x00"s})
        EXPECT_EQ(errorOf(junk), "room: error: not an environment or layout: " + wanted);
}

TEST(Input, JsonIsYamlToo) { EXPECT_EQ(parse("{\"desk\": {\"at\": [1, 2]}}").records.size(), 1U); }

TEST(Input, NamesTheExtensionThatWouldReadIt) {
    addMissingFormat(".plan9", "sketches");
    addMissingFormat("<plan9", "sketches");
    addMissingFormat("#PLAN9", "sketches");
    const ImportOptions options;
    const auto errorOfFile = [&](const std::string& bytes, const std::string& operand) {
        try {
            parseDocument(bytes, operand, options, sceneSchemas());
        } catch (const FormatError& error) {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    const std::string lacks =
        ": error: this build lacks the extension sketches, which reads such files";
    EXPECT_EQ(errorOfFile("walls\n", "a.PLAN9"), "a.PLAN9" + lacks);
    EXPECT_EQ(errorOfFile("<?xml version='1.0'?><plan9/>", "room"), "room" + lacks);
    EXPECT_EQ(errorOfFile("#PLAN9 1\n", "room"), "room" + lacks);
    EXPECT_EQ(errorOfFile("#env 1\ndesk at=1,2\n", "a.plan9"), "no error");
}

TEST(Input, OtherFormatsGetAHint) {
    EXPECT_NE(errorOf("AutoCAD Binary DXF\r\n\x1a\0"s).find("but binary DXF: save it as ASCII DXF"),
              std::string::npos);
    EXPECT_NE(errorOf("AC1027\0\0"s).find("but a DWG drawing: convert it to DXF"),
              std::string::npos);
    EXPECT_NE(errorOf("{\"type\": \"FeatureCollection\", \"features\": []}").find("but GeoJSON"),
              std::string::npos);
    EXPECT_NE(errorOf("{\"id\": 1}").find("error"), std::string::npos);
}

TEST(Input, PicturesAlone) {
    const std::string pgm = "P5\n3 1\n255\n\xff\xff\xff";
    EXPECT_NE(errorOf(pgm).find("room: error: a picture does not say how large its pixels are"),
              std::string::npos);
    ImportOptions options;
    options.resolution = 2;
    EXPECT_EQ(parseDocument(pgm, "room.pgm", options, sceneSchemas()).records.size(), 2U);
    EXPECT_TRUE(isPlan(pgm, "room.pgm", options, sceneSchemas()));
}

TEST(Input, FormatsThatAreNotReadAreNamed) {
    const std::vector<std::pair<std::string, std::string>> files{
        {"%PDF-1.7\n", "but a PDF: if it was drawn, not scanned, convert it to SVG"},
        {"%!PS-Adobe-3.0", "but PostScript: convert it"},
        {"8BPS\0\1"s, "but a Photoshop picture: convert it"},
        {"gimp xcf v011\0"s, "but a GIMP picture: export it as PNG"},
        {"GIF89a", "but a GIF picture: convert it"},
        {"\0\0\0\x0cjP  \r\n"s, "but a JPEG 2000 picture: convert it"},
        {"\xff\xfe\xff\x0eS\0k\0e\0t\0c\0h\0U\0p\0 \0"s, "but a SketchUp model: export it"},
        {"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1\0"s, "but an OLE file, as Revit"},
        {"PK\3\4\x14", "but a zip archive: unpack it"},
        {"ISO-10303-21;\nFILE_SCHEMA(('AP214'));", "but a STEP file without a building"},
        {"BLENDER-v293", "but a Blender scene: export it"},
        {"\x1f\x8b\x08", "but compressed with gzip: unpack it"},
        {"\xff\xfe<\0s\0"s, "but XML in UTF-16: convert it"},
        {"<?xml version='1.0'?>\n<robot name='r'/>",
         "but XML of a kind that is not read (`robot`): SVG, SDF and COLLADA are; `gz sdf -p"},
        {"<launch/>", "but XML of a kind that is not read (`launch`)"},
        {"# scanned\n1 2 3\n4 5 6 255\n7,8,-9e1\n", "but points as text: convert them to PCD"},
        {"3\n1 2 3\n4 5 6\n7 8 9\n", "but points as text"},
        {"x;y;z\n1;2;3\n4;5;6\n7;8;9\n", "but points as text"},
    };
    for (const auto& [bytes, wanted] : files)
        EXPECT_NE(errorOf(bytes).find("room: error: not an environment or layout " + wanted),
                  std::string::npos)
            << errorOf(bytes);
}

TEST(Input, OtherLinesAreNoPoints) {
    for (const std::string text : {"1 2 3\n4 5 6\n", "1 2 3\na b c\n1 2 3\n4 5 6\n",
                                   "1 2\n3 4\n5 6\n", "a\nb\n1 2 3\n4 5 6\n7 8 9\n"})
        EXPECT_EQ(errorOf(text).find("points as text"), std::string::npos) << text;
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
    EXPECT_THROW(readDocument(testing::buildPath(""), {}, sceneSchemas()), std::system_error);
}

TEST(Input, RandomBytesAreErrors) {
    std::mt19937_64 random(5);
    const std::vector<std::string> starts{"",
                                          "glTF",
                                          "#env 1\n",
                                          "#3dm 1\n",
                                          "P5\n",
                                          "- ",
                                          "image: resolution: ",
                                          "2D-Map\n",
                                          "{\"verts\": [",
                                          "0\nSECTION\n",
                                          "ply\n",
                                          "solid facet",
                                          "v 1 2 3\n"};
    for (int i = 0; i < 4000; ++i) {
        std::string bytes = starts[static_cast<std::size_t>(i) % starts.size()];
        for (std::size_t n = 1 + random() % 60; n > 0; --n) bytes += static_cast<char>(random());
        EXPECT_THROW(parse(bytes + '\x02'), FormatError);
    }
}

}  // namespace input_test
}  // namespace ispace

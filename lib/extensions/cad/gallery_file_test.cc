// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "extensions/cad/cad.h"
#include "io/importers.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace gallery_file_test {

Document read(const std::string& text, const ImportOptions& options = {}) {
    return readGalleryFile(text, "a.pol", options, sceneSchemas());
}
std::string errorOf(const std::string& text) {
    return errorsOf([&] { read(text); });
}

TEST(GalleryFile, OutlineAndHoles) {
    const Document document = read("4 0/1 0/1 10/1 0/1 10/1 21/2 0/1 21/2\n1\n4 2 2 2 3 3 3 3 2\n");
    EXPECT_TRUE(writeRecordText(document).starts_with(
        "#env 1\nfence path=0,0;10,0;10,10.5;0,10.5 closed=yes\n"
        "fence path=2,2;2,3;3,3;3,2 closed=yes\ninside at="));
    EXPECT_NEAR(environmentOf(document).indoor().area(), 104, 1e-9);
}

TEST(GalleryFile, CoordinatesKeepTheirDoubles) {
    const Document document = read("3 0/1 0/1 1/3 0/1 0/1 22286993/8388608");
    EXPECT_NE(writeRecordText(document).find("0,0;0.3333333333333333,0;0,2.656816601753235"),
              std::string::npos);
}

TEST(GalleryFile, ClockwiseOutlinesAndRepeatedCorners) {
    const Document document = read("5 0/1 0/1 0/1 3/1 4/1 3/1 4/1 3/1 4/1 0/1");
    EXPECT_NEAR(environmentOf(document).indoor().area(), 12, 1e-9);
}

TEST(GalleryFile, RecognisedByItsFraction) {
    EXPECT_TRUE(isGalleryFile("60 -2918765495/1073741824 22286993/8388608 "));
    EXPECT_TRUE(isGalleryFile("\n 3\r\n0/1"));
    for (const char* text : {"", "60", "2 0/1", "3 1.5", "3 a/b", "x 1/2", "3 1/0", "3: 1/2"})
        EXPECT_FALSE(isGalleryFile(text)) << text;
}

TEST(GalleryFile, PlainNumbersAreRecognisedByTheSuffix) {
    const std::string text = "4 0 0 8 0 8 6 0 6 0\n";
    EXPECT_NEAR(environmentOf(read(text)).indoor().area(), 48, 1e-9);
    const auto is_recognised = [&text](const std::string& name) {
        return std::ranges::any_of(cadImporters(), [&](const Importer& row) {
            return row.recognises({text, name, {}, sceneSchemas()});
        });
    };
    EXPECT_TRUE(is_recognised("p.pol"));
    EXPECT_FALSE(is_recognised("p.txt"));
    EXPECT_TRUE(isGalleryFile(text, true));
    EXPECT_FALSE(isGalleryFile(text));  // points as text begin so, too
    EXPECT_FALSE(isGalleryFile("id: 3", true));
}

TEST(GalleryFile, Refuses) {
    EXPECT_EQ(errorOf("3 0/1 0/1 4/1 0/1 4/1"),
              "a.pol: error: the outline: found the end, wanted a coordinate, a number or a "
              "fraction p/q\n");
    EXPECT_EQ(errorOf("3 0/1 0/1 4/1 0/1 4/0 1/1"),
              "a.pol: error: the outline: found `4/0`, wanted a coordinate, a number or a fraction "
              "p/q\n");
    EXPECT_EQ(errorOf("3 0/1 0/1 4/1 0/1 4/1 1e9"),
              "a.pol: error: the outline: `1e9` is too far away, wanted metres up to 100000000\n");
    EXPECT_EQ(errorOf("4 0/1 0/1 4/1 4/1 4/1 0/1 0/1 3/1"),
              "a.pol: error: the outline crosses itself\n");
    // The height is below the doubles' resolution of points between the corners.
    EXPECT_EQ(
        errorOf("4 0/1 0/1 4/19223372036854775807 0/1 4/1 1 0/1 0/11"),
        "a.pol: error: the polygon leaves no floor, wanted one wider than its edges' rounding "
        "and larger than its holes\n");
    EXPECT_EQ(
        errorOf("4 0/1 0/1 4/1 0/1 4/1 4/1 0/1 4/1 1 4 0/1 0/1 0/1 4/1 4/1 4/1 4/1 0/1"),
        "a.pol: error: the polygon leaves no floor, wanted one wider than its edges' rounding "
        "and larger than its holes\n");
    EXPECT_EQ(errorOf("3 0/1 0/1 4/1 4/1 2/1 2/1"), "a.pol: error: the outline encloses no area\n");
    EXPECT_EQ(errorOf("3 0/1 0/1 4/1 0/1 4/1 1/1 1 3 0 0 1"),
              "a.pol: error: hole 1: found the end, wanted a coordinate, a number or a fraction "
              "p/q\n");
    EXPECT_EQ(errorOf("3 0/1 0/1 4/1 0/1 4/1 1/1 0 7"),
              "a.pol: error: found `7` after the last hole\n");
    // The number alone reserves no memory.
    EXPECT_NE(errorOf("9223372036854775807 0/1 0/1"), "");
}

}  // namespace gallery_file_test
}  // namespace ispace::cad

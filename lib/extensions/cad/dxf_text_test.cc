// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/cad/dxf_text.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "extensions/cad/cad.h"
#include "extensions/cad/tests/test_dxf.h"
#include "support/test_import.h"

namespace ispace::cad {
namespace dxf_text_test {

TEST(DxfText, EscapesAndCodePages) {
    DxfText text;
    EXPECT_EQ(text.decoded("A-WALL"), "A-WALL");
    EXPECT_EQ(text.decoded(""), "");
    EXPECT_EQ(text.decoded("\\U+0421\\U+5899x"), "С墙x");
    for (const char* broken : {"\\U+", "\\U+12", "\\U+12G4", "\\", "a\\b"})
        EXPECT_EQ(text.decoded(broken), broken);
    EXPECT_EQ(text.decoded("\\U+D800"), "??");  // half a pair
    EXPECT_EQ(text.decoded("a\tb"), "a?b");
    EXPECT_EQ(text.decoded("M\xfcller"), "Müller");
    text.setCodePage("ANSI_99999");
    text.setCodePage("ANSI_12x");
    text.setCodePage("UTF-7");
    EXPECT_EQ(text.decoded("\xe4"), "ä");
    text.setCodePage("ANSI_9999");  // of no character set
    EXPECT_EQ(text.decoded("\xf6"), "?");
}

// Before 2007 AutoCAD wrote names in the code page of the drawing.
TEST(DxfText, NamesAreDecoded) {
    const auto read = [](const std::string& dxf, const ImportOptions& options = {}) {
        return readDxf(dxf, "plan.dxf", options, sceneSchemas());
    };
    const auto named = [](const std::string& layer, const std::string& page) {
        std::string dxf = drawing(rectangle(layer, 0, 0, 6, 4) + line("x", 3, 0, 3, 4), "", 6);
        if (!page.empty())
            dxf.insert(dxf.find("  0\nENDSEC"), group(9, "$DWGCODEPAGE") + group(3, page));
        return dxf;
    };
    const std::string walls = "Wände";
    for (const auto& [layer, page] :
         std::vector<std::pair<std::string, std::string>>{{"Wände", "ANSI_1252"},
                                                          {"W\xe4nde", "ANSI_1252"},
                                                          {"W\xe4nde", ""},
                                                          {"W\x84nde", "dos850"},
                                                          {"W\\U+00E4nde", "ANSI_1252"}}) {
        ImportOptions options;
        options.wall_layers = {walls};
        EXPECT_DOUBLE_EQ(environmentOf(read(named(layer, page), options)).indoor().area(), 24)
            << page;
        EXPECT_NE(notesOf(read(named(layer, page))).find("--wall-layer Wände;"), std::string::npos)
            << page;
    }
    for (const auto& [layer, page] : std::vector<std::pair<std::string, std::string>>{
             {"\xd1\xd2\xc5\xcd\xdb", "ANSI_1251"}, {"\xc7\xbd\xcc\xe5", "GB2312"}})
        EXPECT_NE(notesOf(read(named(layer, page)))
                      .find(page == "GB2312" ? "--wall-layer 墙体;" : "--wall-layer СТЕНЫ;"),
                  std::string::npos);
    // Of no character set.
    EXPECT_NE(notesOf(read(named("W\xff\xff", "ANSI_932"))).find("W??"), std::string::npos);
}

TEST(DxfText, LongLinesAndControlCharacters) {
    const auto area = [](const std::string& dxf) {
        return environmentOf(readDxf(dxf, "plan.dxf", {}, sceneSchemas())).indoor().area();
    };
    const std::string junk = group(0, "TEXT") + group(1, std::string(100'000, 'x')) +
                             group(0, "TEXT") + group(1, std::string("\0\x01\xff", 3)) +
                             group(999, "dxflib");
    EXPECT_DOUBLE_EQ(area(drawing(rectangle("W\xe4nde", 0, 0, 4, 3) + junk, "", 6)), 12);
    std::string crlf;
    for (const char c : drawing(rectangle("W", 0, 0, 4, 3), "", 6))
        crlf += c == '\n' ? "\r\n" : std::string(1, c);
    EXPECT_DOUBLE_EQ(area(crlf), 12);
}

}  // namespace dxf_text_test
}  // namespace ispace::cad

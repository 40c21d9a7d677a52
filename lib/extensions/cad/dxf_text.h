// SPDX-License-Identifier: GPL-3.0-or-later
// Names in DXF files, which are in UTF-8 or in one of many code pages.
//
//     DxfText text;
//     text.setVersion("AC1015");
//     text.setCodePage("ANSI_1252");
//     for (const std::string& name : names) text.consider(name);
//     const std::string layer = text.decoded("W\xE4nde");  // "Wände"
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace ispace::cad {

/// Decodes names of layers and blocks in a DXF file to UTF-8, for messages and options. One
/// encoding counts for a file: UTF-8 if all names are UTF-8, unless an older version (before
/// AutoCAD 2007) names a code page of East Asia and no name has a character of three bytes, as
/// nearly all of these have in UTF-8: two bytes of them may look like one of UTF-8. Else the
/// drawing's code page, Windows-1252 by default. `\U+00E4` is a character by its code point.
class DxfText {
  public:
    /// \param name $DWGCODEPAGE: ANSI_1252, DOS850, GB2312; an unknown one has no effect
    void setCodePage(std::string_view name);

    /// \param name $ACADVER: AC1015; an unknown one has no effect
    void setVersion(std::string_view name);

    /// Takes a name into account for the decision on the encoding, before the first decoded().
    void consider(std::string_view name);

    /// Returns one printable line.
    std::string decoded(std::string_view name);

  private:
    [[nodiscard]] bool isUtf8() const;

    std::string charset_ = "CP1252";  // of iconv
    bool is_old_ = false;             // before AutoCAD 2007
    bool all_utf8_ = true;            // the names considered
    bool has_long_ = false;           // a character of three bytes or more
    std::map<std::string, std::string, std::less<>> known_;
};

}  // namespace ispace::cad

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <string_view>

namespace ispace {

/// Decodes names of layers and blocks in a DXF file to UTF-8, for messages and options. A name is
/// UTF-8 if it can be; else its bytes are those of the drawing's code page, Windows-1252 by
/// default, as AutoCAD wrote them before 2007. `\U+00E4` is a character by its code point.
class DxfText {
  public:
    /// \param name $DWGCODEPAGE: ANSI_1252, DOS850, GB2312; an unknown one changes nothing
    void setCodePage(std::string_view name);

    /// Returns one printable line.
    std::string decoded(std::string_view name);

  private:
    std::string charset_ = "CP1252";  // of iconv
    std::map<std::string, std::string, std::less<>> known_;
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/cad/dxf_text.h"

#include <iconv.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <memory>
#include <utility>

#include "base/message.h"

namespace ispace::cad {

namespace {

/// Converts bytes of a character set to UTF-8; returns them unchanged if they are none of its
/// characters.
std::string toUtf8(std::string_view bytes, const std::string& charset) {
    const auto close = [](iconv_t open) { ::iconv_close(open); };
    const iconv_t opened = ::iconv_open("UTF-8", charset.c_str());
    if (reinterpret_cast<std::intptr_t>(opened) == -1) return std::string(bytes);
    const std::unique_ptr<void, decltype(close)> converter(opened, close);
    constexpr std::size_t kMaxBytes = 4;  // of a character of UTF-8
    std::string in(bytes), out(kMaxBytes * bytes.size(), '\0');
    char *from = in.data(), *to = out.data();
    std::size_t unread = in.size(), room = out.size();
    if (::iconv(converter.get(), &from, &unread, &to, &room) == static_cast<std::size_t>(-1))
        return in;
    out.resize(out.size() - room);
    return out;
}

/// Replaces `\U+XXXX`, four hexadecimal digits.
std::string withoutEscapes(std::string_view text) {
    constexpr std::string_view kEscape = "\\U+";
    constexpr std::size_t kDigits = 4;
    std::string out;
    while (!text.empty()) {
        const std::string_view digits =
            text.starts_with(kEscape) ? text.substr(kEscape.size(), kDigits) : std::string_view();
        std::uint32_t code = 0;
        const auto [end, error] =
            std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
        if (digits.size() == kDigits && error == std::errc() &&
            end == digits.data() + digits.size()) {
            const std::array<char, 2> unit{static_cast<char>(code >> 8U),
                                           static_cast<char>(code & 0xFFU)};
            out += toUtf8({unit.data(), unit.size()}, "UTF-16BE");
            text.remove_prefix(kEscape.size() + kDigits);
        } else {
            out += text.front();
            text.remove_prefix(1);
        }
    }
    return out;
}

}  // namespace

void DxfText::setCodePage(std::string_view name) {
    constexpr std::array<std::pair<std::string_view, const char*>, 4> kNamed{
        {{"GB2312", "GBK"}, {"BIG5", "BIG5"}, {"KSC5601", "CP949"}, {"JOHAB", "JOHAB"}}};
    std::string upper(name);
    for (char& c : upper)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    for (const auto& [known, charset] : kNamed)
        if (upper == known) charset_ = charset;
    for (const std::string_view prefix : {"ANSI_", "DOS"}) {
        if (!upper.starts_with(prefix)) continue;
        const std::string number = upper.substr(prefix.size());
        constexpr std::size_t kMaxDigits = 4;
        if (!number.empty() && number.size() <= kMaxDigits &&
            number.find_first_not_of("0123456789") == std::string::npos)
            charset_ = "CP" + number;
    }
}

void DxfText::setVersion(std::string_view name) {
    is_old_ = name.starts_with("AC") && name < "AC1021";
}

void DxfText::consider(std::string_view name) {
    for (std::size_t i = 0; i < name.size();) {
        const std::size_t length = utf8Length(name.substr(i));
        all_utf8_ = all_utf8_ && length > 0;
        has_long_ = has_long_ || length > 2;
        i += std::max<std::size_t>(length, 1);
    }
}

bool DxfText::isUtf8() const {
    constexpr std::array<std::string_view, 8> kEastAsian{"GBK",   "BIG5",  "JOHAB", "CP932",
                                                         "CP936", "CP949", "CP950", "CP1361"};
    const bool may_look_alike =
        is_old_ && std::find(kEastAsian.begin(), kEastAsian.end(), charset_) != kEastAsian.end();
    return all_utf8_ && (has_long_ || !may_look_alike);
}

std::string DxfText::decoded(std::string_view name) {
    const bool is_plain = std::all_of(name.begin(), name.end(),
                                      [](char c) { return c >= ' ' && c <= '~' && c != '\\'; });
    if (is_plain) return std::string(name);
    const auto known = known_.find(name);
    if (known != known_.end()) return known->second;
    const bool is_text = isUtf8() && printable(name) == name;
    const std::string text = is_text ? std::string(name) : toUtf8(name, charset_);
    return known_.emplace(name, printable(withoutEscapes(text))).first->second;
}

}  // namespace ispace::cad

// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <charconv>

#include "base/message.h"
#include "base/number.h"
#include "io/ifc/step_file.h"

namespace ispace {

namespace {

void appendUtf8(std::string& out, std::uint32_t code) {
    const auto put = [&out](std::uint32_t byte) { out += static_cast<char>(byte); };
    if (code < 0x80) {
        put(code);
    } else if (code < 0x800) {
        put(0xC0 | code >> 6U);
        put(0x80 | (code & 0x3FU));
    } else if (code < 0x10000) {
        put(0xE0 | code >> 12U);
        put(0x80 | (code >> 6U & 0x3FU));
        put(0x80 | (code & 0x3FU));
    } else {
        put(0xF0 | code >> 18U);
        put(0x80 | (code >> 12U & 0x3FU));
        put(0x80 | (code >> 6U & 0x3FU));
        put(0x80 | (code & 0x3FU));
    }
}

/// The hexadecimal number of so many digits at the start of `text`, which it is taken from.
std::optional<std::uint32_t> takeHex(std::string_view& text, std::size_t digits) {
    if (text.size() < digits) return std::nullopt;
    std::uint32_t value = 0;
    const char* const end = text.data() + digits;
    const auto [stop, error] = std::from_chars(text.data(), end, value, 16);
    if (error != std::errc() || stop != end) return std::nullopt;
    text.remove_prefix(digits);
    return value;
}

/// Appends a run of \X2\ (digits 4) or \X4\ (digits 8), up to its \X0\.
void takeRun(std::string_view& text, std::size_t digits, std::string& out) {
    std::uint32_t high = 0;  // first half of a pair of UTF-16
    while (const auto unit = takeHex(text, digits)) {
        std::uint32_t code = *unit;
        if (code >= 0xD800 && code < 0xDC00) {
            high = code;
            continue;
        }
        if (code >= 0xDC00 && code < 0xE000)
            code = high == 0 ? 0xFFFD : 0x10000 + ((high - 0xD800) << 10U) + (code - 0xDC00);
        high = 0;
        appendUtf8(out, code > 0x10FFFF ? 0xFFFD : code);
    }
    if (text.starts_with("\\X0\\")) text.remove_prefix(4);
}

/// Appends the character that the escape at the start of `text` stands for.
void takeEscape(std::string_view& text, std::string& out) {
    const auto skips = [&text](std::string_view prefix) {
        if (!text.starts_with(prefix)) return false;
        text.remove_prefix(prefix.size());
        return true;
    };
    if (skips("\\X2\\")) return takeRun(text, 4, out);
    if (skips("\\X4\\")) return takeRun(text, 8, out);
    if (skips("\\X\\")) {
        if (const auto code = takeHex(text, 2)) appendUtf8(out, *code);
        return;
    }
    if (text.size() > 3 && skips("\\S\\")) {
        appendUtf8(out, (static_cast<unsigned char>(text.front()) & 0x7FU) + 0x80U);
        text.remove_prefix(1);
        return;
    }
    if (text.size() > 3 && text[1] == 'P' && text[3] == '\\') return text.remove_prefix(4);
    if (!skips("\\\\")) text.remove_prefix(1);
    out += '\\';
}

}  // namespace

bool StepValue::isNull() const { return text_.empty() || text_ == "$" || text_ == "*"; }

StepId StepValue::reference() const {
    StepId id = 0;
    if (!text_.starts_with('#')) return 0;
    const char* const end = text_.data() + text_.size();
    const auto [stop, error] = std::from_chars(text_.data() + 1, end, id);
    return error == std::errc() && stop == end ? id : 0;
}

std::string_view StepValue::type() const {
    if (text_.empty() || text_.front() < 'A' || text_.front() > 'Z') return {};
    const std::size_t open = text_.find('(');
    if (open == std::string_view::npos) return {};
    const std::string_view name = text_.substr(0, open);
    return name.substr(0, name.find_last_not_of(" \t\r\n") + 1);
}

StepValue StepValue::untyped() const {
    if (type().empty()) return *this;
    const std::vector<StepValue> values = list();
    return values.empty() ? StepValue() : values.front();
}

std::optional<double> StepValue::number() const { return parseDouble(untyped().text_); }

std::string_view StepValue::word() const {
    if (text_.size() < 2 || text_.front() != '.' || text_.back() != '.') return {};
    return text_.substr(1, text_.size() - 2);
}

std::string StepValue::text() const {
    std::string_view rest = untyped().text_;
    if (rest.size() < 2 || rest.front() != '\'' || rest.back() != '\'') return "";
    rest = rest.substr(1, rest.size() - 2);
    std::string out;
    while (!rest.empty()) {
        if (rest.front() == '\\') {
            takeEscape(rest, out);
            continue;
        }
        if (rest.starts_with("''")) rest.remove_prefix(1);
        out += rest.front();
        rest.remove_prefix(1);
    }
    return printable(out);
}

}  // namespace ispace

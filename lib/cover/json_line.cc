// SPDX-License-Identifier: GPL-3.0-or-later
#include "cover/json_line.h"

#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"

namespace ispace {

namespace {

bool isDigit(char c) { return c >= '0' && c <= '9'; }

/// Length of the number at the beginning of `text` as JSON has it; 0 if there is none.
std::size_t numberLength(std::string_view text) {
    const auto at = [text](std::size_t i) { return i < text.size() ? text[i] : '\0'; };
    std::size_t i = at(0) == '-' ? 1 : 0;
    const auto digits = [&] {
        const std::size_t first = i;
        while (isDigit(at(i))) ++i;
        return i > first;
    };
    if (at(i) == '0')
        ++i;
    else if (!digits())
        return 0;
    if (at(i) == '.') {
        ++i;
        if (!digits()) return 0;
    }
    if (at(i) == 'e' || at(i) == 'E') {
        ++i;
        if (at(i) == '+' || at(i) == '-') ++i;
        if (!digits()) return 0;
    }
    return i;
}

void addUtf8(std::string& text, unsigned code) {
    const auto add = [&text](unsigned byte) { text += static_cast<char>(byte); };
    if (code < 0x80) {
        add(code);
    } else if (code < 0x800) {
        add(0xC0U | code >> 6U);
        add(0x80U | (code & 0x3FU));
    } else if (code < 0x10000) {
        add(0xE0U | code >> 12U);
        add(0x80U | (code >> 6U & 0x3FU));
        add(0x80U | (code & 0x3FU));
    } else {
        add(0xF0U | code >> 18U);
        add(0x80U | (code >> 12U & 0x3FU));
        add(0x80U | (code >> 6U & 0x3FU));
        add(0x80U | (code & 0x3FU));
    }
}

}  // namespace

void JsonLine::fail(std::string message) const {
    throw FormatError({file_, number_, static_cast<int>(begin_) + 1, std::move(message)});
}

char JsonLine::peek() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\r'))
        ++at_;
    begin_ = at_;
    return at_ < text_.size() ? text_[at_] : '\0';
}

bool JsonLine::takes(char wanted) {
    if (peek() != wanted || at_ == text_.size()) return false;
    ++at_;
    return true;
}

void JsonLine::expect(char wanted, const char* name) {
    if (takes(wanted)) return;
    std::string message =
        at_ == text_.size() ? "the line ends here" : "found " + excerpt(text_.substr(at_, 20));
    fail(message.append(", wanted ").append(name));
}

bool JsonLine::takesWord(std::string_view word) {
    peek();
    if (!text_.substr(at_).starts_with(word)) return false;
    at_ += word.size();
    return true;
}

std::string JsonLine::string() {
    expect('"', "a string in double quotes");
    std::string result;
    while (at_ < text_.size() && text_[at_] != '"') {
        const char c = text_[at_];
        if (c == '\\') {
            addEscape(result);
            continue;
        }
        const std::size_t length = utf8Length(text_.substr(at_));
        if (length == 0 || static_cast<unsigned char>(c) < 0x20)
            fail("a string holds bytes that are no text");
        result.append(text_.substr(at_, length));
        at_ += length;
    }
    if (at_ == text_.size()) fail("a string without end");
    ++at_;
    return result;
}

void JsonLine::addEscape(std::string& text) {
    constexpr std::string_view kNames = "\"\\/bfnrt", kMeanings = "\"\\/\b\f\n\r\t";
    const char name = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
    at_ += 2;
    if (const auto which = kNames.find(name); name != '\0' && which != std::string_view::npos) {
        text += kMeanings[which];
        return;
    }
    if (name != 'u') fail("a string holds an escape that JSON does not know");
    unsigned code = hexDigits();
    if (code >= 0xD800 && code < 0xDC00 && text_.substr(at_).starts_with("\\u")) {
        at_ += 2;
        const unsigned low = hexDigits();
        if (low < 0xDC00 || low > 0xDFFF) fail("a string holds half of a character");
        code = 0x10000 + ((code - 0xD800) << 10U) + (low - 0xDC00);
    }
    if (code >= 0xD800 && code < 0xE000) fail("a string holds half of a character");
    addUtf8(text, code);
}

unsigned JsonLine::hexDigits() {
    constexpr std::string_view kDigits = "0123456789abcdef0123456789ABCDEF";
    unsigned code = 0;
    for (int i = 0; i < 4; ++i, ++at_) {
        const auto digit = at_ < text_.size() ? kDigits.find(text_[at_]) : std::string_view::npos;
        if (digit == std::string_view::npos) fail("\\u is to be followed by four hex digits");
        code = 16 * code + static_cast<unsigned>(digit % 16);
    }
    return code;
}

double JsonLine::number() {
    peek();
    const std::string_view text = text_.substr(at_);
    const std::size_t length = numberLength(text);
    const auto value = parseDouble(text.substr(0, length));
    if (length == 0 || !value)
        fail((at_ == text_.size() ? "the line ends here" : "found " + excerpt(text.substr(0, 20))) +
             ", wanted a number");
    at_ += length;
    return *value;
}

bool JsonLine::boolean() {
    if (takesWord("true")) return true;
    if (takesWord("false")) return false;
    fail("wanted true or false");
}

void JsonLine::skip() {
    constexpr int kDeepest = 64;
    if (++depth_ > kDeepest) fail("lists and objects are nested too deeply");
    switch (peek()) {
        case '{':
            object([this](const std::string&) { skip(); });
            break;
        case '[':
            array([this] { skip(); });
            break;
        case '"':
            string();
            break;
        default:
            if (!takesWord("null") && !takesWord("true") && !takesWord("false")) number();
    }
    --depth_;
}

void JsonLine::end() {
    peek();
    if (at_ < text_.size()) fail("found " + excerpt(text_.substr(at_, 20)) + " behind the object");
}

}  // namespace ispace

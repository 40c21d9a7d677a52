// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "base/message.h"
#include "record/schema.h"
#include "record/yaml.h"
#include "record/yaml_stages.h"

namespace ispace {

namespace {

/// What some version of YAML takes for no text.
bool isReserved(std::string_view word) {
    constexpr std::string_view kReserved[] = {"y",    "n",     "yes",  "no",  "on", "off",
                                              "true", "false", "null", "nan", "inf"};
    constexpr std::size_t kLongest = 5;
    std::string lower(word.substr(0, kLongest + 1));
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return std::find(std::begin(kReserved), std::end(kReserved), lower) != std::end(kReserved);
}

/// A text that every reader of YAML takes for just that without quotes.
bool isPlain(std::string_view text) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
    return isWord(text) && is_letter(text.front()) && text.find(':') == std::string_view::npos &&
           !isReserved(text);
}

unsigned codePointOf(std::string_view sequence) {
    constexpr std::array<unsigned, 5> kFirstBits = {0, 0x7f, 0x1f, 0x0f, 0x07};
    unsigned code = static_cast<unsigned char>(sequence.front()) & kFirstBits[sequence.size()];
    for (const char c : sequence.substr(1))
        code = (code << 6U) | (static_cast<unsigned>(c) & 0x3fU);
    return code;
}

/// Beyond ASCII: breaks lines, does not print, or might be a byte order mark.
bool isEscaped(unsigned code) {
    return (code >= 0x80 && code <= 0xa0) || code == 0x2028 || code == 0x2029 || code == 0xfeff ||
           (code >= 0xfff0 && code <= 0xffff) || (code & 0xfffeU) == 0xfffe;
}

void appendEscape(std::string& out, unsigned code) {
    std::array<char, 12> text{};
    std::snprintf(text.data(), text.size(), code > 0xffff ? "\\U%08X" : "\\u%04X", code);
    out += text.data();
}

void appendQuoted(std::string& out, std::string_view text) {
    out += '"';
    while (!text.empty()) {
        const std::size_t length = std::max<std::size_t>(utf8Length(text), 1);
        const std::string_view sequence = text.substr(0, length);
        const unsigned code = codePointOf(sequence);
        if (sequence == "\n") {
            out += "\\n";
        } else if (sequence == "\t") {
            out += "\\t";
        } else if (sequence == "\"" || sequence == "\\") {
            out += '\\';
            out += sequence;
        } else if (isEscaped(code)) {
            appendEscape(out, code);
        } else {
            out += sequence;
        }
        text.remove_prefix(length);
    }
    out += '"';
}

void appendTuple(std::string& out, const KeySpec& key, const Tuple& tuple) {
    out += '[';
    for (std::size_t i = 0; i < tuple.size(); ++i) {
        if (i > 0) out += ", ";
        appendNumber(out, key, tuple[i]);
    }
    out += ']';
}

void appendText(std::string& out, std::string_view text) {
    if (isPlain(text))
        out += text;
    else
        appendQuoted(out, text);
}

struct ValueWriter {
    std::string& out;
    const KeySpec& key;

    void operator()(bool value) const { out += value ? "yes" : "no"; }
    void operator()(double value) const { appendNumber(out, key, value); }
    void operator()(const std::string& value) const { appendText(out, value); }
    void operator()(const Tuple& value) const { appendTuple(out, key, value); }
    void operator()(const TupleList& value) const {
        out += '[';
        for (const Tuple& tuple : value) {
            if (out.back() == ']') out += ", ";
            appendTuple(out, key, tuple);
        }
        out += ']';
    }
};

void appendRecord(std::string& out, const Record& record) {
    out += "- ";
    out += record.keyword();
    out += ": {";
    bool is_first = true;
    record.forEachWritten([&](const KeySpec& key, const Value& value) {
        if (!std::exchange(is_first, false)) out += ", ";
        appendText(out, key.name);  // the key `on` is a flag to YAML 1.1
        out += ": ";
        std::visit(ValueWriter{out, key}, value);
    });
    out += "}\n";
}

}  // namespace

std::string writeYaml(const Document& document) {
    std::string out(kYamlMagic);
    out += document.kind == DocumentKind::Layout ? kYamlLayoutVersion : kYamlVersion;
    out += '\n';
    for (const std::string& command : document.history) {
        out += "# ";
        out += printable(command);
        out += '\n';
    }
    if (document.records.empty()) out += "[]\n";
    for (const Record& record : document.records) appendRecord(out, record);
    return out;
}

}  // namespace ispace

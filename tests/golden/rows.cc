// SPDX-License-Identifier: GPL-3.0-or-later
#include "rows.h"

#include <algorithm>

namespace golden {
namespace {

/// Where the argument at `at` of a CMake command ends: a quoted one behind its closing quote.
std::size_t argumentEnd(std::string_view source, std::size_t at) {
    if (source[at] != '"') return std::min(source.find_first_of(" \n\")", at), source.size());
    for (++at; at < source.size() && source[at] != '"'; ++at) {
        if (source[at] == '\\') ++at;
    }
    return std::min(at + 1, source.size());
}

std::string quoted(std::string_view line) {
    std::string result = "\"";
    for (const char c : line) {
        if (c == '"' || c == '\\' || c == '$') result += '\\';
        result += c;
    }
    return result += '"';
}

}  // namespace

std::optional<std::string> withErrorLine(std::string_view source, std::string_view name,
                                         std::string_view line) {
    const std::string head = "ispace_golden(" + std::string(name);
    std::size_t row = source.find(head);
    while (row != std::string_view::npos && source.find_first_of(" \n", row) != row + head.size()) {
        row = source.find(head, row + 1);
    }
    if (row == std::string_view::npos) return std::nullopt;
    std::size_t end = row + head.size();  // of the kept part of the row
    std::size_t at = end;
    bool stays = true;
    while (at < source.size() && source[at] != ')') {
        if (source[at] == ' ' || source[at] == '\n') {
            ++at;
            continue;
        }
        const std::size_t next = argumentEnd(source, at);
        if (source.substr(at, next - at) == "ERR") stays = false;
        if (stays) end = next;
        at = next;
    }
    std::string result(source.substr(0, end));
    if (!line.empty()) result += "\n  ERR " + quoted(line);
    return result += source.substr(at);
}

}  // namespace golden

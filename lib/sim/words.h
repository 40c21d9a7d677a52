// SPDX-License-Identifier: GPL-3.0-or-later
// What commands, scripts and requests have in common.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "record/text.h"

namespace ispace {

/// The words of a line, apart by blanks and tabs.
inline std::vector<Piece> wordsOf(std::string_view line) {
    constexpr std::string_view kBlanks = " \t";
    std::vector<Piece> words;
    words.reserve(4);
    for (std::size_t end = 0;;) {
        const std::size_t start = line.find_first_not_of(kBlanks, end);
        if (start == std::string_view::npos) return words;
        end = std::min(line.find_first_of(kBlanks, start), line.size());
        words.push_back({line.substr(start, end - start), static_cast<int>(start) + 1});
    }
}

/// With its letters a to z as capitals: verbs are, and a person may forget it.
inline std::string upperCase(std::string_view word) {
    std::string out(word);
    for (char& c : out)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    return out;
}

}  // namespace ispace

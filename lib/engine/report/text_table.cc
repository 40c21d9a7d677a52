// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/text_table.h"

#include <algorithm>
#include <cstddef>

#include "base/number.h"

namespace ispace {

namespace {

/// Counts the characters of UTF-8 text.
std::size_t characters(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) {
        constexpr unsigned kContinued = 0x80, kMask = 0xc0;
        return (static_cast<unsigned char>(c) & kMask) != kContinued;
    }));
}

}  // namespace

std::string aligned(const std::vector<TextRow>& rows, const std::string& sides) {
    std::vector<std::size_t> widths;
    const auto side = [&sides](std::size_t i) {
        return i < sides.size() ? sides[i] : sides.back();
    };
    for (const TextRow& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], characters(row[i]));
    }
    std::string text;
    for (const TextRow& row : rows) {
        std::string line;
        for (std::size_t i = 0; i < row.size(); ++i) {
            const std::string blanks(widths[i] - characters(row[i]), ' ');
            if (i > 0) line += "  ";
            line += side(i) == 'r' ? blanks + row[i] : row[i] + blanks;
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    }
    return text;
}

std::string percentText(double share, int decimals) {
    return formatFixed(100 * share, decimals) + '%';
}

}  // namespace ispace

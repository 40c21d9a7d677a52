// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/byte_count.h"

#include <string_view>

#include "base/error.h"
#include "base/number.h"

namespace ispace {

std::uint64_t byteCount(const std::string& text) {
    const auto end = text.find_first_not_of("0123456789.");
    const auto number = parseDouble(text.substr(0, end));
    std::string unit = end == std::string::npos ? "" : text.substr(end);
    for (char& c : unit)
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
    if (unit.ends_with('B')) unit.pop_back();
    const std::string known = "KMGT";
    const auto power = unit.empty() ? std::string::npos : known.find(unit);
    if (!number || *number <= 0 || (!unit.empty() && (unit.size() > 1 || power > known.size())))
        throw UsageError('`' + text + "` is not a size like 500M or 2G");
    double bytes = *number;
    for (std::size_t i = 0; !unit.empty() && i <= power; ++i) bytes *= 1024;
    constexpr double kMost = 1e15;
    if (bytes > kMost) throw UsageError('`' + text + "` is more than any machine has");
    return static_cast<std::uint64_t>(bytes);
}

std::string byteCountText(std::uint64_t bytes) {
    std::string_view units = "KMGT";
    char unit = 0;
    while (!units.empty() && bytes != 0 && bytes % 1024 == 0) {
        bytes /= 1024;
        unit = units.front();
        units.remove_prefix(1);
    }
    std::string text = std::to_string(bytes);
    if (unit != 0) text += unit;
    return text;
}

}  // namespace ispace

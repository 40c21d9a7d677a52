// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/net only: names in replies.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace ispace {

/// Ids of robots or lasers, in order.
template <typename Things>
std::vector<std::string> idsOf(const Things& things) {
    std::vector<std::string> ids;
    ids.reserve(things.size());
    for (const auto& thing : things) ids.push_back(thing.id);
    return ids;
}

inline std::string joined(const std::vector<std::string>& words, std::string_view separator) {
    std::string out;
    for (const std::string& word : words) {
        if (!out.empty()) out += separator;
        out += word;
    }
    return out;
}

}  // namespace ispace

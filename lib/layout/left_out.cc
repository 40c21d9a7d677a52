// SPDX-License-Identifier: GPL-3.0-or-later
#include "layout/left_out.h"

#include <algorithm>

namespace ispace {

std::string leftOutText(std::string_view name, std::string_view done,
                        const std::vector<std::string>& ids) {
    constexpr std::size_t kMost = 3;
    std::string text = "`";
    text.append(name).append("` is not ").append(done).append(" yet, left out: ");
    for (std::size_t i = 0; i < std::min(kMost, ids.size()); ++i)
        text.append(i == 0 ? "" : ", ").append(ids[i]);
    if (ids.size() > kMost)
        text.append(" and ").append(std::to_string(ids.size() - kMost)).append(" more");
    return text;
}

std::vector<std::string> leftOut(const Scene& scene, std::span<const std::string_view> keywords,
                                 std::string_view done,
                                 const std::function<bool(std::size_t)>& is_meant) {
    std::vector<std::string> phrases;
    for (const std::string_view keyword : keywords) {
        std::vector<std::string> ids;
        for (std::size_t i = 0; i < scene.records.size(); ++i)
            if (scene.records[i].keyword() == keyword && (!is_meant || is_meant(i)))
                ids.push_back(scene.ids[i]);
        if (!ids.empty()) phrases.push_back(leftOutText(keyword, done, ids));
    }
    return phrases;
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/joined_worlds.h"

#include <algorithm>

#include "base/message.h"
#include "base/number.h"

namespace ispace {

RoomPoints parseRoomPoints(std::string_view text, std::span<const JoinedRoom> rooms,
                           std::size_t room) {
    constexpr std::size_t kMost = 8;
    RoomPoints found;
    for (;;) {
        const std::string_view one = text.substr(0, text.find(';'));
        std::string_view point = one;
        if (const auto slash = one.rfind('/'); slash != std::string_view::npos) {
            const std::string_view id = one.substr(0, slash);
            const auto named = std::find_if(rooms.begin(), rooms.end(),
                                            [&](const JoinedRoom& each) { return each.id == id; });
            if (named == rooms.end()) return {.fault = "no storey " + excerpt(id)};
            room = static_cast<std::size_t>(named - rooms.begin());
            point = one.substr(slash + 1);
        }
        const auto comma = point.find(',');
        const auto x = parseDouble(point.substr(0, comma));
        const auto y =
            comma == std::string_view::npos ? std::nullopt : parseDouble(point.substr(comma + 1));
        if (!x || !y) return {.fault = "wanted a point like upper/1,2, found " + excerpt(one)};
        if (found.points.size() == kMost)
            return {.fault = "a trip has at most " + std::to_string(kMost) + " points"};
        found.points.push_back({room, {*x, *y}});
        if (one.size() == text.size()) return found;
        text.remove_prefix(one.size() + 1);
    }
}

}  // namespace ispace

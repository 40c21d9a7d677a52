// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/plan/unread.h"

#include <cstddef>
#include <map>
#include <utility>

#include "base/number.h"

namespace ispace {

namespace {

/// Kinds listed in one message.
constexpr std::size_t kMaxKinds = 6;

std::string whereText(const UnreadThing& thing) {
    std::string text;
    if (!thing.layer.empty()) text += "on the layer " + thing.layer;
    if (!thing.block.empty())
        text += (text.empty() ? "in " : " in ") + ("the block " + thing.block);
    if (thing.at)
        text += (text.empty() ? "at " : " at ") + formatFixed(thing.at->x, 2) + ',' +
                formatFixed(thing.at->y, 2) + " of the drawing";
    return text;
}

}  // namespace

void warnOfUnread(const std::vector<UnreadThing>& things, const std::string& advice,
                  ImportRecords& out) {
    if (things.empty()) return;
    std::map<std::string, std::pair<std::size_t, const UnreadThing*>> kinds;
    for (const UnreadThing& thing : things) {
        auto& [count, first] = kinds[thing.kind];
        if (count++ == 0) first = &thing;
    }
    std::string text;
    std::size_t listed = 0;
    for (const auto& [kind, counted] : kinds) {
        if (listed == kMaxKinds) break;
        const auto& [count, first] = counted;
        text += (listed++ == 0 ? "" : "; ") + kind + " (" + std::to_string(count) + ')';
        if (const std::string where = whereText(*first); !where.empty())
            text += (count == 1 ? ", " : ", the first ") + where;
    }
    if (kinds.size() > listed)
        text += "; and " + std::to_string(kinds.size() - listed) + " more kinds";
    out.warn("not read, though it may be a wall: " + text + ": " + advice, things.front().line);
}

}  // namespace ispace

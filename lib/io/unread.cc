// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/unread.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "base/number.h"

namespace ispace {

namespace {

/// Kinds listed in one message.
constexpr std::size_t kMaxKinds = 6;

/// Metres: smaller things are no walls, and walls lie at most so far off their room.
constexpr double kLeastWall = 0.5, kBesideRoom = 0.5;

std::string whereText(const UnreadThing& thing) {
    std::string text;
    if (!thing.layer.empty()) text += "on the layer " + thing.layer;
    if (!thing.owner.empty()) text += (text.empty() ? "in " : " in ") + thing.owner;
    if (thing.at)
        text += (text.empty() ? "at " : " at ") + formatFixed(thing.at->x, 2) + ',' +
                formatFixed(thing.at->y, 2) + " of the file";
    return text;
}

}  // namespace

bool mayBeWallOf(std::span<const PlanRegion> rooms, const UnreadThing& thing) {
    if (thing.extent.empty()) return true;
    if (std::max(thing.extent.width(), thing.extent.depth()) < kLeastWall) return false;
    const Vec2 aside{kBesideRoom, kBesideRoom};
    const Box2 near{thing.extent.low - aside, thing.extent.high + aside};
    const auto touches = [&](const Region& room) {
        bool meets = room.locate(thing.extent.center()) != Side::Outside;
        room.forEachEdge([&](const Segment2& edge) { meets = meets || bounds(edge).meets(near); });
        return meets;
    };
    return rooms.empty() || std::any_of(rooms.begin(), rooms.end(), [&](const PlanRegion& region) {
               return std::any_of(region.rooms.begin(), region.rooms.end(), touches);
           });
}

void warnOfUnread(std::span<const UnreadThing> things, std::span<const PlanRegion> rooms,
                  const std::string& advice, ImportRecords& out) {
    int line = 0;
    std::map<std::string, std::pair<std::size_t, const UnreadThing*>> kinds;
    for (const UnreadThing& thing : things) {
        if (!mayBeWallOf(rooms, thing)) continue;
        auto& [count, first] = kinds[thing.kind];
        if (kinds.size() == 1 && count == 0) line = thing.line;
        if (count++ == 0) first = &thing;
    }
    if (kinds.empty()) return;
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
    out.warn("not read, though it may be a wall: " + text + ": " + advice, line);
}

}  // namespace ispace

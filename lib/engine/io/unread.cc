// SPDX-License-Identifier: GPL-3.0-or-later
// Parts of a file that an importer does not read are told only if a wall may be among them: at
// least 0.5 m long, and within 0.5 m of a room that was found, or inside one.
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

RoomVicinity::RoomVicinity(std::span<const PlanRegion> rooms) {
    std::vector<Box2> boxes;
    for (const PlanRegion& region : rooms)
        for (const Region& room : region.rooms)
            room.forEachEdge([&](const Segment2& edge) {
                edges_.push_back(edge);
                boxes.push_back(bounds(edge));
                box_.add(edge.a);
            });
    tree_ = BoxTree(boxes);
}

bool RoomVicinity::isInside(Point2 p) const {
    bool is_inside = false;
    tree_.search({p, {p.x, box_.high.y}}, [&](std::size_t i) {
        const auto& [a, b] = edges_[i];
        if ((a.x <= p.x) == (b.x <= p.x)) return;
        const double y = a.y + (p.x - a.x) / (b.x - a.x) * (b.y - a.y);
        if (y > p.y) is_inside = !is_inside;
    });
    return is_inside;
}

bool RoomVicinity::mayHaveWall(const UnreadThing& thing) const {
    if (thing.extent.empty()) return true;
    if (std::max(thing.extent.width(), thing.extent.depth()) < kLeastWall) return false;
    if (edges_.empty()) return true;
    bool meets = false;
    tree_.search(thing.extent.expanded(kBesideRoom), [&](std::size_t /*edge*/) { meets = true; });
    return meets || isInside(thing.extent.center());
}

void warnOfUnread(std::span<const UnreadThing> things, std::span<const PlanRegion> rooms,
                  const std::string& advice, ImportRecords& out) {
    if (things.empty()) return;
    const RoomVicinity vicinity(rooms);
    int line = 0;
    std::map<std::string, std::pair<std::size_t, const UnreadThing*>> kinds;
    for (const UnreadThing& thing : things) {
        if (!vicinity.mayHaveWall(thing)) continue;
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

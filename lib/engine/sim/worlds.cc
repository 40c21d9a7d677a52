// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/worlds.h"

#include <algorithm>
#include <utility>

#include "base/message.h"
#include "sim/command.h"

namespace ispace {

namespace {

constexpr std::size_t kMaxPoints = 8;

/// Adds the points of "upper/1,2;3,4", and of a single one "upper/1,2,90" the heading. Returns the
/// reason why the text holds none, or "".
std::string addPoints(std::string_view text, std::span<const RunRoom> rooms, std::size_t room,
                      TripPlan& plan) {
    std::vector<RoomPoint>& points = plan.points;
    for (;;) {
        const std::string_view one = text.substr(0, text.find(';'));
        std::string_view point = one;
        if (const auto slash = one.rfind('/'); slash != std::string_view::npos) {
            const std::string_view id = one.substr(0, slash);
            const auto named = std::find_if(rooms.begin(), rooms.end(),
                                            [&](const RunRoom& each) { return each.id == id; });
            if (named == rooms.end()) return "no storey " + excerpt(id);
            room = static_cast<std::size_t>(named - rooms.begin());
            point = one.substr(slash + 1);
        }
        const auto goal = parseDestination(point);
        if (!goal) return "wanted a point like upper/1,2, found " + excerpt(one);
        if (points.size() == kMaxPoints)
            return "a trip has at most " + std::to_string(kMaxPoints) + " points";
        points.push_back({room, goal->at});
        if (goal->heading) plan.heading = goal->heading;
        if (one.size() == text.size()) return "";
        text.remove_prefix(one.size() + 1);
    }
}

}  // namespace

ParsedTrip parseTrip(std::span<const std::string_view> words, std::span<const RunRoom> rooms,
                     std::size_t room) {
    const bool is_path = words[0] == "PATH";
    ParsedTrip trip;
    const auto fail = [&trip](std::size_t word, std::string fault) {
        trip.word = word;
        trip.fault = std::move(fault);
        return trip;
    };
    std::vector<RoomPoint>& points = trip.plan.points;
    if (std::string fault = addPoints(words[1], rooms, room, trip.plan); !fault.empty())
        return fail(1, std::move(fault));
    if (is_path && trip.plan.heading)
        return fail(1, "points of PATH are x,y: GOTO x,y,heading turns at its point");
    if (!is_path && points.size() > 1) return fail(1, "GOTO leads to one point, PATH to several");
    Command keys;
    for (std::size_t i = 2; i < words.size(); ++i) {
        std::string fault = applyPathKey(words[i], keys);
        if (!is_path && !(fault.empty() && words[i].starts_with("speed=")))
            fault = "unexpected " + excerpt(words[i]) + " behind the point: speed=v alone";
        if (!fault.empty()) return fail(i, std::move(fault));
    }
    if (keys.course.loop && points.size() < 2)
        return fail(1, "a trip with loop=yes has two points or more");
    trip.plan.speed = keys.speed;
    trip.plan.pause = keys.course.pause;
    trip.plan.loop = keys.course.loop;
    return trip;
}

std::vector<RoomState> statesOf(const LiftState& lift) {
    return {{lift.id, "storey", lift.storey}, {lift.id, "open", lift.door > 0 ? "1" : "0"}};
}

}  // namespace ispace

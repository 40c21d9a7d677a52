// SPDX-License-Identifier: GPL-3.0-or-later
// Rooms of a building run in lock step, so that moments are joined by their times in microseconds.
// All moments are held in memory: O(moments * movers). A gap is from circle to circle, those of the
// standing body, whatever posture a person has.
#include "extensions/navigation/navigation_record.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <set>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "scene/bodies.h"

namespace ispace::navigation {

namespace {

/// All movers of a moment, by id.
struct WholeMoment {
    double time = 0;
    struct Place {
        Point2 at;
        std::size_t room = 0;
        bool is_person = false;
    };
    std::map<std::string, Place> movers = {};
    struct Hit {
        std::string id, other;
    };
    std::vector<Hit> hits = {};
};

/// The moments of all rooms, which are in lock step, by microseconds.
using WholeRun = std::map<std::int64_t, WholeMoment>;

void readRoom(RoomRecord& record, std::size_t room, WholeRun& run) {
    constexpr double kMicroseconds = 1e6;
    while (record.reader.next()) {
        const double time = record.reader.time();
        WholeMoment& moment = run[std::llround(time * kMicroseconds)];
        moment.time = time;
        for (const RunState& state : record.reader.states()) {
            const RunMember& member = record.reader.members()[state.member];
            moment.movers[member.id] = {state.pose.position, room, member.is_person};
        }
        if (const auto collisions = record.reader.collisions())
            for (const RunCollision& one : *collisions) moment.hits.push_back({one.id, one.other});
    }
}

std::string onlyRobot(const WholeRun& run, const std::string& wanted) {
    std::set<std::string> robots;
    for (const auto& [key, moment] : run)
        for (const auto& [id, place] : moment.movers)
            if (!place.is_person) robots.insert(id);
    if (robots.count(wanted) != 0) return wanted;
    std::string names;
    for (const std::string& id : robots) names += (names.empty() ? "" : ", ") + printable(id);
    if (!wanted.empty())
        throw UsageError("--robot: the record has no robot " + excerpt(wanted) +
                         (names.empty() ? "" : "; it has " + names));
    if (robots.size() == 1) return *robots.begin();
    throw UsageError(robots.empty() ? "--goal: the record has no robot"
                                    : "--goal: the record has several robots: choose one of " +
                                          names + " by --robot");
}

NavigationContact::Kind kindOf(const WholeMoment& moment, const std::string& robot,
                               const WholeMoment::Hit& hit) {
    const auto find = [&](const std::string& id) {
        const auto found = moment.movers.find(id);
        return found == moment.movers.end() ? nullptr : &found->second;
    };
    const std::string& other = hit.id == robot ? hit.other : hit.id;
    const WholeMoment::Place* const place = find(other);
    if (hit.id != robot && hit.other != robot) return NavigationContact::Kind::BetweenPeople;
    return place == nullptr   ? NavigationContact::Kind::Thing
           : place->is_person ? NavigationContact::Kind::Person
                              : NavigationContact::Kind::Robot;
}

bool isPerson(const WholeMoment& moment, const std::string& id) {
    const auto found = moment.movers.find(id);
    return found != moment.movers.end() && found->second.is_person;
}

}  // namespace

void addRadii(const Scene& scene, MoverRadii& radii) {
    for (const PlacedRobot& robot : scene.robots) radii.emplace(robot.id, robot.model.radius);
    for (const PlacedPerson& person : scene.people)
        radii.emplace(person.id, humanRadius(person.height));
}

RecordedNavigation recordedNavigation(std::vector<RoomRecord> records, const std::string& robot,
                                      const MoverRadii& radii) {
    RecordedNavigation recorded;
    WholeRun whole;
    for (RoomRecord& record : records) {
        readRoom(record, recorded.rooms.size(), whole);
        recorded.rooms.push_back(record.room);
        recorded.is_cut = recorded.is_cut || record.reader.isCut();
    }
    if (whole.empty())
        throw FormatError(
            {records.front().reader.name(), 0, 0, "the record holds no moment", Severity::Error});
    recorded.robot = onlyRobot(whole, robot);
    const auto radius_of = [&](const std::string& id) {
        const auto found = radii.find(id);
        return found == radii.end() ? 0.0 : found->second;
    };
    std::map<std::string, std::size_t> numbers;
    recorded.run.moments.reserve(whole.size());
    for (const auto& [key, moment] : whole) {
        for (const WholeMoment::Hit& hit : moment.hits) {
            const bool is_robots = hit.id == recorded.robot || hit.other == recorded.robot;
            if (!is_robots && !(isPerson(moment, hit.id) && isPerson(moment, hit.other))) continue;
            const auto [first, second] = std::minmax(hit.id, hit.other);
            NavigationContact& one = recorded.run.contacts.emplace_back();
            one.time = moment.time;
            one.kind = kindOf(moment, recorded.robot, hit);
            one.pair.append(first).append(1, ' ').append(second);
        }
        const auto self = moment.movers.find(recorded.robot);
        if (self == moment.movers.end()) continue;
        NavigationMoment& one = recorded.run.moments.emplace_back();
        one.time = moment.time;
        one.place = self->second.at;
        one.room = self->second.room;
        for (const auto& [id, place] : moment.movers) {
            if (!place.is_person || place.room != one.room) continue;
            const std::size_t number = numbers.emplace(id, numbers.size()).first->second;
            one.people.push_back({number, distance(place.at, one.place) - radius_of(id) -
                                              radius_of(recorded.robot)});
        }
    }
    return recorded;
}

}  // namespace ispace::navigation

// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/expect.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/zone.h"
#include "geom/polygon.h"
#include "sense/detection.h"
#include "sense/selection.h"

namespace ispace {

namespace {

using State = Expectation::State;
using When = Expectation::When;

/// State of a mover at a step.
struct Observation {
    bool holds = false;           ///< the state of the expectation
    double measure = 0;           ///< metres, sensors or m/s, by the state
    std::string_view other = {};  ///< of a collision
    bool is_struck = false;       ///< `other` ran into it
};

/// One expectation about one robot or person.
struct Trial {
    std::size_t expectation = 0;
    std::string id;
    std::size_t room = 0;
    std::optional<std::size_t> mover;  // its index in that room; empty while all rooms lack it
    std::optional<SimTime> since;      // since when the state holds
    std::optional<SimTime> decided;    // when the verdict was decided
    bool is_met = false;
    bool was_observed = false;                                 // within the window
    double nearest = std::numeric_limits<double>::infinity();  // distance so far, metres
    SimTime nearest_time{}, longest{};  // longest: time for which the state held
    std::string reason;                 // why it is not met
};

std::string at(SimTime time) { return " at t=" + formatMilliseconds(time); }

std::string rounded(double value) { return formatDouble(roundSignificant(value, 4)); }

/// A world, with its id among others.
struct JudgedRoom {
    std::string id;
    const World* world = nullptr;
    std::optional<DetectionMonitor> watch = {};
    std::vector<Pose2> poses = {};  // of all movers, for the watch
    std::int64_t changes = -1;      // of the world, when it was last read

    [[nodiscard]] std::size_t seenBy(std::size_t mover) const {
        const std::size_t robots = world->robots().size();
        const std::span<const Pose2> all(poses);
        const auto owner = mover < robots
                               ? static_cast<std::uint32_t>(mover)
                               : kFirstPerson + static_cast<std::uint32_t>(mover - robots);
        return watch->seenBy({poses[mover].position, owner},
                             {.robots = all.first(robots), .people = all.subspan(robots)});
    }
};

std::vector<JudgedRoom> judgedRooms(std::span<const JoinedRoom> joined) {
    std::vector<JudgedRoom> rooms;
    for (const JoinedRoom& room : joined) rooms.push_back({room.id, &room.simulation->world()});
    return rooms;
}

std::vector<JudgedRoom> theOnly(const World& world) {
    std::vector<JudgedRoom> rooms;
    rooms.push_back({"", &world});
    return rooms;
}

std::vector<std::string> namesOf(const std::vector<JudgedRoom>& rooms) {
    std::vector<std::string> names;
    for (const JudgedRoom& room : rooms)
        for (const Mover& mover : room.world->movers()) names.push_back(mover.id);
    return names;
}

UsageError unknown(const std::vector<JudgedRoom>& rooms, const std::string& id) {
    return UsageError("no robot or person is " + excerpt(id) + didYouMean(id, namesOf(rooms)));
}

UsageError lacksRoom(const std::vector<JudgedRoom>& rooms, const std::string& text) {
    if (rooms.front().id.empty()) return UsageError("there is one room: leave out its name");
    return UsageError(excerpt(text) + " names no room before it, as in " + rooms.front().id + '/' +
                      text.substr(text.find('/') + 1));
}

/// Zones of a room.
struct RoomZones {
    std::size_t room = 0;
    std::vector<Polygon> outlines = {};
};

/// "is not within 0.4 m of h1", "is seen by 0 sensors".
std::string stateText(const Expectation& expectation, const Observation& seen) {
    const std::string is = seen.holds == expectation.is_negated ? "was not " : "was ";
    switch (expectation.state) {
        case State::Collision:
            return (seen.is_struck ? "was run into by " : "ran into ") + std::string(seen.other);
        case State::Near:
            return std::isfinite(seen.measure) ? "was " + rounded(seen.measure) + " m away"
                                               : "was elsewhere";
        case State::InZone:
            return is + "in zone " + expectation.name;
        case State::Seen:
            return "was seen by " + formatDouble(seen.measure) +
                   (seen.measure == 1 ? " sensor" : " sensors");
        case State::Stalled:
            return is + "stalled";
        case State::Still:
        case State::Faster:
        case State::Slower:
            return "went at " + rounded(seen.measure) + " m/s";
    }
    return {};
}

/// Updates a trial by an observation, and decides it if possible.
void decide(Trial& trial, const Expectation& expectation, const Observation& seen, SimTime now) {
    const auto settle = [&](bool is_met, const std::string& reason) {
        trial.decided = now;
        trial.is_met = is_met;
        if (!is_met) trial.reason = trial.id + ' ' + reason;
    };
    if (trial.since) trial.longest = std::max(trial.longest, now - *trial.since);
    const SimTime since = trial.since.value_or(now);
    if (!seen.holds)
        trial.since.reset();
    else if (!trial.since)
        trial.since = now;
    switch (expectation.when) {
        case When::Once:
            if (seen.holds) settle(true, "");
            break;
        case When::Always:
            if (!seen.holds) settle(false, stateText(expectation, seen) + at(now));
            break;
        case When::Never:
            if (seen.holds) settle(false, stateText(expectation, seen) + at(now));
            break;
        case When::AtLeast:
            if (trial.longest >= expectation.span || (seen.holds && expectation.span == SimTime(0)))
                settle(true, "");
            break;
        case When::AtMost:
            if (trial.longest > expectation.span)
                settle(false, "was so for more than " + formatSimTime(expectation.span) +
                                  " s from t=" + formatMilliseconds(since));
            break;
    }
}

/// Decides a trial that was open until the end.
bool holdsAtTheEnd(const Trial& trial, const Expectation& expectation) {
    switch (expectation.when) {
        case When::Once:
            return false;
        case When::AtLeast:
            return trial.longest >= expectation.span;
        case When::AtMost:
            return trial.longest <= expectation.span;
        case When::Always:
        case When::Never:
            return true;
    }
    return false;
}

/// The run, or the window, has ended.
void close(Trial& trial, const Expectation& expectation, SimTime now) {
    const bool is_over = now >= expectation.before;  // the end of the window, not only of the run
    trial.decided = std::min(now, expectation.before);
    trial.is_met = trial.was_observed && holdsAtTheEnd(trial, expectation);
    if (trial.is_met) return;
    const std::string end = is_over ? "" : "; the run ended" + at(now);
    if (!trial.was_observed)
        trial.reason = trial.id + " was not there in time" + end;
    else if (expectation.when == When::AtLeast)
        trial.reason = trial.id + " was so for " + formatMilliseconds(trial.longest) +
                       " s at the longest" + end;
    else if (std::isfinite(trial.nearest))
        trial.reason = trial.id + " came no nearer than " + rounded(trial.nearest) +
                       " m (t=" + formatMilliseconds(trial.nearest_time) + ')' + end;
    else
        trial.reason = trial.id + " was never so" + end;
}

}  // namespace

struct ExpectationJudge::Data {
    Data(std::vector<JudgedRoom> judged, std::vector<Expectation> list);

    void addTrials(std::size_t expectation);
    void checkTarget(const Expectation& expectation);
    [[nodiscard]] std::size_t roomNamed(const std::string& id, const std::string& text) const;
    [[nodiscard]] RoomZones zonesOf(const std::string& text) const;
    void find();
    [[nodiscard]] std::optional<Point2> placeOf(const Trial& trial) const;
    [[nodiscard]] Observation look(const Trial& trial) const;
    [[nodiscard]] Observation lookForCollision(const Trial& trial) const;
    [[nodiscard]] bool collided(const Trial& trial) const;
    void observe(Trial& trial);

    std::vector<JudgedRoom> rooms;
    std::vector<Expectation> expectations;
    std::vector<RoomZones> zones;  // of the expectations; empty without
    std::vector<Trial> trials;
    bool is_watched = false;
};

ExpectationJudge::Data::Data(std::vector<JudgedRoom> judged, std::vector<Expectation> list)
    : rooms(std::move(judged)), expectations(std::move(list)) {
    for (std::size_t i = 0; i < expectations.size(); ++i) {
        try {
            addTrials(i);
            checkTarget(expectations[i]);
        } catch (const UsageError& error) {
            throw UsageError(excerpt(expectations[i].text) + ": " + error.what());
        }
    }
    is_watched = std::any_of(expectations.begin(), expectations.end(),
                             [](const Expectation& each) { return each.state == State::Seen; });
    find();
}

void ExpectationJudge::Data::addTrials(std::size_t expectation) {
    const std::string& subject = expectations[expectation].subject;
    const std::size_t before = trials.size();
    for (const std::string& name : namesOf(rooms)) {
        if (!isSelected(name, {subject})) continue;
        Trial& trial = trials.emplace_back();
        trial.expectation = expectation;
        trial.id = name;
    }
    if (trials.size() == before && subject != "*") throw unknown(rooms, subject);
}

/// Finds a room by its id, "" for the only one. \param text of which it is a part
std::size_t ExpectationJudge::Data::roomNamed(const std::string& id,
                                              const std::string& text) const {
    for (std::size_t i = 0; i < rooms.size(); ++i)
        if (rooms[i].id == id) return i;
    throw lacksRoom(rooms, text);
}

RoomZones ExpectationJudge::Data::zonesOf(const std::string& text) const {
    RoomZones found;
    std::string name = text;
    if (!rooms.front().id.empty()) {
        const std::size_t slash = std::min(text.find('/'), text.size());
        found.room = roomNamed(text.substr(0, slash), text);
        name = text.substr(std::min(slash + 1, text.size()));
    }
    for (NamedZone& zone : readZones(name, rooms[found.room].world->scene().environment))
        found.outlines.push_back(std::move(zone.outline));
    return found;
}

void ExpectationJudge::Data::checkTarget(const Expectation& expectation) {
    zones.emplace_back();
    if (expectation.state == State::InZone) zones.back() = zonesOf(expectation.name);
    if (expectation.state != State::Near) return;
    if (expectation.place) {
        const Point2 p = *expectation.place;
        static_cast<void>(roomNamed(expectation.room, formatDouble(p.x) + ',' + formatDouble(p.y)));
        return;
    }
    const std::vector<std::string> names = namesOf(rooms);
    if (std::find(names.begin(), names.end(), expectation.name) == names.end())
        throw unknown(rooms, expectation.name);
}

/// Finds movers in worlds that have changed.
void ExpectationJudge::Data::find() {
    bool has_changed = false;
    for (JudgedRoom& room : rooms) {
        if (std::exchange(room.changes, room.world->changes()) == room.world->changes()) continue;
        has_changed = true;
        if (is_watched)
            room.watch.emplace(room.world->scene(),
                               WatchOptions{.outside = room.world->options().outside});
    }
    if (!has_changed) return;
    for (Trial& trial : trials) {
        trial.mover.reset();
        for (std::size_t i = 0; i < rooms.size() && !trial.mover; ++i) {
            trial.room = i;
            trial.mover = rooms[i].world->moverNamed(trial.id);
        }
    }
}

/// Returns the point from which the distance of a mover counts, in its room.
std::optional<Point2> ExpectationJudge::Data::placeOf(const Trial& trial) const {
    const Expectation& expectation = expectations[trial.expectation];
    const JudgedRoom& room = rooms[trial.room];
    if (expectation.place) return expectation.room == room.id ? expectation.place : std::nullopt;
    const auto other = room.world->moverNamed(expectation.name);
    if (!other) return std::nullopt;
    return room.world->status(*other).pose.position;
}

Observation ExpectationJudge::Data::lookForCollision(const Trial& trial) const {
    const World& world = *rooms[trial.room].world;
    for (const Collision& collision : world.collisions()) {
        const std::string& who = world.movers()[collision.robot].id;
        if (who == trial.id) return {.holds = true, .other = collision.into};
        if (collision.into == trial.id) return {.holds = true, .other = who, .is_struck = true};
    }
    return {};
}

bool ExpectationJudge::Data::collided(const Trial& trial) const {
    const auto collisions = rooms[trial.room].world->collisions();
    return std::any_of(collisions.begin(), collisions.end(),
                       [&trial](const Collision& each) { return each.robot == trial.mover; });
}

/// \pre a world has this mover
Observation ExpectationJudge::Data::look(const Trial& trial) const {
    const Expectation& expectation = expectations[trial.expectation];
    const JudgedRoom& room = rooms[trial.room];
    const RobotStatus status = room.world->status(*trial.mover);
    const double speed = std::hypot(status.speed, status.sidespeed);
    switch (expectation.state) {
        case State::Collision:
            return lookForCollision(trial);
        case State::Stalled:
            // A command given since the step may have cleared the flag.
            return {.holds = status.stall || collided(trial)};
        case State::Still:
            return {.holds = speed == 0 && status.rotspeed == Angle(), .measure = speed};
        case State::Faster:
            return {.holds = speed > expectation.amount, .measure = speed};
        case State::Slower:
            return {.holds = speed < expectation.amount, .measure = speed};
        case State::InZone: {
            const auto& [of, outlines] = zones[trial.expectation];
            return {.holds =
                        of == trial.room &&
                        std::any_of(outlines.begin(), outlines.end(), [&](const Polygon& zone) {
                            return locate(zone, status.pose.position) != Side::Outside;
                        })};
        }
        case State::Seen: {
            const auto count = static_cast<double>(room.seenBy(*trial.mover));
            return {.holds = count >= expectation.amount, .measure = count};
        }
        case State::Near:
            break;
    }
    const auto place = placeOf(trial);
    const double away =
        place ? distance(*place, status.pose.position) : std::numeric_limits<double>::infinity();
    return {.holds = away <= expectation.amount, .measure = away};
}

void ExpectationJudge::Data::observe(Trial& trial) {
    const Expectation& expectation = expectations[trial.expectation];
    const SimTime now = rooms.front().world->time();
    if (now < expectation.after) return;
    if (now > expectation.before) {
        if (trial.since) trial.longest = std::max(trial.longest, expectation.before - *trial.since);
        close(trial, expectation, now);
        return;
    }
    if (!trial.mover) return;
    trial.was_observed = true;
    Observation seen = look(trial);
    seen.holds = seen.holds != expectation.is_negated;
    if (expectation.state == State::Near && !expectation.is_negated &&
        seen.measure < trial.nearest) {
        trial.nearest = seen.measure;
        trial.nearest_time = now;
    }
    decide(trial, expectation, seen, now);
}

ExpectationJudge::ExpectationJudge(const World& world, std::vector<Expectation> expectations)
    : data_(std::make_unique<Data>(theOnly(world), std::move(expectations))) {}
ExpectationJudge::ExpectationJudge(std::span<const JoinedRoom> rooms,
                                   std::vector<Expectation> expectations)
    : data_(std::make_unique<Data>(judgedRooms(rooms), std::move(expectations))) {}
ExpectationJudge::~ExpectationJudge() = default;
ExpectationJudge::ExpectationJudge(ExpectationJudge&&) noexcept = default;
ExpectationJudge& ExpectationJudge::operator=(ExpectationJudge&&) noexcept = default;

void ExpectationJudge::observe() {
    Data& data = *data_;
    data.find();
    for (JudgedRoom& room : data.rooms) {
        if (!room.watch) continue;
        room.poses.resize(room.world->movers().size());
        for (std::size_t i = 0; i < room.poses.size(); ++i)
            room.poses[i] = room.world->status(i).pose;
    }
    for (Trial& trial : data.trials)
        if (!trial.decided) data.observe(trial);
}

std::vector<RunVerdict> ExpectationJudge::verdicts() const {
    std::vector<RunVerdict> verdicts;
    for (const Expectation& expectation : data_->expectations)
        verdicts.push_back({.expectation = expectation.text, .is_met = true});
    for (Trial trial : data_->trials) {
        if (!trial.decided)
            close(trial, data_->expectations[trial.expectation],
                  data_->rooms.front().world->time());
        RunVerdict& verdict = verdicts[trial.expectation];
        // Reports the first failure, or else the last success.
        if (!trial.is_met && (verdict.is_met || *trial.decided < verdict.time)) {
            verdict.is_met = false;
            verdict.time = *trial.decided;
            verdict.reason = trial.reason;
        } else if (trial.is_met && verdict.is_met) {
            verdict.time = std::max(verdict.time, *trial.decided);
        }
    }
    return verdicts;
}

std::string unmetText(const std::vector<RunVerdict>& verdicts) {
    std::string text;
    for (const RunVerdict& verdict : verdicts)
        if (!verdict.is_met)
            text.append(text.empty() ? "" : "; ")
                .append("expected `" + verdict.expectation + "`: " + verdict.reason);
    return text;
}

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// A term reads its subjects once a step into looks; clauses combine looks, and a trial for each
// subject of the first condition (one for `any` and `total`) keeps only times: since when the state
// holds, the longest spell, the sum. So memory does not grow with the run, but for open events and
// for the last changes of each subject, which a failure shows.
//
// A state that holds at a step counts until the next one. Verdicts settle as soon as more steps
// cannot change them, else at the end of the window or of the run.
#include "extensions/expect/expect.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "env/zone.h"
#include "geom/polygon.h"
#include "sense/detection.h"
#include "sense/selection.h"

namespace ispace::expect {

namespace {

using State = Condition::State;
using Of = Condition::Of;
using When = Expectation::When;

/// Number of changes kept of each subject, and of those shown with a failure.
constexpr std::size_t kMostChanges = 8, kMostObserved = 40;

bool isOfMovers(State state) { return state < State::On; }

std::string at(SimTime time) { return " at t=" + formatMilliseconds(time); }

std::string rounded(double value) { return formatDouble(roundSignificant(value, 4)); }

/// State of one subject at a step.
struct Look {
    bool is_there = true;
    bool holds = false;           ///< the state of the condition
    double measure = 0;           ///< metres, sensors, m/s, or the value of a thing's state
    std::string_view other = {};  ///< of a collision
    bool is_struck = false;       ///< `other` ran into it
    std::string_view text = {};   ///< of a thing's state
};

/// Zones of a room.
struct RoomZones {
    std::size_t room = 0;
    std::vector<Polygon> outlines = {};

    [[nodiscard]] bool contains(Point2 point) const {
        return std::any_of(outlines.begin(), outlines.end(), [point](const Polygon& zone) {
            return locate(zone, point) != Side::Outside;
        });
    }
};

/// A robot, a person, a thing or a zone that a condition is about.
struct Subject {
    std::string name;
    std::size_t room = 0;
    std::optional<std::size_t> mover = {};  // its index in that room; empty while all rooms lack it
    const ThingState* state = nullptr;      // of a thing
    std::string key = {};                   // of that state, or of the zone
    const RoomZones* zone = nullptr;        // its people or robots count

    bool was_holding = false, was_there = false;  // at the last step
    bool begins = false;                          // at this step, having been otherwise
    std::string last_text = {};                   // last observed
    std::deque<ObservedState> changes = {};
};

/// A condition with its subjects.
struct Term {
    const Condition* condition = nullptr;
    std::vector<Subject> subjects = {};
    const RoomZones* zone = nullptr;  // of InZone
    std::optional<SimTime> since = {};
    bool is_there = false, holds = false;
    Look look = {};  // of the first subject, or the total
};

/// Terms of a clause: any of these, of which all.
using Terms = std::vector<std::vector<Term>>;

/// An event that waits for its answer.
struct Pending {
    SimTime time{};
    std::string by = {};
};

/// One expectation about one subject, or about all together.
struct Trial {
    std::size_t expectation = 0;
    std::string name;
    Terms claim;
    std::optional<SimTime> since;    // since when the claim holds
    std::optional<SimTime> wrong;    // since when it is as it must not be
    std::optional<SimTime> decided;  // when the verdict was decided
    bool is_met = false;
    bool was_observed = false;                                 // within the window
    double nearest = std::numeric_limits<double>::infinity();  // distance so far, metres
    SimTime nearest_time{}, longest{}, in_all{}, last{};       // longest: for which it held
    std::int64_t times = 0;                                    // at which it began to hold
    bool held = false;
    std::string reason;             // why it is not met
    std::optional<SimTime> failed;  // when that was decided, at first
    std::vector<Pending> pending = {};
    std::int64_t answered = 0;  // events that were judged
    std::int64_t failures = 0;
    std::vector<RunFailure> shown = {};
};

/// What the trials of an expectation share.
struct Ground {
    Terms event, gate;
    bool event_held = false, was_observed = false;
    bool is_open = true;        // the gate, at this step
    std::int64_t events = 0;    // so far
    std::vector<Pending> news;  // events of this step
};

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

std::vector<std::string> namesOf(const std::vector<JudgedRoom>& rooms) {
    std::vector<std::string> names;
    for (const JudgedRoom& room : rooms)
        for (const Mover& mover : room.world->movers()) names.push_back(mover.id);
    return names;
}

SentenceError unknown(const std::vector<JudgedRoom>& rooms, const std::string& id,
                      std::size_t offset) {
    return {"no robot or person is " + excerpt(id) + didYouMean(id, namesOf(rooms)), offset};
}

UsageError lacksRoom(const std::vector<JudgedRoom>& rooms, const std::string& text) {
    if (rooms.front().id.empty()) return UsageError("there is one room: leave out its name");
    return UsageError(excerpt(text) + " names no room before it, as in " + rooms.front().id + '/' +
                      text.substr(text.find('/') + 1));
}

/// Returns the state of a thing in words: "was off", "was at 21.5" of celsius.
std::string thingText(const std::string& key, std::string_view text, bool is_on) {
    if (key == "on") return is_on ? "was on" : "was off";
    if (key == "open") return is_on ? "was open" : "was closed";
    if (key == "occupied") return is_on ? "was occupied" : "was empty";
    std::string said = "had " + key + ' ';
    return said.append(text);
}

/// "was not within 0.4 m of h1", "was seen by 0 sensors", of what was observed of a subject.
std::string stateText(const Condition& condition, const Subject& subject, const Look& look) {
    const std::string is = look.holds ? "was " : "was not ";
    switch (condition.state) {
        case State::Collision:
            return (look.is_struck ? "was run into by " : "ran into ") + std::string(look.other);
        case State::Near:
            return std::isfinite(look.measure) ? "was " + rounded(look.measure) + " m away"
                                               : "was elsewhere";
        case State::InZone:
            return (look.holds != condition.is_opposite ? "was in zone " : "was not in zone ") +
                   condition.name;
        case State::Seen:
            return "was seen by " + formatDouble(look.measure) +
                   (look.measure == 1 ? " sensor" : " sensors");
        case State::Stalled:
            return is + "stalled";
        case State::Still:
        case State::Faster:
        case State::Slower:
            return "went at " + rounded(look.measure) + " m/s";
        case State::On:
            return thingText(subject.key, look.text, look.holds != condition.is_opposite);
        case State::Is:
        case State::Above:
        case State::Below:
            return "had " + subject.key + ' ' +
                   (look.text.empty() ? rounded(look.measure) : std::string(look.text));
    }
    return {};
}

/// Returns the states of all terms, the first without its name: "was off and l2 was on".
std::string claimText(const Terms& terms) {
    std::string text;
    for (const auto& all : terms)
        for (const Term& term : all) {
            if (term.subjects.empty()) continue;
            text.append(text.empty() ? "" : " and ");
            if (!text.empty())
                text.append(term.condition->of == Of::Each ? term.subjects.front().name
                                                           : term.condition->subject)
                    .append(" ");
            text.append(stateText(*term.condition, term.subjects.front(), term.look));
        }
    return text;
}

/// Decides a trial that was open until the end.
bool holdsAtTheEnd(const Trial& trial, const Expectation& expectation) {
    switch (expectation.when) {
        case When::Once:
            return false;
        case When::AtEnd:
            return trial.held;
        case When::AtLeast:
            return trial.longest >= expectation.span;
        case When::AtMost:
            return trial.longest <= expectation.span;
        case When::AtLeastTimes:
            return trial.times >= expectation.times;
        case When::AtMostTimes:
            return trial.times <= expectation.times;
        case When::AtLeastInAll:
            return trial.in_all >= expectation.span;
        case When::AtMostInAll:
            return trial.in_all <= expectation.span;
        case When::Always:
        case When::Never:
            return trial.failures == 0;
    }
    return false;
}

/// The states of a failure: the last one before it of each subject, and those in its time.
std::vector<ObservedState> observedIn(std::initializer_list<const Terms*> clauses, SimTime from,
                                      SimTime to) {
    std::vector<ObservedState> seen;
    for (const Terms* const terms : clauses)
        for (const auto& all : *terms)
            for (const Term& term : all)
                for (const Subject& subject : term.subjects) {
                    const ObservedState* before = nullptr;
                    for (const ObservedState& change : subject.changes) {
                        if (change.time < from)
                            before = &change;
                        else if (change.time <= to)
                            seen.push_back(change);
                    }
                    if (before != nullptr) seen.push_back(*before);
                }
    std::stable_sort(seen.begin(), seen.end(), [](const ObservedState& a, const ObservedState& b) {
        return a.time < b.time;
    });
    // A state that two clauses name is one.
    const auto same = [](const ObservedState& a, const ObservedState& b) {
        return a.time == b.time && a.text == b.text;
    };
    seen.erase(std::unique(seen.begin(), seen.end(), same), seen.end());
    if (seen.size() > kMostObserved)
        seen.erase(seen.begin(), seen.end() - static_cast<std::ptrdiff_t>(kMostObserved));
    return seen;
}

}  // namespace

struct ExpectationJudge::Data {
    Data(std::span<const JudgedWorld> judged, std::vector<Expectation> list);

    [[nodiscard]] std::size_t roomNamed(const std::string& id, const std::string& text) const;
    const RoomZones* zonesOf(const std::string& text);
    void add(std::size_t expectation);
    [[nodiscard]] Terms termsOf(const Clause& clause);
    [[nodiscard]] Term termOf(const Condition& condition);
    void addMovers(Term& term);
    void addThings(Term& term);
    [[nodiscard]] std::string keyOf(const Thing& thing, const Condition& condition) const;
    bool addZone(Term& term);
    void checkPlace(const Condition& condition) const;
    [[noreturn]] void unknownThing(const Condition& condition) const;
    void find();

    [[nodiscard]] std::optional<Point2> placeOf(const Condition& condition,
                                                const Subject& subject) const;
    [[nodiscard]] Look look(const Term& term, const Subject& subject) const;
    [[nodiscard]] Look lookAtMover(const Term& term, const Subject& subject) const;
    [[nodiscard]] Look lookForCollision(const Subject& subject) const;
    [[nodiscard]] bool collided(const Subject& subject) const;
    bool read(Terms& terms) const;
    void read(Term& term) const;
    void readGround(Ground& ground, const Expectation& expectation) const;

    void observe(Trial& trial);
    void decide(Trial& trial, bool holds);
    void answer(Trial& trial, bool holds);
    void close(Trial& trial, SimTime time) const;
    void fail(Trial& trial, SimTime from, SimTime to, const std::string& reason) const;
    [[nodiscard]] SimTime now() const { return rooms.front().world->time(); }

    std::vector<JudgedRoom> rooms;
    std::vector<Expectation> expectations;
    ThingStates things;
    std::deque<RoomZones> zones;  // with stable addresses
    std::vector<Ground> grounds;  // of the expectations
    std::vector<Trial> trials;
    bool is_watched = false;
};

ExpectationJudge::Data::Data(std::span<const JudgedWorld> judged, std::vector<Expectation> list)
    : expectations(std::move(list)), things(judged) {
    for (const JudgedWorld& each : judged) rooms.push_back({each.id, each.world});
    grounds.resize(expectations.size());
    for (std::size_t i = 0; i < expectations.size(); ++i) {
        const Expectation& expectation = expectations[i];
        const auto refuse = [&](const std::string& message, std::size_t offset) {
            const std::string text = excerpt(expectation.text) + ": " + message;
            if (expectation.source.file.empty()) throw UsageError(text);
            Diagnostic finding = expectation.source;
            if (expectation.is_verbatim) finding.column += static_cast<int>(offset);
            finding.message = text;
            throw FormatError(std::move(finding));
        };
        try {
            add(i);
        } catch (const SentenceError& error) {
            refuse(error.what(), error.offset());
        } catch (const UsageError& error) {
            refuse(error.what(), 0);
        }
    }
    find();
}

void ExpectationJudge::Data::add(std::size_t expectation) {
    const Expectation& each = expectations[expectation];
    grounds[expectation].event = termsOf(each.event);
    grounds[expectation].gate = termsOf(each.gate);
    const Terms claim = termsOf(each.claim);
    const Term& first = claim.front().front();
    if (first.condition->of != Of::Each) {
        Trial& trial = trials.emplace_back();
        trial.expectation = expectation;
        trial.name =
            (first.condition->of == Of::Any ? "any " : "total ") + first.condition->subject;
        trial.claim = claim;
        return;
    }
    for (const Subject& subject : first.subjects) {
        Trial& trial = trials.emplace_back();
        trial.expectation = expectation;
        trial.name = subject.name;
        trial.claim = claim;
        trial.claim.front().front().subjects = {subject};
    }
}

Terms ExpectationJudge::Data::termsOf(const Clause& clause) {
    Terms terms;
    terms.reserve(clause.size());
    for (const auto& conditions : clause) {
        std::vector<Term>& all = terms.emplace_back();
        all.reserve(conditions.size());
        for (const Condition& condition : conditions) all.push_back(termOf(condition));
    }
    return terms;
}

Term ExpectationJudge::Data::termOf(const Condition& condition) {
    Term term;
    term.condition = &condition;
    if (isOfMovers(condition.state)) {
        addMovers(term);
        checkPlace(condition);
        if (condition.state == State::InZone) term.zone = zonesOf(condition.name);
        if (condition.state == State::Seen) is_watched = true;
        if (condition.of == Of::Total)
            throw SentenceError("`total` is about values of things", condition.offset);
    } else if (!addZone(term)) {
        addThings(term);
    }
    return term;
}

void ExpectationJudge::Data::addMovers(Term& term) {
    const std::string& wanted = term.condition->subject;
    for (const std::string& name : namesOf(rooms))
        if (isSelected(name, {wanted})) term.subjects.push_back({.name = name});
    if (term.subjects.empty() && (wanted == "robot" || wanted == "human"))
        for (const JudgedRoom& room : rooms)
            for (std::size_t i = 0; i < room.world->movers().size(); ++i)
                if ((i < room.world->robots().size()) == (wanted == "robot"))
                    term.subjects.push_back({.name = room.world->movers()[i].id});
    if (!term.condition->part.empty())
        throw SentenceError("`of " + term.condition->part +
                                "` is about things: people and robots are `in zone " +
                                term.condition->part + '`',
                            term.condition->offset);
    if (term.subjects.empty() && wanted == "human")
        throw SentenceError("no person is in this run", term.condition->offset);
    if (term.subjects.empty() && wanted != "*")
        throw unknown(rooms, wanted, term.condition->offset);
}

/// Finds a room by its id, "" for the only one. \param text of which it is a part
std::size_t ExpectationJudge::Data::roomNamed(const std::string& id,
                                              const std::string& text) const {
    for (std::size_t i = 0; i < rooms.size(); ++i)
        if (rooms[i].id == id) return i;
    throw lacksRoom(rooms, text);
}

const RoomZones* ExpectationJudge::Data::zonesOf(const std::string& text) {
    RoomZones found;
    std::string name = text;
    if (!rooms.front().id.empty()) {
        const std::size_t slash = std::min(text.find('/'), text.size());
        found.room = roomNamed(text.substr(0, slash), text);
        name = text.substr(std::min(slash + 1, text.size()));
    }
    for (NamedZone& zone : readZones(name, rooms[found.room].world->scene().environment))
        found.outlines.push_back(std::move(zone.outline));
    return &zones.emplace_back(std::move(found));
}

void ExpectationJudge::Data::checkPlace(const Condition& condition) const {
    if (condition.state != State::Near) return;
    if (condition.place) {
        const Point2 p = *condition.place;
        static_cast<void>(roomNamed(condition.room, formatDouble(p.x) + ',' + formatDouble(p.y)));
        return;
    }
    const std::vector<std::string> names = namesOf(rooms);
    if (std::find(names.begin(), names.end(), condition.name) == names.end())
        throw unknown(rooms, condition.name, condition.offset);
}

/// Returns true if the condition is about the people or robots of a zone.
bool ExpectationJudge::Data::addZone(Term& term) {
    const Condition& condition = *term.condition;
    std::string name = condition.subject, key = condition.key;
    if (key.empty()) {
        const std::size_t dot = name.rfind('.');
        if (dot == std::string::npos) return false;
        key = name.substr(dot + 1);
        name.resize(dot);
    }
    if (key != "people" && key != "robots" && key != "occupied") return false;
    for (const Thing& thing : things.things())
        if (thing.keyword == "zone" && isSelected(thing.name, {name}))
            term.subjects.push_back(
                {.name = thing.name, .room = thing.room, .key = key, .zone = zonesOf(thing.name)});
    return !term.subjects.empty();
}

/// Returns the state of a thing that a condition means: the one that it names, or the only one.
std::string ExpectationJudge::Data::keyOf(const Thing& thing, const Condition& condition) const {
    const auto has = [&thing](const char* key) {
        return std::find(thing.keys.begin(), thing.keys.end(), key) != thing.keys.end();
    };
    if (condition.key == "occupied" && !has("occupied") && has("n")) return "n";  // of a mat
    if (!condition.key.empty()) return condition.key;
    if (thing.keys.size() == 1) return thing.keys.front();
    if (thing.keys.empty())
        throw SentenceError(thing.name + " has no state by itself", condition.offset);
    std::string states;
    for (const std::string& key : thing.keys) states.append(states.empty() ? "" : ", ").append(key);
    throw SentenceError(thing.name + " has the states " + states + ": give one, such as " +
                            thing.name + '.' + thing.keys.front(),
                        condition.offset);
}

void ExpectationJudge::Data::unknownThing(const Condition& condition) const {
    std::vector<std::string> known;
    for (const Thing& thing : things.things()) {
        if (!thing.keys.empty() || thing.keyword == "zone") known.push_back(thing.name);
        if (!thing.keys.empty()) known.push_back(thing.keyword);
        for (const std::string& key : thing.keys) known.push_back(thing.name + '.' + key);
    }
    std::erase(known, condition.subject);  // `l1.level on` knows the name, but not so
    // In a building the room is missed most.
    const auto with_room = std::find_if(known.begin(), known.end(), [&](const std::string& name) {
        return name.ends_with('/' + condition.subject);
    });
    if (with_room != known.end())
        throw SentenceError(
            "no thing is " + excerpt(condition.subject) + ", did you mean `" + *with_room + "`?",
            condition.offset);
    throw SentenceError("no thing is " + excerpt(condition.subject) +
                            (condition.part.empty() ? "" : " of " + condition.part) +
                            didYouMean(condition.subject, known),
                        condition.offset);
}

void ExpectationJudge::Data::addThings(Term& term) {
    const Condition& condition = *term.condition;
    const RoomZones* const part = condition.part.empty() ? nullptr : zonesOf(condition.part);
    const auto is_in_part = [part](const Thing& thing) {
        return part == nullptr ||
               (thing.at && thing.room == part->room && part->contains(*thing.at));
    };
    std::vector<std::string> lacking;
    const auto add = [&](const Thing& thing, const std::string& key) {
        const ThingState* const state = things.find(thing, key);
        if (state == nullptr)
            throw SentenceError(
                thing.name + " has no state " + excerpt(key) + didYouMean(key, thing.keys),
                condition.offset);
        if (term.condition->of == Of::Total && std::isnan(state->number))
            throw SentenceError("`total`: " + thing.name + '.' + key + " is no number",
                                condition.offset);
        term.subjects.push_back(
            {.name = thing.name, .room = thing.room, .state = state, .key = key});
    };
    // By id, by ID.KEY, by keyword, and by KEYWORD.KEY.
    const std::size_t dot = condition.subject.rfind('.');
    const std::string before = condition.subject.substr(0, dot);
    const std::string key = dot == std::string::npos ? "" : condition.subject.substr(dot + 1);
    const bool is_key = !key.empty() && (condition.key.empty() || condition.key == key);
    const auto has_states = [&](const Thing& thing, const std::string& wanted) {
        return !thing.keys.empty() || thing.name == wanted;
    };
    for (const Thing& thing : things.things())
        if (isSelected(thing.name, {condition.subject}) && has_states(thing, condition.subject) &&
            is_in_part(thing))
            add(thing, keyOf(thing, condition));
    if (term.subjects.empty() && is_key)
        for (const Thing& thing : things.things())
            if (isSelected(thing.name, {before}) && has_states(thing, before) && is_in_part(thing))
                add(thing, key);
    if (term.subjects.empty())
        for (const Thing& thing : things.things())
            if (thing.keyword == condition.subject && !thing.keys.empty() && is_in_part(thing))
                add(thing, keyOf(thing, condition));
    if (term.subjects.empty() && is_key)
        for (const Thing& thing : things.things())
            if (thing.keyword == before && !thing.keys.empty() && is_in_part(thing))
                add(thing, key);
    if (term.subjects.empty()) unknownThing(condition);
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
    const auto find_in = [this](Terms& terms) {
        for (auto& all : terms)
            for (Term& term : all) {
                if (!isOfMovers(term.condition->state)) continue;
                for (Subject& subject : term.subjects) {
                    subject.mover.reset();
                    for (std::size_t i = 0; i < rooms.size() && !subject.mover; ++i) {
                        subject.room = i;
                        subject.mover = rooms[i].world->moverNamed(subject.name);
                    }
                }
            }
    };
    for (Ground& ground : grounds) {
        find_in(ground.event);
        find_in(ground.gate);
    }
    for (Trial& trial : trials) find_in(trial.claim);
}

/// Returns the point from which the distance of a mover counts, in its room.
std::optional<Point2> ExpectationJudge::Data::placeOf(const Condition& condition,
                                                      const Subject& subject) const {
    const JudgedRoom& room = rooms[subject.room];
    if (condition.place) return condition.room == room.id ? condition.place : std::nullopt;
    const auto other = room.world->moverNamed(condition.name);
    if (!other) return std::nullopt;
    return room.world->status(*other).pose.position;
}

Look ExpectationJudge::Data::lookForCollision(const Subject& subject) const {
    const World& world = *rooms[subject.room].world;
    for (const Collision& collision : world.collisions()) {
        const std::string& who = world.movers()[collision.robot].id;
        if (who == subject.name) return {.holds = true, .other = collision.into};
        if (collision.into == subject.name) return {.holds = true, .other = who, .is_struck = true};
    }
    return {};
}

bool ExpectationJudge::Data::collided(const Subject& subject) const {
    const auto collisions = rooms[subject.room].world->collisions();
    return std::any_of(collisions.begin(), collisions.end(),
                       [&subject](const Collision& each) { return each.robot == subject.mover; });
}

/// \pre a world has this mover
Look ExpectationJudge::Data::lookAtMover(const Term& term, const Subject& subject) const {
    const Condition& condition = *term.condition;
    const JudgedRoom& room = rooms[subject.room];
    const RobotStatus status = room.world->status(*subject.mover);
    const double speed = std::hypot(status.speed, status.sidespeed);
    switch (condition.state) {
        case State::Collision:
            return lookForCollision(subject);
        case State::Stalled:
            // A command given since the step may have cleared the flag.
            return {.holds = status.stall || collided(subject)};
        case State::Still:
            return {.holds = speed == 0 && status.rotspeed == Angle(), .measure = speed};
        case State::Faster:
            return {.holds = speed > condition.amount, .measure = speed};
        case State::Slower:
            return {.holds = speed < condition.amount, .measure = speed};
        case State::InZone:
            return {.holds = term.zone->room == subject.room &&
                             term.zone->contains(status.pose.position)};
        case State::Seen: {
            const auto count = static_cast<double>(room.seenBy(*subject.mover));
            return {.holds = count >= condition.amount, .measure = count};
        }
        default: {
            const auto place = placeOf(condition, subject);
            const double away = place ? distance(*place, status.pose.position)
                                      : std::numeric_limits<double>::infinity();
            return {.holds = away <= condition.amount, .measure = away};
        }
    }
}

Look ExpectationJudge::Data::look(const Term& term, const Subject& subject) const {
    const Condition& condition = *term.condition;
    Look seen;
    if (isOfMovers(condition.state)) {
        if (!subject.mover) return {.is_there = false};
        seen = lookAtMover(term, subject);
    } else if (subject.zone != nullptr) {
        const World& world = *rooms[subject.zone->room].world;
        for (std::size_t i = 0; i < world.movers().size(); ++i)
            if ((i < world.robots().size()) == (subject.key == "robots") &&
                subject.zone->contains(world.status(i).pose.position))
                ++seen.measure;
        seen.holds = seen.measure > 0;
    } else {
        if (!subject.state->is_there) return {.is_there = false};
        seen = {.holds = subject.state->is_on,
                .measure = subject.state->number,
                .text = subject.state->text};
    }
    if (condition.state == State::Above) seen.holds = seen.measure > condition.amount;
    if (condition.state == State::Below) seen.holds = seen.measure < condition.amount;
    if (condition.state == State::Is) {
        const auto wanted = parseDouble(condition.name);
        seen.holds = wanted ? seen.measure == *wanted : seen.text == condition.name;
    }
    seen.holds = seen.holds != condition.is_opposite;
    return seen;
}

void ExpectationJudge::Data::read(Term& term) const {
    const Condition& condition = *term.condition;
    const SimTime time = now();
    term.is_there = term.holds = false;
    double sum = 0;
    for (Subject& subject : term.subjects) {
        const Look seen = look(term, subject);
        subject.begins = subject.was_there && seen.is_there && seen.holds && !subject.was_holding;
        // Values such as an energy change at each step: their texts do only with the state.
        const bool is_steady = seen.is_there && !seen.text.empty() && subject.key != "kwh";
        const bool has_changed =
            seen.is_there && (!subject.was_there || seen.holds != subject.was_holding ||
                              (is_steady && seen.text != subject.last_text));
        if (has_changed) {
            subject.last_text = seen.text;
            // A collision is told by its own event.
            if (condition.state != State::Collision || seen.holds)
                subject.changes.push_back(
                    {time, subject.name + ' ' + stateText(condition, subject, seen)});
            if (subject.changes.size() > kMostChanges) subject.changes.pop_front();
        }
        subject.was_there = seen.is_there;
        subject.was_holding = seen.holds;
        if (!seen.is_there) continue;
        if (!term.is_there || (seen.holds && !term.holds)) term.look = seen;
        term.is_there = true;
        term.holds = term.holds || seen.holds;
        sum += seen.measure;
    }
    if (condition.of == Of::Total) {
        term.look.measure = sum;
        term.look.text = {};
        term.holds = condition.state == State::Above   ? sum > condition.amount
                     : condition.state == State::Below ? sum < condition.amount
                                                       : sum != 0;
        term.look.holds = term.holds;
    }
    term.holds = term.holds != condition.is_negated;
    if (!term.holds)
        term.since.reset();
    else if (!term.since)
        term.since = time;
    if (condition.lasts > SimTime(0) && term.holds)
        term.holds = time - *term.since > condition.lasts;
}

/// Reads the terms of a clause. \returns true if it holds
bool ExpectationJudge::Data::read(Terms& terms) const {
    bool holds = false;
    for (auto& all : terms) {
        bool all_hold = true;
        for (Term& term : all) {
            read(term);
            all_hold = all_hold && term.holds;
        }
        holds = holds || all_hold;
    }
    return holds;
}

/// Reads the event and the gate of an expectation.
void ExpectationJudge::Data::readGround(Ground& ground, const Expectation& expectation) const {
    ground.news.clear();
    ground.is_open = ground.gate.empty() || read(ground.gate);
    if (ground.event.empty()) return;
    const bool holds = read(ground.event);
    const bool begins = holds && !ground.event_held && ground.was_observed;
    ground.event_held = holds;
    ground.was_observed = true;
    if (now() < expectation.after || now() > expectation.before || !ground.is_open) return;
    const bool is_single = ground.event.size() == 1 && ground.event.front().size() == 1;
    const Term& first = ground.event.front().front();
    // Each of the movers that enter a zone is an event.
    if (is_single && !first.condition->is_negated && first.condition->lasts == SimTime(0) &&
        first.condition->of != Of::Total) {
        for (const Subject& subject : first.subjects)
            if (subject.begins)
                ground.news.push_back({now(), first.subjects.size() > 1 ? subject.name : ""});
    } else if (begins) {
        ground.news.push_back({now(), ""});
    }
    ground.events += static_cast<std::int64_t>(ground.news.size());
}

void ExpectationJudge::Data::fail(Trial& trial, SimTime from, SimTime to,
                                  const std::string& reason) const {
    const std::string text = trial.name + ' ' + reason;
    if (trial.reason.empty()) trial.reason = text;
    if (!trial.failed) trial.failed = to;
    ++trial.failures;
    if (trial.shown.size() >= JudgedExpectation::kMostShown) return;
    const Ground& ground = grounds[trial.expectation];
    const Term& first = trial.claim.front().front();
    trial.shown.push_back(
        {.subject = trial.name,
         .room = first.subjects.empty() ? rooms.front().id : rooms[first.subjects.front().room].id,
         .from = from,
         .to = to,
         .reason = text,
         .observed = observedIn({&ground.event, &ground.gate, &trial.claim}, from, to)});
}

/// Judges the state of a claim by itself.
void ExpectationJudge::Data::decide(Trial& trial, bool holds) {
    const Expectation& expectation = expectations[trial.expectation];
    const SimTime time = now();
    const auto settle = [&](bool is_met) {
        trial.decided = time;
        trial.is_met = is_met;
    };
    if (trial.since) {
        trial.longest = std::max(trial.longest, time - *trial.since);
        trial.in_all += time - trial.last;
    }
    trial.last = time;
    const SimTime since = trial.since.value_or(time);
    if (holds && !trial.since) ++trial.times;
    if (!holds)
        trial.since.reset();
    else if (!trial.since)
        trial.since = time;
    trial.held = holds;
    const auto text = [&] { return claimText(trial.claim) + at(time); };
    switch (expectation.when) {
        case When::Once:
            if (holds) settle(true);
            break;
        case When::Always:
        case When::Never:
            if (holds == (expectation.when == When::Always)) {
                trial.wrong.reset();
            } else if (!trial.wrong) {
                trial.wrong = time;
                const bool is_gated = !expectation.gate.empty();
                fail(trial, time, time,
                     text() + (is_gated ? " while `" + expectation.gate_text + '`' : ""));
            } else if (trial.failures <= static_cast<std::int64_t>(trial.shown.size())) {
                trial.shown.back().to = time;
            }
            break;
        case When::AtLeast:
            if (trial.longest >= expectation.span || (holds && expectation.span == SimTime(0)))
                settle(true);
            break;
        case When::AtMost:
            if (trial.longest > expectation.span) {
                fail(trial, since, time,
                     "was so for more than " + formatSimTime(expectation.span) +
                         " s from t=" + formatMilliseconds(since));
                settle(false);
            }
            break;
        case When::AtLeastTimes:
            if (trial.times >= expectation.times) settle(true);
            break;
        case When::AtMostTimes:
            if (trial.times > expectation.times) {
                fail(trial, time, time,
                     "was so more than " + std::to_string(expectation.times) +
                         (expectation.times == 1 ? " time" : " times") + at(time));
                settle(false);
            }
            break;
        case When::AtLeastInAll:
            if (trial.in_all >= expectation.span) settle(true);
            break;
        case When::AtMostInAll:
            if (trial.in_all > expectation.span) {
                fail(trial, since, time,
                     "was so for more than " + formatSimTime(expectation.span) + " s in all" +
                         at(time));
                settle(false);
            }
            break;
        case When::AtEnd:
            break;
    }
}

/// Judges the state of a claim after events.
void ExpectationJudge::Data::answer(Trial& trial, bool holds) {
    const Expectation& expectation = expectations[trial.expectation];
    const SimTime time = now();
    if (!holds)
        trial.since.reset();
    else if (!trial.since)
        trial.since = time;
    for (const Pending& news : grounds[trial.expectation].news) trial.pending.push_back(news);
    const auto after = [&](const Pending& event) {
        return formatSimTime(expectation.deadline) + " s after `" + expectation.event_text + '`' +
               (event.by.empty() ? "" : " (" + event.by + ')') + at(event.time);
    };
    const auto fail_at = [&](const Pending& event, SimTime to) {
        fail(trial, event.time, to,
             claimText(trial.claim) + at(to) + ", " +
                 (to == event.time + expectation.deadline ? "" : "within ") + after(event));
    };
    // Returns true once the event is judged.
    const auto judge = [&](const Pending& event) {
        const SimTime end = event.time + expectation.deadline;
        switch (expectation.when) {
            case When::Always:
            case When::Never:
                if (time <= end && holds != (expectation.when == When::Always))
                    return fail_at(event, time), true;
                return time >= end;
            case When::AtLeast: {
                const SimTime start = std::max(trial.since.value_or(time), event.time);
                if (holds && start <= end && time - start >= expectation.span) return true;
                if (holds ? start > end : time >= end)
                    return fail(trial, event.time, time,
                                "was not so for " + formatSimTime(expectation.span) +
                                    " s, beginning within " + after(event)),
                           true;
                return false;
            }
            default:
                if (time <= end && holds) return true;
                if (time >= end) return fail_at(event, end), true;
                return false;
        }
    };
    const auto before = static_cast<std::int64_t>(trial.pending.size());
    std::erase_if(trial.pending, judge);
    trial.answered += before - static_cast<std::int64_t>(trial.pending.size());
}

/// The run, or the window, has ended.
void ExpectationJudge::Data::close(Trial& trial, SimTime time) const {
    const Expectation& expectation = expectations[trial.expectation];
    const bool is_over = time >= expectation.before;  // the end of the window, not only of the run
    trial.decided = std::min(time, expectation.before);
    const std::string end = is_over ? "" : "; the run ended" + at(time);
    if (!expectation.event.empty()) {
        trial.is_met = trial.answered > 0 && trial.failures == 0;
        if (trial.is_met || trial.failures > 0) return;
        trial.reason =
            grounds[trial.expectation].events > 0
                ? trial.name + ": the time after `" + expectation.event_text + "` was cut off" + end
                : trial.name + ": `" + expectation.event_text + "` never happened" + end;
        return;
    }
    trial.is_met = trial.was_observed && holdsAtTheEnd(trial, expectation);
    if (trial.is_met || trial.failures > 0) return;
    std::string reason;
    if (!trial.was_observed)
        reason = "was not there in time";
    else if (expectation.when == When::AtEnd)
        reason = claimText(trial.claim) + " at the end";
    else if (expectation.when == When::AtLeast)
        reason = "was so for " + formatMilliseconds(trial.longest) + " s at the longest";
    else if (expectation.when == When::AtLeastInAll)
        reason = "was so for " + formatMilliseconds(trial.in_all) + " s in all";
    else if (expectation.when == When::AtLeastTimes)
        reason = "was so " + std::to_string(trial.times) + (trial.times == 1 ? " time" : " times");
    else if (std::isfinite(trial.nearest))
        reason = "came no nearer than " + rounded(trial.nearest) +
                 " m (t=" + formatMilliseconds(trial.nearest_time) + ')';
    else
        reason = "was never so";
    const SimTime from = std::max(SimTime(0), *trial.decided - std::chrono::seconds(2));
    fail(trial, from, *trial.decided, reason + end);
}

void ExpectationJudge::Data::observe(Trial& trial) {
    const Expectation& expectation = expectations[trial.expectation];
    const Ground& ground = grounds[trial.expectation];
    const SimTime time = now();
    const bool holds = read(trial.claim);
    if (time < expectation.after) return;
    if (time > expectation.before && trial.pending.empty()) {
        if (trial.since) {
            trial.longest = std::max(trial.longest, expectation.before - *trial.since);
            trial.in_all += expectation.before - trial.last;
        }
        close(trial, time);
        return;
    }
    const Term& first = trial.claim.front().front();
    if (!first.is_there) return;
    trial.was_observed = true;
    if (!expectation.event.empty()) return answer(trial, holds);
    if (first.condition->state == State::Near && !first.condition->is_negated &&
        first.look.measure < trial.nearest) {
        trial.nearest = first.look.measure;
        trial.nearest_time = time;
    }
    decide(trial, ground.is_open ? holds : expectation.when == When::Always);
}

ExpectationJudge::ExpectationJudge(std::span<const JudgedWorld> worlds,
                                   std::vector<Expectation> expectations)
    : data_(std::make_unique<Data>(worlds, std::move(expectations))) {}
ExpectationJudge::ExpectationJudge(const World& world, std::vector<Expectation> expectations) {
    const JudgedWorld judged{"", &world, nullptr};
    data_ = std::make_unique<Data>(std::span(&judged, 1), std::move(expectations));
}
ExpectationJudge::~ExpectationJudge() = default;
ExpectationJudge::ExpectationJudge(ExpectationJudge&&) noexcept = default;
ExpectationJudge& ExpectationJudge::operator=(ExpectationJudge&&) noexcept = default;

void ExpectationJudge::observe() {
    Data& data = *data_;
    data.things.observe();
    data.find();
    for (JudgedRoom& room : data.rooms) {
        if (!room.watch) continue;
        room.poses.resize(room.world->movers().size());
        for (std::size_t i = 0; i < room.poses.size(); ++i)
            room.poses[i] = room.world->status(i).pose;
    }
    for (std::size_t i = 0; i < data.grounds.size(); ++i)
        data.readGround(data.grounds[i], data.expectations[i]);
    for (Trial& trial : data.trials)
        if (!trial.decided) data.observe(trial);
}

std::vector<JudgedExpectation> ExpectationJudge::results() const {
    std::vector<JudgedExpectation> results;
    results.reserve(data_->expectations.size());
    for (const Expectation& expectation : data_->expectations)
        results.push_back({.verdict = {.expectation = expectation.name.empty() ? expectation.text
                                                                               : expectation.name,
                                       .is_met = true},
                           .expectation = &expectation});
    for (Trial trial : data_->trials) {
        if (!trial.decided) data_->close(trial, data_->now());
        JudgedExpectation& result = results[trial.expectation];
        RunVerdict& verdict = result.verdict;
        const bool has_events = !result.expectation->event.empty();
        result.checks += has_events ? trial.answered : 1;
        result.failures += trial.failures;
        for (RunFailure& failure : trial.shown)
            if (result.shown.size() < JudgedExpectation::kMostShown)
                result.shown.push_back(std::move(failure));
        // Reports the first failure, or else the last success.
        const SimTime time = trial.failed.value_or(*trial.decided);
        if (!trial.is_met && (verdict.is_met || time < verdict.time)) {
            verdict.is_met = false;
            verdict.time = time;
            verdict.reason = trial.reason;
        } else if (trial.is_met && verdict.is_met) {
            verdict.time = std::max(verdict.time, *trial.decided);
        }
    }
    return results;
}

std::vector<std::string> ExpectationJudge::untold() const { return data_->things.untold(); }

std::vector<RunVerdict> ExpectationJudge::verdicts() const {
    std::vector<RunVerdict> verdicts;
    for (JudgedExpectation& result : results()) verdicts.push_back(std::move(result.verdict));
    return verdicts;
}

}  // namespace ispace::expect

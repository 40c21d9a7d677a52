// SPDX-License-Identifier: GPL-3.0-or-later
// Each kind of event compares the world after a step with the state before, which it keeps for
// itself.
#include "sim/events.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <map>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/number.h"
#include "env/body.h"
#include "sense/detection.h"
#include "sense/formats/reading_text.h"
#include "sense/selection.h"
#include "sim/state_watch.h"
#include "sim/world.h"

namespace ispace {

namespace {

/// Number of events kept for slow readers, besides all those of the last step.
constexpr std::size_t kKept = 16384;

/// Sight is computed at the first step of each such interval.
constexpr SimTime kLookEvery = std::chrono::milliseconds(100);

constexpr std::array<std::string_view, kEventKinds> kEventNames = {
    "collision", "stall", "unreached", "enter",    "leave", "mat",   "gate",
    "seen",      "lost",  "state",     "activity", "mark",  "change"};

}  // namespace

std::string_view nameOf(EventKind kind) { return kEventNames[static_cast<std::size_t>(kind)]; }

std::optional<EventKind> eventKindNamed(std::string_view name) {
    const auto found = std::find(kEventNames.begin(), kEventNames.end(), name);
    if (found == kEventNames.end()) return std::nullopt;
    return static_cast<EventKind>(found - kEventNames.begin());
}

EventKinds allEventKinds() {
    EventKinds kinds;
    for (std::size_t i = 0; i < kEventKinds; ++i) kinds.insert(static_cast<EventKind>(i));
    return kinds;
}

std::string_view eventTableHead() { return "t,kind,id,other,x,y,value,text\n"; }

void appendEventRow(std::string& out, const Event& event) {
    out.append(formatSimTime(event.time)).append(",").append(nameOf(event.kind));
    out.append(",").append(event.id).append(",");  // a word, which requires no quotes
    appendCsvField(out, event.other);
    out += ',';
    if (event.place) appendDouble(out, event.place->x);
    out += ',';
    if (event.place) appendDouble(out, event.place->y);
    out += ',';
    const bool has_value = event.kind == EventKind::Mat || event.kind == EventKind::Gate ||
                           event.kind == EventKind::Seen || event.kind == EventKind::Activity;
    if (has_value) out += std::to_string(event.value);
    out += ',';
    appendCsvField(out, event.text);
    out += '\n';
}

struct EventLog::Data {
    explicit Data(const World& watched) : world(&watched) {}

    void put(Event event) {
        event.time = world->time();
        events.push_back(std::move(event));
    }
    void forget();
    void readScene();
    void notifyCollisions();
    void notifyUnreached();
    void notifyZones();
    void notifyMats();
    void notifyGates();
    void notifySight();
    void notifyStates();
    [[nodiscard]] bool wants(EventKind kind) const {
        return wanted[static_cast<std::size_t>(kind)] > 0;
    }

    const World* world;
    std::array<int, kEventKinds> wanted{};
    std::deque<Event> events;
    std::int64_t dropped = 0;
    std::int64_t changes = -1;  // of the world when its scene was read

    struct Zone {
        std::string id;
        Polygon outline;
        Box2 box;
    };
    std::vector<Zone> zones;
    struct Walker {
        std::string id;
        std::optional<Point2> place;  // position at the last look
        std::vector<bool> in;         // of the zones
        bool is_seen = false;
    };
    std::vector<Walker> walkers;                         // as World::movers()
    std::map<std::string, std::vector<std::string>> on;  // the movers on each mat
    std::optional<DetectionMonitor> watch;               // once Seen or Lost is subscribed
    std::vector<Pose2> watched;                          // poses of the walkers at its last look
    std::int64_t look = -1;                              // the last one
    std::optional<StateWatch> states;                    // once State is subscribed
};

/// Removes old events, except those of the last step.
void EventLog::Data::forget() {
    while (events.size() > kKept) {
        events.pop_front();
        ++dropped;
    }
}

/// Reads movers, zones and mats from the scene; the state of unchanged ones stays.
void EventLog::Data::readScene() {
    if (changes == world->changes()) return;
    changes = world->changes();
    std::unordered_map<std::string, std::set<std::string>> in;
    std::unordered_set<std::string> seen;
    for (const Walker& walker : walkers) {
        for (std::size_t i = 0; i < zones.size(); ++i)
            if (walker.in[i]) in[walker.id].insert(zones[i].id);
        if (walker.is_seen) seen.insert(walker.id);
    }
    watch.reset();
    zones.clear();
    for (const Element& element : world->scene().environment.elements()) {
        if (element.record.keyword() != "zone") continue;
        zones.push_back({element.id, zoneOutline(element.record), {}});
        for (const Point2 corner : zones.back().outline) zones.back().box.add(corner);
    }
    walkers.clear();
    for (const Mover& mover : world->movers())
        walkers.push_back({mover.id, std::nullopt, std::vector<bool>(zones.size()), false});
    for (Walker& walker : walkers) {
        walker.is_seen = seen.contains(walker.id);
        const auto known = in.find(walker.id);
        if (known == in.end()) continue;
        for (std::size_t i = 0; i < zones.size(); ++i)
            walker.in[i] = known->second.contains(zones[i].id);
    }
}

void EventLog::Data::notifyCollisions() {
    for (const EventKind kind : {EventKind::Collision, EventKind::Stall}) {
        if (!wants(kind)) continue;
        for (const Collision& collision : world->collisions()) {
            Event event{.kind = kind, .id = walkers[collision.robot].id};
            if (kind == EventKind::Collision) {
                event.other = collision.into;
                event.place = world->status(collision.robot).pose.position;
            } else if (!world->status(collision.robot).stall) {
                continue;
            }
            put(std::move(event));
        }
    }
}

void EventLog::Data::notifyUnreached() {
    if (!wants(EventKind::Unreached)) return;
    for (const UnreachedPoint& point : world->unreached())
        put({.kind = EventKind::Unreached, .id = walkers[point.mover].id, .place = point.at});
}

/// Tells all entries of a step before all exits: by its events a mover that goes on to a zone that
/// adjoins is always in one. The edge of a zone is part of it.
void EventLog::Data::notifyZones() {
    if (!wants(EventKind::Enter) && !wants(EventKind::Leave)) return;
    std::vector<Event> left;
    for (std::size_t i = 0; i < walkers.size(); ++i) {
        Walker& walker = walkers[i];
        const Point2 place = world->status(i).pose.position;
        if (walker.place == place) continue;
        walker.place = place;
        for (std::size_t k = 0; k < zones.size(); ++k) {
            const bool is_in =
                zones[k].box.contains(place) && locate(zones[k].outline, place) != Side::Outside;
            if (is_in == walker.in[k]) continue;
            walker.in[k] = is_in;
            Event event{.kind = is_in ? EventKind::Enter : EventKind::Leave,
                        .id = walker.id,
                        .other = zones[k].id,
                        .place = place};
            if (!wants(event.kind)) continue;
            if (is_in)
                put(std::move(event));
            else
                left.push_back(std::move(event));
        }
    }
    for (Event& event : left) put(std::move(event));
}

/// Per mat, movers that step on it come before those that leave.
void EventLog::Data::notifyMats() {
    if (!wants(EventKind::Mat)) return;
    const FloorSensors& floor = world->floorSensors();
    const auto tell = [this](const std::string& mat, const std::vector<std::string>& who,
                             const std::vector<std::string>& others, int value) {
        for (const std::string& id : who)
            if (std::find(others.begin(), others.end(), id) == others.end())
                put({.kind = EventKind::Mat, .id = mat, .other = id, .value = value});
    };
    for (std::size_t i = 0; i < floor.mats().size(); ++i) {
        const std::string& mat = floor.matIds()[i];
        std::vector<std::string>& before = on[mat];
        const std::vector<std::string>& now = floor.mat(i).on;
        if (before == now) continue;
        tell(mat, now, before, 1);
        tell(mat, before, now, 0);
        before = now;
    }
}

void EventLog::Data::notifyGates() {
    if (!wants(EventKind::Gate)) return;
    const FloorSensors& floor = world->floorSensors();
    for (const Passage& passage : floor.passages())
        put({.kind = EventKind::Gate,
             .id = floor.gateIds()[passage.gate],
             .other = std::string(passage.who),
             .value = passage.in ? 1 : 0});
}

/// Looks once in kLookEvery, and only if a mover has moved or the scene has changed: a sight of
/// less than that may be missed.
void EventLog::Data::notifySight() {
    if (!wants(EventKind::Seen) && !wants(EventKind::Lost)) return;
    const std::int64_t now = world->time() / kLookEvery;
    if (std::exchange(look, now) == now) return;
    std::vector<Pose2> poses(walkers.size());
    for (std::size_t i = 0; i < poses.size(); ++i) poses[i] = world->status(i).pose;
    if (watch && poses == watched) return;  // most of a day is without motion
    if (!watch) watch.emplace(world->scene(), WatchOptions{.outside = world->options().outside});
    const std::span<const Pose2> all(poses);
    const std::size_t robots = world->robots().size();
    const WatchMoment moment{.robots = all.first(robots), .people = all.subspan(robots)};
    std::vector<DetectionMonitor::Target> targets(walkers.size());
    for (std::size_t i = 0; i < targets.size(); ++i)
        targets[i] = {poses[i].position,
                      static_cast<std::uint32_t>(i < robots ? i : kFirstPerson + (i - robots))};
    const std::vector<std::size_t> counts = watch->seenBy(targets, moment);
    for (const EventKind kind : {EventKind::Seen, EventKind::Lost})
        for (std::size_t i = 0; i < walkers.size(); ++i) {
            const bool comes = kind == EventKind::Seen;
            if (walkers[i].is_seen == comes || (counts[i] > 0) != comes) continue;
            walkers[i].is_seen = comes;
            if (wants(kind))
                put({.kind = kind, .id = walkers[i].id, .value = static_cast<int>(counts[i])});
        }
    watched = std::move(poses);
}

void EventLog::Data::notifyStates() {
    if (!wants(EventKind::State)) return;
    if (!states) states.emplace(*world);
    for (RoomState& state : states->changed())
        put({.kind = EventKind::State,
             .id = std::move(state.id),
             .other = std::move(state.key),
             .text = std::move(state.value)});
}

EventLog::EventLog(const World& world) : data_(std::make_unique<Data>(world)) {}
EventLog::~EventLog() = default;
EventLog::EventLog(EventLog&&) noexcept = default;
EventLog& EventLog::operator=(EventLog&&) noexcept = default;

void EventLog::want(const EventKinds& kinds) {
    for (const EventKind kind : kinds) ++data_->wanted[static_cast<std::size_t>(kind)];
    if (data_->wants(EventKind::State) && !data_->states) data_->states.emplace(*data_->world);
}

void EventLog::unwant(const EventKinds& kinds) {
    for (const EventKind kind : kinds) {
        assert(data_->wants(kind));
        --data_->wanted[static_cast<std::size_t>(kind)];
    }
    // A later subscription starts anew.
    const auto neither = [this](EventKind one, EventKind other) {
        return !data_->wants(one) && !data_->wants(other);
    };
    if (neither(EventKind::Enter, EventKind::Leave))
        for (Data::Walker& walker : data_->walkers) {
            walker.in.assign(walker.in.size(), false);
            walker.place.reset();
        }
    if (neither(EventKind::Seen, EventKind::Lost)) {
        for (Data::Walker& walker : data_->walkers) walker.is_seen = false;
        data_->watch.reset();
        data_->look = -1;
    }
    if (!data_->wants(EventKind::Mat)) data_->on.clear();
    if (!data_->wants(EventKind::State)) data_->states.reset();
}

void EventLog::stepped() {
    const bool any = std::any_of(data_->wanted.begin(), data_->wanted.end(),
                                 [](int count) { return count > 0; });
    if (!any) return;
    data_->forget();
    data_->readScene();
    data_->notifyCollisions();
    data_->notifyUnreached();
    data_->notifyZones();
    data_->notifyMats();
    data_->notifyGates();
    data_->notifySight();
    data_->notifyStates();
}

void EventLog::add(EventKind kind, std::string text, std::string other) {
    assert(kind == EventKind::Mark || kind == EventKind::Change);
    data_->forget();
    data_->put({.kind = kind, .other = std::move(other), .text = std::move(text)});
}

void EventLog::notify(Event event) {
    assert(event.kind == EventKind::Activity || event.kind == EventKind::State ||
           event.kind == EventKind::Unreached);
    if (data_->wants(event.kind)) data_->put(std::move(event));
}

std::int64_t EventLog::next() const {
    return data_->dropped + static_cast<std::int64_t>(data_->events.size());
}

std::int64_t EventLog::first() const { return data_->dropped; }

const Event& EventLog::at(std::int64_t number) const {
    return data_->events[static_cast<std::size_t>(number - data_->dropped)];
}

}  // namespace ispace

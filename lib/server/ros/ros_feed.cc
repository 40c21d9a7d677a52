// SPDX-License-Identifier: GPL-3.0-or-later
#include "server/ros/ros_feed.h"

#include <exception>
#include <set>
#include <tuple>
#include <utility>

#include "server/ros/ros_text.h"

namespace ispace {

namespace {

/// Subscriptions of all clients of a port.
constexpr std::size_t kMostSubscriptions = 16384;

}  // namespace

std::shared_ptr<const std::string> RosMessage::json() const {
    if (!json_) json_ = std::make_shared<const std::string>(rosJson(type_, *cdr_));
    return json_;
}

std::shared_ptr<const std::string> RosMessage::cbor() const {
    if (!cbor_) cbor_ = std::make_shared<const std::string>(rosCbor(type_, *cdr_));
    return cbor_;
}

RosFeed::RosFeed(ServerState& state, RosScenery scenery)
    : state_(&state), scenery_(std::move(scenery)) {
    sync();
}

/// Topics that remain keep their numbers and subscriptions.
void RosFeed::sync() {
    const World& world = state_->simulation().world();
    if (std::exchange(changes_, world.changes()) == world.changes()) return;
    frames_.emplace(world);
    map_.reset();
    std::map<std::pair<std::string, RosType>, std::uint32_t> known;
    for (const auto& [number, entry] : entries_)
        known.emplace(std::pair(entry.channel.topic, entry.channel.type), number);
    Entries entries;
    bool is_changed = false;
    for (RosChannel& channel : rosChannels(world, *frames_)) {
        const auto old = known.find({channel.topic, channel.type});
        const bool is_new = old == known.end();
        const std::uint32_t number = is_new ? next_number_++ : old->second;
        Entry& entry = entries[number];
        if (!is_new) entry = std::move(entries_[number]);
        entry.channel = std::move(channel);
        entry.period = -1;  // a changed world has new readings
        if (entry.channel.row != nullptr && entry.channel.rate > 0)
            entry.periods.emplace(entry.channel.rate);
        is_changed = is_changed || is_new;
    }
    is_changed = is_changed || entries.size() != entries_.size();
    entries_ = std::move(entries);
    if (!is_changed) return;
    ++version_;
    numbers_.clear();
    wanted_.clear();
    subscriptions_ = 0;
    for (const auto& [number, entry] : entries_) {
        numbers_[entry.channel.topic].push_back(number);
        subscriptions_ += entry.wanted;
        if (entry.wanted > 0) wanted_.insert(number);
    }
}

void RosFeed::enter() {
    sync();
    ++clients_;
}

std::span<const std::uint32_t> RosFeed::numbersOf(std::string_view topic) const {
    const auto found = numbers_.find(topic);
    if (found == numbers_.end()) return {};
    return found->second;
}

bool RosFeed::isFull() const { return subscriptions_ >= kMostSubscriptions; }

void RosFeed::want(std::uint32_t number) {
    const auto found = entries_.find(number);
    if (found == entries_.end()) return;
    if (found->second.wanted++ == 0) found->second.period = -1;
    wanted_.insert(number);
    ++subscriptions_;
    update(found->second);
    takeFrames();
}

void RosFeed::unwant(std::uint32_t number) {
    const auto found = entries_.find(number);
    if (found == entries_.end() || found->second.wanted == 0) return;
    // The next first reader must not get an old message.
    --subscriptions_;
    if (--found->second.wanted > 0) return;
    found->second.newest = nullptr;
    wanted_.erase(number);
}

void RosFeed::stepped() {
    if (clients_ == 0 && wanted_.empty()) return;
    sync();
    for (const std::uint32_t number : wanted_) update(entries_.at(number));
    takeFrames();
}

/// Computes the message of the current period, unless a background job does.
void RosFeed::update(Entry& entry) {
    const World& world = state_->simulation().world();
    const RosChannel& channel = entry.channel;
    if (channel.isInput()) return;
    if (channel.sensor != nullptr) {
        const Sensor& sensor = world.sensors()[channel.subject];
        if (isHeavy(sensor)) return;
        const SensorReading& reading = world.reading(channel.subject);
        if (reading.seq == entry.period) return;
        return publish(
            entry, reading.seq,
            rosMessageOf(*channel.sensor, sensor, reading, frames_->sensors[channel.subject]));
    }
    const std::int64_t period =
        entry.periods ? entry.periods->newest(world.time()) : std::int64_t{0};
    if (period == entry.period) return;
    if (channel.type == RosType::OccupancyGrid && !map_) return drawMap();
    publish(entry, period, channel.row->encode(moment(), channel.subject, channel.part));
}

void RosFeed::publish(Entry& entry, std::int64_t period, std::string message) {
    entry.period = period;
    if (message.empty()) return;
    entry.newest = std::make_shared<const RosMessage>(
        entry.channel.type, ++messages_, rosTimeOf(state_->simulation().world().time()),
        std::move(message));
}

RosMoment RosFeed::moment() {
    World& world = state_->simulation().world();
    const auto refresh = [this, &world] {
        if (std::exchange(sonar_steps_, world.steps()) == world.steps()) return;
        sonars_.assign(world.robots().size(), {});
        bumpers_.assign(world.robots().size(), {});
    };
    return {.simulation = state_->simulation(),
            .frames = *frames_,
            .map = map_,
            .has_room = scenery_.room != nullptr,
            .sonars = [this, &world, refresh](std::size_t robot) -> const std::vector<float>& {
                refresh();
                if (sonars_[robot].empty()) sonars_[robot] = world.sonar(robot);
                return sonars_[robot];
            },
            .bumpers = [this, &world, refresh](std::size_t robot) -> const std::vector<bool>& {
                refresh();
                if (bumpers_[robot].empty()) bumpers_[robot] = world.bumper(robot);
                return bumpers_[robot];
            }};
}

/// Computes the map in the background, then publishes it.
void RosFeed::drawMap() {
    if (!scenery_.map || std::exchange(is_drawing_, true)) return;
    const auto map = std::make_shared<RosGrid>();
    state_->runInBackground(
        {[map, draw = scenery_.map, scene = state_->simulation().world().sharedScene()] {
             *map = draw(*scene);
         },
         [self = std::weak_ptr(self_), map, changes = changes_](const std::exception_ptr& failure) {
             const auto feed = self.lock();
             if (!feed) return;
             (*feed)->is_drawing_ = false;
             if (changes != (*feed)->changes_) return;
             // A room without a map, such as one that is too large, has an empty one.
             (*feed)->map_ = failure ? RosGrid() : std::move(*map);
         }});
}

void RosFeed::fetchRoom(std::function<void(std::shared_ptr<const std::string>)> deliver) {
    if (room_ && room_changes_ == changes_) return deliver(room_);
    if (!scenery_.room) return deliver(std::make_shared<const std::string>());
    const auto mesh = std::make_shared<std::string>();
    state_->runInBackground(
        {[mesh, draw = scenery_.room, scene = state_->simulation().world().sharedScene()] {
             *mesh = draw(*scene);
         },
         [self = std::weak_ptr(self_), mesh, changes = changes_,
          deliver = std::move(deliver)](const std::exception_ptr& failure) {
             const auto feed = self.lock();
             if (!feed) return;
             if (failure) mesh->clear();
             (*feed)->room_ = mesh;
             (*feed)->room_changes_ = changes;
             deliver(mesh);
         }});
}

/// Begins the next frame that a reader waits for.
void RosFeed::takeFrames() {
    if (is_taking_) return;
    const World& world = state_->simulation().world();
    std::set<std::size_t> due;
    for (const std::uint32_t number : wanted_) {
        const Entry& entry = entries_.at(number);
        const std::size_t sensor = entry.channel.subject;
        if (entry.channel.sensor != nullptr && isHeavy(world.sensors()[sensor]) &&
            entry.period != world.period(sensor))
            due.insert(sensor);
    }
    if (due.empty()) return;
    const auto next = due.lower_bound(turn_);
    const std::size_t sensor = next == due.end() ? *due.begin() : *next;
    turn_ = sensor + 1;
    takeFrame(sensor);
}

/// Reads a heavy sensor in the background, and encodes all its wanted topics there.
void RosFeed::takeFrame(std::size_t sensor) {
    is_taking_ = true;
    const World& world = state_->simulation().world();
    const auto messages = std::make_shared<std::map<std::uint32_t, std::string>>();
    for (const std::uint32_t number : wanted_) {
        const Entry& entry = entries_.at(number);
        if (entry.channel.sensor != nullptr && entry.channel.subject == sensor &&
            entry.period != world.period(sensor))
            messages->emplace(number, "");
    }
    std::vector<std::pair<std::uint32_t, const RosTopic*>> topics;
    for (const auto& [number, message] : *messages)
        topics.emplace_back(number, entries_[number].channel.sensor);
    state_->takeFrame({.sensor = sensor,
                       .use =
                           [messages, topics, model = world.sensors()[sensor],
                            frame = frames_->sensors[sensor]](const SensorReading& reading) {
                               for (const auto& [number, topic] : topics)
                                   (*messages)[number] =
                                       rosMessageOf(*topic, model, reading, frame);
                           },
                       .deliver =
                           [self = std::weak_ptr(self_), messages, changes = changes_,
                            period = world.period(sensor)](const std::exception_ptr& failure) {
                               const auto feed = self.lock();
                               if (!feed) return;
                               (*feed)->is_taking_ = false;
                               if (changes != (*feed)->state_->simulation().world().changes())
                                   return;
                               for (auto& [number, message] : *messages) {
                                   const auto found = (*feed)->entries_.find(number);
                                   if (found == (*feed)->entries_.end()) continue;
                                   (*feed)->publish(found->second, period,
                                                    failure ? std::string() : std::move(message));
                               }
                           }});
}

}  // namespace ispace

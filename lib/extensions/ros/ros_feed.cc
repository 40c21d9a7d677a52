// SPDX-License-Identifier: GPL-3.0-or-later
// A topic has a number as long as it exists. Its message is computed when its period begins and a
// client wants it; CDR first, JSON and CBOR from that on the first request. Frames of heavy sensors
// are made one at a time, in turn, so that no sensor starves the others.
#include "extensions/ros/ros_feed.h"

#include <exception>
#include <set>
#include <tuple>
#include <utility>

#include "extensions/ros/ros_text.h"
#include "scene/room_state.h"

namespace ispace::ros {

namespace {

/// Subscriptions of all clients of a port.
constexpr std::size_t kMaxFeedSubscriptions = 16384;

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
    : state_(&state), scenery_(std::move(scenery)), sources_(scenery_.sources) {
    sources_.push_back(liftTopics());
    for (const RunRoom& room : state.rooms().worlds->rooms())
        worlds_.push_back({.id = room.id, .simulation = room.simulation});
    for (ServerState* const each : state.rooms().states) rooms_.push_back({.state = each});
    sync();
}

/// Returns true if any world has changed since the last call.
bool RosFeed::hasChanged() {
    bool is_changed = false;
    for (Room& room : rooms_) {
        const std::int64_t changes = room.state->simulation().world().changes();
        if (std::exchange(room.changes, changes) == changes) continue;
        room.map.reset();
        room.sonar_steps = -1;
        is_changed = true;
    }
    return is_changed;
}

/// Updates the positions of rooms.
void RosFeed::place() {
    for (std::size_t i = 0; i < worlds_.size(); ++i)
        worlds_[i].frame = state_->rooms().worlds->frameOf(i);
}

/// Gives each channel its number: that which it had, else a new one.
void RosFeed::number(Entries& entries, bool& is_changed) {
    std::map<std::tuple<std::string, RosType, std::string>, std::uint32_t> known;
    const auto key_of = [](const RosChannel& channel) {
        return std::tuple(channel.topic, channel.type, channel.about);
    };
    for (const auto& [number, entry] : entries_) known.emplace(key_of(entry.channel), number);
    // It stays the same when others come.
    lone_ = scenery_.robot.empty() ? loneRobot(worlds_, lone_) : scenery_.robot;
    std::vector<RosChannel> channels = rosChannels(worlds_, lone_);
    addSources(channels);
    for (RosChannel& channel : channels) {
        const auto old = known.find(key_of(channel));
        const bool is_new = old == known.end();
        const std::uint32_t number = is_new ? next_number_++ : old->second;
        Entry& entry = entries[number];
        if (!is_new) entry = std::move(entries_[number]);
        entry.channel = std::move(channel);
        entry.period = -1;  // a changed world has new readings
        const bool is_timed = entry.channel.row != nullptr || entry.channel.source != nullptr;
        if (is_timed && entry.channel.rate > 0) entry.periods.emplace(entry.channel.rate);
        is_changed = is_changed || is_new;
    }
}

RosRun RosFeed::run() const { return {worlds_, *state_->rooms().worlds}; }

void RosFeed::addSources(std::vector<RosChannel>& out) {
    for (const auto& source : sources_)
        for (RosSourceTopic& topic : source->topics(run()))
            out.push_back(
                {.topic = std::move(topic.topic),
                 .type = topic.type,
                 .rate = topic.rate,
                 .quality = {.depth = topic.rate > 0 || topic.is_input ? RosQuality{}.depth
                                                                       : std::size_t{1},
                             .is_latched = topic.rate == 0 && !topic.is_input},
                 .source = source.get(),
                 .about = std::move(topic.about),
                 .is_input = topic.is_input});
}

/// Topics that remain keep their numbers and subscriptions.
void RosFeed::sync() {
    if (!hasChanged()) return;
    place();
    nameFrames(worlds_);
    Entries entries;
    bool is_changed = false;
    number(entries, is_changed);
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

bool RosFeed::isFull() const { return subscriptions_ >= kMaxFeedSubscriptions; }

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
    place();
    const std::int64_t echoed = state_->echoes().topics();
    if (std::exchange(echoed_, echoed) != echoed) ++version_;
    for (const std::uint32_t number : wanted_) update(entries_.at(number));
    takeFrames();
}

/// Computes the message of the current period, unless a background job does.
void RosFeed::update(Entry& entry) {
    const RosChannel& channel = entry.channel;
    if (channel.isInput()) return updateEcho(entry);
    if (channel.state) return updateState(entry);
    if (channel.source != nullptr) return updateSource(entry);
    const World& world = worlds_[channel.room].world();
    if (channel.sensor != nullptr) {
        const Sensor& sensor = world.sensors()[channel.subject];
        if (isHeavy(sensor)) return;
        const SensorReading& reading = world.reading(channel.subject);
        if (reading.seq == entry.period) return;
        const RosFrames& frames = worlds_[channel.room].frames;
        return publish(entry, reading.seq,
                       rosMessageOf(*channel.sensor, sensor, reading,
                                    frames.sensors[channel.subject], frames.room));
    }
    const std::int64_t period =
        entry.periods ? entry.periods->newest(world.time()) : std::int64_t{0};
    if (period == entry.period) return;
    if (channel.type == RosType::OccupancyGrid && !rooms_[channel.room].map)
        return drawMap(channel.room);
    std::string message = channel.row->encode(moment(channel.room), channel.subject, channel.part);
    // A change of the world may leave a latched message as it is.
    if (period == 0 && entry.newest && *entry.newest->cdr() == message) message.clear();
    publish(entry, period, std::move(message));
}

void RosFeed::updateSource(Entry& entry) {
    const RosChannel& channel = entry.channel;
    const World& world = worlds_.front().world();
    const std::int64_t period = entry.periods ? entry.periods->newest(world.time()) : world.steps();
    if (period == entry.period) return;
    std::string message =
        channel.source->message({channel.topic, channel.type, channel.about, channel.rate}, run());
    const bool is_same = !entry.periods && entry.newest && *entry.newest->cdr() == message;
    publish(entry, period, is_same ? std::string() : std::move(message));
}

/// Publishes the newest message of a client to an input topic, for the others.
void RosFeed::updateEcho(Entry& entry) {
    const TopicEchoes::Echo* const echo = state_->echoes().newest(entry.channel.echoKey());
    if (echo == nullptr || echo->number == entry.period) return;
    publish(entry, echo->number, *echo->message);
}

std::vector<std::uint32_t> RosFeed::echoed() const {
    std::vector<std::uint32_t> numbers;
    if (state_->echoes().topics() == 0) return numbers;
    for (const auto& [number, entry] : entries_)
        if (entry.channel.isInput() && entry.channel.row != nullptr &&
            state_->echoes().newest(entry.channel.echoKey()) != nullptr)
            numbers.push_back(number);
    return numbers;
}

/// Publishes a state after a change of the world that has set it.
void RosFeed::updateState(Entry& entry) {
    if (std::exchange(entry.period, 0) == 0) return;
    const RosChannel& channel = entry.channel;
    Room& room = rooms_[channel.room];
    if (std::exchange(room.state_changes, room.changes) != room.changes) {
        room.states.clear();
        for (RoomState& one : roomStates(worlds_[channel.room].world().scene()))
            room.states[{std::move(one.id), std::move(one.key)}] = std::move(one.value);
    }
    const auto value = room.states.find({channel.state->id, channel.state->key});
    if (value == room.states.end()) return;
    std::string message = stateMessage(channel.type, value->second);
    if (!entry.newest || *entry.newest->cdr() != message) publish(entry, 0, std::move(message));
}

void RosFeed::publish(Entry& entry, std::int64_t period, std::string message) {
    entry.period = period;
    if (message.empty()) return;
    entry.newest = std::make_shared<const RosMessage>(
        entry.channel.type, ++messages_, rosTimeOf(state_->simulation().world().time()),
        std::move(message));
}

RosMoment RosFeed::moment(std::size_t index) {
    Room& room = rooms_[index];
    World& world = room.state->simulation().world();
    const auto refresh = [&room, &world] {
        if (std::exchange(room.sonar_steps, world.steps()) == world.steps()) return;
        room.sonars.assign(world.robots().size(), {});
        room.bumpers.assign(world.robots().size(), {});
    };
    return {.rooms = worlds_,
            .room = worlds_[index],
            .map = room.map,
            .has_mesh = scenery_.room != nullptr,
            .sonars = [&room, &world, refresh](std::size_t robot) -> const std::vector<float>& {
                refresh();
                if (room.sonars[robot].empty()) room.sonars[robot] = world.sonar(robot);
                return room.sonars[robot];
            },
            .bumpers = [&room, &world, refresh](std::size_t robot) -> const std::vector<bool>& {
                refresh();
                if (room.bumpers[robot].empty()) room.bumpers[robot] = world.bumper(robot);
                return room.bumpers[robot];
            },
            .robot_model =
                [this, index, &world](std::size_t robot) {
                    const RosFrames& frames = worlds_[index].frames;
                    return scenery_.robot_model
                               ? scenery_.robot_model(world.scene(), robot, frames.movers[robot],
                                                      frames.wheels[robot], frames.sensors)
                               : std::string();
                },
            .lone = lone_};
}

/// Computes the map of a room in the background, then publishes it.
void RosFeed::drawMap(std::size_t index) {
    Room& room = rooms_[index];
    if (!scenery_.map || std::exchange(room.is_drawing, true)) return;
    const auto map = std::make_shared<RosGrid>();
    room.state->runInBackground(
        {[map, draw = scenery_.map, scene = worlds_[index].world().sharedScene()] {
             *map = draw(*scene);
         },
         [self = std::weak_ptr(self_), map, index,
          changes = room.changes](const std::exception_ptr& failure) {
             const auto feed = self.lock();
             if (!feed) return;
             Room& of = (*feed)->rooms_[index];
             of.is_drawing = false;
             if (changes != of.changes) return;
             // A room without a map, such as one that is too large, has an empty one.
             of.map = failure ? RosGrid() : std::move(*map);
         }});
}

std::vector<std::string> RosFeed::meshes() const {
    std::vector<std::string> uris;
    for (const RosRoom& room : worlds_) uris.push_back(room.mesh());
    return uris;
}

void RosFeed::fetchRoom(std::size_t which,
                        std::function<void(std::shared_ptr<const std::string>)> deliver) {
    Room& room = rooms_[which];
    if (room.mesh && room.mesh_changes == room.changes) return deliver(room.mesh);
    if (!scenery_.room) return deliver(std::make_shared<const std::string>());
    const auto mesh = std::make_shared<std::string>();
    room.state->runInBackground(
        {[mesh, draw = scenery_.room, scene = worlds_[which].world().sharedScene()] {
             *mesh = draw(*scene);
         },
         [self = std::weak_ptr(self_), mesh, which, changes = room.changes,
          deliver = std::move(deliver)](const std::exception_ptr& failure) {
             const auto feed = self.lock();
             if (!feed) return;
             if (failure) mesh->clear();
             Room& of = (*feed)->rooms_[which];
             of.mesh = mesh;
             of.mesh_changes = changes;
             deliver(mesh);
         }});
}

/// Begins the next frame that a reader waits for.
void RosFeed::takeFrames() {
    if (is_taking_) return;
    std::set<SensorOfRoom> due;
    for (const std::uint32_t number : wanted_) {
        const Entry& entry = entries_.at(number);
        if (entry.channel.sensor == nullptr) continue;
        const World& world = worlds_[entry.channel.room].world();
        const std::size_t sensor = entry.channel.subject;
        if (isHeavy(world.sensors()[sensor]) && entry.period != world.period(sensor))
            due.insert({entry.channel.room, sensor});
    }
    if (due.empty()) return;
    const auto next = due.lower_bound(turn_);
    const SensorOfRoom which = next == due.end() ? *due.begin() : *next;
    turn_ = {which.first, which.second + 1};
    takeFrame(which);
}

/// Reads a heavy sensor in the background, and encodes all its wanted topics there.
void RosFeed::takeFrame(SensorOfRoom which) {
    is_taking_ = true;
    const auto [room, sensor] = which;
    const World& world = worlds_[room].world();
    const auto messages = std::make_shared<std::map<std::uint32_t, std::string>>();
    std::vector<std::pair<std::uint32_t, const RosTopic*>> topics;
    for (const std::uint32_t number : wanted_) {
        const Entry& entry = entries_.at(number);
        const RosChannel& channel = entry.channel;
        if (channel.sensor == nullptr || SensorOfRoom(channel.room, channel.subject) != which ||
            entry.period == world.period(sensor))
            continue;
        messages->emplace(number, "");
        topics.emplace_back(number, channel.sensor);
    }
    rooms_[room].state->takeFrame(
        {.sensor = sensor,
         .use =
             [messages, topics, model = world.sensors()[sensor],
              frame = worlds_[room].frames.sensors[sensor],
              in = worlds_[room].frames.room](const SensorReading& reading) {
                 for (const auto& [number, topic] : topics)
                     (*messages)[number] = rosMessageOf(*topic, model, reading, frame, in);
             },
         .deliver =
             [self = std::weak_ptr(self_), messages, room = room, changes = rooms_[room].changes,
              period = world.period(sensor)](const std::exception_ptr& failure) {
                 const auto feed = self.lock();
                 if (!feed) return;
                 (*feed)->is_taking_ = false;
                 if (changes != (*feed)->worlds_[room].world().changes()) return;
                 for (auto& [number, message] : *messages) {
                     const auto found = (*feed)->entries_.find(number);
                     if (found == (*feed)->entries_.end()) continue;
                     (*feed)->publish(found->second, period,
                                      failure ? std::string() : std::move(message));
                 }
             }});
}

}  // namespace ispace::ros

// SPDX-License-Identifier: GPL-3.0-or-later
// A session of the protocol's role WORLD stands behind the bridge, so that commands of MQTT pass
// the same checks, limits and turns as those of TCP. Descriptions are published when things come or
// go, states when they change.
#include "extensions/mqtt/mqtt_bridge.h"

#include <algorithm>
#include <memory>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/message.h"
#include "extensions/mqtt/mqtt_topics.h"
#include "scene/thing_kind.h"

namespace ispace::mqtt {

namespace {

std::string topicOf(const std::string& prefix, std::string_view id, std::string_view key) {
    return prefix + '/' + topicId(id) + '/' + std::string(key);
}

/// Returns the things that have states, of all rooms.
std::vector<MqttEntity> thingsOf(const ServerState& state, const std::string& prefix) {
    std::unordered_map<std::string, const Record*> records;
    for (const auto& [room, world] : state.worlds()) {
        const Scene& scene = world->scene();
        for (std::size_t i = 0; i < scene.records.size(); ++i)
            records.emplace(nameAcross(room, scene.ids[i]), &scene.records[i]);
    }
    std::vector<MqttEntity> things;
    const Record* record = nullptr;
    for (const RoomState& one : state.statesOfAll()) {
        if (things.empty() || things.back().id != one.id) {
            const auto found = records.find(one.id);
            record = found == records.end() ? nullptr : found->second;
            things.push_back({one.id, record == nullptr ? "" : record->keyword(), {}});
        }
        const bool is_actuator = record != nullptr && isActuator(record->keyword());
        things.back().keys.push_back({one.key, topicOf(prefix, one.id, one.key),
                                      is_actuator ? record->schema().find(one.key) : nullptr});
    }
    return things;
}

/// Names all things that may have states, with their keywords.
std::string namedThings(const ServerState& state) {
    std::string names;
    const auto add = [&names](const std::string& name) { names.append(name).append(1, '\n'); };
    for (const auto& [room, world] : state.worlds()) {
        const Scene& scene = world->scene();
        add(room);
        for (std::size_t i = 0; i < scene.records.size(); ++i) {
            add(scene.ids[i]);
            add(scene.records[i].keyword());
            // A person has states once they are set.
            const ThingKind* const kind = thingKind(scene.records[i].keyword());
            if (kind == nullptr || kind->figure == nullptr) continue;
            for (const std::string& key : kind->states) add(scene.records[i].has(key) ? "+" : "-");
        }
        for (const Mover& mover : world->movers()) add(mover.id);
        // A sensor has a state once it has a pose.
        for (const Sensor& sensor : world->sensors()) add(sensor.id);
    }
    return names;
}

/// Requests that wait for the world; further commands are refused.
constexpr std::size_t kMaxRequests = 1000;
constexpr std::size_t kMaxPayload = 256;

}  // namespace

void serveMqtt(Server& server, const MqttOptions& options) {
    const BridgeHost host = server.host();
    server.add(
        std::make_unique<MqttBridge>(host.state, connectMqtt(options, host.wake), options.prefix));
}

MqttBridge::MqttBridge(ServerState& state, std::unique_ptr<MqttClient> client, std::string prefix)
    : state_(&state),
      client_(std::move(client)),
      prefix_(std::move(prefix)),
      survey_(*client_, prefix_),
      movers_(state, *client_, prefix_),
      session_(state) {
    if (!state.limits().token.empty()) session_.request("TOKEN " + state.limits().token);
    // Of all things, also of later ones; an id of a building has its storey before it.
    for (const char* levels : {"/+/+/set", "/+/+/+/set"}) client_->subscribe(prefix_ + levels);
    session_.request("WORLD");
    session_.request("EVENTS state");
    session_.take();
    MqttBridge::serve(false);
}

std::string MqttBridge::topicOf(std::string_view id, std::string_view key) const {
    return mqtt::topicOf(prefix_, id, key);
}

/// Describes new things, or all of them after a connection, and removes those that are gone.
/// Most changes set a state, and bring no thing.
void MqttBridge::introduce(bool all) {
    changes_ = changesOfAll();
    std::string names = namedThings(*state_);
    if (!all && names == names_) return;
    names_ = std::move(names);
    Topics topics;
    Descriptions descriptions;
    std::vector<MqttMessage> news;
    std::vector<MqttEntity> things = thingsOf(*state_, prefix_);
    for (MqttEntity& one : movers_.things()) things.push_back(std::move(one));
    for (const MqttEntity& thing : things) {
        const auto known = descriptions_.find({thing.id, thing.keyword});
        bool has_news = all || known == descriptions_.end();
        for (const MqttKey& key : thing.keys) {
            topics.emplace(key.topic,
                           Topic{thing.id, key.name, isActuator(thing.keyword), key.spec});
            has_news = has_news || !topics_.contains(key.topic);
        }
        std::vector<std::string>& described = descriptions[{thing.id, thing.keyword}];
        if (!has_news) {
            described = known->second;
            continue;
        }
        for (MqttMessage& description : discoveryOf(thing, prefix_)) {
            described.push_back(description.topic);
            news.push_back(std::move(description));
        }
    }
    // An empty retained message removes the one that the broker has.
    const auto remove = [this](const std::string& topic) {
        client_->publish({topic, "", true});
        movers_.forget(topic);
    };
    std::set<std::string_view> kept;
    for (const auto& [thing, described] : descriptions)
        kept.insert(described.begin(), described.end());
    for (const auto& [thing, described] : descriptions_)
        for (const std::string& topic : described)
            if (!kept.contains(topic)) remove(topic);
    for (const auto& [topic, of] : topics_)
        if (!topics.contains(topic)) remove(topic);
    if (connections_ == 1)
        for (const std::string& topic : survey_.leftovers())
            if (!topics.contains(topic) && !kept.contains(topic)) remove(topic);
    for (MqttMessage& description : news) client_->publish(std::move(description));
    topics_ = std::move(topics);
    descriptions_ = std::move(descriptions);
}

void MqttBridge::publishAll() {
    for (const RoomState& state : state_->statesOfAll()) publish(state);
    movers_.publishAll();
}

void MqttBridge::publish(const RoomState& state) {
    const std::string topic = topicOf(state.id, state.key);
    const auto found = topics_.find(topic);
    const bool is_actuator = found != topics_.end() && found->second.is_actuator;
    const KeySpec* const spec = is_actuator ? found->second.spec : nullptr;
    client_->publish({topic, payloadOf(state.key, state.value, is_actuator, spec), true});
}

void MqttBridge::serve(bool /*has_made*/) {
    if (const int now = client_->connections(); std::exchange(connections_, now) != now) {
        introduce(true);
        publishAll();
        client_->publish({statusTopic(prefix_), "online", true});
    }
    for (const MqttMessage& message : client_->take()) receive(message);
    session_.proceed();
    answer();
}

void MqttBridge::refuse(const MqttMessage& message, const std::string& reason) {
    client_->publish({prefix_ + "/error", "ERR 400 " + message.topic + ": " + reason, false});
}

void MqttBridge::receive(const MqttMessage& message) {
    if (survey_.answer(message)) return;
    constexpr std::string_view kSet = "/set";
    std::string_view topic = message.topic;
    // A retained command is of an earlier run.
    if (!topic.starts_with(prefix_ + '/') || !topic.ends_with(kSet) || message.retain) return;
    topic.remove_suffix(kSet.size());
    if (std::string robot; movers_.isRobot(topic, robot)) {
        if (const std::string why = movers_.command(robot, message.payload); !why.empty())
            refuse(message, "`" + printable(message.payload.substr(0, kMaxPayload)) +
                                "` is given: " + printable(why));
        return;
    }
    const auto found = topics_.find(topic);
    if (found == topics_.end())
        return refuse(message, "no thing of the room has this state, see " + prefix_ + "/+/+");
    if (!found->second.is_actuator)
        return refuse(message, "a sensor reports this state, and no command sets it");
    if (const std::string wanted =
            wantedPayload(found->second.key, found->second.spec, message.payload);
        !wanted.empty())
        return refuse(message, "`" + printable(message.payload.substr(0, kMaxPayload)) +
                                   "` is given, wanted " + wanted);
    const std::string value = valueOfPayload(found->second.key, message.payload);
    const bool is_word = !value.empty() && value.size() <= kMaxPayload &&
                         value.find_first_of(" \t\r\n") == std::string::npos;
    if (!is_word || requests_.size() >= kMaxRequests)
        return refuse(message, is_word ? "too many commands" : "this is no value");
    requests_.push_back("ACT " + found->second.id + ' ' + found->second.key + '=' + value);
}

void MqttBridge::answer() {
    while (true) {
        const std::string out = session_.take();
        std::string_view lines = out;
        while (!lines.empty()) {
            const std::string_view line = lines.substr(0, lines.find('\n'));
            lines.remove_prefix(std::min(lines.size(), line.size() + 1));
            readLine(line);
        }
        if (requests_.empty() || session_.waiting() || session_.closing()) return;
        session_.request(requests_.front());
        requests_.pop_front();
    }
}

void MqttBridge::readLine(std::string_view line) {
    if (line.starts_with("ERR ")) client_->publish({prefix_ + "/error", std::string(line), false});
    if (line.starts_with("EVENT missed")) publishAll();
    if (!line.starts_with("EVENT state ")) return;
    // EVENT state t=T id=ID KEY=VALUE, with room=ROOM behind it in a building.
    const std::vector<Piece> words = wordsOf(line);
    constexpr std::size_t kWords = 5;
    constexpr std::string_view kRoom = "room=";
    const bool has_room = words.size() == kWords + 1 && words.back().text.starts_with(kRoom);
    if (words.size() != kWords && !has_room) return;
    const std::string_view state = words[kWords - 1].text;
    const std::size_t equals = state.find('=');
    RoomState told{std::string(words[3].text.substr(3)), std::string(state.substr(0, equals)),
                   std::string(state.substr(equals + 1))};
    const std::string room(has_room ? words.back().text.substr(kRoom.size()) : "");
    // A lift has no room before its id.
    const std::string name = nameAcross(room, told.id);
    if (topics_.contains(topicOf(name, told.key))) told.id = name;
    publish(told);
}

std::int64_t MqttBridge::changesOfAll() const {
    std::int64_t changes = 0;
    for (const auto& [room, world] : state_->worlds()) changes += world->changes();
    return changes;
}

void MqttBridge::stepped() {
    session_.stepped();
    if (changes_ != changesOfAll()) introduce(false);
    movers_.stepped();
    answer();
}

void MqttBridge::end() {
    session_.finish();
    answer();
    client_->publish({statusTopic(prefix_), "offline", true});
    client_->close();
}

}  // namespace ispace::mqtt

// SPDX-License-Identifier: GPL-3.0-or-later
// Source: Foxglove, "WebSocket protocol v1" (github.com/foxglove/ws-protocol, docs/spec.md) and its
// SDK. Requests are untrusted: JSON of at most 256 KiB and 32 levels, at most 256 channels, 4096
// watched parameters, 8 assets under way.
#include "extensions/ros/foxglove_dialogue.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/error.h"
#include "base/file.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "extensions/ros/ros_parameters.h"
#include "extensions/ros/ros_text.h"

namespace ispace::ros {

namespace {

constexpr std::size_t kMaxChannels = 256, kMaxWatched = 4096;
constexpr int kMaxFetches = 8;
constexpr double kTimeRate = 50;  // a second, as of /clock
constexpr const char *kJson = "json", *kCdr = "cdr";

/// Reads a number of 32 bits; empty for anything else.
std::optional<std::uint32_t> numberOf(const nlohmann::json& value) {
    const auto* const number = value.get_ptr<const nlohmann::json::number_unsigned_t*>();
    if (number == nullptr || *number > std::numeric_limits<std::uint32_t>::max())
        return std::nullopt;
    return static_cast<std::uint32_t>(*number);
}

/// Returns a member; null if the value is no object or lacks it.
const nlohmann::json& member(const nlohmann::json& value, const char* name) {
    static const nlohmann::json null;
    if (!value.is_object()) return null;
    const auto found = value.find(name);
    return found == value.end() ? null : *found;
}

std::string textOf(const nlohmann::json& value) {
    const auto* const text = value.get_ptr<const std::string*>();
    return text == nullptr ? std::string() : *text;
}

/// Cuts a little-endian number off; empty if there are too few bytes.
std::optional<std::uint32_t> takeNumber(std::string_view& bytes) {
    std::uint32_t number = 0;
    if (bytes.size() < sizeof number) return std::nullopt;
    std::memcpy(&number, bytes.data(), sizeof number);
    bytes.remove_prefix(sizeof number);
    return number;
}

std::string binary(FoxgloveOpcode opcode) { return std::string(1, static_cast<char>(opcode)); }

}  // namespace

FoxgloveDialogue::FoxgloveDialogue(ServerState& state, RosFeed& feed, const std::string& title,
                                   const std::string& session_id, std::string peer)
    : RosDialogue(state, feed, std::move(peer)) {
    greet(title, session_id);
    advertise();
    advertiseServices();
}

void FoxgloveDialogue::greet(const std::string& title, const std::string& session_id) {
    JsonWriter json;
    json.beginObject().key("op").value("serverInfo").key("name").value(title);
    json.key("capabilities").beginArray();
    for (const char* one : {"clientPublish", "time", "parameters", "parametersSubscribe",
                            "services", "assets", "connectionGraph"})
        json.value(one);
    json.endArray().key("supportedEncodings").beginArray().value(kJson).value(kCdr).endArray();
    // Programs then know the common types.
    json.key("metadata").beginObject().key("ROS_DISTRO").value("jazzy").endObject();
    json.key("sessionId").value(session_id).endObject();
    sendText(json.take());
}

/// Sends only what is new or gone since the last call, and an empty list as long as there was no
/// channel at all. Topics to which clients send are no channels until one has sent.
void FoxgloveDialogue::advertise() {
    const RosFeed::Entries& entries = feed().entries();
    JsonWriter gone;
    gone.beginObject().key("op").value("unadvertise").key("channelIds").beginArray();
    bool has_gone = false;
    for (auto known = advertised_.begin(); known != advertised_.end();) {
        if (entries.contains(*known)) {
            ++known;
            continue;
        }
        has_gone = true;
        gone.value(std::int64_t{*known});
        known = advertised_.erase(known);
    }
    gone.endArray().endObject();
    const bool is_first = newest_ == 0;
    JsonWriter json;
    json.beginObject().key("op").value("advertise").key("channels").beginArray();
    bool has_new = false;
    const auto add = [&](std::uint32_t number, const RosFeed::Entry& entry) {
        has_new = true;
        advertised_.insert(number);
        json.beginObject().key("id").value(std::int64_t{number});
        json.key("topic").value(entry.channel.topic).key("encoding").value(kCdr);
        json.key("schemaName").value(nameOf(entry.channel.type));
        json.key("schemaEncoding").value("ros2msg");
        json.key("schema").value(rosDefinition(entry.channel.type)).endObject();
    };
    // Numbers grow: those after the newest known one are new.
    for (auto at = entries.upper_bound(newest_); at != entries.end(); ++at) {
        newest_ = at->first;
        if (!at->second.channel.isInput()) add(at->first, at->second);
    }
    // Orders of clients are channels for the others once there are some, as in ROS.
    for (const std::uint32_t number : feed().echoed())
        if (!advertised_.contains(number)) add(number, entries.at(number));
    json.endArray().endObject();
    if (has_gone) sendText(gone.take());
    if (has_new || is_first) sendText(json.take());
}

void FoxgloveDialogue::advertiseServices() {
    JsonWriter json;
    json.beginObject().key("op").value("advertiseServices").key("services").beginArray();
    const auto services = rosServices();
    for (std::size_t i = 0; i < services.size(); ++i) {
        json.beginObject().key("id").value(i).key("name").value(services[i].name);
        json.key("type").value(kRosEmptyService);
        for (const char* side : {"request", "response"}) {
            json.key(side).beginObject().key("encoding").value(kCdr);
            json.key("schemaName")
                .value(std::string(kRosEmptyService) + (side[2] == 'q' ? "_Request" : "_Response"));
            json.key("schemaEncoding").value("ros2msg").key("schema").value("").endObject();
        }
        // For clients of before request and response, which call in the first encoding of all.
        constexpr std::string_view kNoFields = R"({"type":"object","properties":{}})";
        json.key("requestSchema").value(kNoFields);
        json.key("responseSchema").value(kNoFields).endObject();
    }
    json.endArray().endObject();
    sendText(json.take());
}

web::WebMessage FoxgloveDialogue::write(std::uint32_t key, const RosFeed::Entry& /*topic*/,
                                        const RosMessage& message) {
    std::string head = binary(FoxgloveOpcode::Message);
    appendLittle(head, key);
    appendLittle(head, message.time());
    return {.head = std::move(head), .body = message.cdr(), .is_text = false};
}

void FoxgloveDialogue::report(Level level, const std::string& text) {
    JsonWriter json;
    json.beginObject().key("op").value("status").key("level").value(static_cast<int>(level));
    json.key("message").value(text).endObject();
    sendText(json.take());
}

void FoxgloveDialogue::stepped() {
    RosDialogue::stepped();
    const Simulation& simulation = state().simulation();
    static const Periods periods(kTimeRate);
    const std::int64_t period = periods.newest(simulation.world().time());
    if (std::exchange(time_period_, period) != period) is_time_due_ = true;
    const bool is_other =
        was_paused_ != simulation.paused() || seen_changes_ != simulation.world().changes();
    was_paused_ = simulation.paused();
    seen_changes_ = simulation.world().changes();
    if (is_other && !watched_.empty()) sendParameters(watched_, "");
}

std::optional<web::WebMessage> FoxgloveDialogue::next() {
    if (hasAnswers() || !std::exchange(is_time_due_, false)) return RosDialogue::next();
    std::string head = binary(FoxgloveOpcode::Time);
    appendLittle(head, rosTimeOf(state().simulation().world().time()));
    return web::WebMessage{.head = std::move(head), .is_text = false};
}

// Requests.

struct FoxgloveDialogue::Op {
    std::string_view name;
    void (FoxgloveDialogue::*obey)(const Json& request);
};

void FoxgloveDialogue::receive(std::string_view message, bool is_text) {
    // The world may have changed since the last step.
    feed().sync();
    try {
        if (is_text) return obeyText(message);
        constexpr char kMessage = 1, kCall = 2;
        if (message.starts_with(kMessage)) return obeyMessage(message.substr(1));
        if (message.starts_with(kCall)) return callService(message.substr(1));
        report(Level::Error, "this opcode is not served");
    } catch (const FormatError& error) {
        report(Level::Error, error.diagnostics().front().message);
    }
}

void FoxgloveDialogue::obeyText(std::string_view text) {
    using Self = FoxgloveDialogue;
    static constexpr std::array<Op, 11> kOps{
        {{"subscribe", &Self::subscribeAll},
         {"unsubscribe", &Self::unsubscribeAll},
         {"advertise", &Self::addChannels},
         {"unadvertise", &Self::removeChannels},
         {"getParameters", &Self::getParameters},
         {"setParameters", &Self::setParameters},
         {"subscribeParameterUpdates", &Self::watchParameters},
         {"unsubscribeParameterUpdates", &Self::unwatchParameters},
         {"subscribeConnectionGraph", &Self::watchGraph},
         {"unsubscribeConnectionGraph", &Self::unwatchGraph},
         {"fetchAsset", &Self::fetchAsset}}};
    const std::optional<Json> request = parseClientJson(text);
    if (!request || !request->is_object()) return report(Level::Error, "this is no JSON object");
    const std::string name = textOf(member(*request, "op"));
    const auto* const op =
        std::find_if(kOps.begin(), kOps.end(), [&](const Op& one) { return one.name == name; });
    if (op == kOps.end()) return report(Level::Error, excerpt(name) + " is not served");
    (this->*op->obey)(*request);
}

void FoxgloveDialogue::subscribeAll(const Json& request) {
    for (const Json& one : member(request, "subscriptions")) {
        const auto key = numberOf(member(one, "id")), channel = numberOf(member(one, "channelId"));
        const auto topic = feed().entries().find(channel.value_or(0));
        if (!key || topic == feed().entries().end() || !advertised_.contains(topic->first)) {
            report(Level::Error, "a subscription to an unknown channel");
            continue;
        }
        if (readsElsewhere(topic->first, *key)) {
            report(Level::Warning, "another subscription has this channel");
            continue;
        }
        const std::size_t depth = topic->second.channel.quality.depth;
        if (!subscribe(*key, {.topic = topic->first, .depth = depth}))
            return report(Level::Error, "too many subscriptions");
    }
}

void FoxgloveDialogue::unsubscribeAll(const Json& request) {
    for (const Json& one : member(request, "subscriptionIds"))
        if (const auto key = numberOf(one)) unsubscribe(*key);
}

void FoxgloveDialogue::addChannels(const Json& request) {
    for (const Json& one : member(request, "channels")) {
        const auto id = numberOf(member(one, "id"));
        const std::string topic = textOf(member(one, "topic")),
                          encoding = textOf(member(one, "encoding")),
                          schema = textOf(member(one, "schemaName"));
        if (!id || (encoding != kJson && encoding != kCdr)) {
            report(Level::Error, "a channel needs an id, and the encoding json or cdr");
        } else if (channels_.size() >= kMaxChannels) {
            return report(Level::Error, "too many channels");
        } else {
            const auto type = rosTypeNamed(schema);
            const bool is_read = type && input(topic, *type) != nullptr;
            channels_[*id] = is_read ? ClientChannel{topic, type, encoding == kJson}
                                     : ClientChannel{excerpt(topic), {}, false};
        }
    }
}

void FoxgloveDialogue::removeChannels(const Json& request) {
    for (const Json& one : member(request, "channelIds"))
        if (const auto id = numberOf(one)) channels_.erase(*id);
}

void FoxgloveDialogue::obeyMessage(std::string_view payload) {
    const auto id = takeNumber(payload);
    const auto channel = id ? channels_.find(*id) : channels_.end();
    if (channel == channels_.end()) return;
    const auto [topic, type, is_json] = channel->second;
    if (!type) {
        channels_.erase(channel);
        return report(Level::Warning, "no messages of this type are read from " + topic);
    }
    const RosChannel* const to = input(topic, *type);
    if (to == nullptr) return report(Level::Error, "the topic " + excerpt(topic) + " is gone");
    if (!is_json) return orders().obey(*to, payload);
    const std::optional<Json> json = parseClientJson(payload);
    if (!json) return report(Level::Error, "a message to " + topic + " is no JSON");
    orders().obey(*to, rosMessage(*type, *json));
}

void FoxgloveDialogue::callService(std::string_view payload) {
    const auto service = takeNumber(payload), call = takeNumber(payload),
               length = takeNumber(payload);
    if (!length || *length > payload.size()) return report(Level::Error, "a call that is cut off");
    const std::string encoding(payload.substr(0, *length));
    const auto fail = [this, service, call](std::string_view why) {
        JsonWriter json;
        json.beginObject().key("op").value("serviceCallFailure");
        json.key("serviceId").value(std::int64_t{*service});
        json.key("callId").value(std::int64_t{*call}).key("message").value(why).endObject();
        sendText(json.take());
    };
    if (*service >= rosServices().size()) return fail("there is no such service");
    if (encoding != kJson && encoding != kCdr) return fail("the encoding is json or cdr");
    if (!orders().mayRequest()) return fail("too many calls at once");
    orders().request(std::string(rosServices()[*service].request),
                     [this, service, call, encoding, fail](bool is_done, std::string_view text) {
                         if (!is_done) return fail(text);
                         std::string head = binary(FoxgloveOpcode::Response);
                         appendLittle(head, *service);
                         appendLittle(head, *call);
                         appendLittle(head, static_cast<std::uint32_t>(encoding.size()));
                         head += encoding;
                         head += encoding == kJson ? std::string_view("{}") : kRosEmpty;
                         send({.head = std::move(head), .is_text = false});
                     });
}

// The graph of nodes: the run is the only one.

void FoxgloveDialogue::watchGraph(const Json& /*request*/) {
    told_graph_.emplace();
    sendGraph(true);
}

void FoxgloveDialogue::unwatchGraph(const Json& /*request*/) { told_graph_.reset(); }

void FoxgloveDialogue::sendGraph(bool with_services) {
    if (!told_graph_) return;
    Graph graph;
    for (const auto& [number, entry] : feed().entries())
        (entry.channel.isInput() ? graph.read : graph.written).insert(entry.channel.topic);
    JsonWriter json;
    json.beginObject().key("op").value("connectionGraphUpdate");
    const auto write = [&json](std::string_view name, const char* members, bool is_there) {
        json.beginObject().key("name").value(name).key(members).beginArray();
        if (is_there) json.value(kRosNode);
        json.endArray().endObject();
    };
    const auto write_changes = [&](const char* list, const char* members, const Topics& now,
                                   const Topics& before) {
        json.key(list).beginArray();
        for (const std::string& topic : now)
            if (!before.contains(topic)) write(topic, members, true);
        for (const std::string& topic : before)
            if (!now.contains(topic) && graph.has(topic)) write(topic, members, false);
        json.endArray();
    };
    write_changes("publishedTopics", "publisherIds", graph.written, told_graph_->written);
    write_changes("subscribedTopics", "subscriberIds", graph.read, told_graph_->read);
    json.key("advertisedServices").beginArray();
    if (with_services)
        for (const auto& one : rosServices()) write(one.name, "providerIds", true);
    json.endArray().key("removedTopics").beginArray();
    for (const std::string& topic : told_graph_->written)
        if (!graph.has(topic)) json.value(topic);
    for (const std::string& topic : told_graph_->read)
        if (!graph.has(topic) && !told_graph_->written.contains(topic)) json.value(topic);
    json.endArray().key("removedServices").beginArray().endArray().endObject();
    told_graph_ = std::move(graph);
    sendText(json.take());
}

// Parameters and assets.

void FoxgloveDialogue::sendParameters(const std::set<std::string>& names, const std::string& id) {
    JsonWriter json;
    json.beginObject().key("op").value("parameterValues").key("parameters").beginArray();
    for (const RosParameter& one : rosParameters(state())) {
        if (!names.empty() && !names.contains(one.name)) continue;
        json.beginObject().key("name").value(one.name).key("value");
        std::visit([&json](const auto& value) { json.value(value); }, one.value);
        if (std::holds_alternative<double>(one.value)) json.key("type").value("float64");
        if (one.value.index() == 2) json.key("type").value("float64_array");
        json.endObject();
    }
    json.endArray();
    if (!id.empty()) json.key("id").value(id);
    json.endObject();
    sendText(json.take());
}

void FoxgloveDialogue::getParameters(const Json& request) {
    std::set<std::string> names;
    for (const Json& one : member(request, "parameterNames")) names.insert(textOf(one));
    sendParameters(names, textOf(member(request, "id")));
}

void FoxgloveDialogue::setParameters(const Json& request) {
    const std::string id = textOf(member(request, "id"));
    std::set<std::string> names;
    for (const Json& one : member(request, "parameters")) {
        const std::string name = textOf(member(one, "name"));
        const RosSetting setting = settingOf(state(), name, member(one, "value"));
        if (!setting.refusal.empty()) {
            report(Level::Error, setting.refusal);
            if (!id.empty()) sendParameters({name}, id);
            continue;
        }
        // PAUSE and RESUME themselves do not need it.
        if (!orders().hasToken()) {
            report(Level::Error, excerpt(name) + " needs the token of this run: ?token=x");
            if (!id.empty()) sendParameters({name}, id);
            continue;
        }
        if (!orders().mayRequest()) return report(Level::Error, "too many parameters at once");
        names.insert(name);
        orders().request(setting.request, [this, name, id](bool is_done, std::string_view text) {
            if (!is_done) report(Level::Error, std::string(text));
            if (!id.empty()) sendParameters({name}, id);
        });
    }
}

// An empty list means all parameters that there are.
void FoxgloveDialogue::watchParameters(const Json& request) {
    const auto watch = [this](const std::string& name) {
        if (watched_.size() < kMaxWatched) watched_.insert(name);
    };
    const Json& names = member(request, "parameterNames");
    for (const Json& one : names) watch(textOf(one));
    if (!names.empty()) return;
    for (const RosParameter& one : rosParameters(state())) watch(one.name);
}

void FoxgloveDialogue::unwatchParameters(const Json& request) {
    const Json& names = member(request, "parameterNames");
    for (const Json& one : names) watched_.erase(textOf(one));
    if (names.empty()) watched_.clear();
}

void FoxgloveDialogue::fetchAsset(const Json& request) {
    const auto id = numberOf(member(request, "requestId"));
    if (!id) return report(Level::Error, "an asset needs a requestId");
    const auto answer = [this, id = *id](const std::shared_ptr<const std::string>& bytes,
                                         std::string_view why) {
        std::string head = binary(FoxgloveOpcode::Asset);
        appendLittle(head, id);
        head += static_cast<char>(bytes ? 0 : 1);
        appendLittle(head, static_cast<std::uint32_t>(why.size()));
        head += why;
        send({.head = std::move(head), .body = bytes, .is_text = false});
    };
    const std::vector<std::string> meshes = feed().meshes();
    const auto mesh = std::find(meshes.begin(), meshes.end(), textOf(member(request, "uri")));
    if (mesh == meshes.end())
        return answer(nullptr, (meshes.size() == 1 ? "the only asset is " : "the first asset is ") +
                                   meshes.front());
    if (fetches_ >= kMaxFetches) return answer(nullptr, "too many assets at once");
    ++fetches_;
    const auto which = static_cast<std::size_t>(mesh - meshes.begin());
    feed().fetchRoom(which, [self = std::weak_ptr(self_), answer](auto mesh) {
        const auto dialogue = self.lock();
        if (!dialogue) return;
        --(*dialogue)->fetches_;
        if (mesh->empty()) return answer(nullptr, "there is no mesh of this room");
        answer(mesh, "");
    });
}

}  // namespace ispace::ros

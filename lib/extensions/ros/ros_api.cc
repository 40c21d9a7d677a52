// SPDX-License-Identifier: GPL-3.0-or-later
// Answers as rosapi of rosbridge_suite gives them. The graph has one node, the run.
#include "extensions/ros/ros_api.h"

#include <algorithm>
#include <array>
#include <functional>
#include <nlohmann/json.hpp>
#include <set>

#include "base/json_writer.h"
#include "extensions/ros/navigate_action.h"
#include "extensions/ros/ros_dialogue.h"
#include "extensions/ros/ros_parameters.h"

namespace ispace::ros {

namespace {

using nlohmann::json;

/// A question to rosapi.
struct Question {
    const RosFeed& feed;
    const Simulation& simulation;
    const json& arguments;

    [[nodiscard]] std::string argument(const char* name) const {
        const auto found = arguments.is_object() ? arguments.find(name) : arguments.end();
        return arguments.is_object() && found != arguments.end() && found->is_string()
                   ? found->get<std::string>()
                   : "";
    }
};

using Texts = std::vector<std::string>;

/// Each topic once, although an input may have two types.
std::vector<const RosChannel*> topicsOf(const Question& question) {
    std::vector<const RosChannel*> out;
    std::set<std::string_view> known;
    for (const auto& [number, entry] : question.feed.entries())
        if (known.insert(entry.channel.topic).second) out.push_back(&entry.channel);
    return out;
}

Texts namesOf(const std::vector<const RosChannel*>& channels) {
    Texts out;
    for (const RosChannel* channel : channels) out.push_back(channel->topic);
    return out;
}

Texts typesOf(const std::vector<const RosChannel*>& channels) {
    Texts out;
    for (const RosChannel* channel : channels) out.emplace_back(nameOf(channel->type));
    return out;
}

Texts serviceNames() {
    Texts out;
    for (const RosService& service : rosServices()) out.emplace_back(service.name);
    return out;
}

void writeTopics(const Question& question, JsonWriter& out) {
    const auto topics = topicsOf(question);
    out.key("topics").value(namesOf(topics)).key("types").value(typesOf(topics));
}

void writeTopicsAndDefinitions(const Question& question, JsonWriter& out) {
    writeTopics(question, out);
    out.key("typedefs_full_text").beginArray();
    for (const RosChannel* channel : topicsOf(question)) out.value(rosDefinition(channel->type));
    out.endArray();
}

void writeTopicsForType(const Question& question, JsonWriter& out) {
    const auto type = rosTypeNamed(question.argument("type"));
    Texts names;
    for (const RosChannel* channel : topicsOf(question))
        if (channel->type == type) names.push_back(channel->topic);
    out.key("topics").value(names);
}

void writeTopicType(const Question& question, JsonWriter& out) {
    const std::string name = question.argument("topic");
    std::string_view type;
    for (const RosChannel* channel : topicsOf(question))
        if (channel->topic == name) type = nameOf(channel->type);
    out.key("type").value(type);
}

void writeServices(const Question& /*question*/, JsonWriter& out) {
    out.key("services").value(serviceNames());
}

void writeServicesForType(const Question& question, JsonWriter& out) {
    const bool is_ours = question.argument("type") == kRosEmptyService;
    out.key("services").value(is_ours ? serviceNames() : Texts());
}

void writeServiceType(const Question& question, JsonWriter& out) {
    const Texts names = serviceNames();
    const bool is_ours =
        std::find(names.begin(), names.end(), question.argument("service")) != names.end();
    out.key("type").value(is_ours ? kRosEmptyService : std::string_view());
}

void writeNodes(const Question& /*question*/, JsonWriter& out) {
    out.key("nodes").beginArray().value(kRosNode).endArray();
}

void writeNodeDetails(const Question& question, JsonWriter& out) {
    Texts published, read;
    for (const RosChannel* channel : topicsOf(question))
        (channel->isInput() ? read : published).push_back(channel->topic);
    out.key("subscribing").value(read).key("publishing").value(published);
    out.key("services").value(serviceNames());
}

/// Writes whether this node is at the other end of a topic.
void writeEnds(const Question& question, JsonWriter& out, const char* key, bool is_input) {
    const std::string name = question.argument("topic");
    bool is_here = false;
    for (const RosChannel* channel : topicsOf(question))
        is_here = is_here || (channel->topic == name && channel->isInput() == is_input);
    out.key(key).value(is_here ? Texts{std::string(kRosNode)} : Texts());
}

void writePublishers(const Question& question, JsonWriter& out) {
    writeEnds(question, out, "publishers", false);
}
void writeSubscribers(const Question& question, JsonWriter& out) {
    writeEnds(question, out, "subscribers", true);
}

void writeTime(const Question& question, JsonWriter& out) {
    constexpr std::uint64_t kSecond = 1'000'000'000;
    const std::uint64_t now = rosTimeOf(question.simulation.world().time());
    out.key("time").beginObject().key("sec").value(static_cast<std::int64_t>(now / kSecond));
    out.key("nanosec").value(static_cast<std::int64_t>(now % kSecond)).endObject();
}

void writeParameterNames(const Question& question, JsonWriter& out) {
    out.key("names").beginArray();
    for (const RosParameter& one : rosParameters(question.feed.state()))
        out.value(std::string(kRosNode) + ':' + one.name);
    out.endArray();
}

/// Returns a parameter as JSON; "" without.
std::string parameterText(const Question& question) {
    const std::string name = parameterNamed(question.argument("name"));
    JsonWriter value;
    for (const RosParameter& one : rosParameters(question.feed.state()))
        if (one.name == name) std::visit([&](const auto& it) { value.value(it); }, one.value);
    return value.take();
}

/// The value is JSON within a text: of a parameter that there is not, the default, else that of an
/// empty text.
void writeParameter(const Question& question, JsonWriter& out) {
    std::string value = parameterText(question);
    for (const char* name : {"default_value", "default"})
        if (value.empty()) value = question.argument(name);
    out.key("value").value(value.empty() ? R"("")" : value);
}

void writeHasParameter(const Question& question, JsonWriter& out) {
    out.key("exists").value(!parameterText(question).empty());
}

/// All parameters are those of the running world.
void writeDeletedParameter(const Question& question, JsonWriter& out) {
    const bool is_known = !parameterText(question).empty();
    out.key("successful")
        .value(false)
        .key("reason")
        .value(is_known ? "parameters of the world cannot be deleted"
                        : "there is no such parameter");
}

/// A robot that takes goals has the action of Nav2.
void writeActionServers(const Question& question, JsonWriter& out) {
    Texts names;
    for (const auto& [number, entry] : question.feed.entries())
        if (const std::string& topic = entry.channel.topic;
            topic.ends_with(kGoalTopic) && entry.channel.isInput())
            names.push_back(topic.substr(0, topic.size() - kGoalTopic.size()) +
                            std::string(kNavigate));
    out.key("action_servers").value(names);
}

void writeServiceNode(const Question& question, JsonWriter& out) {
    const Texts names = serviceNames();
    const bool is_ours =
        std::find(names.begin(), names.end(), question.argument("service")) != names.end();
    out.key("node").value(is_ours ? kRosNode : "");
}

/// The services have neither arguments nor answers.
void writeEmptyDetails(const Question& question, JsonWriter& out, const char* part) {
    out.key("typedefs").beginArray();
    if (question.argument("type") == kRosEmptyService) {
        out.beginObject().key("type").value(std::string(kRosEmptyService) + part);
        for (const char* key :
             {"fieldnames", "fieldtypes", "fieldarraylen", "examples", "constnames", "constvalues"})
            out.key(key).value(Texts());
        out.endObject();
    }
    out.endArray();
}
void writeRequestDetails(const Question& question, JsonWriter& out) {
    writeEmptyDetails(question, out, "_Request");
}
void writeResponseDetails(const Question& question, JsonWriter& out) {
    writeEmptyDetails(question, out, "_Response");
}

void writeVersion(const Question& /*question*/, JsonWriter& out) {
    out.key("version").value(2).key("distro").value("jazzy");
}

/// Appends the definition of a struct and of those that it contains, each once.
void writeDetailsOf(const RosStruct& type, JsonWriter& out, std::set<std::string>& known) {
    if (!known.insert(type.name).second) return;
    Texts names, types, examples;
    std::vector<std::int64_t> lengths;
    for (const RosField& field : type.fields) {
        names.push_back(field.name);
        types.push_back(field.type.substr(0, field.type.find('[')));
        lengths.push_back(field.is_array ? static_cast<std::int64_t>(field.length) : -1);
        examples.emplace_back(field.is_array                         ? "[]"
                              : field.kind == RosField::Kind::Struct ? "{}"
                              : field.kind == RosField::Kind::Text   ? ""
                                                                     : "0");
    }
    out.beginObject().key("type").value(type.name).key("fieldnames").value(names);
    out.key("fieldtypes").value(types).key("fieldarraylen").value(lengths);
    out.key("examples").value(examples).key("constnames").value(Texts());
    out.key("constvalues").value(Texts()).endObject();
    for (const RosField& field : type.fields)
        if (field.fields != nullptr) writeDetailsOf(*field.fields, out, known);
}

void writeMessageDetails(const Question& question, JsonWriter& out) {
    out.key("typedefs").beginArray();
    std::set<std::string> known;
    if (const auto type = rosTypeNamed(question.argument("type")))
        writeDetailsOf(rosFields(*type), out, known);
    out.endArray();
}

struct ApiService {
    std::string_view name;
    void (*write)(const Question& question, JsonWriter& out);
};
constexpr ApiService kServices[] = {{"topics", writeTopics},
                                    {"topics_and_raw_types", writeTopicsAndDefinitions},
                                    {"topics_for_type", writeTopicsForType},
                                    {"topic_type", writeTopicType},
                                    {"publishers", writePublishers},
                                    {"subscribers", writeSubscribers},
                                    {"services", writeServices},
                                    {"services_for_type", writeServicesForType},
                                    {"service_type", writeServiceType},
                                    {"nodes", writeNodes},
                                    {"node_details", writeNodeDetails},
                                    {"message_details", writeMessageDetails},
                                    {"get_param_names", writeParameterNames},
                                    {"get_param", writeParameter},
                                    {"has_param", writeHasParameter},
                                    {"delete_param", writeDeletedParameter},
                                    {"action_servers", writeActionServers},
                                    {"service_node", writeServiceNode},
                                    {"service_request_details", writeRequestDetails},
                                    {"service_response_details", writeResponseDetails},
                                    {"get_time", writeTime},
                                    {"get_ros_version", writeVersion}};

}  // namespace

std::optional<std::string> rosApi(const RosFeed& feed, const Simulation& simulation,
                                  std::string_view name, const json& arguments) {
    constexpr std::string_view kPrefix = "rosapi/";
    if (!name.starts_with(kPrefix)) return std::nullopt;
    name.remove_prefix(kPrefix.size());
    const auto* const service =
        std::find_if(std::begin(kServices), std::end(kServices),
                     [&](const ApiService& one) { return one.name == name; });
    if (service == std::end(kServices)) return std::nullopt;
    JsonWriter out;
    out.beginObject();
    service->write({feed, simulation, arguments}, out);
    out.endObject();
    return out.take();
}

}  // namespace ispace::ros

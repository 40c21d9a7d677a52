// SPDX-License-Identifier: GPL-3.0-or-later
// Source: RobotWebTools, "rosbridge v2.0 Protocol Specification" and rosbridge_suite, where they
// differ. Requests of one client for one topic share a subscription: with the least interval, the
// shortest queue and the best form among them.
#include "extensions/ros/rosbridge_dialogue.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "extensions/ros/navigate_action.h"
#include "extensions/ros/ros_api.h"
#include "extensions/ros/ros_parameters.h"
#include "extensions/ros/ros_text.h"
#include "raster/codec.h"

namespace ispace::ros {

namespace {

/// The action that roslib's TF clients use, and the beginning of its topics in ROS 1.
constexpr std::string_view kRepublisher = "/tf2_web_republisher";
/// The beginning of topics that its service answers with.
constexpr std::string_view kRepublished = "/tf2_web_republisher/tf_repub_";

/// Smaller fragments would be heads for the greater part.
constexpr std::size_t kMinFragment = 256;
constexpr std::size_t kMaxWishes = 1024, kMaxIds = 64, kMaxAdvertised = 256;

const nlohmann::json& memberOf(const nlohmann::json& value, const char* name) {
    static const nlohmann::json null;
    const auto found = value.find(name);
    return found == value.end() ? null : *found;
}

/// Returns a text; "" for anything else.
std::string wordOf(const nlohmann::json& value, const char* name) {
    const auto* const text = memberOf(value, name).get_ptr<const std::string*>();
    return text == nullptr ? "" : *text;
}

/// Returns the id of a request, a text or a number, as JSON; "" if it has none.
std::string idOf(const nlohmann::json& request) {
    const nlohmann::json& id = memberOf(request, "id");
    return id.is_string() || id.is_number() ? id.dump() : "";
}

/// Returns a number from 0 to `most`; 0 if it is absent or negative.
double figureOf(const nlohmann::json& value, const char* name, double most) {
    const nlohmann::json& one = memberOf(value, name);
    return one.is_number() ? std::clamp(one.get<double>(), 0.0, most) : 0;
}

/// Returns a name with one leading slash, as topics are called here.
std::string absolute(const std::string& name) { return name.starts_with('/') ? name : "/" + name; }

/// Returns the member of an answer with an id of idOf(), after a comma; "" for no id.
std::string idMember(const std::string& id) { return id.empty() ? "" : ",\"id\":" + id; }

/// Returns true if a message of this type has all members of the object.
bool hasMembersOf(const nlohmann::json& message, RosType type) {
    const std::vector<RosField>& fields = rosFields(type).fields;
    return std::ranges::all_of(message.items(), [&](const auto& item) {
        return std::ranges::any_of(fields,
                                   [&](const RosField& field) { return field.name == item.key(); });
    });
}

/// Begins a message of a topic in CBOR; its value is to follow.
std::string cborPublication(const std::string& topic) {
    std::string out;
    appendCborHead(out, CborHead::Map, 3);
    for (const std::string_view text :
         {std::string_view("op"), std::string_view("publish"), std::string_view("topic"),
          std::string_view(topic), std::string_view("msg")})
        appendCborText(out, text);
    return out;
}

/// Cuts a text into pieces of about so many bytes, between characters.
std::vector<std::string_view> piecesOf(std::string_view text, std::size_t size) {
    constexpr unsigned kMask = 0xc0, kInside = 0x80;  // of bytes within a character of UTF-8
    std::vector<std::string_view> pieces;
    while (!text.empty()) {
        std::size_t end = std::min(size, text.size());
        while (end < text.size() && (static_cast<unsigned char>(text[end]) & kMask) == kInside)
            ++end;
        pieces.push_back(text.substr(0, end));
        text.remove_prefix(end);
    }
    return pieces;
}

/// Returns a message as a PNG whose samples are its text, with blanks up to a rectangle.
std::string inPng(std::string text) {
    constexpr double kSamples = 3;
    const auto size = static_cast<double>(text.size());
    const double columns = std::max(1.0, std::floor(std::sqrt(size / kSamples)));
    const double rows = std::ceil(size / kSamples / columns);
    text.resize(static_cast<std::size_t>(kSamples * columns * rows), ' ');
    const std::string png =
        pngOfRgb(static_cast<int>(columns), static_cast<int>(rows),
                 std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
    JsonWriter json;
    json.beginObject().key("op").value("png").key("data").value(base64(png));
    return json.endObject().take();
}

}  // namespace

std::size_t RosbridgeDialogue::Wish::count() const {
    std::size_t count = 0;
    for (const auto& [name, ids] : names) count += ids.size();
    return count;
}

RosbridgeDialogue::Form RosbridgeDialogue::formOf(const Wish::Ids& ids) {
    Form form = Form::Json;
    for (const auto& [id, one] : ids) form = std::max(form, one.form);
    return form;
}

/// Clients find their topic by the name that they asked for.
web::WebMessage RosbridgeDialogue::write(std::uint32_t /*key*/, const RosFeed::Entry& topic,
                                         const RosMessage& message) {
    const auto wish = wishes_.find(topic.channel.topic);
    if (wish == wishes_.end()) return publication(topic.channel.topic, Form::Json, message);
    std::vector<web::WebMessage> all;
    for (const auto& [name, ids] : wish->second.names)
        for (web::WebMessage& one : publications(name, ids, message)) all.push_back(std::move(one));
    web::WebMessage first = std::move(all.front());
    all.erase(all.begin());
    // They come next: this is written only when all else is sent.
    sendParts(std::move(all));
    return first;
}

/// Returns a message, or the fragments of its text if that is longer than they shall be.
std::vector<web::WebMessage> RosbridgeDialogue::publications(const std::string& name,
                                                             const Wish::Ids& ids,
                                                             const RosMessage& message) {
    std::vector<web::WebMessage> out;
    out.push_back(publication(name, formOf(ids), message));
    std::size_t size = 0;
    for (const auto& [id, one] : ids)
        if (one.fragment > 0 && (size == 0 || one.fragment < size)) size = one.fragment;
    if (size == 0 || !out.front().is_text || out.front().size() <= size) return out;
    const web::WebMessage& whole = out.front();
    const std::string text = whole.head + (whole.body ? *whole.body : "") + whole.tail;
    const std::vector<std::string_view> pieces = piecesOf(text, size);
    const std::string id = std::to_string(next_fragmented_++);
    std::vector<web::WebMessage> fragments;
    fragments.reserve(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        JsonWriter json;
        json.beginObject().key("op").value("fragment").key("id").value(id);
        json.key("data").value(pieces[i]).key("num").value(i).key("total").value(pieces.size());
        fragments.push_back({.head = json.endObject().take()});
    }
    return fragments;
}

web::WebMessage RosbridgeDialogue::publication(const std::string& name, Form form,
                                               const RosMessage& message) {
    if (form == Form::Json || form == Form::Png) {
        JsonWriter head;
        head.beginObject().key("op").value("publish").key("topic").value(name).key("msg");
        if (form == Form::Png) return {.head = inPng(head.take() + *message.json() + '}')};
        return {.head = head.take(), .body = message.json(), .tail = "}"};
    }
    std::string head = cborPublication(name);
    if (form == Form::Cbor)
        return {.head = std::move(head), .body = message.cbor(), .is_text = false};
    constexpr std::uint64_t kSecond = 1'000'000'000;
    appendCborHead(head, CborHead::Map, 3);
    appendCborText(head, "secs");
    appendCborHead(head, CborHead::Unsigned, message.time() / kSecond);
    appendCborText(head, "nsecs");
    appendCborHead(head, CborHead::Unsigned, message.time() % kSecond);
    appendCborText(head, "bytes");
    appendCborHead(head, CborHead::Bytes, message.cdr()->size());
    return {.head = std::move(head), .body = message.cdr(), .is_text = false};
}

void RosbridgeDialogue::report(Level level, const std::string& text, const std::string& id) {
    constexpr std::array<const char*, 3> kLevels{"info", "warning", "error"};
    JsonWriter json;
    json.beginObject().key("op").value("status");
    json.key("level").value(kLevels[static_cast<std::size_t>(level)]).key("msg").value(text);
    sendText(json.take() + idMember(id) + '}');
}

struct RosbridgeDialogue::Op {
    std::string_view name;
    void (RosbridgeDialogue::*obey)(const Json& request);
};

void RosbridgeDialogue::receive(std::string_view message, bool is_text) {
    using Self = RosbridgeDialogue;
    static constexpr std::array<Op, 11> kOps{{{"subscribe", &Self::subscribeTo},
                                              {"unsubscribe", &Self::unsubscribeFrom},
                                              {"advertise", &Self::advertise},
                                              {"unadvertise", &Self::unadvertise},
                                              {"publish", &Self::publish},
                                              {"call_service", &Self::callService},
                                              {"send_action_goal", &Self::sendGoal},
                                              {"cancel_action_goal", &Self::cancelGoal},
                                              {"set_level", &Self::ignore},
                                              {"status", &Self::ignore},
                                              {"auth", &Self::ignore}}};
    // The world may have changed since the last step.
    feed().sync();
    if (!is_text) return report(Level::Error, "requests are JSON, in messages of text");
    const std::optional<Json> request = parseClientJson(message);
    if (!request || !request->is_object()) return report(Level::Error, "this is no JSON object");
    const std::string name = wordOf(*request, "op"), id = idOf(*request);
    const auto* const op =
        std::find_if(kOps.begin(), kOps.end(), [&](const Op& one) { return one.name == name; });
    if (op == kOps.end()) return report(Level::Error, "op " + excerpt(name) + " is not served", id);
    try {
        (this->*op->obey)(*request);
    } catch (const FormatError& error) {
        report(Level::Error, error.diagnostics().front().message, id);
    }
}

// Topics.

void RosbridgeDialogue::subscribeTo(const Json& request) {
    constexpr double kMaxMilliseconds = 1e6, kMaxQueue = 1000;
    const std::string topic = absolute(wordOf(request, "topic")), id = idOf(request),
                      form = wordOf(request, "compression");
    const bool is_new = !wishes_.contains(topic);
    if (is_new && wishes_.size() >= kMaxWishes)
        return report(Level::Error, "too many subscriptions", id);
    if (!is_new && wishes_.at(topic).count() >= kMaxIds)
        return report(Level::Error, "too many subscriptions", id);
    if (const auto type = rosTypeNamed(wordOf(request, "type")))
        for (const std::uint32_t number : feed().numbersOf(topic)) {
            const RosChannel& channel = feed().entries().at(number).channel;
            if (!channel.isInput() && channel.type != *type)
                return report(Level::Error,
                              excerpt(topic) + " is of type " + std::string(nameOf(channel.type)) +
                                  ", not " + std::string(nameOf(*type)),
                              id);
        }
    Wish& wish = wishes_[topic];
    const double wait = figureOf(request, "throttle_rate", kMaxMilliseconds);
    const auto fragment = static_cast<std::size_t>(figureOf(request, "fragment_size", 1e9));
    wish.names[wordOf(request, "topic")][id] = {
        std::chrono::milliseconds(std::llround(wait)),
        static_cast<std::size_t>(figureOf(request, "queue_length", kMaxQueue)),
        form == "cbor"       ? Form::Cbor
        : form == "cbor-raw" ? Form::Raw
        : form == "png"      ? Form::Png
                             : Form::Json,
        fragment > 0 ? std::max(fragment, kMinFragment) : 0};
    apply(topic, wish);
    const auto republished =
        std::ranges::find(republished_, topic, &std::pair<std::string, Json>::first);
    if (republished != republished_.end() && !transform_actions_.contains(topic))
        beginTransforms(topic, "", republished->second);
}

/// Subscribes to a topic with the least interval and the shortest queue of its requests.
/// \param is_new a request has come, to which the newest message goes
void RosbridgeDialogue::apply(const std::string& topic, const Wish& wish, bool is_new) {
    for (const std::uint32_t number : feed().numbersOf(topic)) {
        const RosFeed::Entry& entry = feed().entries().at(number);
        // Orders of clients can be read, as they are topics in ROS, too.
        if (entry.channel.isInput() && entry.channel.row == nullptr) continue;
        Subscription subscription{.topic = number};
        subscription.interval = std::chrono::nanoseconds::max();
        subscription.depth = std::numeric_limits<std::size_t>::max();
        for (const auto& [name, ids] : wish.names)
            for (const auto& [id, one] : ids) {
                subscription.interval = std::min(subscription.interval, one.interval);
                subscription.depth = std::min(subscription.depth, one.depth);
            }
        if (subscription.depth == 0) subscription.depth = entry.channel.quality.depth;
        if (!is_new && adjust(number, subscription)) continue;
        if (!subscribe(number, std::move(subscription)))
            report(Level::Error, "too many subscriptions");
    }
}

void RosbridgeDialogue::unsubscribeFrom(const Json& request) {
    const std::string topic = absolute(wordOf(request, "topic")), id = idOf(request);
    const auto wish = wishes_.find(topic);
    if (wish == wishes_.end()) return;
    auto& names = wish->second.names;
    auto found = names.find(wordOf(request, "topic"));
    if (found == names.end() && names.size() == 1) found = names.begin();
    if (found == names.end()) return;
    found->second.erase(id);
    // Without an id all requests by this name end.
    if (id.empty() || found->second.empty()) names.erase(found);
    if (!names.empty()) return apply(topic, wish->second, false);
    wishes_.erase(wish);
    for (const std::uint32_t number : feed().numbersOf(topic)) unsubscribe(number);
    const auto gone = std::ranges::find(republished_, topic, &std::pair<std::string, Json>::first);
    if (gone == republished_.end()) return;
    republished_.erase(gone);
    if (transforms_.end(topic)) transform_actions_.erase(topic);
}

void RosbridgeDialogue::topicsChanged() {
    // Numbers grow: those after the newest known one are new.
    const RosFeed::Entries& entries = feed().entries();
    for (auto entry = entries.upper_bound(newest_); entry != entries.end(); ++entry) {
        newest_ = entry->first;
        const auto wish = wishes_.find(entry->second.channel.topic);
        if (wish != wishes_.end() && !hasSubscription(entry->first))
            apply(wish->first, wish->second);
    }
}

void RosbridgeDialogue::advertise(const Json& request) {
    const std::string topic = absolute(wordOf(request, "topic")), id = idOf(request);
    if (topic.starts_with(kRepublisher)) return;
    const auto type = rosTypeNamed(wordOf(request, "type"));
    if (!type || input(topic, *type) == nullptr)
        return report(
            Level::Error,
            "no messages " + excerpt(wordOf(request, "type")) + " are read from " + excerpt(topic),
            id);
    if (advertised_.size() >= kMaxAdvertised && !advertised_.contains(topic))
        return report(Level::Error, "too many topics are advertised", id);
    advertised_[topic] = *type;
}

void RosbridgeDialogue::unadvertise(const Json& request) {
    advertised_.erase(absolute(wordOf(request, "topic")));
}

void RosbridgeDialogue::publish(const Json& request) {
    const std::string topic = absolute(wordOf(request, "topic"));
    const Json& message = memberOf(request, "msg");
    if (publishTransforms(topic, message)) return;
    const auto known = advertised_.find(topic);
    const RosChannel* channel = nullptr;
    if (known != advertised_.end()) {
        channel = input(topic, known->second);
    } else {
        // Inputs of one topic differ in their types: the first that has the message's members.
        for (const std::uint32_t number : feed().numbersOf(topic)) {
            const RosChannel& one = feed().entries().at(number).channel;
            if (!one.isInput()) continue;
            if (channel == nullptr) channel = &one;
            if (!hasMembersOf(message, one.type)) continue;
            channel = &one;
            break;
        }
    }
    if (channel == nullptr)
        return report(Level::Error, "no messages are read from " + excerpt(topic), idOf(request));
    orders().obey(*channel, rosMessage(channel->type, message));
}

// Actions.

namespace {

void writeTime(JsonWriter& json, const char* name, SimTime time) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    json.key(name).beginObject().key("sec").value(std::int64_t{time.count() / kSecond});
    json.key("nanosec").value(std::int64_t{time.count() % kSecond}).endObject();
}

}  // namespace

/// The goal of an action is one of the robot's topic goal_pose.
void RosbridgeDialogue::sendGoal(const Json& request) {
    Goal goal{.id = idOf(request), .action = wordOf(request, "action"), .number = next_goal_++};
    const std::string name = absolute(goal.action), type = wordOf(request, "action_type");
    if (name == kRepublisher)
        return beginTransforms(wordOf(request, "id"), goal.action, memberOf(request, "args"));
    const bool is_known =
        name.ends_with(kNavigate) && (type.empty() || type == "nav2_msgs/action/NavigateToPose" ||
                                      type == "nav2_msgs/NavigateToPose");
    const RosChannel* const channel =
        is_known ? input(name.substr(0, name.size() - kNavigate.size()) + std::string(kGoalTopic),
                         RosType::PoseStamped)
                 : nullptr;
    if (channel == nullptr)
        return answerGoal(goal, kUnknown,
                          "there is no action " + excerpt(name) +
                              (type.empty() ? "" : " of type " + excerpt(type)));
    const Json& args = memberOf(request, "args");
    const Json& watched = memberOf(request, "feedback");
    goal.is_watched = watched.is_boolean() && watched.get<bool>();
    goal.started = goal.told = state().simulation().world().time();
    const std::string robot = orders().robotOf(*channel);
    std::string refusal;
    try {
        if (!args.is_object() || !memberOf(args, "pose").is_object())
            refusal = "the goal has no pose";
        else
            refusal = orders().pursue(
                *channel, rosMessage(RosType::PoseStamped, memberOf(args, "pose")),
                [this, robot, number = goal.number](RosGoalEnd end, const std::string& why) {
                    endGoal(robot, number, end, why);
                });
    } catch (const FormatError& error) {
        refusal = error.diagnostics().front().message;
    }
    if (!refusal.empty()) return answerGoal(goal, kUnknown, refusal);
    goals_[robot] = std::move(goal);
}

void RosbridgeDialogue::cancelGoal(const Json& request) {
    const std::string id = idOf(request), action = wordOf(request, "action");
    if (const auto found = transform_actions_.find(wordOf(request, "id"));
        transforms_.end(wordOf(request, "id"))) {
        answerGoal({.id = id, .action = found->second}, kCanceled, "");
        transform_actions_.erase(found);
        return;
    }
    const auto found = std::ranges::find_if(goals_, [&](const auto& one) {
        return one.second.id == id &&
               (action.empty() || absolute(action) == absolute(one.second.action));
    });
    const std::string why = found == goals_.end() ? "this goal is not under way"
                                                  : orders().cancel(std::string(found->first));
    if (!why.empty()) report(Level::Error, why, id);
}

/// Cancels the goals of the action that a service of ROS 2 names. \returns false for other services
bool RosbridgeDialogue::cancelAll(const std::string& service) {
    const std::string cancel = std::string(kNavigate) + "/_action/cancel_goal";
    if (!service.ends_with(cancel)) return false;
    const std::string robot_topics = service.substr(0, service.size() - cancel.size());
    if (input(robot_topics + std::string(kGoalTopic), RosType::PoseStamped) == nullptr)
        return false;
    std::vector<std::string> robots;
    for (const auto& [robot, goal] : goals_)
        if (service.starts_with(absolute(goal.action) + "/")) robots.push_back(robot);
    for (const std::string& robot : robots)
        if (const std::string why = orders().cancel(robot); !why.empty()) report(Level::Error, why);
    return true;
}

/// A goal of tf2_web_republisher lasts until it is cancelled; the poses are its feedback.
void RosbridgeDialogue::beginTransforms(const std::string& id, const std::string& action,
                                        const Json& arguments) {
    const std::string refusal = transforms_.begin(id, arguments);
    if (refusal.empty())
        transform_actions_[id] = action;
    else if (action.empty())
        report(Level::Error, "a goal of " + std::string(kRepublisher) + ": " + refusal);
    else
        answerGoal({.id = JsonWriter().value(id).take(), .action = action}, kUnknown, refusal);
}

/// Takes goals and their cancellations by topics, as clients of ROS 1 send them. \returns false for
/// other topics
bool RosbridgeDialogue::publishTransforms(const std::string& topic, const Json& message) {
    if (!topic.starts_with(kRepublisher) || !message.is_object()) return false;
    const std::string what = topic.substr(kRepublisher.size());
    if (what == "/goal") {
        const Json& id = memberOf(message, "goal_id");
        beginTransforms(id.is_object() ? wordOf(id, "id") : "", "", memberOf(message, "goal"));
        return true;
    }
    if (what != "/cancel") return false;
    const std::string id = wordOf(message, "id");
    if (transforms_.end(id)) transform_actions_.erase(id);
    return true;
}

void RosbridgeDialogue::notifyTransforms(const std::string& id, const std::string& feedback) {
    const std::string text_id = JsonWriter().value(id).take(), &action = transform_actions_[id];
    JsonWriter json;
    json.beginObject();
    if (!action.empty()) {
        json.key("op").value("action_feedback").key("action").value(action).key("values");
        return sendText(json.take() + feedback + idMember(text_id) + '}');
    }
    const bool is_republished = id.starts_with(kRepublished);
    const std::string topic = is_republished ? id : std::string(kRepublisher) + "/feedback";
    const auto wish = wishes_.find(topic);
    json.key("op").value("publish").key("topic");
    json.value(wish == wishes_.end() ? topic : wish->second.names.begin()->first).key("msg");
    if (is_republished) return sendText(json.take() + feedback + '}');
    sendText(json.take() + R"({"status":{"status":1,"goal_id":{"id":)" + text_id +
             R"(}},"feedback":)" + feedback + "}}");
}

/// Takes a request of the service republish_tfs, for poses on a separate topic, which begin
/// with the subscription to it. Of requests without one the oldest gives way. \returns the topic;
/// "" if there are too many
std::string RosbridgeDialogue::republish(const Json& arguments) {
    if (republished_.size() >= TransformGoals::kMostGoals) {
        const auto unread = std::ranges::find_if(
            republished_, [&](const auto& one) { return !wishes_.contains(one.first); });
        if (unread == republished_.end()) return "";
        republished_.erase(unread);
    }
    republished_.emplace_back(std::string(kRepublished) + std::to_string(next_republished_++),
                              arguments);
    return republished_.back().first;
}

void RosbridgeDialogue::endGoal(const std::string& robot, std::int64_t number, RosGoalEnd end,
                                const std::string& why) {
    const auto found = goals_.find(robot);
    if (found == goals_.end() || found->second.number != number) return;
    const Goal goal = std::move(found->second);
    goals_.erase(found);
    answerGoal(goal, statusOf(end), why);
}

/// Sends the result of a goal: of a refused one the reason.
void RosbridgeDialogue::answerGoal(const Goal& goal, int status, const std::string& error) {
    JsonWriter json;
    json.beginObject().key("op").value("action_result").key("action").value(goal.action);
    json.key("values");
    if (status == kUnknown) {
        json.value(error);
    } else {
        json.beginObject().key("error_code").value(status == kAborted ? 1 : 0);
        json.key("error_msg").value(error).endObject();
    }
    json.key("status").value(status).key("result").value(status != kUnknown);
    sendText(json.take() + idMember(goal.id) + '}');
}

void RosbridgeDialogue::notifyProgress(const std::string& robot, Goal& goal) {
    const auto progress = orders().progress(robot);
    if (!progress) return;
    constexpr double kStanding = 0.01;
    const SimTime now = state().simulation().world().time();
    goal.told = now;
    const std::string room = state().worlds()[progress->room].id;
    const double half = progress->pose.heading.radians() / 2;
    JsonWriter json;
    json.beginObject().key("op").value("action_feedback").key("action").value(goal.action);
    json.key("values").beginObject().key("current_pose").beginObject();
    json.key("header").beginObject();
    writeTime(json, "stamp", now);
    json.key("frame_id").value(room.empty() ? std::string(kRosWorld) : rosName(room)).endObject();
    json.key("pose").beginObject().key("position").beginObject();
    json.key("x").value(progress->pose.position.x).key("y").value(progress->pose.position.y);
    json.key("z").value(0.0).endObject().key("orientation").beginObject();
    json.key("x").value(0.0).key("y").value(0.0).key("z").value(std::sin(half));
    json.key("w").value(std::cos(half)).endObject().endObject().endObject();
    writeTime(json, "navigation_time", now - goal.started);
    const double left = progress->speed > kStanding ? progress->distance / progress->speed : 0;
    writeTime(json, "estimated_time_remaining", SimTime(std::llround(left * 1e9)));
    json.key("number_of_recoveries").value(0);
    json.key("distance_remaining").value(progress->distance).endObject();
    sendText(json.take() + idMember(goal.id) + '}');
}

/// Feedback comes twice in a simulated second, but not to a client that is behind.
void RosbridgeDialogue::stepped() {
    constexpr SimTime kPeriod = std::chrono::milliseconds(500);
    RosDialogue::stepped();
    if (hasAnswers()) return;
    transforms_.stepped([this](const std::string& id, const std::string& feedback) {
        notifyTransforms(id, feedback);
    });
    const SimTime now = state().simulation().world().time();
    for (auto& [robot, goal] : goals_)
        if (goal.is_watched && now - goal.told >= kPeriod) notifyProgress(robot, goal);
}

// Services.

void RosbridgeDialogue::callService(const Json& request) {
    const std::string service = wordOf(request, "service"), id = idOf(request),
                      name = absolute(service);
    if (const auto values = rosApi(feed(), state().simulation(), std::string_view(name).substr(1),
                                   memberOf(request, "args")))
        return answer(id, service, true, *values);
    if (name == "/rosapi/set_param") return setParameter(memberOf(request, "args"), id, service);
    if (cancelAll(name)) return answer(id, service, true, "{}");
    if (name == "/republish_tfs" || name == std::string(kRepublisher) + "/republish_tfs") {
        const std::string topic = republish(memberOf(request, "args"));
        if (topic.empty())
            return answer(id, service, false, JsonWriter().value("too many requests").take());
        JsonWriter json;
        json.beginObject().key("topic_name").value(topic).endObject();
        return answer(id, service, true, json.take());
    }
    const auto services = rosServices();
    const auto found = std::find_if(services.begin(), services.end(),
                                    [&](const RosService& one) { return one.name == name; });
    const auto fail = [this, id, service](std::string_view why) {
        answer(id, service, false, JsonWriter().value(why).text());
    };
    if (found == services.end()) return fail("there is no service " + excerpt(service));
    if (!orders().mayRequest()) return fail("too many calls at once");
    orders().request(std::string(found->request),
                     [this, id, service, fail](bool is_done, std::string_view text) {
                         is_done ? answer(id, service, true, "{}") : fail(text);
                     });
}

/// Sets a parameter to a value, which is JSON within a text, as of rosapi in ROS 2.
void RosbridgeDialogue::setParameter(const Json& arguments, const std::string& id,
                                     const std::string& service) {
    const auto respond = [this, id, service](const std::string& reason) {
        JsonWriter json;
        json.beginObject().key("successful").value(reason.empty()).key("reason").value(reason);
        answer(id, service, true, json.endObject().take());
    };
    const std::string name = parameterNamed(wordOf(arguments, "name"));
    const Json value = Json::parse(wordOf(arguments, "value"), nullptr, false);
    const RosSetting setting = settingOf(state(), name, value);
    if (!setting.refusal.empty()) return respond(setting.refusal);
    // PAUSE and RESUME themselves do not need it.
    if (!orders().hasToken())
        return respond(excerpt(name) + " needs the token of this run: ?token=x");
    if (!orders().mayRequest()) return respond("too many calls at once");
    orders().request(setting.request, [respond](bool is_done, std::string_view text) {
        respond(is_done ? "" : std::string(text));
    });
}

/// \param values JSON; for a failure the reason as a text of JSON
void RosbridgeDialogue::answer(const std::string& id, std::string_view service, bool is_done,
                               std::string_view values) {
    JsonWriter json;
    json.beginObject().key("op").value("service_response");
    json.key("service").value(service).key("result").value(is_done).key("values");
    send({.head = json.take(),
          .body = std::make_shared<const std::string>(values),
          .tail = idMember(id) + '}'});
}

}  // namespace ispace::ros

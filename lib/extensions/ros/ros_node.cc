// SPDX-License-Identifier: GPL-3.0-or-later
// A node without rcl: names and types are mangled as rmw does (design.ros2.org, "Topic and Service
// name mapping to DDS"), and the graph is told by ros_discovery_info. Messages go out in bursts of
// 32 KiB with pauses of 1 ms, since sockets of peers hold few packets.
#include "extensions/ros/ros_node.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "extensions/ros/ros_parameters.h"
#include "extensions/ros/ros_queries.h"
#include "extensions/ros/ros_type_hash.h"
#include "raster/codec.h"
#include "sense/formats/cdr.h"

namespace ispace::ros {

namespace {

/// Parameters that a request may set.
constexpr std::size_t kMostParameters = 16;
/// A peer's socket holds some 90 packets by custom, which the scans of a hundred robots exceed at
/// once.
constexpr std::size_t kBurst = std::size_t{1} << 15U;
constexpr auto kPause = std::chrono::milliseconds(1);

std::unique_ptr<DdsParticipant> openModule(const DdsSettings& settings) {
    std::string error;
    void* const found = moduleSymbol("dds.so", kOpenDds, error);
    if (found == nullptr)
        throw FormatError(Diagnostic{
            "", 0, 0, "--ros2 needs Cyclone DDS (Debian: libddsc0debian): " + printable(error)});
    std::unique_ptr<DdsParticipant> out;
    reinterpret_cast<OpenDds*>(found)(settings, out);
    return out;
}

/// Appends a node's description as since Iron: ids have 16 bytes.
void putIds(CdrWriter& out, const std::vector<DdsGuid>& ids) {
    out.count(ids.size());
    for (const DdsGuid& id : ids) out.array(std::span<const std::uint8_t>(id));
}

}  // namespace

RosNode::RosNode(ServerState& state, RosFeed& feed, const DdsSettings& settings)
    : RosNode(state, feed, openModule(settings)) {}

RosNode::RosNode(ServerState& state, RosFeed& feed, std::unique_ptr<DdsParticipant> participant)
    : feed_(&feed),
      orders_(state, [](const std::string& /*error*/) {}),
      participant_(std::move(participant)) {
    graph_ =
        participant_->addWriter({.name = "ros_discovery_info",
                                 .type = ddsTypeOf("rmw_dds_common/msg/ParticipantEntitiesInfo"),
                                 .is_latched = true});
    addServices();
    actions_.emplace(state, feed, orders_, *participant_);
    sync();
}

RosNode::~RosNode() {
    for (const auto& [topic, end] : ends_)
        if (end.is_wanted) feed_->unwant(topic);
}

void RosNode::addServices() {
    const auto add = [this](std::string_view name, std::string_view type, auto serve) {
        services_.push_back({RosServer(*participant_, name, type), std::move(serve)});
    };
    for (const RosService& service : rosServices())
        add(service.name, kRosEmptyService,
            [this, request = std::string(service.request)](const RosServer& server,
                                                           const RosCall& call) {
                carryOut(request, server, call.caller);
            });
    for (const RosQuery& query : rosQueries())
        add(query.name, query.type, [this, &query](const RosServer& server, const RosCall& call) {
            CdrReader in(call.content);
            CdrWriter out;
            query.answer(in, feed_->state(), out);
            server.answer(call.caller, out.take());
        });
    for (const bool is_atomic : {false, true})
        add(is_atomic ? "/simrun/set_parameters_atomically" : "/simrun/set_parameters",
            is_atomic ? "rcl_interfaces/srv/SetParametersAtomically"
                      : "rcl_interfaces/srv/SetParameters",
            [this, is_atomic](const RosServer& server, const RosCall& call) {
                set(server, call, is_atomic);
            });
}

/// Adapts to the topics of a changed world.
void RosNode::sync() {
    feed_->sync();
    if (std::exchange(version_, feed_->version()) == feed_->version()) return;
    std::erase_if(ends_, [this](const auto& one) {
        if (feed_->entries().contains(one.first)) return false;
        participant_->remove(one.second.number);
        return true;
    });
    left_out_ = 0;
    for (const auto& [number, entry] : feed_->entries()) {
        if (ends_.contains(number)) continue;
        if (ends_.size() < kMostTopics)
            add(number, entry.channel);
        else
            ++left_out_;
    }
    actions_->sync();
    notifyGraph();
}

void RosNode::add(std::uint32_t topic, const RosChannel& channel) {
    const DdsTopic dds{.name = ddsTopicOf("rt", channel.topic),
                       .type = ddsTypeOf(nameOf(channel.type)),
                       .depth = channel.quality.depth,
                       // A reader of best effort accepts writers of both kinds; a reliable writer
                       // serves readers of both.
                       .is_reliable = !channel.isInput(),
                       .is_latched = channel.quality.is_latched,
                       .user_data = "typehash=" + rosTypeHash(channel.type) + ";"};
    const bool is_input = channel.isInput();
    const int number = is_input ? participant_->addReader(dds) : participant_->addWriter(dds);
    ends_[topic] = {.number = number, .is_input = is_input};
}

/// Names the node and its topics, for `ros2 node list`.
void RosNode::notifyGraph() {
    std::vector<DdsGuid> readers, writers;
    for (const auto& [topic, end] : ends_) {
        (end.is_input ? readers : writers).push_back(participant_->guid(end.number));
    }
    for (const Service& service : services_) service.server.addEnds(readers, writers);
    actions_->addEnds(readers, writers);
    CdrWriter out;
    const DdsGuid own = participant_->guid();
    out.array(std::span<const std::uint8_t>(own)).count(1).put("/").put("simrun");
    putIds(out, readers);
    putIds(out, writers);
    participant_->write(graph_, out.take());
}

void RosNode::lookForReaders() {
    for (auto& [topic, end] : ends_) {
        if (end.is_input) continue;
        const bool is_read = participant_->isRead(end.number);
        if (std::exchange(end.is_wanted, is_read) == is_read) continue;
        is_read ? feed_->want(topic) : feed_->unwant(topic);
    }
}

/// Sends new messages, in turn, until a burst is full; the rest follows after a pause.
void RosNode::send() {
    const WallTime now = std::chrono::steady_clock::now();
    if (now < next_send_) return;
    std::size_t sent = 0;
    const auto send_from = [&](auto end, auto last) {
        for (; end != last; ++end) {
            if (!end->second.is_wanted) continue;
            const auto& newest = feed_->entries().at(end->first).newest;
            if (!newest || end->second.last == newest->number()) continue;
            if (sent > 0 && sent + newest->cdr()->size() > kBurst) return end;
            participant_->write(end->second.number, *newest->cdr());
            end->second.last = newest->number();
            sent += newest->cdr()->size();
        }
        return last;
    };
    const auto first = ends_.lower_bound(turn_);
    auto stopped = send_from(first, ends_.end());
    has_unsent_ = stopped != ends_.end();
    if (!has_unsent_) {
        stopped = send_from(ends_.begin(), first);
        has_unsent_ = stopped != first;
    }
    turn_ = has_unsent_ ? stopped->first : 0;
    if (has_unsent_) next_send_ = now + kPause;
}

void RosNode::stepped() {
    if (!participant_) return;
    sync();
    feed_->stepped();
    send();
    orders_.stepped();
    actions_->stepped();
}

void RosNode::serve() {
    if (!participant_) return;
    orders_.proceed();
    if (!participant_->changed()) {
        if (!has_unsent_) return;
        sync();
        return send();
    }
    sync();
    lookForReaders();
    send();
    takeOrders();
    for (const Service& service : services_)
        service.server.serve([&](const RosCall& call) { service.serve(service.server, call); });
    actions_->serve();
}

void RosNode::takeOrders() {
    for (const auto& [topic, end] : ends_) {
        if (!end.is_input) continue;
        for (const DdsMessage& message : participant_->take(end.number)) {
            feed_->sync();  // an earlier order may have changed the world
            const auto found = feed_->entries().find(topic);
            if (found == feed_->entries().end()) break;
            try {
                orders_.obey(found->second.channel, message.bytes);
            } catch (const FormatError&) {
                continue;  // too short: no order
            }
        }
    }
}

/// Makes a request of the protocol, and answers the caller once it is done.
void RosNode::carryOut(const std::string& request, const RosServer& server,
                       const RosCaller& caller) {
    if (!orders_.mayRequest()) return;
    orders_.request(request, [self = std::weak_ptr(self_), server, caller](
                                 bool is_done, std::string_view /*text*/) {
        const auto node = self.lock();
        if (node && is_done && (*node)->participant_) server.answer(caller, kRosEmpty);
    });
}

/// Sets parameters, and answers once each is set or refused.
void RosNode::set(const RosServer& server, const RosCall& call, bool is_atomic) {
    CdrReader in(call.content);
    const auto parameters = readParameters(in);
    struct Outcome {
        std::vector<std::string> refusals;  // "" for a parameter that is set
        std::size_t open = 0;
    };
    const auto outcome = std::make_shared<Outcome>();
    outcome->refusals.resize(parameters.size());
    outcome->open = parameters.size() + 1;
    const auto settle = [self = std::weak_ptr(self_), server, caller = call.caller, is_atomic,
                         outcome] {
        const auto node = self.lock();
        if (--outcome->open > 0 || !node || !(*node)->participant_) return;
        CdrWriter out;
        if (!is_atomic) out.count(outcome->refusals.size());
        for (const std::string& refusal : outcome->refusals) {
            writeSetResult(refusal, out);
            if (is_atomic) break;
        }
        server.answer(caller, out.take());
    };
    for (std::size_t i = 0; i < parameters.size(); ++i) {
        std::string& refusal = outcome->refusals[i];
        RosSetting setting;
        if (is_atomic && parameters.size() > 1)
            refusal = "several parameters cannot be set at once: set each alone";
        else if (!orders_.hasToken())
            refusal = "nodes do not know the token of this run";
        else if (i >= kMostParameters || !orders_.mayRequest())
            refusal = "too many parameters at once";
        else
            setting = settingOf(feed_->state(), parameters[i].first, parameters[i].second);
        if (refusal.empty()) refusal = setting.refusal;
        if (!refusal.empty()) {
            settle();
            continue;
        }
        orders_.request(setting.request, [outcome, settle, i](bool is_done, std::string_view text) {
            if (!is_done) outcome->refusals[i] = text;
            settle();
        });
    }
    settle();
}

void RosNode::end() {
    orders_.finish();
    actions_.reset();
    participant_.reset();
}

}  // namespace ispace::ros

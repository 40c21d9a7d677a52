// SPDX-License-Identifier: GPL-3.0-or-later
#include "extensions/ros/ros_server.h"

#include "base/error.h"
#include "sense/formats/cdr.h"

namespace ispace::ros {

namespace {

constexpr std::size_t kServiceDepth = 10;
/// Of nodes over Cyclone; a multiple of the largest alignment.
constexpr std::size_t kServiceHeader = 16;

RosCall callOf(DdsMessage message) {
    const std::size_t head = kCdrHead.size();
    if (message.request || message.bytes.size() <= head + kServiceHeader)
        return {{message.request, ""}, std::move(message.bytes)};
    RosCall call{{std::nullopt, message.bytes.substr(head, kServiceHeader)},
                 std::move(message.bytes)};
    call.content.erase(head, kServiceHeader);
    return call;
}

}  // namespace

std::string ddsTopicOf(std::string_view prefix, std::string_view topic) {
    return std::string(prefix) + std::string(topic);
}

std::string ddsTypeOf(std::string_view type) {
    std::string out;
    const std::size_t last = type.rfind('/') + 1;
    for (const char c : type.substr(0, last)) c == '/' ? out += "::" : out += c;
    return out.append("dds_::").append(type.substr(last)).append("_");
}

RosServer::RosServer(DdsParticipant& participant, std::string_view name, std::string_view type)
    : participant_(&participant),
      reader_(participant.addReader({.name = ddsTopicOf("rq", name) + "Request",
                                     .type = ddsTypeOf(type) + "Request_",
                                     .depth = kServiceDepth})),
      writer_(participant.addWriter({.name = ddsTopicOf("rr", name) + "Reply",
                                     .type = ddsTypeOf(type) + "Response_",
                                     .depth = kServiceDepth})) {}

void RosServer::remove() const {
    participant_->remove(reader_);
    participant_->remove(writer_);
}

void RosServer::serve(const std::function<void(const RosCall& call)>& serve) const {
    for (DdsMessage& message : participant_->take(reader_)) {
        try {
            serve(callOf(std::move(message)));
        } catch (const FormatError&) {
            continue;  // too short: no request
        }
    }
}

void RosServer::answer(const RosCaller& caller, std::string_view message) const {
    if (caller.request) return participant_->answer(writer_, *caller.request, message);
    if (caller.header.empty()) return;
    participant_->write(writer_, std::string(message).insert(kCdrHead.size(), caller.header));
}

void RosServer::addEnds(std::vector<DdsGuid>& readers, std::vector<DdsGuid>& writers) const {
    readers.push_back(participant_->guid(reader_));
    writers.push_back(participant_->guid(writer_));
}

}  // namespace ispace::ros

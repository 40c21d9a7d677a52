// SPDX-License-Identifier: GPL-3.0-or-later
// Interface between lib/extensions/ros and the module that links Cyclone DDS.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/network.h"

namespace ispace::ros {

/// A topic as DDS knows it: "rt/scan", "sensor_msgs::msg::dds_::LaserScan_".
struct DdsTopic {
    std::string name, type;
    std::size_t depth = 1;    ///< messages kept
    bool is_reliable = true;  ///< else best effort
    bool is_latched = false;  ///< later readers get the last message
    std::string user_data = {};
};

struct DdsSettings {
    std::uint32_t domain = 0;
    /// Machines that may take part, besides this one. None: no packet leaves this machine.
    std::vector<Network> allowed = {};
    /// Called by threads of DDS when changed() has become true.
    std::function<void()> wake = {};
};

using DdsGuid = std::array<std::uint8_t, 16>;

/// The identity of a request that is not in its content, as nodes over Fast DDS send it.
struct DdsRequest {
    DdsGuid reader{};  ///< of the caller, for answers
    std::int64_t number = 0;
};

struct DdsMessage {
    std::string bytes;
    std::optional<DdsRequest> request = {};  ///< empty for messages other than such requests
};

/// A participant of DDS with its writers and readers, by numbers. Messages are CDR with its head.
/// All functions are for one thread, and none waits for peers.
class DdsParticipant {
  public:
    DdsParticipant() = default;
    DdsParticipant(const DdsParticipant&) = delete;
    DdsParticipant& operator=(const DdsParticipant&) = delete;
    /// Ends all threads of DDS.
    virtual ~DdsParticipant() = default;

    /// Return the number of the new writer or reader, an end. \throws std::runtime_error
    virtual int addWriter(const DdsTopic& topic) = 0;
    virtual int addReader(const DdsTopic& topic) = 0;
    virtual void remove(int end) = 0;
    /// Return the identity on the network, of the participant or of an end.
    [[nodiscard]] virtual DdsGuid guid() const = 0;
    [[nodiscard]] virtual DdsGuid guid(int end) const = 0;

    /// True once after readers have come or gone, or messages have arrived.
    virtual bool changed() = 0;
    /// True while a peer's reader is matched with the writer: else its messages need not be made.
    [[nodiscard]] virtual bool isRead(int writer) const = 0;
    /// Sends a message, or drops it if slow readers leave no room.
    virtual void write(int writer, std::string_view message) = 0;
    /// Sends the answer to a request, as write() does. Answers above 13.9 KB are dropped.
    virtual void answer(int writer, const DdsRequest& request, std::string_view message) = 0;
    /// Returns the messages that have arrived, at most the topic's depth.
    virtual std::vector<DdsMessage> take(int reader) = 0;
};

/// The module's function. \throws std::runtime_error with a message for people
using OpenDds = void(const DdsSettings& settings, std::unique_ptr<DdsParticipant>& out);
constexpr const char* kOpenDds = "ispaceOpenDds";

}  // namespace ispace::ros

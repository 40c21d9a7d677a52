// SPDX-License-Identifier: GPL-3.0-or-later
// Services as nodes of ROS 2 call them over DDS.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "extensions/ros/module/dds_participant.h"

namespace ispace::ros {

/// The names that nodes of ROS 2 give topics and types in DDS: "/scan" is "rt/scan",
/// "sensor_msgs/msg/LaserScan" is "sensor_msgs::msg::dds_::LaserScan_".
std::string ddsTopicOf(std::string_view prefix, std::string_view topic);
std::string ddsTypeOf(std::string_view type);

/// Where the answer to a request goes. Nodes over Cyclone DDS put the caller and a number before
/// the content of requests and of answers, those over Fast DDS beside it.
struct RosCaller {
    std::optional<DdsRequest> request;  ///< of a node over Fast DDS
    std::string header;                 ///< of one over Cyclone DDS; "" with neither
};
struct RosCall {
    RosCaller caller;
    std::string content;  ///< CDR with its head
};

/// The ends of a service: a reader of requests and a writer of answers. The participant outlives
/// all calls.
class RosServer {
  public:
    /// \param name "/reset" \param type "std_srvs/srv/Empty"
    RosServer(DdsParticipant& participant, std::string_view name, std::string_view type);
    /// Removes both ends.
    void remove() const;
    /// Calls serve(call) for each request that has arrived; one that ends too early for it is left.
    void serve(const std::function<void(const RosCall& call)>& serve) const;
    /// Sends an answer, CDR with its head. A caller that is not known gets none.
    void answer(const RosCaller& caller, std::string_view message) const;
    /// Appends the ends.
    void addEnds(std::vector<DdsGuid>& readers, std::vector<DdsGuid>& writers) const;

  private:
    DdsParticipant* participant_;
    int reader_, writer_;
};

}  // namespace ispace::ros

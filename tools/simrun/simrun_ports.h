// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/file.h"
#include "server/server.h"
#include "sim/simulation.h"
#include "simrun/simrun_options.h"

namespace ispace {

class RosBridge;

/// Addresses of the ports besides that of the protocol; "" without.
struct ServedAddresses {
    std::string web, foxglove, rosbridge;
    std::optional<int> ros_domain;  ///< of DDS
    DeviceAddresses devices;
    RosBridge* ros = nullptr;  ///< null without topics of ROS
};
/// Opens the ports that options ask for, and adds the roles of extensions to the protocol. \param
/// title of the room or the record \param replayed folders of the records that are replayed \throws
/// std::system_error, UsageError naming the option
ServedAddresses servePorts(Server& server, const SimrunOptions& options, const std::string& title,
                           const std::vector<std::string>& replayed);

/// Returns the name of the file of --mcap: for a folder, `run/`, that of a bag in it,
/// `run/run_0.mcap`; "" without.
std::string mcapFile(const SimrunOptions& options);
/// Returns that of the bag's metadata; "" without a folder.
std::string bagMetadataFile(const SimrunOptions& options);

/// The file of --mcap. It ends the run once it is larger than --record-limit.
class TopicLog {
  public:
    /// Call before the run. \throws std::system_error
    TopicLog(RosBridge& ros, Simulation& simulation, const SimrunOptions& options);
    TopicLog(const TopicLog&) = delete;
    TopicLog& operator=(const TopicLog&) = delete;
    ~TopicLog() = default;
    /// Completes the file after the run; warns of topics left out. \throws FormatError if the limit
    /// ended the run
    void commit();

  private:
    const RosBridge* ros_;
    const SimrunOptions* options_;
    std::string name_;
    OutputFile file_;
    std::uint64_t bytes_ = 0;
    SimTime end_ = kMaxTime;  // at which the file was full
};

/// Writes the first line of output: clients can connect now.
void announce(const Server& server, const ServedAddresses& addresses);

/// Says after the run how much slow readers have lost, if any.
void tellLosses(const Server& server, const SimrunOptions& options);

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/extension.h"
#include "cli/run_judge.h"
#include "server/device/wire_session.h"
#include "server/mqtt/mqtt_client.h"
#include "server/server.h"
#include "sim/record_form.h"
#include "sim/simulation.h"

namespace ispace {

/// Parses "10940" of this machine, or "127.0.0.2:10940". \throws UsageError
Endpoint parsePort(const std::string& text);

/// An option that serves a robot or sensor at the port of a real device.
struct DevicePortOption {
    const WireProtocol* protocol = nullptr;
    std::string id;
    Endpoint endpoint;
};

/// The options of device ports, one for each row of wireProtocols(), and their access rules.
class DevicePortOptions {
  public:
    void declare(CommandLine& line);
    /// Stores the options after parsing. \param has_others ports besides these heed --allow
    /// \throws UsageError
    void take(const CommandLine& line, bool has_others, ServerLimits& limits);
    [[nodiscard]] const std::vector<DevicePortOption>& ports() const { return ports_; }
    /// Returns the number of simultaneous connections to device ports.
    [[nodiscard]] std::size_t connections() const;

  private:
    std::map<const WireProtocol*, std::vector<std::string>> texts_;
    std::vector<std::string> allowed_;
    std::string clock_ = "simulated";
    std::vector<DevicePortOption> ports_;
};

/// Maps the id of a robot or sensor to its device port, by protocol.
using DeviceAddresses = std::map<const WireProtocol*, std::map<std::string, std::string>>;
/// \throws UsageError naming the option, std::system_error
DeviceAddresses serveDevices(Server& server, const DevicePortOptions& options);

/// Drawing of a record, for -o.
struct DrawingOptions {
    std::string format;          ///< png, svg, pdf, y4m or gif; "" without -o
    int width = 1200;            ///< pixels
    double fps = 25, speed = 1;  ///< of a film: pictures per second, simulated seconds per second
};

struct SimrunOptions {
    CommonOptions common;
    std::vector<std::string> operands;
    SceneRules rules;
    std::vector<std::string> zones;  ///< to add to those of the room
    Clock clock;
    SimTime step = std::chrono::milliseconds(5);
    std::optional<SimTime> until;
    bool noise = false;
    std::string script;                                     ///< "" without; "-" is stdin
    std::string report;                                     ///< page for people; "" without
    std::optional<int> suggestions;                         ///< at most so many; empty: none
    std::string record;                                     ///< folder; "" without
    std::uint64_t max_recorded = std::uint64_t{16} << 30U;  ///< bytes
    std::string replay;                                     ///< folder; "" without
    SimTime from{};                                         ///< of the replay
    bool holds = false;                                     ///< at the end of the replay
    DrawingOptions drawing;
    std::shared_ptr<JudgeExtensions> judges;
    std::string junit;  ///< file; "" without
    std::optional<bool> records_readings;
    double recorded_frames = 1;  ///< per simulated second, at most
    double recorded_sonars = 10;
    RecordForm record_form;
    std::string port_file;  ///< "" without
    Endpoint listen;
    std::optional<Endpoint> web, foxglove, rosbridge;
    bool web_edits = false;         ///< the page changes the room
    std::optional<int> ros_domain;  ///< of --ros2
    std::string ros_robot;          ///< "": the only one
    bool rmf = false;               ///< topics of Open-RMF
    std::string mcap;               ///< "" without
    std::optional<MqttOptions> mqtt;
    std::string mqtt_login;  ///< file; "" without
    std::optional<bool> shutdown, changes;
    std::string token_file;   ///< "" without
    std::string load_folder;  ///< "": that of the scene
    ServerLimits limits;
    DevicePortOptions devices;
    ExtensionTask task;  ///< instead of a run; empty: none
};

/// Parses the value of a time option. \throws UsageError outside [least, most]
SimTime timeOption(const std::string& text, SimTime least, SimTime most);

class SimrunCommand : public ToolCommand<SimrunOptions> {
  public:
    /// Opens no file. \throws UsageError, TextRequested
    SimrunCommand(int argc, const char* const* argv);

  private:
    void declareRun();
    void declareReplay();
    void declareJudgement();
    void checkReplay() const;
    void declareDrawing();
    void takeDrawing();
    void takeJudgement();
    void declareServer();
    void declareRos();
    void declareMqtt();
    void takeMqtt();
    void takeServer();

    std::string to_;
    std::string mqtt_prefix_;
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/command_line.h"
#include "cli/common_options.h"
#include "server/device/wire_session.h"
#include "server/server.h"
#include "sim/expect.h"
#include "sim/simulation.h"

namespace ispace {

/// A robot or sensor behind the port of a real device, as an option asks for it.
struct DevicePortOption {
    const WireProtocol* protocol = nullptr;
    std::string id;
    Endpoint endpoint;
};

/// The options of device ports, one for each row of wireProtocols(), and who may use them.
class DevicePortOptions {
  public:
    void declare(CommandLine& line);
    /// Once the line is parsed. \throws UsageError
    void take(const CommandLine& line, ServerLimits& limits);
    [[nodiscard]] const std::vector<DevicePortOption>& ports() const { return ports_; }
    /// Connections they may take at once.
    [[nodiscard]] std::size_t connections() const;

  private:
    std::map<const WireProtocol*, std::vector<std::string>> texts_;
    std::vector<std::string> allowed_;
    std::string clock_ = "simulated";
    std::vector<DevicePortOption> ports_;
};

/// The addresses of device ports, by the id of their robot or sensor.
using DeviceAddresses = std::map<const WireProtocol*, std::map<std::string, std::string>>;
/// \throws UsageError naming the option, std::system_error
DeviceAddresses serveDevices(Server& server, const DevicePortOptions& options);

/// What -o draws of a record.
struct DrawingOptions {
    std::string format;          ///< png, svg, pdf, y4m or gif; "" without -o
    int width = 1200;            ///< pixels
    double fps = 25, speed = 1;  ///< of a film: pictures a second, simulated seconds a second
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
    std::string record;                                     ///< folder; "" without
    std::uint64_t max_recorded = std::uint64_t{16} << 30U;  ///< bytes
    std::string replay;                                     ///< folder; "" without
    SimTime from{};                                         ///< of the replay
    bool holds = false;                                     ///< at the end of the replay
    DrawingOptions drawing;
    std::vector<Expectation> expected;
    std::string junit;           ///< file; "" without
    double recorded_frames = 1;  ///< a simulated second, at most
    double recorded_sonars = 10;
    std::string port_file;  ///< "" without
    Endpoint listen;
    std::optional<Endpoint> web;
    std::optional<bool> shutdown, changes;
    std::string token_file;   ///< "" without
    std::string load_folder;  ///< "": that of the scene
    ServerLimits limits;
    DevicePortOptions devices;
};

/// The value of an option that is a time. \throws UsageError unless it is one from `least` to
/// `most`
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
    void takeExpectations();
    void declareServer();
    void takeServer();

    std::vector<std::string> expected_;
    std::string to_;
};

}  // namespace ispace

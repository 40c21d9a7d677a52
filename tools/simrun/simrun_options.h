// SPDX-License-Identifier: GPL-3.0-or-later
// The command line of simrun: the core's options, and those of its extensions.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/common_options.h"
#include "cli/drawing_group.h"
#include "cli/option_group.h"
#include "cli/record_group.h"
#include "cli/report_group.h"
#include "cli/run_bridge.h"
#include "cli/run_judge.h"
#include "server/server.h"
#include "sim/record_form.h"
#include "sim/simulation.h"

namespace ispace {

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
    std::string report;                                     ///< file; "" without
    std::shared_ptr<const ReportExtensions> reports;        ///< of extensions, for people
    std::shared_ptr<const RecordExtensions> records;        ///< of extensions
    std::string record;                                     ///< folder; "" without
    std::uint64_t max_recorded = std::uint64_t{16} << 30U;  ///< bytes
    std::string replay;                                     ///< folder; "" without
    SimTime from{};                                         ///< of the replay
    bool holds = false;                                     ///< at the end of the replay
    std::shared_ptr<const DrawingGroup> drawing;            ///< for -o; null without
    std::shared_ptr<JudgeExtensions> judges;
    std::string junit;  ///< file; "" without
    std::optional<bool> records_readings;
    double recorded_frames = 1;  ///< per simulated second, at most
    double recorded_sonars = 10;
    RecordForm record_form;
    std::string port_file;  ///< "" without
    Endpoint listen;
    std::shared_ptr<BridgeExtensions> bridges;
    std::optional<bool> shutdown, changes;
    std::string token_file;   ///< "" without
    std::string load_folder;  ///< "": that of the scene
    ServerLimits limits;
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
    void takeDrawing();
    void takeJudgement();
    void declareServer();
    void takeServer();

    std::shared_ptr<DrawingExtensions> drawings_;
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
// What a folder of lib/extensions adds to the ways into a run: options of simrun, and the bridges
// that they ask for (server/bridge.h). See cli/extension.h.
//
// Order of calls: declare(), take(), claim(), open(), begin(), announce(), the run, commit(). All
// ports listen before the first line of output names them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/json_writer.h"
#include "cli/command_line.h"
#include "cli/common_options.h"
#include "server/network.h"
#include "server/server.h"
#include "sim/simulation.h"

namespace ispace {

/// Parses "10940" of this machine, or "127.0.0.2:10940". \throws UsageError
Endpoint parsePort(const std::string& text);

/// What the tool's own options say when those of bridges are checked.
struct BridgeRules {
    const CommandLine& line;
    ServerLimits& limits;         ///< with those of the tool; bridges add theirs
    bool is_replay = false;       ///< of a record, which nothing changes
    bool has_token = false;       ///< clients of other machines show one
    bool heeds_networks = false;  ///< set by a bridge that heeds ServerLimits::allowed (--allow)
};

/// The run that bridges are opened for.
struct BridgeRun {
    const CommonOptions& common;
    std::string title;                  ///< of the room or the record
    std::vector<std::string> replayed;  ///< folders of the records that are replayed
    std::uint64_t max_recorded = 0;     ///< bytes of a file, --record-limit
};

/// Options that ask for a bridge, and their values: an object is made for each command line and
/// kept until its run has ended.
class BridgeGroup {
  public:
    virtual ~BridgeGroup() = default;
    /// Declares the options, bound to members. The group begins with line.group(HEADING).
    virtual void declare(CommandLine& line) = 0;
    /// Checks the options; opens no file. \throws UsageError
    virtual void take(BridgeRules& rules) = 0;
    /// Returns how many connections it serves at once besides the clients of the protocol.
    [[nodiscard]] virtual std::size_t connections() const = 0;
    /// Reserves the outputs before the run.
    virtual void claim() const {}
    /// Opens the bridges that are asked for. \throws UsageError naming the option, FormatError,
    /// std::system_error
    virtual void open(Server& server, Simulation& simulation, const BridgeRun& run) = 0;
    /// Makes files and folders, once the bridges of all groups are open. \throws std::system_error
    virtual void begin(Simulation& /*simulation*/, const BridgeRun& /*run*/) {}
    /// Adds the addresses to the first line of output, which is an object.
    virtual void announce(JsonWriter& json) const = 0;
    /// Completes files after the run. \throws FormatError
    virtual void commit(const CommonOptions& /*common*/) {}
};

/// A row of Extensions, see cli/extensions.h.
struct BridgeRow {
    std::string_view extension;
    std::unique_ptr<BridgeGroup> (*make)();
};

/// The bridges that extensions add to one command line.
class BridgeExtensions {
  public:
    /// \param rows in the order of `--help`
    explicit BridgeExtensions(std::span<const BridgeRow> rows);
    /// Declares --allow in the present group, and then the group of each.
    void declare(CommandLine& line);
    /// As those of BridgeGroup, for all of them.
    void take(BridgeRules& rules) const;
    [[nodiscard]] std::size_t connections() const;
    void claim() const;
    /// Opens all of them, then begins them.
    void open(Server& server, Simulation& simulation, const BridgeRun& run) const;
    void announce(JsonWriter& json) const;
    void commit(const CommonOptions& common) const;
    /// Returns the names of the options ("--web").
    [[nodiscard]] const std::vector<std::string>& options() const { return options_; }

  private:
    std::span<const BridgeRow> rows_;
    std::vector<std::shared_ptr<BridgeGroup>> groups_;
    std::vector<std::string> options_;
    std::vector<std::string> allowed_;
};

}  // namespace ispace

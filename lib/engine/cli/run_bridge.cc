// SPDX-License-Identifier: GPL-3.0-or-later
#include "cli/run_bridge.h"

#include "base/error.h"

namespace ispace {

Endpoint parsePort(const std::string& text) {
    return parseEndpoint(text.find(':') == std::string::npos ? "127.0.0.1:" + text : text);
}

BridgeExtensions::BridgeExtensions(std::span<const BridgeRow> rows) : rows_(rows) {
    groups_.reserve(rows.size());
    for (const BridgeRow& row : rows) groups_.push_back(row.make());
}

void BridgeExtensions::declare(CommandLine& line) {
    const auto before = static_cast<std::ptrdiff_t>(line.names().size());
    line.texts("--allow", "CIDR", allowed_,
               "machines besides this one that may use ports of devices and --ros2, e.g. "
               "192.168.1.0/24",
               Enters::Nothing);
    for (std::size_t i = 0; i < groups_.size(); ++i) {
        line.extension(std::string(rows_[i].extension));
        groups_[i]->declare(line);
    }
    line.extension("");
    const std::vector<std::string> names = line.names();
    options_.assign(names.begin() + before, names.end());
}

void BridgeExtensions::take(BridgeRules& rules) const {
    for (const std::string& text : allowed_)
        rules.limits.allowed.push_back(ofOption("--allow", [&text] { return parseNetwork(text); }));
    for (const auto& group : groups_) group->take(rules);
    if (!allowed_.empty() && !rules.heeds_networks)
        throw UsageError("--allow is about ports of devices, and none is asked for");
}

std::size_t BridgeExtensions::connections() const {
    std::size_t count = 0;
    for (const auto& group : groups_) count += group->connections();
    return count;
}

void BridgeExtensions::claim() const {
    for (const auto& group : groups_) group->claim();
}

void BridgeExtensions::open(Server& server, Simulation& simulation, const BridgeRun& run) const {
    for (const auto& group : groups_) group->open(server, simulation, run);
    for (const auto& group : groups_) group->begin(simulation, run);
}

void BridgeExtensions::announce(JsonWriter& json) const {
    for (const auto& group : groups_) group->announce(json);
}

void BridgeExtensions::commit(const CommonOptions& common) const {
    for (const auto& group : groups_) group->commit(common);
}

}  // namespace ispace

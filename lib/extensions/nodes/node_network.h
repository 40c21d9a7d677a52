// SPDX-License-Identifier: GPL-3.0-or-later
// Messages between the nodes of a run.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "extensions/nodes/node_record.h"

namespace ispace::nodes {

/// A message on its way.
struct NodeMessage {
    std::size_t from = 0;     ///< index of the node
    std::int64_t number = 0;  ///< of the node's messages, from 1
    SimTime arrival{};
    std::string text;
};

/// The lines of the nodes. A message enters its node's line, behind those before it if the line
/// has a rate, and arrives after a delay drawn from the seed, the node and the number
/// of the message: log-normal with the node's mean and deviation, so later ones may overtake it.
/// The sender of a lost one is not told.
///
/// Messages that arrive within one step are delivered after it, by their arrival; equal ones by
/// node and number. Hence a run with programs that send the same messages at the same steps
/// delivers the same ones, on any machine.
class NodeNetwork {
  public:
    /// Messages of a node on their way, and waiting for its line: more are lost.
    static constexpr std::size_t kMostOnTheWay = 10'000;
    static constexpr double kLongestQueue = 1;  ///< seconds

    NodeNetwork(std::vector<Node> nodes, std::uint64_t seed);
    [[nodiscard]] std::span<const Node> nodes() const { return nodes_; }
    [[nodiscard]] std::optional<std::size_t> find(std::string_view id) const;

    /// Sends a message now. \returns its number
    std::int64_t send(std::size_t node, std::string text, SimTime now);
    /// Takes the messages that have arrived, in order.
    std::vector<NodeMessage> arrived(SimTime now);

    /// Numbers of a node's messages.
    struct Tally {
        std::int64_t sent = 0, lost = 0;
        std::int64_t dropped = 0;  ///< since the line was full
    };
    [[nodiscard]] const Tally& tally(std::size_t node) const { return lines_[node].tally; }

  private:
    struct Line {
        Tally tally;
        double free_at = 0;  // seconds: the line is free again
        std::size_t on_the_way = 0;
    };
    std::vector<Node> nodes_;
    std::uint64_t seed_;
    std::vector<Line> lines_;
    std::map<std::tuple<SimTime, std::size_t, std::int64_t>, std::string> on_the_way_;
};

}  // namespace ispace::nodes

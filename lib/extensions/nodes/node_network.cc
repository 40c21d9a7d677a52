// SPDX-License-Identifier: GPL-3.0-or-later
// A delay with mean m and deviation s is exp(N(ln m - v/2, v)) with v = ln(1 + s^2/m^2), which has
// exactly this mean and deviation. Draws are keyed by seed, node and number: a message gets the
// same delay and fate whatever other nodes send. Numbers go on over lost and dropped messages. A
// lost one has used its node's line; a dropped one has not, unless it was dropped since too many
// are on the way.
#include "extensions/nodes/node_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/random.h"

namespace ispace::nodes {

namespace {

/// Of the draws here, apart from those of the core; a byte.
constexpr auto kNetworkDraws = static_cast<Purpose>(200);

/// Draws a log-normal variable with this mean and deviation.
double logNormal(double mean, double deviation, double normal) {
    if (mean == 0 || deviation == 0) return mean;
    const double variance = std::log1p((deviation / mean) * (deviation / mean));
    return mean * std::exp(std::sqrt(variance) * normal - variance / 2);
}

}  // namespace

NodeNetwork::NodeNetwork(std::vector<Node> nodes, std::uint64_t seed)
    : nodes_(std::move(nodes)), seed_(seed), lines_(nodes_.size()) {}

std::optional<std::size_t> NodeNetwork::find(std::string_view id) const {
    const auto found =
        std::find_if(nodes_.begin(), nodes_.end(), [&](const Node& node) { return node.id == id; });
    if (found == nodes_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - nodes_.begin());
}

std::int64_t NodeNetwork::send(std::size_t node, std::string text, SimTime now) {
    const Node& from = nodes_[node];
    Line& line = lines_[node];
    const std::int64_t number = ++line.tally.sent;
    std::array<float, 1> normal{}, uniform{};
    draw({seed_, kNetworkDraws, hashOf(from.id), static_cast<std::uint64_t>(number)}, 0,
         {.normal = normal, .uniform = uniform});
    double leaves = seconds(now);
    if (from.rate) {
        const double waits = std::max(line.free_at - leaves, 0.0);
        if (waits > kLongestQueue) {
            ++line.tally.dropped;
            return number;
        }
        leaves += waits + 1 / *from.rate;
        line.free_at = leaves;
    }
    if (static_cast<double>(uniform[0]) < from.loss) {
        ++line.tally.lost;
        return number;
    }
    if (line.on_the_way >= kMostOnTheWay) {
        ++line.tally.dropped;
        return number;
    }
    const double delay = logNormal(from.delay, from.jitter, static_cast<double>(normal[0]));
    const SimTime arrival =
        std::max(now, simSeconds(std::min(leaves + delay, seconds(kMaxTime) / 2)));
    on_the_way_.emplace(std::make_tuple(arrival, node, number), std::move(text));
    ++line.on_the_way;
    return number;
}

std::vector<NodeMessage> NodeNetwork::arrived(SimTime now) {
    std::vector<NodeMessage> messages;
    auto next = on_the_way_.begin();
    for (; next != on_the_way_.end() && std::get<0>(next->first) <= now; ++next) {
        const auto [arrival, node, number] = next->first;
        messages.push_back({node, number, arrival, std::move(next->second)});
        --lines_[node].on_the_way;
    }
    on_the_way_.erase(on_the_way_.begin(), next);
    return messages;
}

}  // namespace ispace::nodes

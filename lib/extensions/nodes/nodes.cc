// SPDX-License-Identifier: GPL-3.0-or-later
// Messages are delivered after each step, in the order of arrival, node and number, whichever
// program asks first. Text of a message is the rest of the line, blanks included. Unread messages
// of a program that does not read are bounded (UnreadItems), and the program is told how many it
// missed.
#include "extensions/nodes/nodes.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/message.h"
#include "base/number.h"
#include "extensions/nodes/node_network.h"
#include "server/role_answer.h"

namespace ispace::nodes {

namespace {

constexpr auto kRequests = std::to_array<RoleRequest>({
    {"TIME", "", 0, 0},
    {"AWAIT", "t", 1, 1},
    {"SEND", "text", 1, static_cast<std::size_t>(-1)},
    {"HEAR", "[node...]", 0, static_cast<std::size_t>(-1)},
});

std::string clockText(double time) { return formatFixed(time, 6); }

/// The state of a node that its program shares with the run.
struct Seat {
    bool is_taken = false, was_taken = false;
    std::optional<SimTime> awaited = {};  // by AWAIT
    bool hears = false;
    std::vector<std::size_t> heard = {};  // nodes; empty: all others
    UnreadItems<NodeMessage> unread = {};
};

struct Run {
    NodeNetwork network;
    std::vector<Seat> seats;
    const Simulation* simulation = nullptr;

    [[nodiscard]] SimTime now() const { return simulation->world().time(); }
};

class NodeClient : public ClientRole {
  public:
    NodeClient(Run& run, std::size_t node) : run_(run), node_(node) {
        seat().is_taken = seat().was_taken = true;
    }
    ~NodeClient() override { seat() = Seat{.was_taken = true}; }
    NodeClient(const NodeClient&) = delete;
    NodeClient& operator=(const NodeClient&) = delete;

    [[nodiscard]] std::span<const RoleRequest> requests() const override { return kRequests; }
    RoleAnswer request(std::span<const std::string_view> words) override {
        if (words[0] == "AWAIT") return await(words[1]);
        if (words[0] == "SEND") return send(words.subspan(1));
        if (words[0] == "HEAR") return hear(words.subspan(1));
        return {"OK TIME t=" + clockText(clock(run_.now())) + "\n"};
    }
    [[nodiscard]] bool waits() const override {
        return seat().awaited && *seat().awaited > run_.now();
    }
    std::string stepped(bool has_room) override {
        std::string lines;
        if (!has_room) return lines;
        lines = seat().unread.missedLine(clockText(clock(run_.now())));
        for (const NodeMessage& message : seat().unread.take()) {
            lines.append("EVENT message t=").append(clockText(clock(message.arrival)));
            lines.append(" from=").append(run_.network.nodes()[message.from].id);
            lines.append(" n=").append(std::to_string(message.number));
            lines.append(" text=").append(message.text).append("\n");
        }
        return lines;
    }
    [[nodiscard]] std::span<const std::string> sensors() const override { return node().sensors; }
    [[nodiscard]] double clock(SimTime time) const override { return node().clock(time); }

  private:
    [[nodiscard]] Seat& seat() const { return run_.seats[node_]; }
    [[nodiscard]] const Node& node() const { return run_.network.nodes()[node_]; }

    RoleAnswer await(std::string_view text) {
        const auto clock = parseDouble(text);
        const auto time = clock ? node().worldTime(*clock) : std::nullopt;
        if (!time)
            return {
                errorText(416, excerpt(text) + " is no time in seconds that its clock will show")};
        seat().awaited = *time;
        if (waits()) return {"", true};
        return {"OK AWAIT t=" + clockText(this->clock(run_.now())) + "\n"};
    }

    RoleAnswer send(std::span<const std::string_view> words) {
        const std::string_view last = words.back();
        const auto size = static_cast<std::size_t>(last.data() + last.size() - words[0].data());
        const std::int64_t number =
            run_.network.send(node_, std::string(words[0].data(), size), run_.now());
        return {"OK SEND n=" + std::to_string(number) + "\n"};
    }

    RoleAnswer hear(std::span<const std::string_view> words) {
        std::vector<std::size_t> heard = {};
        for (const std::string_view word : words) {
            const auto other = run_.network.find(word);
            if (!other) {
                std::vector<std::string> known;
                for (const Node& each : run_.network.nodes()) known.push_back(each.id);
                return {errorText(404, "no node " + excerpt(word) + didYouMean(word, known))};
            }
            heard.push_back(*other);
        }
        seat().hears = true;
        seat().heard = std::move(heard);
        return {"OK HEAR t=" + clockText(clock(run_.now())) + "\n"};
    }

    Run& run_;
    std::size_t node_;
};

class Nodes : public RoleService {
  public:
    Nodes(std::vector<Node> nodes, const Simulation& simulation, std::uint64_t seed)
        : run_{NodeNetwork(std::move(nodes), seed), {}, &simulation} {
        run_.seats.resize(run_.network.nodes().size());
    }
    [[nodiscard]] std::string_view verb() const override { return "NODE"; }

    std::unique_ptr<ClientRole> take(std::string_view id, std::string& answer) override {
        const auto found = run_.network.find(id);
        if (!found) {
            std::vector<std::string> known;
            for (const Node& each : run_.network.nodes()) known.push_back(each.id);
            const std::string hint = didYouMean(id, known);
            answer +=
                errorText(404, "no node " + excerpt(id) +
                                   (hint.empty() ? "; there is " + joined(known, ",") : hint));
            return nullptr;
        }
        if (run_.seats[*found].is_taken) {
            answer += errorText(409, "node " + excerpt(id) + " is held by another client");
            return nullptr;
        }
        const Node& node = run_.network.nodes()[*found];
        answer.append("OK NODE ").append(node.id).append(" t=");
        answer.append(clockText(node.clock(run_.now())));
        answer.append(" sensors=").append(joined(node.sensors, ","));
        answer.append(" lockstep=").append(node.lockstep ? "1" : "0").append("\n");
        return std::make_unique<NodeClient>(run_, *found);
    }

    void stepped() override {
        for (NodeMessage& message : run_.network.arrived(run_.now()))
            for (std::size_t i = 0; i < run_.seats.size(); ++i) {
                Seat& seat = run_.seats[i];
                if (!seat.hears || i == message.from) continue;
                const bool is_heard =
                    seat.heard.empty() || std::find(seat.heard.begin(), seat.heard.end(),
                                                    message.from) != seat.heard.end();
                if (!is_heard) continue;
                seat.unread.add(message);
            }
    }

    /// A node in lockstep holds the world no more once its program has come and gone.
    [[nodiscard]] bool holdsWorld() const override {
        for (std::size_t i = 0; i < run_.seats.size(); ++i) {
            const Seat& seat = run_.seats[i];
            if (!run_.network.nodes()[i].lockstep || (seat.was_taken && !seat.is_taken)) continue;
            if (!seat.awaited || *seat.awaited <= run_.now()) return true;
        }
        return false;
    }

    [[nodiscard]] std::string waitsFor() const override {
        std::vector<std::string> ids;
        for (const Node& node : run_.network.nodes())
            if (node.lockstep) ids.push_back(node.id);
        return ids.empty() ? "" : "the programs of nodes in lockstep: " + joined(ids, ",");
    }

  private:
    Run run_;
};

}  // namespace

std::unique_ptr<RoleService> makeNodes(std::span<const RunRoom> rooms, std::uint64_t seed) {
    std::vector<Node> nodes;
    for (const RunRoom& room : rooms) {
        std::vector<Node> its =
            nodesOf(room.simulation->world().scene(), room.id.empty() ? "" : room.id + "/");
        std::move(its.begin(), its.end(), std::back_inserter(nodes));
    }
    if (nodes.empty()) return nullptr;
    return std::make_unique<Nodes>(std::move(nodes), *rooms.front().simulation, seed);
}

}  // namespace ispace::nodes

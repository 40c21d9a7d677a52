// SPDX-License-Identifier: GPL-3.0-or-later
// Inside lib/net only: names in replies.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "net/limits.h"
#include "sim/simulation.h"

namespace ispace {

/// Ids of robots or lasers, in order.
template <typename Things>
std::vector<std::string> idsOf(const Things& things) {
    std::vector<std::string> ids;
    ids.reserve(things.size());
    for (const auto& thing : things) ids.push_back(thing.id);
    return ids;
}

inline std::string joined(const std::vector<std::string>& words, std::string_view separator) {
    std::string out;
    for (const std::string& word : words) {
        if (!out.empty()) out += separator;
        out += word;
    }
    return out;
}

/// The steps that clients ask of a paused world: taken one client's after the other's, in the order
/// of asking.
class StepQueue {
  public:
    /// What one STEP came to so far.
    struct Ticket {
        std::int64_t count = 0, left = 0;
        bool over = false;  ///< to be answered: all are taken, or no more will be
    };

    explicit StepQueue(Simulation& simulation);
    /// \pre the simulation is paused, count > 0
    std::shared_ptr<const Ticket> ask(std::int64_t count);
    /// Counts the steps taken since the last call.
    void settle();
    /// PAUSE, RESUME, the end: what is not taken by now will not be.
    void cut();
    /// Nobody waits for these any more: they are not taken. Null is allowed.
    void drop(const std::shared_ptr<const Ticket>& ticket);

  private:
    void end();

    Simulation* simulation_;
    std::int64_t seen_;  // steps of the world at the last call
    std::deque<std::shared_ptr<Ticket>> tickets_;
};

/// What all clients share: who holds which robot, and the text of the newest scans, made once for
/// all readers.
class Hall {
  public:
    explicit Hall(Simulation& simulation, const ServerLimits& limits = {});
    [[nodiscard]] Simulation& simulation() { return *simulation_; }
    [[nodiscard]] const ServerLimits& limits() const { return limits_; }

    /// False if another client holds it.
    bool hold(std::size_t robot);
    /// Frees a robot and stops it.
    void release(std::size_t robot);

    [[nodiscard]] StepQueue& steps() { return steps_; }
    /// Of all clients together.
    [[nodiscard]] Ration& pauses() { return pauses_; }

    /// The newest scan of a laser as scanText writes it. Until there is a newer one all readers get
    /// the same string.
    std::shared_ptr<const std::string> scan(std::size_t laser, bool stream, bool binary);
    /// Bytes of scans that only those hold who have still to send them.
    [[nodiscard]] std::size_t staleBytes() const { return *alive_ - kept_; }

  private:
    struct Text {
        std::int64_t seq = -1;
        std::shared_ptr<const std::string> bytes;
    };
    [[nodiscard]] std::shared_ptr<const std::string> counted(std::string text) const;
    void keep(Text& text, std::int64_t seq, std::shared_ptr<const std::string> bytes);

    Simulation* simulation_;
    ServerLimits limits_;
    StepQueue steps_;
    std::vector<bool> held_;
    Ration pauses_;
    std::vector<std::array<Text, 4>> texts_;  // of each laser, by stream and binary
    std::size_t kept_ = 0;                    // bytes in texts_
    // Bytes of all texts that somebody has; it outlives them.
    std::shared_ptr<std::size_t> alive_ = std::make_shared<std::size_t>(0);
};

}  // namespace ispace

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "net/ration.h"
#include "net/server_limits.h"
#include "net/step_queue.h"

namespace ispace {

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

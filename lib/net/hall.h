// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "net/step_queue.h"

namespace ispace {

/// What all clients share: who holds which robot, and the text of the newest scans, made once for
/// all readers.
class Hall {
  public:
    explicit Hall(Simulation& simulation);
    [[nodiscard]] Simulation& simulation() { return *simulation_; }

    /// False if another client holds it.
    bool hold(std::size_t robot);
    /// Frees a robot and stops it.
    void release(std::size_t robot);

    [[nodiscard]] StepQueue& steps() { return steps_; }

    /// The newest scan of a laser as scanText writes it. Until there is a newer one all readers get
    /// the same string.
    std::shared_ptr<const std::string> scan(std::size_t laser, bool stream, bool binary);

  private:
    struct Text {
        std::int64_t seq = -1;
        std::shared_ptr<const std::string> bytes;
    };
    Simulation* simulation_;
    StepQueue steps_;
    std::vector<bool> held_;
    std::vector<std::array<Text, 4>> texts_;  // of each laser, by stream and binary
};

}  // namespace ispace

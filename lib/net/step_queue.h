// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "sim/simulation.h"

namespace ispace {

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

}  // namespace ispace

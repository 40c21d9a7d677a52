// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/step_queue.h"

#include <algorithm>
#include <utility>

namespace ispace {

StepQueue::StepQueue(Simulation& simulation)
    : simulation_(&simulation), seen_(simulation.world().steps()) {}

std::shared_ptr<const StepQueue::Ticket> StepQueue::ask(std::int64_t count) {
    settle();
    simulation_->allow(count);
    tickets_.push_back(std::make_shared<Ticket>(Ticket{.count = count, .left = count}));
    return tickets_.back();
}

void StepQueue::settle() {
    const std::int64_t steps = simulation_->world().steps();
    std::int64_t taken = steps - std::exchange(seen_, steps);
    while (taken > 0 && !tickets_.empty()) {
        Ticket& ticket = *tickets_.front();
        const std::int64_t share = std::min(taken, ticket.left);
        ticket.left -= share;
        taken -= share;
        if (ticket.left > 0) break;
        ticket.over = true;
        tickets_.pop_front();
    }
    if (simulation_->finished()) end();
}

void StepQueue::cut() {
    settle();
    end();
}

void StepQueue::end() {
    for (const auto& ticket : tickets_) ticket->over = true;
    tickets_.clear();
}

void StepQueue::drop(const std::shared_ptr<const Ticket>& ticket) {
    settle();
    const auto found = std::find(tickets_.begin(), tickets_.end(), ticket);
    if (found == tickets_.end()) return;
    simulation_->forgo(ticket->left);
    tickets_.erase(found);
}

}  // namespace ispace

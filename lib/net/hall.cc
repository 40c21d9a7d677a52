// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/hall.h"

#include "net/scan_text.h"

namespace ispace {

Hall::Hall(Simulation& simulation)
    : simulation_(&simulation),
      steps_(simulation),
      held_(simulation.world().robots().size()),
      texts_(simulation.world().lasers().size()) {}

bool Hall::hold(std::size_t robot) {
    if (held_[robot]) return false;
    held_[robot] = true;
    return true;
}

void Hall::release(std::size_t robot) {
    held_[robot] = false;
    simulation_->world().command(robot, {Verb::Stop, 0});
}

std::shared_ptr<const std::string> Hall::scan(std::size_t laser, bool stream, bool binary) {
    const SensorReading& reading = simulation_->world().reading(laser);
    Text& text = texts_[laser][(stream ? 1U : 0U) + (binary ? 2U : 0U)];
    if (text.seq != reading.seq || !text.bytes) {
        text.bytes = std::make_shared<const std::string>(scanText(reading, stream, binary));
        text.seq = reading.seq;
    }
    return text.bytes;
}

}  // namespace ispace

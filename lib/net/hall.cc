// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/hall.h"

#include <utility>

#include "net/scan_text.h"

namespace ispace {

Hall::Hall(Simulation& simulation, const ServerLimits& limits)
    : simulation_(&simulation),
      limits_(limits),
      steps_(simulation),
      held_(simulation.world().robots().size()),
      pauses_(limits.all_pauses),
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
    if (text.seq == reading.seq && text.bytes) return text.bytes;
    auto bytes = counted(scanText(reading, stream, binary));
    keep(text, reading.seq, bytes);
    return bytes;
}

std::shared_ptr<const std::string> Hall::counted(std::string text) const {
    text.shrink_to_fit();
    *alive_ += text.size();
    return {new std::string(std::move(text)), [alive = alive_](const std::string* old) {
                *alive -= old->size();
                delete old;
            }};
}

void Hall::keep(Text& text, std::int64_t seq, std::shared_ptr<const std::string> bytes) {
    const auto size_of = [](const Text& kept) { return kept.bytes ? kept.bytes->size() : 0; };
    kept_ += bytes->size() - size_of(text);
    text = {seq, std::move(bytes)};
    if (kept_ <= limits_.unread / 2) return;
    // Many big lasers in every form: what nobody asks for again need not stay.
    kept_ = size_of(text);
    for (auto& forms : texts_)
        for (Text& other : forms)
            if (&other != &text) other = {};
}

}  // namespace ispace

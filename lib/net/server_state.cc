// SPDX-License-Identifier: GPL-3.0-or-later
#include "net/server_state.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <utility>

#include "base/number.h"

namespace ispace {

bool TokenBucket::has(WallTime now) {
    if (now > filled_) {
        const double seconds = std::chrono::duration<double>(now - filled_).count();
        left_ = std::min(limits_.burst, left_ + limits_.rate * seconds);
        filled_ = now;
    }
    return left_ >= 1;
}

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

ServerState::ServerState(Simulation& simulation, const ServerLimits& limits)
    : simulation_(&simulation),
      limits_(limits),
      steps_(simulation),
      held_(simulation.world().robots().size()),
      pauses_(limits.all_pauses),
      texts_(simulation.world().sensors().size()) {}

bool ServerState::hold(std::size_t robot) {
    if (held_[robot]) return false;
    held_[robot] = true;
    return true;
}

void ServerState::release(std::size_t robot) {
    held_[robot] = false;
    simulation_->world().command(robot, {Verb::Stop, 0});
}

std::shared_ptr<const std::string> ServerState::scan(std::size_t laser, bool stream, bool binary) {
    const World& world = simulation_->world();
    const SensorReading& reading = world.reading(laser);
    Text& text = texts_[laser][(stream ? 1U : 0U) + (binary ? 2U : 0U)];
    if (text.seq == reading.seq && text.bytes) return text.bytes;
    auto bytes = counted(scanText(world.sensors()[laser], reading, stream, binary));
    keep(text, reading.seq, bytes);
    return bytes;
}

std::shared_ptr<const std::string> ServerState::counted(std::string text) const {
    text.shrink_to_fit();
    *alive_ += text.size();
    return {new std::string(std::move(text)), [alive = alive_](const std::string* old) {
                *alive -= old->size();
                delete old;
            }};
}

void ServerState::keep(Text& text, std::int64_t seq, std::shared_ptr<const std::string> bytes) {
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

namespace {

void appendHead(std::string& out, const RunSensor& sensor, const SensorReading& reading,
                bool stream) {
    const Laser& laser = *sensor.model<Laser>();
    out.append("SCAN ").append(sensor.id);
    out.append(" t=").append(formatMilliseconds(reading.time));
    out.append(" seq=").append(std::to_string(reading.seq));
    out.append(" angle_min=").append(formatDouble(laser.first.degrees()));
    out.append(" angle_max=").append(formatDouble(laser.last().degrees()));
    out.append(" step=").append(formatDouble(laser.step.degrees()));
    out.append(" n=").append(std::to_string(reading.scan().ranges.size()));
    if (stream) out += " stream=1";
}

void appendLittleEndian(std::string& out, float value) {
    const auto bits = std::bit_cast<std::uint32_t>(value);
    for (int shift = 0; shift < 32; shift += 8) out += static_cast<char>((bits >> shift) & 0xffu);
}

}  // namespace

void appendRange(std::string& out, float range) {
    if (std::isinf(range)) {
        out += '-';
        return;
    }
    // A float times 1000 is exact in a double, so rounding it half to even is what a correctly
    // rounded conversion to three decimals does.
    constexpr double kMax = 1e9;
    const double value = range;
    if (!(value >= 0 && value < kMax)) {
        out += formatFixed(value, 3);
        return;
    }
    const auto millimetres = std::llrint(value * 1000);
    std::array<char, 24> digits;
    char* const end =
        std::to_chars(digits.data(), digits.data() + digits.size(), millimetres / 1000).ptr;
    const auto rest = static_cast<int>(millimetres % 1000);
    end[0] = '.';
    end[1] = static_cast<char>('0' + rest / 100);
    end[2] = static_cast<char>('0' + rest / 10 % 10);
    end[3] = static_cast<char>('0' + rest % 10);
    out.append(digits.data(), end + 4);
}

std::string scanText(const RunSensor& sensor, const SensorReading& reading, bool stream,
                     bool binary) {
    const auto& ranges = reading.scan().ranges;
    constexpr std::size_t kHead = 192, kTextRange = sizeof "12.345,", kBinaryRange = 4;
    std::string out;
    out.reserve(kHead + ranges.size() * (binary ? kBinaryRange : kTextRange));
    appendHead(out, sensor, reading, stream);
    if (binary) {
        out.append(" bytes=").append(std::to_string(ranges.size() * kBinaryRange)).append("\n");
        for (const float range : ranges) appendLittleEndian(out, range);
        return out;
    }
    out += " r=";
    for (std::size_t i = 0; i < ranges.size(); ++i) {
        if (i > 0) out += ',';
        appendRange(out, ranges[i]);
    }
    out += '\n';
    return out;
}

}  // namespace ispace

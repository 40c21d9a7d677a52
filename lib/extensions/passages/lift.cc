// SPDX-License-Identifier: GPL-3.0-or-later
// Phases of a lift, and the ride with constant acceleration: a parabola up to the speed, a line,
// and a parabola back; over short ways two parabolas.
#include "extensions/passages/lift.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ispace::passages {

namespace {

SimTime timeOf(double duration) {
    constexpr double kMicroseconds = 1e6;
    return std::chrono::microseconds(std::llround(duration * kMicroseconds));
}

}  // namespace

double liftRide(double distance, double speed) {
    const double a = Lift::kAcceleration;
    if (distance * a < speed * speed) return 2 * std::sqrt(distance / a);
    return distance / speed + speed / a;
}

double liftPath(double distance, double speed, double seconds) {
    const double a = Lift::kAcceleration;
    const double whole = liftRide(distance, speed);
    const double t = std::clamp(seconds, 0.0, whole);
    const double ramp = std::min(speed / a, whole / 2);
    if (t <= ramp) return a * t * t / 2;
    if (t >= whole - ramp) return distance - a * (whole - t) * (whole - t) / 2;
    return a * ramp * ramp / 2 + a * ramp * (t - ramp);
}

double doorTime(double width) { return width / 2 / Lift::kLeafSpeed; }

void Lift::call(std::size_t stop) {
    assert(stop < model_.floors.size());
    if (std::find(state_.calls.begin(), state_.calls.end(), stop) == state_.calls.end())
        state_.calls.push_back(stop);
}

void Lift::hold(std::optional<std::size_t> stop) {
    assert(!stop || *stop < model_.floors.size());
    hold_ = stop;
    if (stop) call(*stop);
}

void Lift::begin(Phase phase, SimTime time, SimTime length) {
    state_.phase = phase;
    state_.since = time;
    until_ = time + length;
}

void Lift::advance(SimTime time, bool held) {
    const SimTime door = timeOf(doorTime(model_.door));
    const auto serve = [this] { std::erase(state_.calls, state_.stop); };
    switch (state_.phase) {
        case Phase::Waiting:
            if (!hold_ && state_.calls.empty()) break;
            state_.next = hold_ ? *hold_ : state_.calls.front();
            if (state_.next == state_.stop) {
                serve();
                begin(Phase::Opening, time, door);
            } else {
                const double way =
                    std::abs(model_.floors[state_.next] - model_.floors[state_.stop]);
                begin(Phase::Riding, time, timeOf(liftRide(way, model_.speed)));
            }
            break;
        case Phase::Opening:
            if (time >= until_) begin(Phase::Open, time, kDwell);
            break;
        case Phase::Open:
            serve();
            if (time >= until_ && !held && hold_ != state_.stop) begin(Phase::Closing, time, door);
            break;
        case Phase::Closing:
            if (time >= until_) begin(Phase::Waiting, time, SimTime(0));
            break;
        case Phase::Riding:
            if (time < until_) break;
            state_.stop = state_.next;
            serve();
            begin(Phase::Opening, time, door);
            break;
    }
}

double Lift::height(SimTime time) const {
    const double from = model_.floors[state_.stop];
    if (state_.phase != Phase::Riding) return from;
    const double way = model_.floors[state_.next] - from;
    const double gone = liftPath(std::abs(way), model_.speed, seconds(time - state_.since));
    return from + std::copysign(gone, way);
}

double Lift::opening(SimTime time) const {
    const double share = std::clamp(seconds(time - state_.since) / doorTime(model_.door), 0.0, 1.0);
    switch (state_.phase) {
        case Phase::Opening:
            return share;
        case Phase::Open:
            return 1;
        case Phase::Closing:
            return 1 - share;
        case Phase::Waiting:
        case Phase::Riding:
            break;
    }
    return 0;
}

}  // namespace ispace::passages

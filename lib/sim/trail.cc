// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/trail.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ispace {

namespace {

/// Shortest time between two moments of which both are kept.
SimTime spacingOf(SimTime length, std::size_t bodies) {
    constexpr std::size_t kMostBodies = std::size_t{1} << 19U;
    const auto moments = std::clamp<std::size_t>(kMostBodies / (bodies + 1), 16, 4096);
    return length / static_cast<SimTime::rep>(moments);
}

}  // namespace

Places::Places(const Movers& movers) : swings(movers.swings.begin(), movers.swings.end()) {
    robots.reserve(movers.robots.size());
    for (const Motion& motion : movers.robots) robots.push_back(motion.pose);
    people.reserve(movers.people.size());
    for (const Motion& motion : movers.people) people.push_back(motion.pose);
}

Pose2 poseBetween(const Pose2& from, const Pose2& to, double share) {
    if (from == to || share == 1) return to;
    constexpr double kStraight = 1e-6;
    const Vec2 chord = to.position - from.position;
    const Angle turn = wrapped(to.heading - from.heading);
    const double half = 0.5 * turn.radians();
    const double part =
        std::abs(half) < kStraight ? share : std::sin(share * half) / std::sin(half);
    const auto [c, s] = cosSin(0.5 * (share - 1) * turn);
    const Vec2 way{c * chord.x - s * chord.y, s * chord.x + c * chord.y};
    return {from.position + part * way, wrapped(from.heading + share * turn)};
}

void Trail::add(SimTime time, const Movers& movers, bool moved, const MovingBodies& bodies) {
    if (!isKept()) return;
    std::shared_ptr<const Moment> moment;
    if (!moved && !entries_.empty()) moment = entries_.back().moment;
    while (!entries_.empty() && entries_.back().time >= time) entries_.pop_back();
    // The newest one is always kept.
    if (entries_.size() > 1 &&
        entries_[entries_.size() - 2].time + spacingOf(length_, bodies.bodies().size()) > time)
        entries_.pop_back();
    if (!moment) moment = std::make_shared<const Moment>(Moment{Places(movers), bodies});
    entries_.push_back({time, std::move(moment)});
    while (entries_.size() > 1 && entries_[1].time + length_ <= time) entries_.pop_front();
}

void Trail::goOn(const Trail& before, Indices robots, Indices people, const Places& now,
                 const SetBodies& set_bodies) {
    entries_.clear();
    if (!isKept()) return;
    const Moment* last = nullptr;
    for (const Entry& entry : before.entries_) {
        if (entry.moment.get() == last) {
            entries_.push_back({entry.time, entries_.back().moment});
            continue;
        }
        last = entry.moment.get();
        const Places& was = last->places;
        auto moment = std::make_shared<Moment>(Moment{now, {}});
        for (std::size_t i = 0; i < robots.size(); ++i)
            if (robots[i]) moment->places.robots[i] = was.robots[*robots[i]];
        for (std::size_t i = 0; i < people.size(); ++i) {
            if (!people[i]) continue;
            moment->places.people[i] = was.people[*people[i]];
            moment->places.swings[i] = was.swings[*people[i]];
        }
        set_bodies(moment->places, moment->bodies);
        entries_.push_back({entry.time, std::move(moment)});
    }
}

bool Trail::isStillSince(SimTime time) const {
    if (entries_.empty()) return true;
    const auto* const last = entries_.back().moment.get();
    // Once somebody has moved, earlier moments are others.
    for (std::size_t i = entries_.size(); i-- > 0;) {
        if (entries_[i].moment.get() != last) return false;
        if (entries_[i].time <= time) return true;
    }
    return true;
}

Trail::Walk::Walk(const Trail& trail, SimTime begin) : trail_(&trail), begin_(begin) { to(0); }

double Trail::Walk::secondsTo(std::size_t entry) const {
    return seconds(trail_->entries_[entry].time - begin_);
}

void Trail::Walk::to(double later) {
    const std::size_t count = trail_->entries_.size();
    while (after_ < count && secondsTo(after_) < later) ++after_;
    before_ = after_ == 0 ? 0 : after_ - 1;
    share_ = 0;
    if (after_ == 0 || after_ >= count) return;
    const double from = secondsTo(before_);
    share_ = (later - from) / (secondsTo(after_) - from);
}

Pose2 Trail::Walk::robot(std::size_t index) const {
    const Pose2& from = trail_->entries_[before_].moment->places.robots[index];
    if (share_ == 0) return from;
    return poseBetween(from, trail_->entries_[after_].moment->places.robots[index], share_);
}

Pose2 Trail::Walk::person(std::size_t index) const {
    const Pose2& from = trail_->entries_[before_].moment->places.people[index];
    if (share_ == 0) return from;
    return poseBetween(from, trail_->entries_[after_].moment->places.people[index], share_);
}

const MovingBodies& Trail::Walk::bodies() const {
    constexpr double kHalf = 0.5;
    const std::size_t entry = share_ > kHalf ? after_ : before_;
    return trail_->entries_[entry].moment->bodies;
}

}  // namespace ispace

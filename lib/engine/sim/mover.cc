// SPDX-License-Identifier: GPL-3.0-or-later
// Poses over time, and people as robots. A trail stores one moment for all steps in which no mover
// moves.
#include "sim/mover.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "scene/bodies.h"
#include "scene/robot.h"

namespace ispace {

namespace {

/// Returns the shortest time between two stored moments.
SimTime spacingOf(SimTime length, const Movers& movers) {
    constexpr std::size_t kMaxBodies = std::size_t{1} << 19U;
    constexpr std::size_t kPartsOfPerson = 16;
    const std::size_t bodies = movers.robots.size() + kPartsOfPerson * movers.people.size();
    const auto moments = std::clamp<std::size_t>(kMaxBodies / (bodies + 1), 16, 4096);
    return length / static_cast<SimTime::rep>(moments);
}

}  // namespace

MoverPoses::MoverPoses(const Movers& movers) : swings(movers.swings.begin(), movers.swings.end()) {
    robots.reserve(movers.robots.size());
    for (const Motion& motion : movers.robots) robots.push_back(motion.pose);
    people.reserve(movers.people.size());
    for (const Motion& motion : movers.people) people.push_back(motion.pose);
}

void PoseHistory::add(SimTime time, const Movers& movers, bool moved) {
    if (!isKept()) return;
    std::shared_ptr<Moment> moment;
    if (!moved && !entries_.empty()) moment = entries_.back().moment;
    while (!entries_.empty() && entries_.back().time >= time) entries_.pop_back();
    // The newest one is always kept.
    if (entries_.size() > 1 &&
        entries_[entries_.size() - 2].time + spacingOf(length_, movers) > time)
        entries_.pop_back();
    if (!moment) moment = std::make_shared<Moment>(Moment{MoverPoses(movers)});
    entries_.push_back({time, std::move(moment)});
    while (entries_.size() > 1 && entries_[1].time + length_ <= time) entries_.pop_front();
}

void PoseHistory::goOn(const PoseHistory& before, Indices robots, Indices people,
                       const MoverPoses& now) {
    entries_.clear();
    if (!isKept()) return;
    const Moment* last = nullptr;
    for (const Entry& entry : before.entries_) {
        if (entry.moment.get() == last) {
            entries_.push_back({entry.time, entries_.back().moment});
            continue;
        }
        last = entry.moment.get();
        const MoverPoses& was = last->places;
        auto moment = std::make_shared<Moment>(Moment{now});
        for (std::size_t i = 0; i < robots.size(); ++i)
            if (robots[i]) moment->places.robots[i] = was.robots[*robots[i]];
        for (std::size_t i = 0; i < people.size(); ++i) {
            if (!people[i]) continue;
            moment->places.people[i] = was.people[*people[i]];
            moment->places.swings[i] = was.swings[*people[i]];
        }
        entries_.push_back({entry.time, std::move(moment)});
    }
}

void PoseHistory::makeBodies(SimTime since, const SetBodies& set_bodies) {
    std::vector<Moment*> bare;
    for (std::size_t i = entries_.size(); i-- > 0;) {
        Moment& moment = *entries_[i].moment;
        if (!std::exchange(moment.has_bodies, true)) bare.push_back(&moment);
        if (entries_[i].time <= since) break;
    }
    tbb::parallel_for(std::size_t{0}, bare.size(),
                      [&](std::size_t i) { set_bodies(bare[i]->places, bare[i]->bodies); });
}

bool PoseHistory::isStillSince(SimTime time) const {
    if (entries_.empty()) return true;
    const auto* const last = entries_.back().moment.get();
    // Once a mover has moved, earlier moments differ.
    for (std::size_t i = entries_.size(); i-- > 0;) {
        if (entries_[i].moment.get() != last) return false;
        if (entries_[i].time <= time) return true;
    }
    return true;
}

PoseHistory::Walk::Walk(const PoseHistory& trail, SimTime begin) : trail_(&trail), begin_(begin) {
    to(0);
}

double PoseHistory::Walk::secondsTo(std::size_t entry) const {
    return seconds(trail_->entries_[entry].time - begin_);
}

void PoseHistory::Walk::to(double later) {
    const std::size_t count = trail_->entries_.size();
    while (after_ < count && secondsTo(after_) < later) ++after_;
    before_ = after_ == 0 ? 0 : after_ - 1;
}

double PoseHistory::Walk::end() const {
    return after_ < trail_->entries_.size() ? secondsTo(after_)
                                            : std::numeric_limits<double>::infinity();
}

PoseHistory::Walk::Share PoseHistory::Walk::share() const {
    if (before_ == last()) return {};
    const double from = secondsTo(before_), rate = 1 / (secondsTo(after_) - from);
    return {-from * rate, rate};
}

const MovingBodies& PoseHistory::Walk::bodies(double share) const {
    constexpr double kHalf = 0.5;
    return trail_->entries_[share > kHalf ? last() : before_].moment->bodies;
}

std::vector<Mover> moversOf(const Scene& scene) {
    std::vector<Mover> movers;
    movers.reserve(scene.robots.size() + scene.people.size());
    for (const PlacedRobot& robot : scene.robots)
        movers.push_back({robot.id, robot.model, robot.pose, robot.course, robot.place});
    for (const PlacedPerson& person : scene.people)
        movers.push_back({person.id, modelOf(person), person.pose, person.course, person.place,
                          true, person.figure});
    return movers;
}

std::string_view Mover::rest() const {
    if (figure == nullptr) return "";
    return figure->rest;
}

RobotModel modelOf(const PlacedPerson& person) {
    constexpr double kRelaxation = 0.5, kHurry = 1.3;
    RobotModel model;
    model.radius = humanRadius(person.height);
    model.height = person.height;
    model.speed = person.speed;
    model.max_speed = kHurry * person.speed;
    model.accel = person.speed / kRelaxation;
    model.rotspeed = Angle::degrees(180);
    model.max_rotspeed = Angle::degrees(360);
    model.rotaccel = Angle::degrees(720);
    model.drive = Drive::Omni;
    model.max_sidespeed = person.speed / 2;
    return model;
}

Angle Gait::swing(double speed) const { return limbSwing(phase, speed); }

void Gait::walk(double height, double way, double speed) {
    if (way == 0 || speed == 0) return;
    phase += way / (strideOf(height) * shareOfSwing(speed));
    phase -= std::floor(phase);
    if (phase >= 1) phase = 0;  // slightly below 0, rounded
}

}  // namespace ispace

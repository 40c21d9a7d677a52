// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/replay.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "sim/world_state.h"

namespace ispace {

namespace {

RobotStatus statusOf(const RunState& state) {
    return {.pose = state.pose,
            .speed = state.speed,
            .rotspeed = state.rotspeed,
            .accel = state.accel,
            .rotaccel = state.rotaccel,
            .stall = state.is_stalled,
            .sidespeed = state.sidespeed,
            .phase = state.phase};
}

}  // namespace

SimTime recordedTime(double seconds) {
    constexpr double kNanoseconds = 1e9;
    return SimTime(std::llround(seconds * kNanoseconds));
}

Replay::Replay(const std::string& folder) : Replay(folder, std::optional<SimTime>()) {}

Replay::Replay(const std::string& folder, SimTime step) : Replay(folder, std::optional(step)) {}

Replay::Replay(const std::string& folder, std::optional<SimTime> joined_step)
    : folder_(folder), is_joined_(joined_step), reader_(folder) {
    const bool has_moment = reader_.next();
    has_moments_ = has_moment;
    const auto info = recordedInfo(folder);
    if (!has_moment && !is_joined_ && (!info || info->steps == 0))
        throw FormatError({reader_.name(), 0, 0,
                           "holds no moment of a run, and no info.csv tells how long that was"});
    if (const auto change = recordedChange(folder)) changed_ = recordedTime(*change);
    const SimTime begin = has_moment ? recordedTime(reader_.time()) : SimTime(0);
    info_ = info.value_or(RunInfo());
    // A record without a moment of the start began without movers.
    is_late_ = is_joined_ ? !has_moment || begin > SimTime(0)
                          : begin > SimTime(0) && info && isEmptyAt(SimTime(0));
    if (!is_late_) start_.assign(reader_.states().begin(), reader_.states().end());
    is_ahead_ = has_moment && (is_late_ || reader_.next());
    if (info)
        step_ = recordedTime(info->every);
    else if (is_joined_)
        step_ = *joined_step;
    else if (is_ahead_)
        step_ = recordedTime(reader_.time()) - begin;
    else
        step_ = std::chrono::milliseconds(5);
    is_still_ = !has_moment && end().value_or(SimTime(0)) > SimTime(0);
    if ((begin != SimTime(0) && !is_late_) || step_ < World::kMinStep || step_ > World::kMaxStep)
        throw FormatError({reader_.name(), 0, 0,
                           "begins at t=" + formatSimTime(begin) + " with steps of " +
                               formatSimTime(step_) + " s, wanted 0 and from " +
                               formatSimTime(World::kMinStep) + " to " +
                               formatSimTime(World::kMaxStep) + " s"});
}

void Replay::placeAtStart(Scene& scene) const {
    std::unordered_map<std::string_view, Pose2> places;
    std::unordered_set<std::string_view> ids;
    for (const RunState& state : start_) {
        const RunMember& member = reader_.members()[state.member];
        const auto has = [&member](const auto& list) {
            return std::any_of(list.begin(), list.end(),
                               [&member](const auto& each) { return each.id == member.id; });
        };
        if (member.is_person ? !has(scene.people) : !has(scene.robots))
            throw FormatError({reader_.name(), 0, 0,
                               std::string("the scene has no ") +
                                   (member.is_person ? "person " : "robot ") + excerpt(member.id) +
                                   ": it is not that of the record"});
        ids.insert(member.id);
        places.emplace(member.id, state.pose);
    }
    keepInPlace(scene, ids, places);
}

/// Returns true if the record may lack the moment at a time because the world had no movers. A
/// change takes effect before the next step.
bool Replay::isEmptyAt(SimTime time) const {
    const SimTime next = recordedTime(reader_.time());
    if (is_joined_ && !is_ahead_) return true;
    return changed_ && *changed_ <= next && time < next;
}

std::function<void()> Replay::preparation(const World& world, std::optional<SimTime> to) {
    if (to && *to < world.time())
        return [this, prepare = world.preparer(), start = world.sharedBeginning()] {
            prepared_.emplace(Prepared{true, {}, prepare(Scene(*start))});
        };
    if (to && *to < world.time() + step_) return nullptr;
    const double before = seconds(world.time() + step_);
    const bool may_change = !atEnd() || is_joined_;
    if (!may_change || !run_changes_ || !run_changes_->isDue(before)) return nullptr;
    std::unordered_map<std::string_view, Pose2> places;
    for (std::size_t i = 0; i < world.movers().size(); ++i)
        places.emplace(world.movers()[i].id, world.status(i).pose);
    return [this, before, scene = world.sharedScene(), prepare = world.preparer(),
            places = std::move(places)] {
        prepared_ = Prepared{false, std::nullopt, {}};
        auto& [rewinds, step, next] = *prepared_;
        step = run_changes_->next(before, *scene, [&places](const std::string& id) {
            const auto place = places.find(id);
            return place == places.end() ? std::nullopt : std::optional(place->second);
        });
        if (!step) return;
        try {
            next = prepare(std::move(step->scene));
        } catch (const FormatError& error) {
            run_changes_->refuse(error.what());
            step.reset();
        }
    };
}

std::shared_ptr<const void> Replay::adopt(World& world) {
    if (!prepared_) return nullptr;
    const Prepared prepared = std::exchange(prepared_, std::nullopt).value();
    if (prepared.rewinds) return rewind(world, prepared.next);
    if (!prepared.step) return nullptr;
    try {
        auto old = prepared.step->restarts ? world.restart(prepared.next)
                                           : world.change(prepared.next, prepared.step->placed);
        made_.push_back(prepared.step->change);
        return old;
    } catch (const FormatError& error) {
        run_changes_->refuse(error.what());
        return nullptr;
    }
}

void Replay::prepareAll(World& world, std::optional<SimTime> to,
                        const std::function<void()>& adopted) {
    while (const auto prepare = preparation(world, to)) {
        prepare();
        adopt(world);
        if (adopted) adopted();
    }
}

/// Indices shift when a world changes, and members are added while the record is read.
void Replay::find(const World& world) {
    if (changes_ != world.changes()) movers_.clear();
    changes_ = world.changes();
    const std::vector<RunMember>& members = reader_.members();
    for (std::size_t i = movers_.size(); i < members.size(); ++i)
        movers_.push_back(world.moverNamed(members[i].id));
}

/// Reads the collisions of the next step.
void Replay::collide(const World& world) {
    collisions_.clear();
    const SimTime time = world.time() + step_;
    if (const auto recorded = reader_.collisions()) {
        recorded_.assign(recorded->begin(), recorded->end());
        for (const auto& [id, other] : recorded_)
            if (const auto mover = world.moverNamed(id))
                collisions_.push_back({*mover, world.moverNamed(other), other, time});
        return;
    }
    for (std::size_t i = 0; i < states_.size(); ++i)
        if (states_[i].stall && !world.status(i).stall)
            collisions_.push_back({i, std::nullopt, "something", time});
}

/// Reads the targets that are given up in the next step.
void Replay::giveUp(const World& world) {
    for (const RunUnreached& target : reader_.unreached()) {
        const auto mover = world.moverNamed(target.id);
        if (mover && target.at && target.to.empty())
            points_.push_back({*mover, *target.at});
        else
            unreached_.push_back(target);
    }
}

bool Replay::step(World& world) { return step(world, true); }

bool Replay::step(World& world, bool reads) {
    points_.clear();
    unreached_.clear();
    if (atEnd() && !is_joined_) return false;
    const SimTime now = world.time() + step_;
    const SimTime time = is_ahead_ ? recordedTime(reader_.time()) : now;
    const bool is_empty = is_still_ || (isEmptyAt(now) && (time - now) % step_ == SimTime(0));
    if (time != now && !is_empty)
        throw FormatError(
            {reader_.name(), 0, 0,
             "goes on at t=" + formatSimTime(time) + ", wanted t=" + formatSimTime(now)});
    prepareAll(world, {});
    find(world);
    states_.resize(world.movers().size());
    for (std::size_t i = 0; i < states_.size(); ++i) states_[i] = world.status(i);
    if (is_empty) {
        reads ? world.stepTo(states_, {}) : world.passTo(states_);
        if (is_still_) readNext(world);
        return true;
    }
    odometries_.assign(world.robots().size(), std::nullopt);
    for (const RunState& state : reader_.states()) {
        const auto mover = movers_[state.member];
        if (!mover) continue;
        states_[*mover] = statusOf(state);
        if (*mover < odometries_.size()) odometries_[*mover] = state.odometry;
    }
    for (const auto& [id, hit] : reader_.bumpers())
        if (const auto robot = world.robotNamed(id)) world.setBumpers(*robot, hit);
    if (reads) {
        collide(world);
        giveUp(world);
        world.stepTo(states_, collisions_, odometries_, points_);
    } else {
        world.passTo(states_);
    }
    readNext(world);
    return true;
}

/// Reads the moment of the next step.
void Replay::readNext(const World& world) {
    is_ahead_ = reader_.next();
    // A change of the world may have taken the movers out; it is made before the next step.
    const SimTime next = world.time() + step_;
    const bool may_lack_movers = !has_moments_ || (changed_ && *changed_ <= next);
    is_still_ = !is_ahead_ && may_lack_movers && next <= end().value_or(SimTime(0));
}

std::shared_ptr<const void> Replay::rewind(World& world, const NextScene& beginning) {
    RunReader again(folder_);
    const bool has_moment = again.next();
    is_ahead_ = has_moment && (is_late_ || again.next());
    is_still_ = !has_moment && end().value_or(SimTime(0)) > SimTime(0);
    reader_ = std::move(again);
    movers_.clear();
    if (run_changes_) run_changes_->rewind();
    return world.rewind(beginning);
}

void Replay::seek(World& world, SimTime time) {
    do prepareAll(world, time);
    while (!seekSome(world, time, std::chrono::steady_clock::time_point::max()));
}

bool Replay::stepTowards(World& world, SimTime time) {
    // Every sensor is read once in its turn before that time; the first scan of a spinning laser
    // after it may lack its beginning, and the next one is late.
    if (settled_changes_ != world.changes()) {
        settled_changes_ = world.changes();
        settle_ = 0;
        for (const Sensor& sensor : world.sensors()) {
            const auto* laser = sensor.tryAs<Laser>();
            const int periods = laser != nullptr && laser->duration() > 0 ? 4 : 1;
            settle_ = std::max(settle_, periods * (1 / periodRate(sensor) + 2 * seconds(step_)));
        }
    }
    return step(world, seconds(time - world.time()) <= settle_);
}

bool Replay::seekSome(World& world, SimTime time, std::chrono::steady_clock::time_point until) {
    if (time < world.time()) return false;
    while (world.time() + step_ <= time) {
        if (preparation(world) != nullptr) return false;
        if (!stepTowards(world, time)) break;
        if (std::chrono::steady_clock::now() >= until) return false;
    }
    return true;
}

std::optional<SimTime> Replay::end() const {
    if (info_.steps == 0) return std::nullopt;
    return info_.steps * recordedTime(info_.step) / step_ * step_;
}

Motion motionOf(const RobotStatus& status) {
    Motion motion;
    motion.pose = {status.pose.position, wrapped(status.pose.heading)};
    motion.drive.speed = status.speed;
    motion.drive.accel = status.accel;
    motion.turn.speed = status.rotspeed.degrees();
    motion.turn.accel = status.rotaccel.degrees();
    motion.side.speed = status.sidespeed;
    return motion;
}

}  // namespace ispace

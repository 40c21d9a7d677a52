// SPDX-License-Identifier: GPL-3.0-or-later
#include "sim/world_data.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/replay.h"

namespace ispace {

namespace {

/// Metres around a robot within which obstacles are looked for: farther ones are looked for again
/// when it has gone as far.
constexpr double kLookout = 1;

std::map<std::string_view, std::size_t> indexById(const auto& things) {
    std::map<std::string_view, std::size_t> index;
    for (std::size_t i = 0; i < things.size(); ++i) index.emplace(things[i].id, i);
    return index;
}

}  // namespace

World::Data::Data(std::shared_ptr<const Scene> room, SimTime length, const RunOptions& run)
    : scene(room),
      start(std::move(room)),
      options(run),
      step_length(length),
      movers(moversOf(*scene)),
      mover_index(indexById(movers)),
      obstacles(obstaclesOf(scene->environment, movers)),
      friction(scene->environment),
      order(settlingOrder(movers)),
      motions(movers.size()),
      states(movers.size()),
      gaits(scene->people.size()),
      swings(scene->people.size()),
      pilots(movers.size()),
      moves(movers.size()),
      traffic(movers, order, seconds(length)),
      sensors(*scene, {run.seed, run.sensor_noise, length}),
      sensor_index(indexById(sensors.sensors())) {
    checkStart(scene->environment, movers, obstacles);
    if (options.noise) kept_starts = strayStarts(movers, obstacles, options.seed);
    odometers.reserve(scene->robots.size());
    for (std::size_t i = 0; i < motions.size(); ++i) {
        const auto& [id, model, pose, course, place, is_person] = movers[i];
        motions[i].pose = {pose.position, wrapped(pose.heading)};
        states[i].obstacles = &obstacles.at(model.height);
        states[i].limits = limitsOf(model, 0);
        if (!is_person) odometers.emplace_back(movers[i], options.seed, options.noise);
        pilots[i] = Pilot(movers[i], options.seed);
        pilots[i].follow(course, model.speed, false);
        moves[i].from = &motions[i];
        moves[i].limits = &states[i].limits;
        moves[i].duration = seconds(length);
        moves[i].radius = model.radius;
    }
}

void World::Data::proposeAll() {
    if (std::exchange(moved, false)) traffic.rebuild(motions);
    const Surroundings around{movers, motions, &traffic};
    // Fewer are done before other threads have begun.
    constexpr std::size_t kTogether = 64;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, movers.size(), kTogether),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                          for (std::size_t i = range.begin(); i < range.end(); ++i)
                              propose(i, around);
                      });
}

/// Independent of all other proposals: of others only place and speed count, which stay.
void World::Data::propose(std::size_t mover, const Surroundings& around) {
    Move& move = moves[mover];
    Motion& motion = motions[mover];
    states[mover].blocked.reset();
    if (const SimTime now = time - step_length; pilots[mover].isDue(now, motion))
        pilots[mover].steer({&around, states[mover].obstacles, &states[mover].vicinity, mover,
                             states[mover].clearance, now, step_length},
                            motion);
    if (motion.arrived()) {
        move.to = {.motion = motion};
        move.drift = {};
        return;
    }
    setLimits(mover);
    move.to = advance(motion, states[mover].limits, move.duration);
    if (mover < odometers.size() && odometers[mover].isNoisy()) {
        move.drift = odometers[mover].stray(move.to.motion, motion.pose, steps);
        move.to.path += length(move.drift);
    }
    states[mover].blocked = elementAhead(mover);
}

void World::Data::setLimits(std::size_t mover) {
    MotionLimits& limits = states[mover].limits;
    const double rough = friction.at(motions[mover].pose.position);
    if (!friction.empty()) limits = limitsOf(movers[mover].model, rough);
    if (const auto& own = states[mover].own_limits) {
        limits = narrowed(limitsOf(movers[mover].model, rough), *own, rough);
        return;
    }
    const double speed = pilots[mover].isOn() ? pilots[mover].speed() : movers[mover].model.speed;
    limits.drive.top = (1 - rough) * speed;
}

std::optional<std::size_t> World::Data::elementAhead(std::size_t mover) {
    const Move& move = moves[mover];
    MoverState& state = states[mover];
    if (move.to.path == 0) return std::nullopt;
    if (state.clearance < move.to.path) {
        const double around = move.radius + kLookout;
        state.clearance = state.obstacles->nearest(move.start(), around) - move.radius - kTouch;
        if (state.clearance < move.to.path) {
            if (const auto element = collides(move, *state.obstacles)) return element;
        }
    }
    state.clearance -= move.to.path;
    return std::nullopt;
}

/// One after another: each move depends on what became of those before it.
void World::Data::settle() {
    const bool any =
        std::any_of(moves.begin(), moves.end(), [](const Move& move) { return move.to.path > 0; });
    if (!any) return;
    for (const std::size_t mover : order) {
        if (moves[mover].to.path == 0) continue;
        if (states[mover].blocked) {
            collide({mover, std::nullopt, elements()[*states[mover].blocked].id, time});
        } else if (const auto other = traffic.hit(moves, mover)) {
            collide({mover, other, movers[*other].id, time});
        }
    }
}

void World::Data::collide(const Collision& collision) {
    Move& move = moves[collision.robot];
    states[collision.robot].bump = move.end() - move.start();
    move.cancel();
    if (collision.robot < odometers.size()) odometers[collision.robot].stay();
    if (pilots[collision.robot].isOn()) return pilots[collision.robot].bumped();
    states[collision.robot].stall = true;
    collisions.push_back(collision);
}

void World::Data::apply() {
    for (const std::size_t mover : order) {
        Motion& motion = motions[mover];
        if (moves[mover].to.motion.pose != motion.pose) {
            moved = true;
            sensors.moved();
        }
        motion = moves[mover].to.motion;
        if (movers[mover].is_person)
            walk(mover);
        else
            odometers[mover].count(steps);
        if (states[mover].running == 0) continue;
        if (Pilot& pilot = pilots[mover]; pilot.isOn()) {
            continue;
        } else if (pilot.state() != Pilot::State::Off) {
            end(mover, pilot.state() == Pilot::State::Arrived ? Outcome::Done : Outcome::Unreached);
            pilot.turnOff();
        } else if (states[mover].stall) {
            end(mover, Outcome::Stall);
        } else if (motion.arrived()) {
            end(mover, Outcome::Done);
            motion.halt();
        }
    }
}

void World::Data::walk(std::size_t mover) {
    const std::size_t person = mover - scene->robots.size();
    const Motion& motion = motions[mover];
    const double speed = std::hypot(motion.drive.speed, motion.side.speed);
    const double path = moves[mover].to.path;
    gaits[person].walk(movers[mover].model.height, motion.drive.speed < 0 ? -path : path, speed);
    swings[person] = gaits[person].swing(speed);
}

void World::Data::tell(std::size_t mover) {
    MoverState& state = states[mover];
    if (state.told == 0) state.told_first = time;
    if (state.told == 0 || state.told_last != time) ++state.told;
    state.told_last = time;
}

void World::Data::put(std::size_t mover, const RobotStatus& status) {
    moved = moved || status.pose != motions[mover].pose;
    if (moved) sensors.moved();
    motions[mover] = motionOf(status);
    states[mover].stall = status.stall;
    if (!movers[mover].is_person) return;
    Gait& gait = gaits[mover - scene->robots.size()];
    gait.phase = status.phase;
    swings[mover - scene->robots.size()] = gait.swing(std::hypot(status.speed, status.sidespeed));
}

void World::Data::keepGait(std::size_t mover, const Data& before, std::size_t old) {
    if (!movers[mover].is_person || !before.movers[old].is_person) return;
    const std::size_t person = mover - scene->robots.size();
    const std::size_t was = old - before.scene->robots.size();
    gaits[person] = before.gaits[was];
    swings[person] = before.swings[was];
}

void World::Data::end(std::size_t mover, Outcome outcome) {
    ends.push_back({mover, std::exchange(states[mover].running, 0), outcome, time});
}

std::unordered_map<std::string_view, Pose2> World::Data::places() const {
    std::unordered_map<std::string_view, Pose2> places;
    for (std::size_t i = 0; i < motions.size(); ++i) places.emplace(movers[i].id, motions[i].pose);
    return places;
}

std::unique_ptr<World::Data> World::Data::next(
    Scene next_scene, const std::unordered_set<std::string_view>& stayers) const {
    auto after = std::make_unique<Data>(std::make_shared<const Scene>(std::move(next_scene)),
                                        step_length, options);
    after->start = start;
    after->time = time;
    after->steps = steps;
    after->changes = changes + 1;
    for (std::size_t i = 0; i < after->motions.size(); ++i) {
        const std::string& id = after->movers[i].id;
        const auto old = moverNamed(id);
        if (!old) continue;
        MoverState& state = after->states[i];
        state.ids = states[*old].ids;
        state.told = states[*old].told;
        state.told_first = states[*old].told_first;
        state.told_last = states[*old].told_last;
        state.running = states[*old].running;
        if (stayers.contains(id)) {
            state.stall = states[*old].stall;
            state.bump = states[*old].bump;
            state.recorded_bumpers = states[*old].recorded_bumpers;
            state.own_limits = states[*old].own_limits;
            after->motions[i] = motions[*old];
            if (after->movers[i].course == movers[*old].course) after->pilots[i] = pilots[*old];
            after->keepGait(i, *this, *old);
            if (i < after->odometers.size()) after->odometers[i] = odometers[*old];
        } else if (state.running != 0) {
            after->end(i, Outcome::Stopped);
        }
    }
    after->sensors.follow(sensors, stayers, after->where());
    after->sensors.read(time, after->where());
    return after;
}

}  // namespace ispace
